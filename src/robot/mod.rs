//! The robot: links with a flat or round cap at each end, and chains of links.

mod algorithm_1;
mod chain;
mod compare;
mod error;
mod link_tree;
mod modified_cylinder;
mod radius_steps;
mod registration;
mod scale;
#[cfg(feature = "serde-serialize")]
mod serialised;
mod simplify;
mod to_trimesh;

pub(crate) use algorithm_1::from_link_radii;
pub use chain::Chain;
pub(crate) use chain::{check_chain, check_segments, radius_for_all, without_length};
pub use error::RobotError;
pub(crate) use error::number;
pub(crate) use link_tree::{BoundingCapsule, LinkNode, distance_to_segment, place_of_leaf};
pub(crate) use modified_cylinder::{COORDINATE_LIMIT, check_place, check_radii, has_direction};
pub use modified_cylinder::{Cap, ModifiedCylinder};
pub(crate) use radius_steps::{RadiusSteps, is_same, is_step};
pub use registration::{MatrixError, pose_from_matrix};
pub(crate) use registration::{NotRigid, rigid, rotation_by};
pub(crate) use scale::{LEVEL, direction, length};
pub use simplify::simplify;
