//! The sweep over the triangles near one link: pieces of wall appear and merge. `local_minima` has
//! the derivation.

use super::local_minima::{CULLED, NONE};
use super::long_rings::{FEW, LongRings};
use super::triangle_candidates::{CandidateIndex, LinkCandidates};
use super::wall::Wall;
use crate::mesh::{PARTS, ends_of, find_root};
use crate::pair::{Nearest, PlacedLink, Ranked, rounding};
use parry3d_f64::math::{Real, Vector};

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
        // Which piece it meets at which part, and whether its least point is on that part.
        let (mut met, mut count) = ([(0, CULLED, false); 2 * PARTS], 0);
        for part in (0..PARTS).filter(|&part| !known.is_beyond(part)) {
            let add = |around: &mut IncidentTriangles, other: u32, index: Option<usize>| match index
            {
                Some(index) => around.add(self.places[index], self.near.in_question[index].lower),
                None => {
                    around.slopes |= self.near.is_culled(self.index, self.wall.place_of(), other)
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
            let meets_left_out = around.slopes || around.left_out_from < known.upper;
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
        // Parts with the least point come first: they are met at the triangle's own distance.
        for met_there in [true, false] {
            for &(part, with, holds_least_point) in &met[..count] {
                if holds_least_point != met_there {
                    continue;
                }
                let [mine, other] = [place, with].map(|place| find_root(self.piece, place));
                if mine == other {
                    continue;
                }
                let [from, to] = ends_of(corners, part);
                let farther = self.grown(mine).max(self.grown(other))
                    + rounding(self.link.extent_with([from, to, to]));
                if nearest.distance <= farther
                    && (met_there || self.link.comes_within(farther, from, to))
                {
                    // The merged piece appeared with the nearer of the two.
                    self.piece[mine.max(other) as usize] = mine.min(other);
                }
            }
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
    slopes: bool,
    /// The least index of a measured triangle. If it is the querying triangle's own, it joins none
    /// there.
    first: u32,
}

impl Default for IncidentTriangles {
    fn default() -> Self {
        Self { left_out_from: Real::INFINITY, slopes: false, first: NONE }
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
