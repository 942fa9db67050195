//! Robot against mesh: the closest triangle of every link, by search or exhaustively.

mod bvh;
mod certificate;
mod coarse;
mod descent;
mod engine;
mod exhaustive;
mod packed;
mod patch;
mod placed;
mod probe;
mod report;
mod scan;
mod search;
#[cfg(feature = "serde-serialize")]
mod serialised;
mod share;
mod soa;
mod tree;
mod walk;

pub(crate) use probe::Probe;
pub(crate) use search::{Found, Until, search};

pub use bvh::BvhSearch;
pub use certificate::Certificate;
pub use descent::Visits;
pub use engine::Proximity;
pub use exhaustive::{Exhaustive, Precision};
pub use report::{LinkProximity, MeshError, ProximityError};
pub use scan::Work;
