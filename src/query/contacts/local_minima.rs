//! The local minima of the distance between one link and a mesh: triangles sorted by distance, and
//! union-find.
//!
//! # Definitions
//! - d(x): the distance of a point x from the link. d(T), d(f): the least distance of a triangle T,
//!   and of a corner or an edge f.
//! - Two triangles *share* f if both have it, at the same place. f is a corner, an edge, or a
//!   *seam*: a stretch in which open edges touch within the rounding of their coordinates
//!   ([`SharedParts`](crate::mesh::SharedParts)).
//! - gap(f): a bound on the distance between f and either triangle that shares it. It is 0 where
//!   corners are equal. A triangle with an f of another gap, or with a seam, is *loose*.
//! - The wall within c: all points x of the mesh with `d(x) <= c`. A *piece* is a connected
//!   component of the wall within c. As c grows, pieces appear, grow and merge.
//! - *Local minimum*: the nearest point of a piece, where the piece appears.
//! - t: the rounding of a distance, `32 u extent` of the link and a triangle, edge or corner. It is
//!   far above the error of a measurement. `2 t` stands for t of the triangle where a piece
//!   appeared, plus t and gap(f) of the f where the piece merges.
//!
//! If two pieces merge at most `2 t` above the farther of their minima, the farther piece *ends*:
//! its minimum is not reported. So a flat wall along the link, whose triangles tie within rounding,
//! is one piece. A triangle whose least point lies on a nearer neighbour starts no piece of its
//! own. Since the nearer piece stays, the nearest point of each connected piece of wall within the
//! margin is always reported.
//!
//! # Claim
//! A path on the wall goes through triangles. It changes from one to another only at an f that both
//! share, and may jump there by gap(f).
//!
//! 1. *None is missed*: from every point x of the wall a path on the wall leads to a reported
//!    minimum. Along it d never exceeds `d(x) + 2 t`.
//! 2. *None is found twice*: each path from one reported minimum to another exceeds the farther of
//!    the two by more than `2 t`.
//! 3. *Each is a minimum*: let T' be a triangle that contains it, or that shares an f within gap(f)
//!    of it with the minimum's triangle. No point of T' is nearer, beyond `2 t`.
//!
//! Coincident triangles share their corners and edges, but not their faces. So a minimum between
//! their edges is reported once for each. Closed surfaces that touch one another share only equal
//! corners, because neither has an open edge.
//!
//! # Reduction to a graph
//! The link is convex, so d is a convex function. So the part of a triangle with `d <= c` is
//! convex, and connected. T belongs to the wall within c from `c = d(T)` on, as one piece. Two
//! triangles that share f are joined by f exactly from `c = d(f)` on, when both pieces contain the
//! nearest point of f.
//!
//! So the pieces are the components of a graph. Its nodes are the triangles; T exists from d(T) on.
//! It has an edge for each shared f, from `d(f) >= max(d(T), d(T'))` on. With a gap, d(f) is
//! measured at one side, and `d(f) + gap(f)` is not less than either distance.
//!
//! Of all triangles around a place or an edge, one pair joined by a seam is enough: each of the
//! others shares with one of the two a corner or edge that contains the seam.
//!
//! # Algorithm
//! 1. **Cull** triangles that certainly hold no reported minimum (see below).
//! 2. **Measure** the others and sort them, nearest first; ties by the triangle's number.
//! 3. **Sweep.** Each triangle T in turn starts a piece. It meets a piece at each f that it shares
//!    with an earlier, nearer triangle. If d(f) is at most `2 t` above the farther of the two
//!    minima, the piece with that minimum ends. (This is the elder rule of persistent homology.)
//! 4. **Report** the first triangle of each piece that has not ended.
//!
//! The *rank* of a triangle is its number in the order of step 2, counted from 1. Union-find
//! (Galler and Fischer) has the pieces: each rank names an earlier rank of the same piece, or
//! itself if it is the first.
//!
//! If the least point of T lies on f, d(f) is d(T) and is not computed. That holds for nearly all
//! f.
//!
//! # Proof
//! - Claim 2. The sweep handles f at d(T), before d(f), but misses no pair of pieces thereby. The
//!   minimum of a piece that could end is at least `d(f) - 2 t >= d(T) - 2 t`, and every triangle
//!   nearer than T has been processed.
//! - Claim 1. Go from x straight to the least point of its triangle. Whenever the piece there has
//!   ended, go through its f to the piece that it joined, whose minimum is nearer.
//! - Claim 3. A triangle that contains the minimum of T shares with T an f there, with
//!   `d(f) <= d(T) + 2 t`. So one of the two pieces ended: the piece of T, if the other one is
//!   nearer.
//!
//! # Culling
//! Most triangles lie on a slope: their nearest point is on a shared edge or corner f, and the
//! other triangle is nearer by far more than `2 t`. The search detects that from the neighbour
//! (`descent_cull`) or from the bounds of all candidates (`feature_cull`). A triangle D is *culled*
//! in two cases:
//! - It lies on a slope. At d(D) it joins a piece whose minimum is nearer by far more than `2 t`,
//!   so no piece ever ends in favour of D.
//! - Its nearest point is on an f that it shares with a culled triangle. At d(f) it joins that
//!   triangle, which is in such a piece from a distance on that is not greater.
//!
//! A loose triangle is never culled, since the proofs need the nearest point of D to lie exactly on
//! f. So gaps occur only between triangles that are measured.
//!
//! Culled triangles still count where other pieces meet them. If a piece shares f with D, and d(f)
//! is at most `2 t` above the minimum of that piece, the piece ends. For `d(f) >= d(D)`, so the
//! minimum of D's piece is the nearer one. The piece to which D belongs makes no difference, so all
//! culled triangles count as one piece, nearer than any other ([`CULLED`]).
//!
//! An f that is certainly farther than the nearest point of a triangle joins that triangle to no
//! nearer one. Such an f is skipped.
//!
//! # Cost
//! A triangle queries all triangles that share a corner or an edge with it: whether one is nearer
//! by far or culled, and which came first. The answers are the same for the whole ring, so a long
//! ring is evaluated once ([`LongRings`]). So the cost grows linearly with the triangles near a
//! link and around their corners.
//!
//! # Overlap
//! Where link and wall overlap, d = 0. A piece is then a connected piece of wall inside the link,
//! and one contact. Its representative is the triangle nearest to the axis; ties go to the lowest
//! triangle.

