//! A mesh with all that questions need of it.

use crate::mesh::Mesh;
use crate::query::contacts::OppositeCorners;
use crate::query::nearest::SideGrid;
use crate::query::side::FarFields;
use crate::search::hierarchy::Hierarchy;
use crate::threads::Lazy;
use fearless_simd::Level;
use parry3d_f64::math::Vector;

/// The hierarchy of a mesh, and what some questions need beside it: built at the first of them, or
/// when it is prepared.
#[derive(Clone)]
pub(super) struct PreparedMesh {
    pub hierarchy: Hierarchy,
    /// For those who ask for contacts.
    across: Lazy<OppositeCorners<f32>>,
    /// For those who ask on which side of the mesh a point is.
    far_fields: Lazy<FarFields>,
    /// For those who ask whether a margin is kept.
    sides: Lazy<SideGrid>,
}

impl PreparedMesh {
    pub(super) fn new(level: Level, mesh: Mesh) -> Self {
        let hierarchy = Hierarchy::new(level, mesh);
        Self { hierarchy, across: Lazy::new(), far_fields: Lazy::new(), sides: Lazy::new() }
    }

    /// Builds all that a question would build.
    pub(super) fn prepare(&self, level: Level) {
        self.hierarchy.prepare(level);
        self.sides();
        self.far_fields();
        let across = self.across.get_or_build(|| OppositeCorners::new(self.hierarchy.single()));
        across.prepare(self.hierarchy.single(), &self.hierarchy.mesh);
    }

    /// For each edge of each triangle the corner of a neighbour beyond it.
    pub(super) fn across(&self) -> &Lazy<OppositeCorners<f32>> {
        &self.across
    }

    /// What the hierarchy's nodes are from far away, for the side of a point. The division of
    /// either hierarchy serves.
    pub(super) fn far_fields(&self) -> &FarFields {
        let Hierarchy { mesh, .. } = &self.hierarchy;
        self.far_fields.get_or_build(|| FarFields::new(self.hierarchy.single(), mesh))
    }

    /// On which side of the wall space lies, roughly.
    pub(super) fn sides(&self) -> &SideGrid {
        self.sides.get_or_build(|| SideGrid::new(&self.hierarchy.mesh))
    }

    /// Moves the vertices, which were checked.
    pub(super) fn set_vertices(&mut self, level: Level, vertices: &[Vector]) {
        self.hierarchy.set_vertices(level, vertices);
        self.far_fields.take();
        let bounds = self.hierarchy.mesh.bounds();
        if self.sides.get().is_some_and(|sides| !sides.covers(bounds)) {
            self.sides.take();
        }
        if let Some(across) = self.across.get_mut() {
            across.forget();
        }
    }
}
