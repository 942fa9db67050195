//! The sweep over the triangles near one link: connected components of the wall appear and merge.
//! `local_minima` has the derivation.
//!
//! **Long rings.** A triangle queries all others around its corners and edges. In a fan, or if all
//! invalid vertices were put at the origin, a ring is long, and the cost would be quadratic. So one
//! walk around a long ring, near each link, collects the result for all of its triangles.
//!
//! **Union-find** (Galler and Fischer). Each item names an earlier item of the same set, or itself
//! if it is the first.

use super::triangle_candidates::{CandidateIndex, LinkCandidates, Wall};
use crate::mesh::{PARTS, SharedParts, ends_of};
use crate::pair::{Nearest, PlacedLink, Ranked, rounding};
use parry3d_f64::math::{Real, Vector};

/// The index of the piece of all culled triangles.
pub(crate) const CULLED: u32 = 0;

/// The index of no triangle.
pub(crate) const NONE: u32 = u32::MAX;

/// The pieces of wall within the margin of one link.
pub(crate) struct WallComponents<'a> {
    pub link: &'a PlacedLink,
    pub wall: Wall<'a>,
    pub near: LinkCandidates<'a>,
    pub places: &'a [u32],
    pub index: &'a CandidateIndex,
    /// The triangles within the margin, nearest first.
    pub ranked: &'a [Ranked],
    /// Union-find: for each index an earlier one of the same piece, or itself.
    pub piece: &'a mut Vec<u32>,
    pub around: &'a mut LongRings<IncidentTriangles>,
}

impl WallComponents<'_> {
    /// Runs the sweep. Returns the first triangles of the pieces that have not ended, nearest
    /// first.
    pub(crate) fn first_triangles(&mut self) -> impl Iterator<Item = &Nearest> {
        self.piece.clear();
        self.piece.push(CULLED);
        for place in 1..=self.ranked.len() {
            self.join(place as u32);
        }
        let places = self.ranked.iter().zip(&self.piece[1..]).zip(1..);
        places.filter(|((_, piece), place)| *piece == place).map(|((ranked, _), _)| &ranked.nearest)
    }

    /// Merges a triangle with the pieces of nearer triangles (step 3).
    fn join(&mut self, place: u32) {
        self.piece.push(place);
        let Ranked { nearest, rounding: own_rounding, .. } = self.ranked[place as usize - 1];
        let Some(index) = self.near.index(self.index, nearest.triangle) else { return };
        let (known, shared) = (self.near.in_question[index], self.wall.mesh.parts());
        let corners = self.wall.mesh.corners(nearest.triangle);
        let is_loose = shared.is_loose(nearest.triangle);
        // Which piece it meets at which part, and whether its least point is on that part.
        let (mut met, mut count) = ([(0, CULLED, false); 2 * PARTS], 0);
        for part in (0..PARTS).filter(|&part| is_loose || !known.is_beyond(part)) {
            let add = |around: &mut IncidentTriangles, other: u32, index: Option<usize>| match index
            {
                Some(index) => around.add(self.places[index], self.near.in_question[index].lower),
                None => {
                    around.descents |= self.near.is_culled(self.index, self.wall.place_of(), other)
                }
            };
            let (mut around, mut others) =
                (IncidentTriangles::default(), shared.others(nearest.triangle, part));
            for other in others.by_ref().take(FEW) {
                add(&mut around, other, self.near.index(self.index, other));
            }
            if others.next().is_some() {
                around = *self.around.around(shared, self.near, self.index, [index, part], add);
            }
            // If a culled triangle is certainly farther than this one, so is each part that they
            // share.
            let meets_left_out = around.descents || around.left_out_from < known.upper;
            let first = around.first;
            let others = [meets_left_out.then_some(CULLED), (first < place).then_some(first)];
            if others == [None; 2] {
                continue;
            }
            let holds_least_point = is_on(nearest.on_mesh, ends_of(corners, part), own_rounding);
            for with in others.into_iter().flatten() {
                met[count] = (part, with, holds_least_point);
                count += 1;
            }
        }
        let gaps = match is_loose {
            true => self.wall.mesh.indices()[nearest.triangle as usize].map(|end| shared.gap(end)),
            false => [0.0; 3],
        };
        // Parts with the least point come first: they are met at the triangle's own distance.
        for met_there in [true, false] {
            for &(part, with, holds_least_point) in &met[..count] {
                if holds_least_point == met_there {
                    let [one, other] = ends_of(gaps, part);
                    let gap = one.max(other);
                    self.meet([place, with], ends_of(corners, part), gap, holds_least_point);
                }
            }
            if is_loose {
                self.meet_across_seams(place, met_there);
            }
        }
    }

    /// Merges a triangle with the pieces of nearer triangles beyond its seams; those that hold its
    /// least point, or the others.
    fn meet_across_seams(&mut self, place: u32, met_there: bool) {
        let Ranked { nearest, rounding: own_rounding, .. } = self.ranked[place as usize - 1];
        let mesh = self.wall.mesh;
        for seam in mesh.parts().seams(nearest.triangle) {
            // A triangle with a seam is never culled.
            let index = self.near.index(self.index, seam.other);
            let with = index.map_or(NONE, |index| self.places[index]);
            let ends = seam.ends.map(|end| mesh.vertices()[end as usize]);
            let holds_least_point = is_on(nearest.on_mesh, ends, own_rounding + 2.0 * seam.gap);
            if with < place && holds_least_point == met_there {
                self.meet([place, with], ends, seam.gap, holds_least_point);
            }
        }
    }

    /// Merges the pieces of two triangles if a part that both share is at most `2 t` above the
    /// farther of the two minima.
    #[inline(always)]
    fn meet(
        &mut self,
        places: [u32; 2],
        [from, to]: [Vector; 2],
        gap: Real,
        holds_least_point: bool,
    ) {
        let [mine, other] = places.map(|place| find_root(self.piece, place));
        if mine == other {
            return;
        }
        let farther = self.grown(mine).max(self.grown(other))
            + rounding(self.link.extent_with([from, to, to]))
            + gap;
        if self.ranked[places[0] as usize - 1].nearest.distance <= farther
            && (holds_least_point || self.link.comes_within(farther, from, to))
        {
            // The merged piece appeared with the nearer of the two.
            self.piece[mine.max(other) as usize] = mine.min(other);
        }
    }

    /// Returns the minimum of a piece plus its rounding; a piece that merges below this (and the
    /// rounding of the pass) ends.
    fn grown(&self, place: u32) -> Real {
        let ranked = (place as usize).checked_sub(1).map(|place| &self.ranked[place]);
        ranked.map_or(Real::NEG_INFINITY, |ranked| ranked.nearest.distance + ranked.rounding)
    }
}