use super::long_rings::{LongRings, SHORT_RING};
use super::triangle_candidates::{ALL_PARTS, NearLink};
use crate::distance::lanes::set_bits;
use crate::mesh::{PARTS, ends_of, find_root};
use crate::pair::{Measurement, Nearest, PlacedLink, rounding};
use crate::robot::share_along;
use parry3d_f64::math::{Real, Vector};

/// The rank of all culled triangles: they count as one piece, nearer than any other.
pub(crate) const CULLED: u32 = 0;

/// No rank: a triangle that is not within the margin.
pub(crate) const NONE: u32 = u32::MAX;

/// The ring of a corner or an edge, as it concerns a triangle whose nearest point lies there.
#[derive(Clone)]
pub(super) struct CullRing {
    /// The least upper bound on the distance of a candidate in the ring.
    upper: Real,
    /// Whether a triangle of the ring is culled.
    has_culled: bool,
}

impl Default for CullRing {
    fn default() -> Self {
        Self { upper: Real::INFINITY, has_culled: false }
    }
}

/// Step 1: gives the rank [`CULLED`] to the candidates that certainly lie on a slope towards a
/// nearer triangle.
pub(super) fn cull(near: &NearLink, ranks: &mut [u32], rings: &mut LongRings<CullRing>) {
    rings.clear();
    // A culled triangle may cull another; the second round finds most such cases.
    for _ in 0..2 {
        for candidate in 0..near.candidates.triangles.len() {
            if ranks[candidate] != CULLED && lies_on_slope(near, candidate, ranks, rings) {
                ranks[candidate] = CULLED;
                rings.change_rings_of(candidate, |ring| ring.has_culled = true);
            }
        }
    }
}

/// Returns true if the nearest point of a candidate certainly lies on a corner or an edge that it
/// shares with a culled triangle, or with one that is nearer by far.
fn lies_on_slope(
    near: &NearLink,
    candidate: usize,
    ranks: &[u32],
    rings: &mut LongRings<CullRing>,
) -> bool {
    let (triangles, shared) = (near.candidates.triangles, near.wall.mesh.parts());
    let known = &triangles[candidate];
    let Some(part) = known.nearest_feature().filter(|_| !shared.is_loose(known.triangle)) else {
        return false;
    };
    let mut others = shared.others(known.triangle, part);
    let culls = |other: u32| match near.index_of(other) {
        Some(index) => triangles[index].upper < known.lower || ranks[index] == CULLED,
        None => near.is_culled(other),
    };
    if others.by_ref().take(SHORT_RING).any(culls) {
        return true;
    }
    if others.next().is_none() {
        return false;
    }
    let add = |ring: &mut CullRing, other: u32, index: Option<usize>| match index {
        Some(index) => {
            ring.upper = ring.upper.min(triangles[index].upper);
            ring.has_culled |= ranks[index] == CULLED;
        }
        None => ring.has_culled |= near.is_culled(other),
    };
    // The ring includes the triangle itself, but its `upper` is not below its `lower`.
    let ring = rings.ring_of(near, [candidate, part], add);
    ring.has_culled || ring.upper < known.lower
}

