//! The robot: links with a flat or round cap at each end, and chains of links.

mod algorithm_1;
mod chain;
mod compare;
mod constant_curvature;
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

pub use chain::Chain;
pub use constant_curvature::{BendingSection, ConstantCurvature};
pub use error::RobotError;
pub(crate) use error::number;
pub(crate) use link_tree::{
    BoundingCapsule, LinkNode, distance_to_segment, place_of_leaf, share_along,
};
pub(crate) use modified_cylinder::{COORDINATE_LIMIT, check_radii};
pub use modified_cylinder::{Cap, ModifiedCylinder};
pub use registration::{MatrixError, pose_from_matrix};
pub(crate) use registration::{NotRigid, rigid, rotation_by};
pub(crate) use scale::{direction, length};
pub use simplify::simplify;
#[cfg(feature = "tubes")]
pub(crate) use {
    algorithm_1::from_link_radii,
    chain::{check_chain, check_segments, radius_for_all, without_length},
    constant_curvature::{Arc, check_bending, check_sections},
    modified_cylinder::{check_place, has_direction},
    radius_steps::{RadiusSteps, is_same},
};
#[cfg(feature = "robots")]
pub(crate) use {
    radius_steps::is_step,
    scale::{LEVEL, length_and_direction},
};
