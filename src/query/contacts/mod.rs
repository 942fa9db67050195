//! All places where a link is near the mesh: the local minima of the distance.

mod descent_cull;
mod feature_cull;
mod local_minima;
mod prominence;
mod search;
mod triangle_candidates;
mod wall_components;

#[cfg(feature = "gpu")]
pub(crate) use local_minima::contacts_by_all_triangles;
pub(crate) use local_minima::{ContactCollector, LocalMinima};
pub(crate) use prominence::ContactQuery;
pub(crate) use search::{ContactSearch, OppositeCorners};
pub(crate) use triangle_candidates::Wall;
