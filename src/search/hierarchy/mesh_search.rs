//! The search through a mesh for one convex body, in the precision that resolves it.

use super::build::WideBvh;
use super::traverse::{Stack, Traversal};
use crate::answer::Work;
use crate::distance::Scalar;
use crate::mesh::Mesh;
use crate::pair::{Best, Nearest, PlacedLink, SearchLink};
use crate::threads::{Lazy, each};
use fearless_simd::Level;
use parry3d_f64::math::{Real, Vector};

/// Stacks and counters of a query, reused by later queries.
#[derive(Clone, Default)]
pub(crate) struct Scratch {
    single: Stack<f32>,
    double: Stack<f64>,
    pub work: Work,
}

/// A search through a mesh at rest, with its scratch memory.
pub(crate) struct MeshSearch<'a> {
    pub level: Level,
    pub hierarchy: &'a Hierarchy,
    pub scratch: &'a mut Scratch,
}

/// Runs `$ask` on the traversal in the precision that resolves a link. Runs `$out_of_reach` if
/// neither precision does.
macro_rules! resolved {
    ($search:ident, $link:expr, |$traversal:ident, $searched:ident| $ask:expr, $out_of_reach:expr) => {
        match $search.hierarchy.in_resolving_precision($search.level, $link) {
            Searched::Single($searched) => {
                let mut $traversal = $search.single();
                $ask
            }
            Searched::Double($searched) => {
                let mut $traversal = $search.double();
                $ask
            }
            Searched::OutOfReach => $out_of_reach,
        }
    };
}

#[cfg(feature = "tubes")]
pub(super) use resolved;

impl<'a> MeshSearch<'a> {
    pub(crate) fn new(level: Level, hierarchy: &'a Hierarchy, scratch: &'a mut Scratch) -> Self {
        Self { level, hierarchy, scratch }
    }
}

impl MeshSearch<'_> {
    /// Returns the nearest triangle of a link, or `best` if no triangle improves on it. The leaves
    /// of the `start` triangles are visited first.
    pub(crate) fn nearest(
        &mut self,
        link: &PlacedLink,
        mut best: Best,
        start: [Option<u32>; 2],
    ) -> Best {
        resolved!(
            self,
            link,
            |traversal, searched| traversal.nearest(link, &searched, best, start),
            {
                let mesh = &self.hierarchy.mesh;
                if !self.is_near(link, best.bound()) {
                    return best;
                }
                for triangle in 0..mesh.len() as u32 {
                    best.measure(link, triangle, mesh.corners(triangle));
                }
                self.scratch.work.measured += mesh.len() as u64;
                best
            }
        )
    }

    /// Returns the nearest triangle at any distance, if a triangle overlaps or many candidates
    /// remain. Otherwise returns none and adds the candidates to `few`, unmeasured, the least bound
    /// first.
    pub(crate) fn nearest_or_candidates(
        &mut self,
        link: &PlacedLink,
        start: [Option<u32>; 2],
        few: &mut Vec<u32>,
    ) -> Option<Best> {
        resolved!(
            self,
            link,
            |traversal, searched| traversal.nearest_or_candidates(link, &searched, start, few),
            Some(self.nearest(link, Best::within(Real::INFINITY), start))
        )
    }

    /// Returns the nearest triangle as [`MeshSearch::nearest`] does, and a lower bound on the
    /// distance of every triangle, at most about `far`. Also returns a triangle at about that
    /// bound, if one was met.
    ///
    /// No triangle farther than `far` is searched; `far` is at least the bound of `best`.
    pub(crate) fn nearest_with_lower_bound(
        &mut self,
        link: &PlacedLink,
        best: Best,
        far: Real,
        start: [Option<u32>; 2],
    ) -> (Best, Real, Option<u32>) {
        resolved!(
            self,
            link,
            |traversal, searched| traversal
                .nearest_with_lower_bound(link, &searched, best, far, start),
            (self.nearest(link, best, start), 0.0, None)
        )
    }

    /// Searches a triangle about nearest to a capsule around links. None if neither precision
    /// resolves the capsule.
    pub(crate) fn search_guess(&mut self, capsule: &PlacedLink) -> Option<u32> {
        resolved!(self, capsule, |traversal, searched| traversal.search_guess(&searched), None)
    }

    /// Returns true if any triangle may be at most `bound` from a capsule around links.
    /// False is a proof, true is not.
    pub(crate) fn may_meet(&mut self, capsule: &PlacedLink, bound: Real) -> bool {
        self.may_meet_lower(capsule, bound, u32::MAX)
    }

    /// Returns true if any triangle with a number less than `triangle_limit` may be at most `bound`
    /// from a capsule around links. False is a proof, true is not.
    pub(crate) fn may_meet_lower(
        &mut self,
        capsule: &PlacedLink,
        bound: Real,
        triangle_limit: u32,
    ) -> bool {
        resolved!(
            self,
            capsule,
            |traversal, searched| traversal.may_meet(&searched, bound, triangle_limit),
            { self.is_near(capsule, bound) }
        )
    }

    /// Returns true if a mesh that is tiny beside a link may be at most `bound` from it. Such a
    /// mesh lies about where its first triangle is.
    pub(super) fn is_near(&self, link: &PlacedLink, bound: Real) -> bool {
        let (first, size) = (self.any(link).distance, self.hierarchy.size);
        let extent = link.along().abs().max_element() + link.radius();
        first - 2.0 * size - 64.0 * Real::UNIT_ROUNDOFF * (first + size + extent) <= bound
    }

    /// Measures the first triangle of the mesh, for a link whose search finds none.
    pub(crate) fn any(&self, link: &PlacedLink) -> Nearest {
        link.measure(0, self.hierarchy.mesh.corners(0))
    }

    pub(crate) fn single(&mut self) -> Traversal<'_, f32> {
        let Scratch { single: stack, work, .. } = &mut *self.scratch;
        let tree = self.hierarchy.single();
        Traversal { level: self.level, mesh: &self.hierarchy.mesh, tree, stack, work }
    }

    pub(crate) fn double(&mut self) -> Traversal<'_, f64> {
        let tree = self.hierarchy.double(self.level);
        let Scratch { double: stack, work, .. } = &mut *self.scratch;
        Traversal { level: self.level, mesh: &self.hierarchy.mesh, tree, stack, work }
    }
}

/// A mesh and its hierarchies.
#[derive(Clone)]
pub(crate) struct Hierarchy {
    pub mesh: Mesh,
    /// The largest coordinate of a triangle.
    pub mesh_reach: Real,
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
        let (single, [mesh_reach, size]) = (WideBvh::new(level, &mesh), extent(mesh.bounds()));
        Self { single, double: Lazy::new(), longest: Lazy::new(), mesh_reach, size, mesh }
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
    pub(crate) fn in_resolving_precision(&self, level: Level, link: &PlacedLink) -> Searched {
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
        [self.mesh_reach, self.size] = extent(self.mesh.bounds());
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
    /// Too far out even for double precision, in units of a mesh so small.
    OutOfReach,
}
