//! The engines, and the trait that all of them implement.

pub(crate) mod bvh;
#[cfg(test)]
mod definitions;
#[cfg(feature = "exhaustive")]
mod exhaustive;
mod proximity;
#[cfg(feature = "robots")]
mod robot_pair;
#[cfg(feature = "robots")]
mod self_query;

pub use bvh::BvhSearch;
#[cfg(feature = "robots")]
pub(crate) use bvh::SceneMotion;
#[cfg(feature = "exhaustive")]
pub use exhaustive::{Exhaustive, SearchPrecision};
pub use proximity::Proximity;
#[cfg(feature = "gpu")]
pub(crate) use proximity::placed;
pub(crate) use proximity::{Engine, any_triangle};
#[cfg(feature = "robots")]
pub use robot_pair::RobotPair;
#[cfg(feature = "robots")]
pub use self_query::SelfQuery;
