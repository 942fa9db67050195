//! The robot: links with a flat or round cap at each end, chains of links, tubes and motions.

mod aabb;
mod algorithm_1;
mod cap;
mod chain;
mod compare;
mod constant_curvature;
mod convert;
mod error;
mod link_tree;
mod modified_cylinder;
mod motion;
mod radius_runs;
mod radius_steps;
mod registration;
mod rigid_pose;
mod scale;
#[cfg(feature = "serde-serialize")]
mod serialised;
mod sight;
mod simplify;
mod stations;
mod to_trimesh;
mod tube;

pub use cap::Cap;
pub use chain::Chain;
pub use constant_curvature::{BendingSection, ConstantCurvature};
pub use error::RobotError;
pub(crate) use link_tree::{BoundingCapsule, LinkNode, distance_to_segment, place_of_leaf};
pub(crate) use modified_cylinder::COORDINATE_LIMIT;
pub use modified_cylinder::ModifiedCylinder;
pub use motion::{
    BendingMotion, BendingRates, Course, LinearMotion, Motion, MotionPath, MovingBase, RigidMotion,
    Speed, bending_course, bending_speed, verify_motion,
};
pub(crate) use motion::{MotionDrift, SectionSignature, ShapePath, check_speed};
pub(crate) use radius_steps::is_step;
pub use registration::{MatrixError, pose_from_matrix};
pub(crate) use rigid_pose::{NotRigid, rigid};
pub(crate) use scale::{direction, length};
pub use simplify::simplify;
pub use stations::stations;
pub(crate) use tube::{CapPersistence, CurveBound, Drift, EndFace, Section, TooSharp, TubeTurns};
pub use tube::{Tube, TubeSection};
