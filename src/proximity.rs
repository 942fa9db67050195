//! Robot against mesh: the closest triangle of every link, by search or exhaustively.

#[cfg(feature = "gpu")]
pub use crate::answer::DeviceFailure;
pub use crate::answer::{
    Certificate, Clearance, Contact, ContactFeature, Decision, Derivative, InsideAnswer, LinkFeature,
    LinkProximity, MeshError, MotionAnswer, ProximityError, ShapeInContact, Side, TriangleFeature, TubePiece,
    Witness, Work,
};
pub use crate::engine::{BvhSearch, Exhaustive, Proximity, SearchPrecision};
