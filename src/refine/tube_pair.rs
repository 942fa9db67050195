//! Two tubes beside one another: pairs of pieces, and bounds on their distance.
//!
//! # Definitions
//! - **Pair**: one piece of each tube, each in a bounding body.
//! - y: any point of space. d1(y), d2(y): upper bounds on its distance from the two tubes
//!   ([`PlacedTube::near`]).
//!
//! # Bounds
//! - **Lower bound**: the distance of the two bodies, measured as two links.
//! - **Upper bound**: d1(y) + d2(y). The path from one tube by way of y to the other is at least as
//!   long as the clearance. If both are 0, y is a common point and the tubes overlap.
//!
//! # Algorithm
//! 1. **Begin** with the pairs that are at most `upper` apart (`capsule_tree`). `upper` is the
//!    first upper bound or the margin: farther pairs cannot change the answer.
//! 2. **Upper bound of a pair** (`found_from`). Start with y between the bodies. Move y to the
//!    middle of the two tube points found from it; repeat up to [`MAX_MOVES`] times while the sum
//!    decreases.
//! 3. **Halve** the piece whose body becomes narrower by more.

use super::bounding_body::{BoundingBody, MOST_CORES, SectionRange};
use super::capsule_tree::{CapsuleTree, NearPairs, Parts, WaitingRuns, pays};
use super::placed_tube::{Piece, PlacedTube};
use super::refinable::{Body, Refinable, UpperBound};
use super::tube_point::TubePoint;
use crate::answer::ProximityError;
use crate::pair::{NearestOfLinks, PlacedLink};
use parry3d_f64::math::{Real, Vector};
use std::ops::Range;

/// How often y is moved.
const MAX_MOVES: u32 = 4;

/// How far y moves towards a tube, as a share of the way to its surface: more than 1, to end
/// inside.
const INTO: Real = 1.125;

/// Two tubes in one frame.
#[derive(Clone, Copy)]
pub(crate) struct TubePair<'a> {
    pub(super) tubes: [PlacedTube<'a>; 2],
}

/// A piece of each tube, with its body.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PiecePair {
    pieces: [Piece; 2],
    outers: [BoundingBody; 2],
    /// A lower bound on their distance.
    pub at_least: Real,
}

impl Body for [BoundingBody; 2] {
    fn excess(&self) -> Real {
        self[0].excess + self[1].excess
    }

    fn is_flat(&self) -> bool {
        self.iter().any(Body::is_flat)
    }
}

/// An upper bound on the distance of two tubes, and the points that realise it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PairUpperBound {
    pub upper: Real,
    pub sections: [u32; 2],
    pub arcs: [Real; 2],
    pub points: [Vector; 2],
}

impl PairUpperBound {
    /// Returns the section whose `speeds` entry is larger, and that speed; ties return the first.
    pub(crate) fn faster(&self, speeds: [Real; 2]) -> (usize, Real) {
        let k = usize::from(speeds[1] > speeds[0]);
        (self.sections[k] as usize, speeds[k])
    }

    /// Returns the smaller bound; ties return `self`.
    fn nearer(self, other: Self) -> Self {
        if other.upper < self.upper { other } else { self }
    }
}

impl UpperBound for PairUpperBound {
    fn upper(&self) -> Real {
        self.upper
    }

    fn triangle(&self) -> Option<u32> {
        None
    }

    fn tie(&self) -> [u32; 2] {
        self.sections
    }
}

/// The initial pieces and pairs of a query. A later query reuses the memory.
#[derive(Clone, Debug, Default)]
pub(crate) struct PairQueue {
    pieces: [Parts<Piece>; 2],
    trees: [CapsuleTree; 2],
    waiting: WaitingRuns,
    nearest: NearestPairs,
}

impl<'a> TubePair<'a> {
    pub(crate) fn new(mut tubes: [PlacedTube<'a>; 2]) -> Self {
        let [first, second] = tubes;
        tubes[0].beside(&second);
        tubes[1].beside(&first);
        Self { tubes }
    }

    /// Returns the pairs in which the stated turn of one tube, or of both, is ignored, where that
    /// leaves less known. All bounds of those pairs hold for this one.
    pub(crate) fn less_known(&self) -> impl Iterator<Item = Self> + use<'a> {
        let [first, second] = self.tubes;
        let less = [first.without_turn(), second.without_turn()];
        let both = less[0].zip(less[1]).map(|(first, second)| [first, second]);
        let one = [less[0].map(|first| [first, second]), less[1].map(|second| [first, second])];
        both.into_iter().chain(one.into_iter().flatten()).map(|tubes| Self { tubes })
    }

