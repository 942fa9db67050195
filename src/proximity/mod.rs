//! Robot against mesh: the closest triangle of every link, by search or exhaustively.

mod bvh;
mod coarse;
mod engine;
mod exhaustive;
mod probe;
mod report;
mod search;

pub use bvh::BvhSearch;
pub use engine::Proximity;
pub use exhaustive::{Exhaustive, SearchPrecision};
pub use report::{LinkProximity, MeshError, ProximityError};
