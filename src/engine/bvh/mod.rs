//! The engine on a bounding volume hierarchy: one file per kind of query.

#[cfg(feature = "tubes")]
mod clearance;
#[cfg(feature = "tubes")]
mod motion;
mod prepared_mesh;
#[cfg(feature = "tubes")]
mod proof;
#[cfg(feature = "robots")]
mod scene;
mod search;
mod sections;
mod side;

#[cfg(feature = "robots")]
pub(crate) use scene::SceneMotion;
pub use search::BvhSearch;
