//! The results of long rings: all triangles around a corner or an edge.
//!
//! A triangle queries all others around its corners and edges. In a fan, or if all invalid vertices
//! were put at the origin, a ring is long, and the cost would be quadratic. So one walk around a
//! long ring, near each link, collects the result for all of its triangles.

use super::triangle_candidates::NearLink;
use crate::mesh::PARTS;

/// The most triangles of a short ring. They are queried one by one. A carefully made mesh has fewer
/// around its corners.
pub(super) const SHORT_RING: usize = 24;

/// The results for the long rings near one link.
#[derive(Clone)]
pub(super) struct LongRings<K> {
    /// For each part of each candidate the number of its ring, counted from 1; 0 without a result.
    /// Empty before the first result.
    of_part: Vec<u32>,
    known: Vec<K>,
}

impl<K> Default for LongRings<K> {
    fn default() -> Self {
        Self { of_part: Vec::new(), known: Vec::new() }
    }
}

impl<K: Default> LongRings<K> {
    /// Removes all results, before the next link.
    pub(super) fn clear(&mut self) {
        self.of_part.clear();
        self.known.clear();
    }

    /// Returns the result for the ring around a part of a candidate; the candidate itself is
    /// included.
    ///
    /// The first call for a ring computes it: `add` receives every triangle of the ring with its
    /// index among the candidates.
    pub(super) fn ring_of(
        &mut self,
        near: &NearLink,
        [candidate, part]: [usize; 2],
        mut add: impl FnMut(&mut K, u32, Option<usize>),
    ) -> &K {
        let ring = self.number(candidate, part).unwrap_or_else(|| {
            let triangles = near.candidates.triangles;
            self.of_part.resize(PARTS * triangles.len(), 0);
            let mut known = K::default();
            for (triangle, part) in near.wall.mesh.parts().ring(triangles[candidate].triangle, part)
            {
                let index = near.index_of(triangle);
                add(&mut known, triangle, index);
                if let Some(index) = index {
                    self.of_part[PARTS * index + part] = self.known.len() as u32 + 1;
                }
            }
            self.known.push(known);
            self.known.len() - 1
        });
        &self.known[ring]
    }

    /// Calls `change` for the results of all rings of a candidate.
    pub(super) fn change_rings_of(&mut self, candidate: usize, mut change: impl FnMut(&mut K)) {
        if self.known.is_empty() {
            return;
        }
        for part in 0..PARTS {
            if let Some(ring) = self.number(candidate, part) {
                change(&mut self.known[ring]);
            }
        }
    }

    /// The index of the ring around a part of a candidate, if it has a result.
    fn number(&self, candidate: usize, part: usize) -> Option<usize> {
        self.of_part
            .get(PARTS * candidate + part)
            .and_then(|&number| (number as usize).checked_sub(1))
    }
}
