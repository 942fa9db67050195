//! Search through a bounding volume hierarchy with 16 children per node, a pack of children at a
//! time.

mod bound;
mod build;
mod mesh_search;
mod moving_mesh;
mod node;
mod oriented_box;
mod traverse;

pub(crate) use build::WideBvh;
pub(crate) use mesh_search::{Hierarchy, MeshSearch, PlacedMeshSearch, Scratch, Searched};
pub(crate) use moving_mesh::{MeshAt, MeshSpeed, MovingMesh};
pub(crate) use node::{Child, WIDTH};
pub(crate) use traverse::{LeafVisitor, Traversal};
