//! What is known of the long rings of triangles around corners and edges.
//!
//! A triangle asks about all others around its corners and edges. Where these are many, as in a
//! fan, or where all invalid vertices were put at the origin, each of them would ask about as many.
//! So what can be asked about a long ring is gathered by one walk around it, near each link, and
//! kept for all that are in it.

use super::triangle_candidates::{CandidateIndex, LinkCandidates};
use crate::mesh::{PARTS, SharedParts};

/// So many others are asked one by one. Around the corners of a mesh that was made with care there
/// are fewer.
pub(crate) const FEW: usize = 24;

/// What is known of the long rings near one link.
#[derive(Clone)]
pub(crate) struct LongRings<K> {
    /// For each part of each triangle in question the number of its ring, counted from 1, or 0 if
    /// nothing is known of it. Empty as long as nothing is known of any.
    of_part: Vec<u32>,
    known: Vec<K>,
}

impl<K> Default for LongRings<K> {
    fn default() -> Self {
        Self { of_part: Vec::new(), known: Vec::new() }
    }
}

impl<K: Default> LongRings<K> {
    /// Forgets all of them: the next will be those near another link.
    pub(crate) fn clear(&mut self) {
        self.of_part.clear();
        self.known.clear();
    }

    /// What is known of the ring around a part of a triangle in question, the triangle itself
    /// included.
    ///
    /// At the first question `add` gets every triangle of the ring, with its place among those in
    /// question.
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

    /// The same to be changed, for all rings of a triangle in question of which something is known.
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
