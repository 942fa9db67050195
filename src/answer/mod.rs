//! Results and errors: plain data, in the mesh's frame and unit. Nothing here computes.

mod chain;
mod checked_fields;
mod engine;
mod error;
mod motion;
mod robots;
mod scene;
mod scene_motion;
mod surface;
mod tube;
mod witness;

pub use chain::{
    Certificate, Contact, ContactFeature, Derivative, LinkFeature, LinkProximity, TriangleFeature,
};
pub use engine::{InsideAnswer, Proof, Side, Work};
pub use error::{MeshError, PlacementFault, ProximityError};
#[cfg(feature = "gpu")]
pub use gpu_batch::DeviceFailure;
pub use motion::{MotionAnswer, MotionClearance, ShapeInContact};
pub use robots::{
    RobotClearance, RobotMotionAnswer, RobotMotionClearance, RobotProximity, RobotsInContact,
};
pub use scene::{Between, SceneContact, SceneError, StructureProximity, Tightest};
pub use scene_motion::{
    SceneClearance, SceneMotionAnswer, SceneMotionClearance, SceneMotionContact, ScenePlace,
};
pub use surface::{Opening, SurfaceReport};
pub use tube::{Clearance, Decision, TubePiece, UndecidedReason};
pub use witness::{PairWitness, Witness};
