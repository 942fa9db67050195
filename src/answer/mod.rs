//! What comes back: plain data and errors, in the mesh's frame and unit. Nothing here computes.

mod certificate;
mod checked_fields;
mod clearance;
mod contact;
mod decision;
mod derivative;
mod error;
mod feature;
mod inside_answer;
mod link_proximity;
mod motion_answer;
mod motion_clearance;
mod proof;
mod robot_clearance;
mod robot_proximity;
mod scene_answers;
mod scene_error;
mod shape_in_contact;
mod side;
mod tube_piece;
mod witness;
mod work;

pub use certificate::Certificate;
pub use clearance::Clearance;
pub use contact::Contact;
pub use decision::Decision;
pub use derivative::Derivative;
pub use error::{MeshError, PlacementFault, ProximityError};
pub use feature::{ContactFeature, LinkFeature, TriangleFeature};
#[cfg(feature = "gpu")]
pub use gpu_batch::DeviceFailure;
pub use inside_answer::InsideAnswer;
pub use link_proximity::LinkProximity;
pub use motion_answer::MotionAnswer;
pub use motion_clearance::MotionClearance;
pub use proof::Proof;
pub use robot_clearance::RobotClearance;
pub use robot_proximity::RobotProximity;
pub use scene_answers::{Between, SceneContact, StructureProximity, Tightest};
pub use scene_error::SceneError;
pub use shape_in_contact::ShapeInContact;
pub use side::Side;
pub use tube_piece::TubePiece;
pub use witness::Witness;
pub use work::Work;
