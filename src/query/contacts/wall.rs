//! The mesh of a query for contacts.

use crate::mesh::Mesh;
use crate::search::hierarchy::WideBvh;

/// The mesh, and its hierarchy if the search culls triangles on slopes.
#[derive(Clone, Copy)]
pub(crate) struct Wall<'a> {
    pub mesh: &'a Mesh,
    /// The hierarchy of a search that culls triangles on slopes.
    pub tree: Option<&'a WideBvh<f32>>,
}

impl<'a> Wall<'a> {
    /// A wall without such a search.
    pub(crate) fn of(mesh: &'a Mesh) -> Self {
        Self { mesh, tree: None }
    }

    /// Returns the place of each triangle in the leaves of the search; empty without such a search.
    #[inline(always)]
    pub(super) fn place_of(&self) -> &'a [u32] {
        self.tree.map_or(&[], |tree| &tree.place_of)
    }
}
