//! All places where a link is near the mesh: the local minima of the distance.

mod contact_collector;
mod descent_cull;
mod feature_cull;
mod local_minima;
mod long_rings;
mod prominence;
mod search;
mod triangle_candidates;

#[cfg(feature = "gpu")]
pub(crate) use contact_collector::contacts_by_all_triangles;
pub(crate) use contact_collector::{ContactCollector, ContactMemory};
pub(crate) use prominence::ContactQuery;
pub(crate) use search::{ContactSearch, OppositeCorners};
pub(crate) use triangle_candidates::Wall;