/// Step 2: sorts the triangles, nearest first, and returns those within the margin.
pub(super) fn nearest_first(measured: &mut [Measurement], margin: Real) -> &[Measurement] {
    // Triangles beyond the margin come last, because they appear at their distance.
    measured.sort_unstable_by(|a, b| {
        a.appears_at.total_cmp(&b.appears_at).then(a.nearest.triangle.cmp(&b.nearest.triangle))
    });
    let count = measured.partition_point(|ranked| ranked.nearest.distance <= margin);
    &measured[..count]
}

/// The sweep of steps 3 and 4 over the wall near one link.
pub(super) struct Sweep<'a> {
    pub link: &'a PlacedLink,
    pub near: &'a NearLink<'a>,
    /// The rank of each candidate.
    pub ranks: &'a [u32],
    /// The triangles within the margin, nearest first.
    pub ranked: &'a [Measurement],
    /// Union-find: for each rank an earlier one of the same piece, or itself.
    pub piece: &'a mut Vec<u32>,
    pub rings: &'a mut LongRings<SweepRing>,
}

impl Sweep<'_> {
    /// Runs the sweep. Returns the first triangles of the pieces that have not ended, nearest
    /// first.
    pub(super) fn first_triangles(&mut self) -> impl Iterator<Item = &Nearest> {
        self.piece.clear();
        self.piece.push(CULLED);
        for rank in 1..=self.ranked.len() {
            self.add(rank as u32);
        }
        let ranks = (1..self.piece.len()).filter(|&rank| self.piece[rank] == rank as u32);
        ranks.map(|rank| &self.ranked[rank - 1].nearest)
    }

    /// Starts a piece at the triangle of a rank, and merges it with the pieces of nearer triangles
    /// (step 3).
    fn add(&mut self, rank: u32) {
        self.piece.push(rank);
        let Measurement { nearest, rounding: own_rounding, .. } = self.ranked[rank as usize - 1];
        let (near, mesh) = (self.near, self.near.wall.mesh);
        let Some(candidate) = near.index_of(nearest.triangle) else { return };
        let (known, shared) = (near.candidates.triangles[candidate], mesh.parts());
        let corners = mesh.corners(nearest.triangle);
        let is_loose = shared.is_loose(nearest.triangle);
        let gaps = match is_loose {
            true => mesh.indices()[nearest.triangle as usize].map(|end| shared.gap(end)),
            false => [0.0; 3],
        };
        let gap_of = |part| ends_of(gaps, part).into_iter().fold(0.0, Real::max);
        // Parts with the least point come first: they are met at the triangle's own distance. The
        // others are kept, with the rank that is met.
        let (mut others_met, mut count) = ([(0, CULLED); 2 * PARTS], 0);
        let mut root = rank;
        for part in set_bits(if is_loose { ALL_PARTS } else { known.near_parts() }) {
            let add = |ring: &mut SweepRing, other: u32, index: Option<usize>| match index {
                Some(index) => {
                    ring.add(self.ranks[index], near.candidates.triangles[index].lower);
                }
                None => ring.has_culled |= near.is_culled(other),
            };
            let (mut ring, mut others) =
                (SweepRing::default(), shared.others(nearest.triangle, part));
            for other in others.by_ref().take(SHORT_RING) {
                add(&mut ring, other, near.index_of(other));
            }
            if others.next().is_some() {
                ring = *self.rings.ring_of(near, [candidate, part], add);
            }
            // A culled triangle whose lower bound is at least this one's upper bound is as far, and
            // so is each part that they share.
            let meets_culled = ring.has_culled || ring.culled_lower < known.upper;
            let first = ring.first;
            for (is_met, with) in [(meets_culled, CULLED), (first < rank, first)] {
                if !is_met || find_root(self.piece, with) == root {
                    continue;
                }
                let ends = ends_of(corners, part);
                if is_on(nearest.on_mesh, ends, own_rounding) {
                    root = self.meet([rank, root, with], ends, gap_of(part), true);
                } else {
                    others_met[count] = (part, with);
                    count += 1;
                }
            }
        }
        if is_loose {
            root = self.meet_across_seams([rank, root], true);
        }
        for &(part, with) in &others_met[..count] {
            root = self.meet([rank, root, with], ends_of(corners, part), gap_of(part), false);
        }
        if is_loose {
            self.meet_across_seams([rank, root], false);
        }
    }

    /// Merges a triangle with the pieces of nearer triangles beyond its seams: beyond the seams
    /// that hold its least point, or beyond the other seams. `root` is the first rank of its piece.
    /// Returns the first rank of the merged piece.
    fn meet_across_seams(&mut self, [rank, mut root]: [u32; 2], met_there: bool) -> u32 {
        let Measurement { nearest, rounding: own_rounding, .. } = self.ranked[rank as usize - 1];
        let mesh = self.near.wall.mesh;
        for seam in mesh.parts().seams(nearest.triangle) {
            // A triangle with a seam is never culled.
            let candidate = self.near.index_of(seam.other);
            let with = candidate.map_or(NONE, |candidate| self.ranks[candidate]);
            let ends = seam.ends.map(|end| mesh.vertices()[end as usize]);
            let holds_least_point = is_on(nearest.on_mesh, ends, own_rounding + 2.0 * seam.gap);
            if with < rank && holds_least_point == met_there {
                root = self.meet([rank, root, with], ends, seam.gap, holds_least_point);
            }
        }
        root
    }

    /// Merges the pieces of two triangles, `rank` and `with`, if a part that both share is at most
    /// `2 t` above the farther of the two minima. `root` is the first rank of the piece of `rank`;
    /// returns it after the merge.
    #[inline(always)]
    fn meet(
        &mut self,
        [rank, root, with]: [u32; 3],
        [from, to]: [Vector; 2],
        gap: Real,
        holds_least_point: bool,
    ) -> u32 {
        let other = find_root(self.piece, with);
        if root == other {
            return root;
        }
        let merge_limit = self.minimum_with_rounding(root).max(self.minimum_with_rounding(other))
            + rounding(self.link.extent_with([from, to, to]))
            + gap;
        if self.ranked[rank as usize - 1].nearest.distance > merge_limit
            || !holds_least_point && !self.link.comes_within(merge_limit, from, to)
        {
            return root;
        }
        // The merged piece appeared with the nearer of the two.
        self.piece[root.max(other) as usize] = root.min(other);
        root.min(other)
    }

    /// Returns the minimum of a piece plus its rounding; a piece that merges below this (and the
    /// rounding of the pass) ends.
    fn minimum_with_rounding(&self, piece: u32) -> Real {
        let ranked = (piece as usize).checked_sub(1).map(|index| &self.ranked[index]);
        ranked.map_or(Real::NEG_INFINITY, |ranked| ranked.nearest.distance + ranked.rounding)
    }
}

