//! Two tubes beside one another: a piece of each, and what is found between them.
//!
//! The bodies around two pieces are as far apart as two links, which bounds the clearance of the
//! pieces from below. From above any point y of space does: the way from one tube to y and on to
//! the other is no shorter than the clearance, and how far y is from a tube at most is known from
//! any place of its centreline nearby ([`PlacedTube::near`]). It is the less the nearer y is to the
//! shortest way between the tubes; where they overlap, a y that is in both shows it. So y begins
//! between the bodies, and moves to the middle between the two points of the tubes that are found
//! from there.
//!
//! Of a pair the piece is halved whose body gains more. A pair that is farther apart than the first
//! upper bound, or than the margin that is asked about, is none to begin with, since it cannot
//! change the answer.

use super::bounding_body::BoundingBody;
use super::nearest_pairs::NearestPairs;
use super::piece::Piece;
use super::placed_tube::PlacedTube;
use super::refinable::{Body, Refinable, UpperBound};
use super::refine::WorkItem;
use super::tube_point::TubePoint;
use crate::answer::ProximityError;
use crate::pair::{NearestOfLinks, PlacedLink};
use parry3d_f64::math::{Real, Vector};

/// How often y moves at most.
const MAX_MOVES: u32 = 4;

/// By how much farther than to its surface y moves into a tube.
const INTO: Real = 1.125;

/// How many cores are tried of two bodies that overlap.
const MOST_CORES: u32 = 4;

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
}

impl Body for [BoundingBody; 2] {
    fn excess(&self) -> Real {
        self[0].excess + self[1].excess
    }
}

/// An upper bound on how far two tubes are apart, and what realises it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PairUpperBound {
    pub upper: Real,
    pub sections: [u32; 2],
    pub arcs: [Real; 2],
    pub points: [Vector; 2],
}

impl PairUpperBound {
    /// Which of the two sections is faster, and how fast, of these speeds.
    pub(crate) fn faster(&self, speeds: [Real; 2]) -> (usize, Real) {
        let k = usize::from(speeds[1] > speeds[0]);
        (self.sections[k] as usize, speeds[k])
    }
}

impl PairUpperBound {
    /// The lesser of two bounds, the first of equals.
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

impl WorkItem<TubePair<'_>> for PiecePair {
    fn piece(&self, _: &TubePair) -> PiecePair {
        *self
    }

    fn halves(self, _: &TubePair, halves: [PiecePair; 2]) -> [Self; 2] {
        halves
    }
}

/// A piece, whatever the shape of its tube.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SectionRange<'a> {
    pub section: u32,
    /// Where along the section.
    pub shares: [Real; 2],
    /// What holds it in the present shape.
    pub outer: &'a BoundingBody,
    pub radius: Real,
}

/// What two tubes are divided into to begin with, in memory that is used again.
#[derive(Clone, Debug, Default)]
pub(crate) struct PairQueue {
    pieces: Vec<Piece>,
    bodies: [Vec<(Piece, BoundingBody)>; 2],
    nearest: NearestPairs,
}

impl<'a> TubePair<'a> {
    pub(crate) fn new(mut tubes: [PlacedTube<'a>; 2]) -> Self {
        let [first, second] = tubes;
        tubes[0].beside(&second);
        tubes[1].beside(&first);
        Self { tubes }
    }

    /// The same tubes as if the turn of one of them, or of both, had not been stated, where that is
    /// other tubes. All bounds of those hold for these.
    pub(crate) fn less_known(&self) -> impl Iterator<Item = Self> + use<'a> {
        let [first, second] = self.tubes;
        let less = [first.without_turn(), second.without_turn()];
        let both = less[0].zip(less[1]).map(|(first, second)| [first, second]);
        let one = [less[0].map(|first| [first, second]), less[1].map(|second| [first, second])];
        both.into_iter().chain(one.into_iter().flatten()).map(|tubes| Self { tubes })
    }

