//! Robot against mesh: the closest triangle of every link, by search or exhaustively.

mod bvh;
mod coarse;
mod engine;
mod exhaustive;
mod packed;
mod probe;
mod report;
mod scan;
mod search;
mod soa;

pub use bvh::BvhSearch;
pub use engine::Proximity;
pub use exhaustive::{Exhaustive, Precision};
pub use report::{LinkProximity, MeshError, ProximityError};
pub use scan::Work;
