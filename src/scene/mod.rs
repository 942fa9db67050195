//! Scenes: several structures and robots, queried together.

mod batch;
mod bounding_box;
mod distance_cache;
mod least_slack;
mod motions;
mod moving_robot;
mod odometer;
mod queries;
mod scene_bounds;
mod solid;
mod structure;
mod structure_end;
mod tubes;

pub use queries::Scene;
pub use structure_end::StructureEnd;
