//! A mesh with every structure that queries need of it.

use crate::mesh::Mesh;
use crate::query::contacts::OppositeCorners;
use crate::query::nearest::SideGrid;
use crate::query::side::{FarFields, Surface};
use crate::search::hierarchy::Hierarchy;
use crate::threads::Lazy;
use fearless_simd::Level;
use parry3d_f64::math::Vector;

/// The hierarchy of a mesh, and the structures of some queries: built by the first of them, or by
/// [`prepare`](Self::prepare).
#[derive(Clone)]
pub(super) struct PreparedMesh {
    pub hierarchy: Hierarchy,
    /// Neighbours of triangles, for contacts.
    across: Lazy<OppositeCorners<f32>>,
    /// Far fields of nodes, for the side of a point.
    far_fields: Lazy<FarFields>,
    /// A coarse grid of the sides of the wall, for queries about a margin.
    sides: Lazy<SideGrid>,
    /// The openings of the mesh, for the side of a robot.
    surface: Lazy<Surface>,
}

impl PreparedMesh {
    pub(super) fn new(level: Level, mesh: Mesh) -> Self {
        let hierarchy = Hierarchy::new(level, mesh);
        Self {
            hierarchy,
            across: Lazy::new(),
            far_fields: Lazy::new(),
            sides: Lazy::new(),
            surface: Lazy::new(),
        }
    }

    /// Builds every structure that a query would build at first use.
    pub(super) fn prepare(&self, level: Level) {
        self.hierarchy.prepare(level);
        self.sides();
        self.far_fields();
        let across = self.across.get_or_build(|| OppositeCorners::new(self.hierarchy.single()));
        across.prepare(self.hierarchy.single(), &self.hierarchy.mesh);
        if let Some(lids) = &self.surface(level).lids {
            lids.prepare(level);
        }
    }

    /// For each edge of each triangle, the opposite corner of the neighbour.
    pub(super) fn across(&self) -> &Lazy<OppositeCorners<f32>> {
        &self.across
    }

    /// The far fields of the nodes of the hierarchy in single precision, for the side of a point.
    pub(super) fn far_fields(&self) -> &FarFields {
        let Hierarchy { mesh, .. } = &self.hierarchy;
        self.far_fields.get_or_build(|| FarFields::new(self.hierarchy.single(), mesh))
    }

    /// A coarse guess at the side of the wall on which a cell of space lies.
    pub(super) fn sides(&self) -> &SideGrid {
        self.sides.get_or_build(|| SideGrid::new(&self.hierarchy.mesh))
    }

    /// The openings of the mesh, and its edges that make its sides doubtful.
    pub(super) fn surface(&self, level: Level) -> &Surface {
        self.surface.get_or_build(|| Surface::new(level, &self.hierarchy.mesh))
    }

    /// Moves the vertices, which are checked, and drops the structures that no longer fit.
    pub(super) fn set_vertices(&mut self, level: Level, vertices: &[Vector]) {
        self.hierarchy.set_vertices(level, vertices);
        self.far_fields.take();
        self.surface.take();
        let bounds = self.hierarchy.mesh.bounds();
        if self.sides.get().is_some_and(|sides| !sides.covers(bounds)) {
            self.sides.take();
        }
        if let Some(across) = self.across.get_mut() {
            across.forget();
        }
    }
}
