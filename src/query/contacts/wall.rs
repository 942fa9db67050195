//! The mesh as contacts are asked of it.

use crate::mesh::Mesh;
use crate::search::hierarchy::WideBvh;

/// What the robot is near to.
#[derive(Clone, Copy)]
pub(crate) struct Wall<'a> {
    pub mesh: &'a Mesh,
    /// The hierarchy of a search that knows slopes.
    pub tree: Option<&'a WideBvh<f32>>,
}

impl<'a> Wall<'a> {
    /// Without a search that knows slopes.
    pub(crate) fn of(mesh: &'a Mesh) -> Self {
        Self { mesh, tree: None }
    }

    /// Where each triangle stands in the leaves of the search: nowhere, if it knows no slopes.
    #[inline(always)]
    pub(super) fn place_of(&self) -> &'a [u32] {
        self.tree.map_or(&[], |tree| &tree.place_of)
    }
}