/// The ring of a corner or an edge, as it concerns a triangle that may be joined there.
#[derive(Clone, Copy)]
pub(super) struct SweepRing {
    /// The least lower bound on the distance of a culled candidate in the ring.
    culled_lower: Real,
    /// Whether the search has culled a triangle of the ring.
    has_culled: bool,
    /// The least rank of a triangle in the ring. If it is the rank of the triangle that is added,
    /// that triangle joins none there.
    first: u32,
}

impl Default for SweepRing {
    fn default() -> Self {
        Self { culled_lower: Real::INFINITY, has_culled: false, first: NONE }
    }
}

impl SweepRing {
    /// Adds a candidate.
    #[inline(always)]
    fn add(&mut self, rank: u32, lower: Real) {
        if rank == CULLED {
            self.culled_lower = self.culled_lower.min(lower);
        } else {
            self.first = self.first.min(rank);
        }
    }
}

/// Returns true if a point lies on a segment, within half of `rounding`: the rounding of a distance
/// (`pair::measure_batch`) is twice that of a point.
fn is_on(point: Vector, [from, to]: [Vector; 2], rounding: Real) -> bool {
    let (edge, relative) = (to - from, point - from);
    (relative - edge * share_along(relative, edge)).abs().max_element() <= 0.5 * rounding
}
