//! A mesh's hierarchies, and the precision that resolves a link.

use super::build::WideBvh;
use crate::mesh::Mesh;
use crate::pair::{PlacedLink, SearchLink};
use crate::threads::Lazy;
use fearless_simd::Level;
use parry3d_f64::math::{Real, Vector};

/// A mesh and its hierarchies.
#[derive(Clone)]
pub(crate) struct Hierarchy {
    pub mesh: Mesh,
    /// The largest coordinate of a triangle.
    pub reach: Real,
    single: WideBvh<f32>,
    /// For links that single precision does not resolve, built when the first of them comes.
    double: Lazy<WideBvh<f64>>,
}

impl Hierarchy {
    pub(crate) fn new(level: Level, mesh: Mesh) -> Self {
        Self { single: WideBvh::new(level, &mesh), double: Lazy::new(), reach: reach(mesh.bounds()), mesh }
    }

    pub(crate) fn double(&self, level: Level) -> &WideBvh<f64> {
        self.double.get_or_build(|| WideBvh::new(level, &self.mesh))
    }

    /// The hierarchy that is always there.
    pub(crate) fn single(&self) -> &WideBvh<f32> {
        &self.single
    }

    /// Builds what a query far out would build.
    pub(crate) fn prepare(&self, level: Level) {
        self.double(level);
    }

    /// The link in the precision that resolves it.
    pub(crate) fn searched(&self, level: Level, link: &PlacedLink) -> Searched {
        let single = SearchLink::new(link, &self.single.frame);
        if let Some(single) = single.filter(|single| single.is_resolved(&self.single.frame)) {
            return Searched::Single(single);
        }
        match SearchLink::new(link, &self.double(level).frame) {
            Some(double) => Searched::Double(double),
            None => Searched::OutOfReach,
        }
    }

    /// Moves the vertices of the mesh, which were checked.
    pub(crate) fn set_vertices(&mut self, level: Level, vertices: &[Vector]) {
        self.mesh.set_vertices(vertices);
        self.reach = reach(self.mesh.bounds());
        self.single.refit(level, &self.mesh);
        if let Some(double) = self.double.get_mut() {
            double.refit(level, &self.mesh);
        }
    }
}

/// The largest coordinate of what lies in a box.
fn reach([low, high]: [Vector; 2]) -> Real {
    low.abs().max(high.abs()).max_element()
}

/// A link in the frame of a search.
pub(crate) enum Searched {
    Single(SearchLink<f32>),
    Double(SearchLink<f64>),
    /// Farther out than double precision reaches beside a mesh so small.
    OutOfReach,
}