    /// Returns both pieces of a pair as ranges of their sections, with their bodies and radii.
    pub(crate) fn section_ranges<'p>(&self, pair: &'p PiecePair) -> [SectionRange<'p>; 2] {
        [0, 1].map(|k: usize| self.tubes[k].section_range(&pair.pieces[k], &pair.outers[k]))
    }

    /// Returns one of the two tubes.
    pub(crate) fn tube(&self, number: usize) -> &PlacedTube<'a> {
        &self.tubes[number]
    }

    /// Whether these section numbers exist in the two tubes.
    pub(crate) fn have(&self, sections: [u32; 2]) -> bool {
        sections
            .iter()
            .zip(&self.tubes)
            .all(|(&section, tube)| (section as usize) < tube.sections().len())
    }

    /// Returns a first upper bound: from the nearest points of the chords of the longest sections.
    pub(crate) fn first_bound(&self) -> PairUpperBound {
        let sections = self.tubes.map(|tube| tube.longest_section());
        let [first, second] = [0, 1].map(|k: usize| self.tubes[k].chord(sections[k]));
        let (feet, _) = first.0.nearest_on_axes(&second.0);
        let arc = |(chord, [start, end]): (PlacedLink, [Real; 2]), foot| {
            start + (end - start) * chord.share_of(foot)
        };
        self.bound_at(sections, [arc(first, feet[0]), arc(second, feet[1])])
    }

    /// Returns the upper bound found from two places of the tubes.
    pub(crate) fn bound_at(&self, sections: [u32; 2], arcs: [Real; 2]) -> PairUpperBound {
        let places = [0, 1].map(|k: usize| self.tubes[k].place_at(sections[k], arcs[k]));
        let radii = [0, 1].map(|k: usize| self.tubes[k].section(sections[k]).radius);
        self.found_from(sections, arcs, half_way(places, radii))
    }

    /// Fills `pairs` with the initial pairs, the nearest one last: all pairs whose bodies are at
    /// most `upper` apart.
    ///
    /// Returns false if there are more than `most`: then only the nearest are kept.
    ///
    /// # Errors
    /// A curve is not finite.
    pub(crate) fn begin(
        &self,
        scale: Real,
        upper: Real,
        most: usize,
        beginning: &mut PairQueue,
        pairs: &mut Vec<PiecePair>,
    ) -> Result<bool, ProximityError> {
        self.begin_pieces(scale, beginning)?;
        Ok(self.begin_pairs(upper, most, beginning, pairs))
    }

    /// Fills `beginning` with the initial pieces.
    ///
    /// # Errors
    /// A curve is not finite.
    pub(crate) fn begin_pieces(
        &self,
        scale: Real,
        beginning: &mut PairQueue,
    ) -> Result<(), ProximityError> {
        let PairQueue { pieces, trees, .. } = beginning;
        for (tube, pieces) in self.tubes.iter().zip(&mut *pieces) {
            pieces.list.clear();
            tube.begin_along(scale.max(0.25 * tube.widest()), |piece| pieces.list.push(piece));
            pieces.forget_bodies();
        }
        let pays = pays(pieces.each_ref().map(|pieces| pieces.list.len()));
        for (k, tube) in self.tubes.iter().enumerate() {
            // Samples are finite.
            if !pays || tube.tube.is_function() {
                for place in 0..pieces[k].list.len() {
                    let piece = pieces[k].list[place];
                    tube.check_finite(&piece, self.body_of(k, place, &mut pieces[k]))?;
                }
            }
            if pays {
                let count = pieces[k].list.len();
                trees[k].begin(count, 0, &mut |run| self.capsule(k, run, &mut pieces[k]));
            }
        }
        Ok(())
    }

    /// Returns the body of an initial piece.
    fn body_of<'p>(
        &self,
        k: usize,
        place: usize,
        pieces: &'p mut Parts<Piece>,
    ) -> &'p BoundingBody {
        pieces.body(place, |piece| self.tubes[k].outer(piece))
    }

    /// Returns the capsule of a run of initial pieces.
    fn capsule(
        &self,
        k: usize,
        run: Range<usize>,
        pieces: &mut Parts<Piece>,
    ) -> Option<([Vector; 2], Real)> {
        if run.len() > 1 {
            let list = &pieces.list[run];
            return self.tubes[k].around_run([&list[0], &list[list.len() - 1]]);
        }
        let BoundingBody { body, .. } = self.body_of(k, run.start, pieces);
        Some(([body.start(), body.end()], body.radius()))
    }

    /// As [`begin`](Self::begin), for the pieces in `beginning`.
    pub(crate) fn begin_pairs(
        &self,
        upper: Real,
        most: usize,
        beginning: &mut PairQueue,
        pairs: &mut Vec<PiecePair>,
    ) -> bool {
        let PairQueue { pieces, trees, waiting, nearest } = beginning;
        nearest.begin(most);
        let mut offer = |least: Real, places: [usize; 2], pieces: &mut [Parts<Piece>; 2]| {
            let at_least = self.initial_at_least(least, places, pieces);
            if at_least <= upper {
                nearest.push(at_least, places);
            }
        };
        let counts = pieces.each_ref().map(|pieces| pieces.list.len());
        if pays(counts) {
            let mut near = NearPairs::new(trees, waiting, upper + 2.0 * self.slack());
            while let Some((least, places)) = self.next_pair(&mut near, pieces) {
                offer(least, places, pieces);
            }
        } else {
            for i in 0..counts[0] {
                (0..counts[1]).for_each(|j| offer(Real::NEG_INFINITY, [i, j], pieces));
            }
        }
        let (order, is_all) = nearest.farthest_first();
        pairs.clear();
        pairs.extend(order.map(|(at_least, places)| self.pair(at_least, places, pieces)));
        is_all
    }

    /// Returns the next pair of the trees and its lower bound.
    fn next_pair(
        &self,
        near: &mut NearPairs,
        pieces: &mut [Parts<Piece>; 2],
    ) -> Option<(Real, [usize; 2])> {
        near.next(&|_| true, &mut |k, run| self.capsule(k, run, &mut pieces[k]))
    }

    /// Returns a lower bound on the distance of two initial pieces, given the one of the tree.
    fn initial_at_least(
        &self,
        least: Real,
        places: [usize; 2],
        [first, second]: &mut [Parts<Piece>; 2],
    ) -> Real {
        let bodies = [self.body_of(0, places[0], first), self.body_of(1, places[1], second)];
        self.at_least(bodies.map(|outer| &outer.body)).max(least - 2.0 * self.slack())
    }

    fn pair(
        &self,
        at_least: Real,
        places: [usize; 2],
        pieces: &mut [Parts<Piece>; 2],
    ) -> PiecePair {
        let outers = [0, 1].map(|k: usize| *self.body_of(k, places[k], &mut pieces[k]));
        let pieces = [0, 1].map(|k: usize| pieces[k].list[places[k]]);
        PiecePair { pieces, outers, at_least }
    }

    /// Returns the upper bound from the nearest initial pieces; `None` if there are so few pairs
    /// that all can be begun.
    pub(crate) fn bound_of_bodies(&self, beginning: &mut PairQueue) -> Option<PairUpperBound> {
        let PairQueue { pieces, trees, waiting, .. } = beginning;
        if !pays(pieces.each_ref().map(|pieces| pieces.list.len())) {
            return None;
        }
        let mut nearest: Option<PiecePair> = None;
        let mut near = NearPairs::new(trees, waiting, Real::INFINITY);
        while let Some((least, places)) = self.next_pair(&mut near, pieces) {
            let at_least = self.initial_at_least(least, places, pieces);
            if nearest.is_none_or(|nearest| at_least < nearest.at_least) {
                near.bound = at_least + 2.0 * self.slack();
                nearest = Some(self.pair(at_least, places, pieces));
            }
        }
        nearest.map(|PiecePair { pieces, outers, .. }| {
            let [one, two] = outers.map(|outer| outer.body);
            let (feet, _) = one.nearest_on_axes(&two);
            let arcs = [0, 1].map(|k: usize| {
                let [start, end] = self.tubes[k].arcs(&pieces[k]);
                start + (end - start) * outers[k].body.share_of(feet[k])
            });
            let radii = [one.radius(), two.radius()];
            self.found_from(pieces.map(|piece| piece.section), arcs, half_way(feet, radii))
        })
    }

    /// Returns a lower bound on the distance of two bodies: the distance of the capsules around
    /// them, minus rounding.
    pub(super) fn at_least(&self, [one, two]: [&PlacedLink; 2]) -> Real {
        let (_, apart) = one.nearest_on_axes(two);
        apart - one.radius() - two.radius() - self.slack()
    }

    /// Returns the upper bound found from the point `from` (step 2 of the module).
    fn found_from(&self, sections: [u32; 2], arcs: [Real; 2], from: Vector) -> PairUpperBound {
        found_from(sections, arcs, from, |arcs, from| {
            [0, 1].map(|k: usize| self.tubes[k].near(sections[k], arcs[k], from))
        })
    }
}

