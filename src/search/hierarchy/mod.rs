//! Search through a bounding volume hierarchy with 16 children per node, a pack of children at a
//! time.

mod bound;
mod build;
mod mesh_search;
#[cfg(feature = "tubes")]
mod moving_mesh;
mod node;
mod oriented_box;
#[cfg(feature = "tubes")]
mod placed_search;
mod traverse;

pub(crate) use build::WideBvh;
pub(crate) use mesh_search::{Hierarchy, MeshSearch, Scratch, Searched};
#[cfg(feature = "tubes")]
pub(crate) use moving_mesh::{MeshAt, MeshSpeed, MovingMesh};
pub(crate) use node::{Child, WIDTH};
#[cfg(feature = "tubes")]
pub(crate) use placed_search::PlacedMeshSearch;
pub(crate) use traverse::{LeafVisitor, Traversal};
