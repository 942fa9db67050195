//! All places where a link is near the mesh: the local minima of the distance.
//!
//! # Words
//! - *Part* of a triangle: one of its three corners or three edges ([`PARTS`](crate::mesh::PARTS)).
//!   In formulas f is a part, or a seam of the mesh.
//! - *Feature*: the part that holds the nearest point of a triangle, or its face.
//! - *Pass*: the least distance of an f, beyond which its triangles are one piece of wall.
//! - *Gap* of an f: how far apart it is in the triangles that share it; 0 for equal corners.

mod contact_collector;
mod descent_cull;
mod feature_cull;
mod local_minima;
mod long_rings;
mod prominence;
mod search;
mod triangle_candidates;

#[cfg(feature = "exhaustive")]
pub(crate) use contact_collector::ContactCollector;
pub(crate) use contact_collector::ContactMemory;
#[cfg(feature = "gpu")]
pub(crate) use contact_collector::contacts_by_all_triangles;
pub(crate) use prominence::ContactQuery;
pub(crate) use search::{ContactSearch, OppositeCorners};
#[cfg(feature = "exhaustive")]
pub(crate) use triangle_candidates::Wall;
