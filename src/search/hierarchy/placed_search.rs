//! The search through a mesh at its placement at one instant.

use super::build::WideBvh;
use super::mesh_search::{MeshSearch, Searched, resolved};
use super::moving_mesh::MeshAt;
use super::traverse::{LeafVisitor, Traversal};
use crate::distance::lanes::{Lane, Pack};
use crate::distance::{Face, dispatch};
use crate::mesh::{BLOCK, Mesh, load_vertices};
use crate::pair::{Best, LinkLanes, Nearest, PlacedLink, SearchLink};
use parry3d_f64::math::{Real, Vector};

/// A search through a mesh at rest, or at its placement at one instant.
///
/// It has only the queries that know the placement, so that no query can ignore it.
pub(crate) struct PlacedMeshSearch<'a> {
    search: MeshSearch<'a>,
    /// The placement of a moving mesh.
    moved: Option<MeshAt<'a>>,
}

impl<'a> PlacedMeshSearch<'a> {
    pub(crate) fn at_rest(search: MeshSearch<'a>) -> Self {
        Self { search, moved: None }
    }

    pub(crate) fn moved(search: MeshSearch<'a>, moved: MeshAt<'a>) -> Self {
        Self { search, moved: Some(moved) }
    }
}

impl PlacedMeshSearch<'_> {
    /// Returns the nearest triangle of a link, or `best` if no triangle improves on it. The `start`
    /// triangle is tested first.
    pub(crate) fn nearest(&mut self, link: &PlacedLink, best: Best, start: Option<u32>) -> Best {
        let Some(moved) = &mut self.moved else {
            return self.search.nearest(link, best, [start, None]);
        };
        let MeshSearch { hierarchy, scratch, .. } = &mut self.search;
        moved.nearest(&hierarchy.mesh, hierarchy.single(), link, best, start, &mut scratch.work)
    }

    /// Returns true if any triangle may be at most `bound` from a capsule. False is a proof, true
    /// is not.
    pub(crate) fn may_meet(&mut self, capsule: &PlacedLink, bound: Real) -> bool {
        match &mut self.moved {
            Some(moved) => moved.may_meet(self.search.hierarchy.single(), capsule, bound),
            None => self.search.may_meet(capsule, bound),
        }
    }

    /// Writes to `found` all triangles that may be at most `bound` from a link, in no order.
    /// Returns false if there are more than `most`, or if they are unknown.
    pub(crate) fn gather(
        &mut self,
        link: &PlacedLink,
        bound: Real,
        most: usize,
        found: &mut Vec<u32>,
    ) -> bool {
        let Some(moved) = &mut self.moved else {
            return self.search.gather(link, bound, most, found);
        };
        found.clear();
        let hierarchy = self.search.hierarchy;
        moved.gather(&hierarchy.mesh, hierarchy.single(), link, bound, most, found)
    }

    /// Returns the distance of the first triangle, for a link whose search finds none.
    pub(crate) fn any(&self, link: &PlacedLink) -> Nearest {
        link.measure(0, self.corners(0))
    }

    /// Returns the corners of a triangle at its placement.
    pub(crate) fn corners(&self, triangle: u32) -> [Vector; 3] {
        let mesh = &self.search.hierarchy.mesh;
        self.moved
            .as_ref()
            .map_or_else(|| mesh.corners(triangle), |moved| moved.corners(mesh, triangle))
    }

    /// Returns the longest edge of the mesh at rest.
    pub(crate) fn longest_at_rest(&self) -> Real {
        self.search.hierarchy.longest()
    }
}

impl MeshSearch<'_> {
    /// Writes to `found` all triangles that may be at most `bound` from a link, in no order.
    /// Returns false if there are more than `most`, or if they are unknown.
    fn gather(
        &mut self,
        link: &PlacedLink,
        bound: Real,
        most: usize,
        found: &mut Vec<u32>,
    ) -> bool {
        found.clear();
        resolved!(
            self,
            link,
            |traversal, searched| traversal.gather(&searched, bound, most, found),
            { !self.is_near(link, bound) }
        )
    }
}

impl<E: Lane> Traversal<'_, E> {
    /// Adds to `found` all triangles that may be at most `bound` from the link, in no order.
    /// Returns false if there are more than `most`.
    fn gather(
        &mut self,
        searched: &SearchLink<E>,
        bound: f64,
        most: usize,
        found: &mut Vec<u32>,
    ) -> bool {
        let limit = searched.axis_limit(bound);
        let mut near = CappedGather { limit, most, found, is_overfull: false };
        dispatch!(E::WIDEST_SEARCH, self.level, simd => self.visit_leaves::<E::Pack<_>>(simd, searched, limit, &mut near));
        !near.is_overfull
    }
}

/// The triangles gathered so far. The tests are the same as in a search for the nearest triangle
/// (`traverse`).
struct CappedGather<'a, E> {
    /// A gathered triangle has an axis distance below this.
    pub limit: E,
    /// The most triangles to gather.
    pub most: usize,
    /// The triangles so far.
    pub found: &'a mut Vec<u32>,
    /// Whether there are more than `most`.
    pub is_overfull: bool,
}

impl<E: Lane> LeafVisitor<E> for CappedGather<'_, E> {
    #[inline(always)]
    fn visit<L: Pack<Element = E>>(
        &mut self,
        token: L::Token,
        lanes: &LinkLanes<L>,
        tree: &WideBvh<E>,
        _: &Mesh,
        number: u32,
    ) {
        if self.is_overfull {
            return;
        }
        let leaf = &tree.leaves[number as usize];
        let limit = L::splat(token, self.limit);
        for lane in (0..BLOCK).step_by(L::LANES) {
            let vertices = load_vertices::<L>(token, &leaf.rows, lane);
            if lanes.not_excluded_by_plane(vertices, limit) == 0 {
                continue;
            }
            let mut near = lanes.may_be_nearer(&Face::in_order(vertices), limit).nearer;
            while near != 0 {
                let triangle = leaf.triangles[lane + near.trailing_zeros() as usize];
                near &= near - 1;
                // A leaf that is not full repeats its last triangle.
                if self.found.last() == Some(&triangle) {
                    continue;
                }
                if self.found.len() == self.most {
                    self.is_overfull = true;
                    return;
                }
                self.found.push(triangle);
            }
        }
    }
}
