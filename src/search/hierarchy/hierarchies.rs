//! The hierarchies of a mesh in single and double precision, and which of them resolves a link.

use super::build::WideBvh;
use crate::mesh::Mesh;
use crate::pair::{PlacedLink, SearchLink};
use crate::threads::{Lazy, each};
use fearless_simd::Level;
use parry3d_f64::math::{Real, Vector};

/// A mesh and its hierarchies.
#[derive(Clone)]
pub(crate) struct Hierarchy {
    pub mesh: Mesh,
    /// The largest coordinate of a triangle.
    pub reach: Real,
    /// The longest side of the box around all triangles.
    pub size: Real,
    /// An upper bound on the longest edge, computed on first use.
    longest: Lazy<Real>,
    single: WideBvh<f32>,
    /// For links that single precision does not resolve; built on first use.
    double: Lazy<WideBvh<f64>>,
}

impl Hierarchy {
    pub(crate) fn new(level: Level, mesh: Mesh) -> Self {
        let (single, [reach, size]) = (WideBvh::new(level, &mesh), extent(mesh.bounds()));
        Self { single, double: Lazy::new(), longest: Lazy::new(), reach, size, mesh }
    }

    pub(crate) fn double(&self, level: Level) -> &WideBvh<f64> {
        self.double.get_or_build(|| WideBvh::new(level, &self.mesh))
    }

    /// An upper bound on the longest edge of a triangle.
    pub(crate) fn longest(&self) -> Real {
        *self.longest.get_or_build(|| longest(&self.mesh))
    }

    /// The single-precision hierarchy, which always exists.
    pub(crate) fn single(&self) -> &WideBvh<f32> {
        &self.single
    }

    /// Builds everything that a later query might build.
    pub(crate) fn prepare(&self, level: Level) {
        self.double(level);
        self.longest();
    }

    /// Returns the link in the precision that resolves it.
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

    /// Moves the vertices, which the caller has checked, and refits.
    pub(crate) fn set_vertices(&mut self, level: Level, vertices: &[Vector]) {
        self.mesh.set_vertices(vertices);
        [self.reach, self.size] = extent(self.mesh.bounds());
        self.single.refit(level, &self.mesh);
        if let Some(double) = self.double.get_mut() {
            double.refit(level, &self.mesh);
        }
        if let Some(edge) = self.longest.get_mut() {
            *edge = longest(&self.mesh);
        }
    }
}

/// The largest coordinate of a box, and its longest side.
fn extent([low, high]: [Vector; 2]) -> [Real; 2] {
    [low.abs().max(high.abs()).max_element(), (high - low).max_element()]
}

/// An upper bound on the longest edge of a triangle, at most twice as long.
fn longest(mesh: &Mesh) -> Real {
    let edge = |triangle: &[u32; 3]| {
        let [a, b, c] = triangle.map(|vertex| mesh.vertices()[vertex as usize]);
        (a.max(b).max(c) - a.min(b).min(c)).max_element()
    };
    let mut shares: Vec<_> =
        mesh.indices().chunks(Mesh::TASK_SIZE).map(|share| (share, 0.0)).collect();
    each(&mut shares, |_, (share, most)| *most = share.iter().map(edge).fold(0.0, Real::max));
    // The largest side of a box is used, because squares would overflow. The diagonal of a cube is
    // less than twice its edge.
    2.0 * shares.into_iter().fold(0.0, |most: Real, (_, edge)| most.max(edge))
}

/// A link in the frame of a search.
pub(crate) enum Searched {
    Single(SearchLink<f32>),
    Double(SearchLink<f64>),
    /// Too far out even for double precision, beside a mesh so small.
    OutOfReach,
}