    /// The sections of a pair and the shares of them between which its pieces lie, with their
    /// bodies and radii.
    pub(crate) fn section_ranges<'p>(&self, pair: &'p PiecePair) -> [SectionRange<'p>; 2] {
        [0, 1].map(|k: usize| self.tubes[k].section_range(&pair.pieces[k], &pair.outers[k]))
    }

    /// Whether both have the sections.
    pub(crate) fn have(&self, sections: [u32; 2]) -> bool {
        sections
            .iter()
            .zip(&self.tubes)
            .all(|(&section, tube)| (section as usize) < tube.sections().len())
    }

    /// A first upper bound: from where the chords of the longest sections are nearest.
    pub(crate) fn first_bound(&self) -> PairUpperBound {
        let sections = self.tubes.map(|tube| tube.longest_section());
        let [first, second] = [0, 1].map(|k: usize| self.tubes[k].chord(sections[k]));
        let (feet, _) = first.0.nearest_on_axes(&second.0);
        let arc = |(chord, [start, end]): (PlacedLink, [Real; 2]), foot| {
            start + (end - start) * chord.share_of(foot)
        };
        self.bound_at(sections, [arc(first, feet[0]), arc(second, feet[1])])
    }

    /// The upper bound as seen from two places of the tubes.
    pub(crate) fn bound_at(&self, sections: [u32; 2], arcs: [Real; 2]) -> PairUpperBound {
        let places = [0, 1].map(|k: usize| self.tubes[k].place_at(sections[k], arcs[k]));
        let radii = [0, 1].map(|k: usize| self.tubes[k].section(sections[k]).radius);
        self.found_from(sections, arcs, half_way(places, radii))
    }

    /// The pairs of pieces to begin with, the nearest one last: all that are not farther apart than
    /// `upper`. Where these are more than `most` the nearest ones, and false.
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
        let PairQueue { pieces, bodies, nearest } = beginning;
        for (tube, bodies) in self.tubes.iter().zip(&mut *bodies) {
            tube.begin(scale.max(0.25 * tube.widest()), pieces);
            bodies.clear();
            for piece in pieces.iter() {
                let outer = tube.outer(piece);
                tube.check_finite(piece, &outer)?;
                bodies.push((*piece, outer));
            }
        }
        nearest.begin(most);
        let [first, second] = &*bodies;
        for (i, (_, one)) in first.iter().enumerate() {
            for (j, (_, two)) in second.iter().enumerate() {
                let at_least = self.at_least(&[*one, *two]);
                if at_least <= upper {
                    nearest.push(at_least, [i, j]);
                }
            }
        }
        let (order, is_all) = nearest.farthest_first();
        pairs.clear();
        pairs.extend(order.map(|[i, j]| {
            let ((one, outer), (two, beside)) = (first[i], second[j]);
            PiecePair { pieces: [one, two], outers: [outer, beside] }
        }));
        Ok(is_all)
    }

    /// How far two bodies are apart at least: as far as the capsules around them, less what
    /// rounding does to that.
    pub(super) fn at_least(&self, [one, two]: &[BoundingBody; 2]) -> Real {
        let (_, apart) = one.body.nearest_on_axes(&two.body);
        apart - one.body.radius() - two.body.radius() - self.slack()
    }

    /// The upper bound as seen from a point, and from where it moves to.
    fn found_from(&self, sections: [u32; 2], arcs: [Real; 2], from: Vector) -> PairUpperBound {
        found_from(sections, arcs, from, |arcs, from| {
            [0, 1].map(|k: usize| self.tubes[k].near(sections[k], arcs[k], from))
        })
    }
}

/// The upper bound as seen from a point, and from where it moves to. `seen` is how near the two are
/// to a point, as seen from two arc lengths.
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
            // From within one tube to the other, and a little into it.
            [true, false] => place + (one.point - place) * INTO,
            [false, true] => place + (two.point - place) * INTO,
            [false, false] => break,
        };
        let next = seen([one.arc, two.arc], place);
        // Written so that NaN ends it.
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
        self.at_least(bodies) <= bound
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
        // A common point of the bodies may be outside of both tubes; half way between the axes it
        // is not.
        let (feet, _) = links[0].nearest_on_axes(links[1]);
        let mut found = found.nearer(self.found_from(
            sections,
            arcs_at(feet),
            half_way(feet, links.map(PlacedLink::radius)),
        ));
        // At flat ends either may be in the plane of a face, which rounding cannot tell from what
        // is before it.
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

/// Where balls of two radii around two points have the same way to go, or overlap by as much.
pub(super) fn half_way(places: [Vector; 2], radii: [Real; 2]) -> Vector {
    let way = places[1] - places[0];
    let away = way.length();
    let share = 0.5 + 0.5 * (radii[0] - radii[1]) / away;
    // Written so that NaN, where both are one, is the first.
    let share = if share > 0.0 { share.min(1.0) } else { 0.0 };
    places[0] + way * share
}