/// Returns the upper bound found from the point `from` (step 2 of the module). `seen` returns both
/// tubes' bounds on the distance of a point, searching near two arc lengths.
pub(super) fn found_from(
    sections: [u32; 2],
    arcs: [Real; 2],
    from: Vector,
    seen: impl Fn([Real; 2], Vector) -> [TubePoint; 2],
) -> PairUpperBound {
    let (mut best, mut place) = (seen(arcs, from), from);
    for _ in 0..MAX_MOVES {
        let [one, two] = best;
        place = match [one.upper > 0.0, two.upper > 0.0] {
            [true, true] => (one.point + two.point) * 0.5,
            // Move from inside one tube into the other.
            [true, false] => place + (one.point - place) * INTO,
            [false, true] => place + (two.point - place) * INTO,
            [false, false] => break,
        };
        let next = seen([one.arc, two.arc], place);
        // This form makes NaN end the loop.
        if next[0].upper + next[1].upper >= one.upper + two.upper || !place.is_finite() {
            break;
        }
        best = next;
    }
    let [one, two] = best;
    PairUpperBound {
        upper: one.upper + two.upper,
        sections,
        arcs: [one.arc, two.arc],
        points: [one.point, two.point],
    }
}

impl Refinable for TubePair<'_> {
    type Piece = PiecePair;
    type Body = [BoundingBody; 2];
    type Nearest = NearestOfLinks;
    type Upper = PairUpperBound;

    fn body(&self, pair: &PiecePair) -> [BoundingBody; 2] {
        pair.outers
    }

    fn place(&self, pair: &PiecePair) -> [u32; 4] {
        let [one, two] = pair.pieces;
        [one.section, one.from, two.section, two.from]
    }

    fn check_finite(
        &self,
        pair: &PiecePair,
        bodies: &[BoundingBody; 2],
    ) -> Result<(), ProximityError> {
        let mut of_each = self.tubes.iter().zip(&pair.pieces).zip(bodies);
        of_each.try_for_each(|((tube, piece), outer)| tube.check_finite(piece, outer))
    }

    fn halves(
        &self,
        pair: &PiecePair,
        bodies: &[BoundingBody; 2],
        aim: Real,
    ) -> Option<[PiecePair; 2]> {
        let gains = |k: usize| bodies[k].narrows > 0.5 * self.tubes[k].slack();
        let halves = |k: usize| {
            let tube = &self.tubes[k];
            let halves = if gains(k) { tube.halves(&pair.pieces[k], aim) } else { None }?;
            Some(halves.map(|half| {
                let mut pair = *pair;
                (pair.pieces[k], pair.outers[k]) = (half, tube.outer(&half));
                pair
            }))
        };
        let first = usize::from(bodies[1].narrows > bodies[0].narrows);
        halves(first).or_else(|| halves(1 - first))
    }

    fn may_meet(&mut self, bodies: &[BoundingBody; 2], bound: Real) -> bool {
        self.at_least(bodies.each_ref().map(|outer| &outer.body)) <= bound
    }

    fn nearest(
        &mut self,
        bodies: &[BoundingBody; 2],
        bound: Real,
        _: Option<u32>,
    ) -> Option<NearestOfLinks> {
        bodies[0].body.measure_link_within(bound, &bodies[1].body)
    }

    fn distance(nearest: &NearestOfLinks) -> Real {
        nearest.distance
    }

    fn found(
        &self,
        pair: &PiecePair,
        bodies: &[BoundingBody; 2],
        nearest: &NearestOfLinks,
    ) -> PairUpperBound {
        let links = [&bodies[0].body, &bodies[1].body];
        let sections = pair.pieces.map(|piece| piece.section);
        let arcs_at = |points: [Vector; 2]| {
            [0, 1].map(|k: usize| {
                let [start, end] = self.tubes[k].arcs(&pair.pieces[k]);
                start + (end - start) * links[k].share_of(points[k])
            })
        };
        let points = [nearest.on_first, nearest.on_second];
        let found = self.found_from(sections, arcs_at(points), (points[0] + points[1]) * 0.5);
        if nearest.distance > 0.0 || found.upper <= 0.0 {
            return found;
        }
        // A common point of the bodies may be outside both tubes. A point half way between the axes
        // is inside.
        let (feet, _) = links[0].nearest_on_axes(links[1]);
        let mut found = found.nearer(self.found_from(
            sections,
            arcs_at(feet),
            half_way(feet, links.map(PlacedLink::radius)),
        ));
        // At flat ends either point may lie in the plane of a face, where rounding decides on which
        // side. The bodies without an outer layer give points farther inside.
        let mut depth = 1.0;
        for _ in 0..MOST_CORES {
            if found.upper <= 0.0 {
                break;
            }
            let cores =
                [0, 1].map(|k: usize| self.tubes[k].core(&pair.pieces[k], &bodies[k], depth));
            let [Some(one), Some(two)] = cores else { break };
            let Some(NearestOfLinks { on_first: point, .. }) = one.measure_link_within(0.0, &two)
            else {
                break;
            };
            found = found.nearer(self.found_from(sections, arcs_at([point; 2]), point));
            depth *= 8.0;
        }
        found
    }

    fn is_in_first_half(&self, found: &PairUpperBound, halves: &[PiecePair; 2]) -> bool {
        let [low, high] = halves;
        let k = usize::from(low.pieces[0].to == high.pieces[0].to);
        found.arcs[k] < self.tubes[k].arcs(&low.pieces[k])[1]
    }

    fn radius(&self, pair: &PiecePair) -> Real {
        let [first, second] = [0, 1].map(|k: usize| self.tubes[k].radius(&pair.pieces[k]));
        first.max(second)
    }

    fn direction_uncertainty(&self, pair: &PiecePair) -> Real {
        [0, 1].map(|k: usize| self.tubes[k].direction_uncertainty(&pair.pieces[k])).iter().sum()
    }

    fn may_become_round(&self, pair: &PiecePair) -> bool {
        (0..2).any(|k| self.tubes[k].may_become_round(&pair.pieces[k]))
    }

    fn position_uncertainty(&self) -> Real {
        self.tubes.iter().map(PlacedTube::position_uncertainty).sum()
    }

    fn slack(&self) -> Real {
        self.tubes.iter().map(PlacedTube::slack).sum()
    }
}

