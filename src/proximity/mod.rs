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
#[cfg(feature = "serde-serialize")]
mod serialised;
mod share;
mod soa;
mod tree;
mod walk;

#[cfg(feature = "gpu")]
pub(crate) use coarse::{CoarseFrame, CoarseLink};
pub(crate) use probe::{Found, Probe};
#[cfg(feature = "gpu")]
pub(crate) use probe::{check_margin, check_moved, check_vertices, place};
#[cfg(feature = "gpu")]
pub(crate) use share::each;

pub use bvh::BvhSearch;
pub use certificate::Certificate;
pub use descent::Visits;
pub use engine::Proximity;
pub use exhaustive::{Exhaustive, Precision};
#[cfg(feature = "gpu")]
pub use report::DeviceFailure;
pub use report::{LinkProximity, MeshError, ProximityError};
pub use scan::Work;
