//! What comes back: plain data and errors, in the mesh's frame and unit. Nothing here computes.

mod certificate;
mod clearance;
mod contact;
mod decision;
mod derivative;
mod error;
mod feature;
mod first_contact;
mod inside_answer;
mod link_proximity;
mod motion_answer;
#[cfg(feature = "serde-serialize")]
mod motion_serialised;
#[cfg(feature = "serde-serialize")]
mod place;
mod side;
mod tube_piece;
mod work;

pub use certificate::Certificate;
pub use clearance::Clearance;
pub use contact::Contact;
pub use decision::Decision;
pub use derivative::Derivative;
#[cfg(feature = "gpu")]
pub use error::DeviceFailure;
pub use error::{MeshError, ProximityError};
pub use feature::{ContactFeature, LinkFeature, TriangleFeature};
pub use first_contact::FirstContact;
pub use inside_answer::InsideAnswer;
pub use link_proximity::LinkProximity;
pub use motion_answer::MotionAnswer;
pub use side::Side;
pub use tube_piece::TubePiece;
pub use work::Work;
