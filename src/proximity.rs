//! Robot against mesh: the closest triangle of every link, by search or exhaustively.

#[cfg(feature = "gpu")]
pub use crate::answer::DeviceFailure;
pub use crate::answer::{
    Certificate, Clearance, Contact, ContactFeature, Decision, Derivative, FirstContact, InsideAnswer,
    LinkFeature, LinkProximity, MeshError, MotionAnswer, ProximityError, Side, TriangleFeature, TubePiece,
    Work,
};
pub use crate::engine::{BvhSearch, Exhaustive, Proximity, SearchPrecision};
