//! The engine that searches a hierarchy, one short file a question.

mod clearance;
mod motion;
mod prepared_mesh;
mod proof;
mod search;
mod side;

pub use search::BvhSearch;
