//! The engine on a bounding volume hierarchy: one file per kind of query.

mod clearance;
mod motion;
mod prepared_mesh;
mod proof;
mod search;
mod sections;
mod side;

pub(crate) use motion::SceneMotion;
pub use search::BvhSearch;