/// The ring of a corner or an edge, as it concerns a triangle that may be joined there.
#[derive(Clone, Copy)]
pub(crate) struct IncidentTriangles {
    /// The least lower bound on the distance of a culled candidate in the ring.
    left_out_from: Real,
    /// Whether a triangle of the ring was culled by the search as lying on a slope.
    descents: bool,
    /// The least index of a measured triangle. If it is the querying triangle's own, it joins none
    /// there.
    first: u32,
}

impl Default for IncidentTriangles {
    fn default() -> Self {
        Self { left_out_from: Real::INFINITY, descents: false, first: NONE }
    }
}

impl IncidentTriangles {
    /// Adds a candidate.
    #[inline(always)]
    fn add(&mut self, place: u32, lower: Real) {
        if place == CULLED {
            self.left_out_from = self.left_out_from.min(lower);
        } else {
            self.first = self.first.min(place);
        }
    }
}

/// Returns true if a point lies on a segment, within rounding.
fn is_on(point: Vector, [from, to]: [Vector; 2], rounding: Real) -> bool {
    let (edge, relative) = (to - from, point - from);
    let share = relative.dot(edge) / edge.length_squared();
    // For a segment without length this is 0 / 0; the comparison turns NaN into 0.
    let share = if share > 0.0 { share.min(1.0) } else { 0.0 };
    (relative - edge * share).abs().max_element() <= 0.5 * rounding
}

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

/// Returns the first item of a set, and halves the path to it.
#[inline(always)]
pub(crate) fn find_root(joined: &mut [u32], mut place: u32) -> u32 {
    while joined[place as usize] != place {
        let next = joined[place as usize];
        joined[place as usize] = joined[next as usize];
        place = next;
    }
    place
}

/// Unites the sets of two items. Returns the first item of the united set, then the former first
/// item of the other set; both are equal if the items were in one set.
#[inline(always)]
pub(crate) fn unite(joined: &mut [u32], one: u32, other: u32) -> [u32; 2] {
    let (one, other) = (find_root(joined, one), find_root(joined, other));
    let firsts = [one.min(other), one.max(other)];
    joined[firsts[1] as usize] = firsts[0];
    firsts
}
