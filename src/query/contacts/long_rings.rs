//! Results for long rings of triangles around corners and edges, computed once per ring.
//!
//! A triangle queries all others around its corners and edges. In a fan, or if all invalid vertices
//! were put at the origin, a ring is long, and the cost would be quadratic. So one walk around a
//! long ring, near each link, collects the result for all of its triangles.

use super::triangle_candidates::{CandidateIndex, LinkCandidates};
use crate::mesh::{PARTS, SharedParts};

/// Triangles of a ring that are queried one by one. A carefully made mesh has fewer around its
/// corners.
pub(crate) const FEW: usize = 24;

/// The results for the long rings near one link.
#[derive(Clone)]
pub(crate) struct LongRings<K> {
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
    pub(crate) fn clear(&mut self) {
        self.of_part.clear();
        self.known.clear();
    }

    /// Returns the result for the ring around a part of a candidate; the candidate itself is
    /// included.
    ///
    /// The first call for a ring computes it: `add` receives every triangle of the ring with its
    /// index among the candidates.
    pub(crate) fn around(
        &mut self,
        shared: &SharedParts,
        near: LinkCandidates,
        index: &CandidateIndex,
        [place, part]: [usize; 2],
        mut add: impl FnMut(&mut K, u32, Option<usize>),
    ) -> &K {
        let ring = self.ring(place, part).unwrap_or_else(|| {
            self.of_part.resize(PARTS * near.in_question.len(), 0);
            let mut known = K::default();
            for (triangle, part) in shared.ring(near.in_question[place].triangle, part) {
                let place = near.index(index, triangle);
                add(&mut known, triangle, place);
                if let Some(place) = place {
                    self.of_part[PARTS * place + part] = self.known.len() as u32 + 1;
                }
            }
            self.known.push(known);
            self.known.len() - 1
        });
        &self.known[ring]
    }

    /// Calls `change` for the results of all rings of a candidate.
    pub(crate) fn all_around(&mut self, place: usize, mut change: impl FnMut(&mut K)) {
        if self.known.is_empty() {
            return;
        }
        for part in 0..PARTS {
            if let Some(ring) = self.ring(place, part) {
                change(&mut self.known[ring]);
            }
        }
    }

    fn ring(&self, place: usize, part: usize) -> Option<usize> {
        self.of_part.get(PARTS * place + part).and_then(|&number| (number as usize).checked_sub(1))
    }
}
