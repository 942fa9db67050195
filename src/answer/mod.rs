//! Results and errors: plain data, in the mesh's frame and unit. Nothing here computes.

mod chain;
mod checked_fields;
#[cfg(feature = "tubes")]
mod decision;
mod engine;
mod error;
#[cfg(feature = "tubes")]
mod motion;
#[cfg(feature = "robots")]
mod pair_witness;
#[cfg(feature = "tubes")]
mod proof;
#[cfg(feature = "robots")]
mod robots;
#[cfg(feature = "robots")]
mod scene;
#[cfg(feature = "robots")]
mod scene_motion;
mod surface;
#[cfg(feature = "tubes")]
mod tube;
mod witness;

pub use chain::{
    Certificate, Contact, ContactFeature, Derivative, LinkFeature, LinkProximity, TriangleFeature,
};
#[cfg(feature = "tubes")]
pub use decision::{Decision, UndecidedReason};
pub use engine::{InsideAnswer, Side, Work};
pub use error::{MeshError, PlacementFault, ProximityError};
#[cfg(feature = "gpu")]
pub use gpu_batch::DeviceFailure;
#[cfg(feature = "tubes")]
pub use motion::{MotionAnswer, MotionClearance, ShapeInContact};
#[cfg(feature = "robots")]
pub use pair_witness::PairWitness;
#[cfg(feature = "tubes")]
pub use proof::Proof;
#[cfg(feature = "robots")]
pub use robots::{
    RobotClearance, RobotMotionAnswer, RobotMotionClearance, RobotProximity, RobotsInContact,
};
#[cfg(feature = "robots")]
pub use scene::{Between, SceneContact, SceneError, StructureProximity, Tightest};
#[cfg(feature = "robots")]
pub use scene_motion::{
    SceneClearance, SceneMotionAnswer, SceneMotionClearance, SceneMotionContact, ScenePlace,
};
pub use surface::{Opening, SurfaceReport};
#[cfg(feature = "tubes")]
pub use tube::{Clearance, TubePiece};
pub use witness::Witness;
