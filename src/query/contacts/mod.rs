//! All places where a link is near the mesh: the local minima of the distance.

mod candidate_gather;
mod descent_cull;
mod disjoint_lists;
mod feature_cull;
mod flood;
mod link_neighbourhood;
mod local_minima;
mod long_rings;
mod opposite_corners;
mod prominence;
mod search;
mod triangle_candidates;
mod wall;
mod wall_components;

#[cfg(feature = "gpu")]
pub(crate) use local_minima::contacts_by_all_triangles;
pub(crate) use local_minima::{ContactCollector, LocalMinima};
pub(crate) use opposite_corners::OppositeCorners;
pub(crate) use prominence::ContactQuery;
pub(crate) use search::ContactSearch;
pub(crate) use wall::Wall;