/// Returns the point on the segment between two balls that is equally far from both surfaces
/// (equally deep if they overlap).
pub(super) fn half_way(places: [Vector; 2], radii: [Real; 2]) -> Vector {
    let way = places[1] - places[0];
    let away = way.length();
    let share = 0.5 + 0.5 * (radii[0] - radii[1]) / away;
    // This form maps NaN (both places coincide) to the first place.
    let share = if share > 0.0 { share.min(1.0) } else { 0.0 };
    places[0] + way * share
}

/// Pairs of body indices with lower bounds on their distances. Keeps the nearest `most` pairs.
#[derive(Clone, Debug, Default)]
pub(super) struct NearestPairs {
    order: Vec<(Real, [u32; 2])>,
    most: usize,
    is_all: bool,
}

impl NearestPairs {
    pub(super) fn begin(&mut self, most: usize) {
        self.order.clear();
        (self.most, self.is_all) = (most, true);
    }

    pub(super) fn push(&mut self, at_least: Real, [i, j]: [usize; 2]) {
        self.order.push((at_least, [i as u32, j as u32]));
        if self.order.len() >= self.most.saturating_mul(2) {
            self.keep_nearest();
        }
    }

    /// Returns the pairs with their bounds, the farthest first, and whether all pairs were kept.
    pub(super) fn farthest_first(&mut self) -> (impl Iterator<Item = (Real, [usize; 2])>, bool) {
        self.keep_nearest();
        self.order.sort_unstable_by(|a, b| b.0.total_cmp(&a.0).then(b.1.cmp(&a.1)));
        let pair =
            |&(at_least, pair): &(Real, [u32; 2])| (at_least, pair.map(|place| place as usize));
        (self.order.iter().map(pair), self.is_all)
    }

    fn keep_nearest(&mut self) {
        if self.order.len() > self.most {
            self.order.select_nth_unstable_by(self.most, |a, b| a.0.total_cmp(&b.0));
            self.order.truncate(self.most);
            self.is_all = false;
        }
    }
}
