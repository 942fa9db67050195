//! The engines, and the trait that all of them implement.

pub(crate) mod bvh;
#[cfg(test)]
mod definitions;
mod exhaustive;
mod proximity;
mod robot_pair;
mod self_query;

pub use bvh::BvhSearch;
pub(crate) use bvh::SceneMotion;
pub use exhaustive::{Exhaustive, SearchPrecision};
pub use proximity::Proximity;
#[cfg(feature = "gpu")]
pub(crate) use proximity::placed;
pub(crate) use proximity::{Engine, any_triangle};
pub use robot_pair::RobotPair;
pub use self_query::SelfQuery;
