//! A tube beside itself: which pairs of its parts are queried, and bounds on their distance.
//!
//! # Definitions
//! - **Place**: the ball of the tube's radius around a point of the centreline. The tube contains
//!   it, since it bends by less than 1 / radius. Where the ball would stick out of a nearby face,
//!   the place is the disc.
//! - **Face**: the base, the tip, or the wider side of a step. The wider side of a chain's step may
//!   be a round cap: a ball around its centre.
//! - **Turn** of two places: the integral of the curvature between them; for a chain, the sum of
//!   the angles of the joints. Bounds on it: `curve::turns`.
//! - **Queried** pair: places that may be a local minimum of the distance (section "Rule").
//! - **Counts**: the pair is known to be queried, so its distance is an upper bound.
//! - k: the largest curvature between two places. r1, r2: the radii of the places.
//!
//! # Rule
//! The rule is the one of a chain. Its proofs (`query::robots::robot_with_itself`) hold for every
//! centreline that has a direction.
//! 1. Two places need a turn of at least pi. Neighbours are near only because they are neighbours.
//! 2. A face and a place ahead of it need a turn of at least pi / 2.
//! 3. Two faces that look at one another, the end of a section and the start of a later one, need
//!    no turn.
//! 4. From a place beside a face the robot must not lead nearer to the face. A piece is excluded if
//!    the robot leads nearer from all of its places ([`TubeWithItself::leads_on`]).
//!
//! For links of a chain `pair::JoinedLink` decides, as for a chain.
//!
//! # Bounds
//! The bounds enclose the least distance of all queried pairs. Each uses the bound on the turn that
//! is safe for it:
//! - **Lower bound.** A pair of pieces is kept if the turn from the start of the first to the end
//!   of the second may be enough. This excludes no queried pair of places. So the distances of the
//!   bodies of the kept pairs bound the answer from below.
//! - **Upper bound.** A pair of places counts if its turn is known to be enough.
//!
//! # Pairs between the two bounds
//! Some pairs are kept and do not count: it is unknown whether they are queried.
//!
//! **Claim.** If all radii between the two places are less than 1 / k, such a pair is as far apart
//! as the tightest bend is wide: 2 / k - r1 - r2, or at least 1 / k - r2 in case 3.
//!
//! **Proof.** Let the curve turn by u, and let m be its direction where half of u is behind it. All
//! directions are within u / 2 of m, and within k s of m at the arc length s from there.
//! 1. **Two places.** Let u <= pi, while the bound k allows pi: the curve is at least pi / k long.
//!    So y - x has at least (2 / k) f(u / 2) along m, where f(v) = sin v + (pi / 2 - v) cos v. f
//!    decreases up to v = pi / 2, where f = 1. So the surfaces are at least 2 / k - r1 - r2 apart.
//! 2. **A face that the curve leads away from** (the base, the tip, the wider side of a step).
//!    - Let u <= pi / 2. The centre y is at least sin(u) / k behind the face. Its disc reaches only
//!      r2 sin u ahead, so nothing is ahead of the face.
//!    - Let u <= pi. Let p = y + w be a point of the disc ahead of the face, and c the centre of
//!      the face. The vector y - c has at least (2 / k) sin(u / 2) along m. The vector w has at
//!      most r2 sin(u / 2) against m, since it is perpendicular to a direction within u / 2 of m.
//!      So p - c has at least (2 / k - r2) sin(u / 2) along m. It has no component along the
//!      direction of the curve at c, which is within u / 2 of m. So |p - c| >= 2 / k - r2, and p is
//!      at least 2 / k - r1 - r2 away from the face.
//! 3. **The step from which the thinner tube comes.** Let u <= pi / 2: the curve is pi / (2 k)
//!    long, counted from c on as in case 1. Then y is at least f(u) / k >= 1 / k ahead, and its
//!    disc at least 1 / k - r2.
//!
//! **Consequence.** These pairs matter only for margins as wide as a bend. Pairs that turn by more
//! than required count as soon as the samples show the turn. Undecided pairs that turn by less than
//! [`MIN_TURN`] are not halved further.
//!
//! # Faces
//! **No local minimum is missed**: the shortest segment leaves the face outwards
//! (`query::robots::robot_with_itself`), so the place is ahead of it. A pair with a face is
//! excluded if the other body is entirely behind the plane of the face; the test allows for the
//! uncertainty of the normal.
//!
//! A place counts if it is known to be ahead, unless the robot certainly leads nearer from it. So
//! the query contains slightly more than the local minima: places from which it leads nearer by
//! less than is known of the curve there, and places beside the wider part of a step that the tube
//! passes there.
//!
//! The body of a face is flat and goes a little into the tube, so that rounding does not turn it
//! (`bounding_body`).
//!
//! # Shortest segments between two convex parts
//! For two faces, or a face and a link of a chain, the direction of the shortest segment decides
//! whether it leaves the face.
//!
//! **Claim.** Let the measured bodies be within D of the parts, both together. Let w, of length d,
//! be the measured segment and w* the true one. Then |w - w*| <= D + 2 sqrt(D (d + D)).
//!
//! **Proof.** w is within D of a segment w' between the parts, and |w'| <= d + D, |w*| >= d - D.
//! Differences of convex sets are convex, so |w' - w*|^2 <= |w'|^2 - |w*|^2 <= 4 D (d + D).
//!
//! A normal that is off by a tilt adds (d + D) tilt. A segment within rounding of the plane of the
//! face leaves it, as for a chain. All other uncertain pairs are kept and do not count.
//!
//! # Further rules
//! **Stated errors** say where the curve may be, not how it turns. So the given curve decides which
//! pairs are queried, and errors count in every distance.
//!
//! **While the tube moves**, pairs that are not queried in the tested shape may be queried at other
//! times. `section_motions` bounds the extra turn and the extra distance ahead. In the tested shape
//! the same pairs count as at rest.
//!
//! **Sharing the turn.** If two places turn by more than required, the excess is split between both
//! sides. All places up to the first arc length and from the second one on still turn enough
//! (`TubeTurns::room`). Each point between these two parts bounds the distance of both
//! (`tube_point`).

use super::bounding_body::{BoundingBody, MOST_CORES, SectionRange};
use super::capsule_tree::{CapsuleTree, NearPairs, Parts, WaitingRuns};
use super::placed_tube::{Piece, PlacedTube};
use super::refinable::{Body, Refinable};
use super::section_motions::{SectionMotion, SectionMotions};
use super::tube_pair::{NearestPairs, PairUpperBound, TubePair, found_from, half_way};
use super::tube_point::TubePoint;
use crate::answer::ProximityError;
use crate::curve::{EndFace, Section, Tube, TubeTurns};
use crate::distance::Scalar;
use crate::pair::{JoinedLink, MovedLinks, NearestOfLinks, PlacedLink};
use crate::robot::is_step;
use parry3d_f64::math::{Pose, Real, Vector};
use std::f64::consts::{FRAC_PI_2, PI};
use std::ops::Range;

/// Pairs that may or may not be queried are not halved if their turn is uncertain by less than this
/// (rad).
const MIN_TURN: Real = 1.0 / 1024.0;

/// While the tube moves, they are not halved if their turn is uncertain by less than this share of
/// their extra turn.
const MAX_SHARE_OF_EXTRA_TURN: Real = 1.0 / 16.0;

/// How far the body of a face goes into the tube, in radii.
const INTO_TUBE: Real = 1.0 / 1024.0;

/// The rounding error of the bodies of two faces, in slacks: `off_of_bodies` without tilt and
/// stated error.
const ROUNDING_OF_FACES: Real = 140.0;

/// The half length, in radii, of the piece around a place that tells whether the robot leads nearer
/// from there.
const AROUND_PLACE: Real = 1.0 / 1024.0;

/// How often a place of one part is moved to the nearest place of the other.
const MAX_MOVES: u32 = 3;

/// A tube beside itself, in its own frame.
#[derive(Clone, Copy)]
pub(crate) struct TubeWithItself<'a> {
    /// The same tube twice.
    both: TubePair<'a>,
    turns: &'a TubeTurns,
    /// How far it moves in the interval; `None` at rest.
    moves: Option<&'a SectionMotions>,
}

/// Two pieces in their order along the tube. A piece without length is a face.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SelfPair {
    pub(super) pieces: [Piece; 2],
    outers: [BoundingBody; 2],
    /// For a face, the end of its section at which it is.
    pub(super) faces: [Option<usize>; 2],
    is_asked: bool,
}

impl Body for SelfPair {
    fn excess(&self) -> Real {
        self.outers.excess()
    }

    fn is_flat(&self) -> bool {
        self.outers.is_flat()
    }
}

/// A piece, and the end at which it is a face.
type SelfPart = (Piece, Option<usize>);

/// The initial pieces and pairs of a query. A later query reuses the memory.
#[derive(Clone, Debug, Default)]
pub(crate) struct SelfPairQueue {
    /// The pieces along the tube, then the faces along the tube.
    parts: Parts<SelfPart>,
    /// How many pieces there are.
    count: usize,
    /// For each part, upper bounds on the turn up to its start and up to its end.
    turned: Vec<[Real; 2]>,
    /// For each part, how many faces before it are at starts and at ends of sections.
    faces_before: Vec<[u32; 2]>,
    tree: CapsuleTree,
    waiting: WaitingRuns,
    nearest: NearestPairs,
}

impl<'a> TubeWithItself<'a> {
    /// Places a tube beside itself, at rest.
    ///
    /// # Errors
    /// The tube has no section or is out of range.
    pub(crate) fn new(tube: &'a Tube, turns: &'a TubeTurns) -> Result<Self, ProximityError> {
        let placed = PlacedTube::new(tube, &Pose::IDENTITY, 0.0)?;
        Ok(Self { both: TubePair::new([placed; 2]), turns, moves: None })
    }

    /// Returns the tube with its stated turn ignored, if that leaves less known. All bounds of that
    /// tube hold for this one.
    pub(crate) fn less_known(&self) -> Option<Self> {
        let less = self.tube().without_turn()?;
        Some(Self { both: TubePair { tubes: [less; 2] }, ..*self })
    }

    /// Places the shape at the middle of an interval of time beside itself.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub(crate) fn moving(
        tube: &'a Tube,
        turns: &'a TubeTurns,
        moves: &'a SectionMotions,
    ) -> Result<Self, ProximityError> {
        let placed = PlacedTube::new(tube, &Pose::IDENTITY, 0.0)?.moving();
        Ok(Self { both: TubePair::new([placed; 2]), turns, moves: Some(moves) })
    }

    /// Returns both pieces of a pair as ranges of their sections, with their bodies and radii.
    pub(crate) fn section_ranges<'p>(&self, pair: &'p SelfPair) -> [SectionRange<'p>; 2] {
        [0, 1].map(|k: usize| self.tube().section_range(&pair.pieces[k], &pair.outers[k]))
    }

    /// Returns how much more a pair may turn at other times of the interval.
    pub(crate) fn extra_turn(&self, pair: &SelfPair) -> Real {
        self.moves.map_or(0.0, |moves| moves.extra_turn(pair.pieces[1].section))
    }

    /// Returns how far both pieces of a pair may move together, and how far the piece `turning` may
    /// turn.
    fn moved(&self, pair: &SelfPair, turning: usize) -> SectionMotion {
        let Some(moves) = self.moves else { return SectionMotion::default() };
        let [one, two] = pair.pieces.map(|piece| moves.of(piece.section));
        SectionMotion { points: one.points + two.points, turn: [one, two][turning].turn }
    }

    fn tube(&self) -> &PlacedTube<'a> {
        &self.both.tubes[0]
    }

    /// Fills `pairs` with the initial pairs, the nearest one last: all queried pairs whose bodies
    /// are at most `upper` apart.
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
        beginning: &mut SelfPairQueue,
        pairs: &mut Vec<SelfPair>,
    ) -> Result<bool, ProximityError> {
        let mut nearest = std::mem::take(&mut beginning.nearest);
        nearest.begin(most);
        let begun = self.initial_pairs(scale, upper, beginning)?;
        begun.for_each(|(places, at_least, _)| nearest.push(at_least, places));
        let (order, is_all) = nearest.farthest_first();
        pairs.clear();
        pairs.extend(order.map(|(_, places)| self.pair(places, &mut beginning.parts)));
        beginning.nearest = nearest;
        Ok(is_all)
    }

    /// Returns the pairs of [`begin`](Self::begin) one after another, with their places in
    /// `bodies` and lower bounds on their distances. Of two groups of pairs the nearer comes first.
    ///
    /// # Errors
    /// A curve is not finite.
    pub(crate) fn initial_pairs<'q>(
        &self,
        scale: Real,
        upper: Real,
        beginning: &'q mut SelfPairQueue,
    ) -> Result<impl Iterator<Item = ([usize; 2], Real, SelfPair)> + use<'a, 'q>, ProximityError>
    {
        let tube = self.tube();
        let SelfPairQueue { parts, count, turned, faces_before, tree, waiting, .. } = beginning;
        parts.list.clear();
        tube.begin_along(scale.max(0.25 * tube.widest()), |piece| parts.list.push((piece, None)));
        *count = parts.list.len();
        self.push_faces(&mut parts.list);
        parts.forget_bodies();
        // Samples are finite.
        if tube.tube.is_function() {
            for place in 0..*count {
                let (piece, _) = parts.list[place];
                tube.check_finite(&piece, self.body_of(place, parts))?;
            }
        }
        turned.clear();
        faces_before.clear();
        faces_before.push([0; 2]);
        let mut faces = [0; 2];
        for (piece, face) in &parts.list {
            let at = |tick| tube.tube.turned_at_most(self.turns, piece.section, tick);
            turned.push([at(piece.from), at(piece.to)]);
            if let Some(end) = face {
                faces[*end] += 1;
            }
            faces_before.push(faces);
        }
        let (own, count) = (*self, *count);
        let capsule = move |run: Range<usize>, parts: &mut Parts<SelfPart>| {
            if run.len() > 1 {
                let is_one_list = run.start >= count || run.end <= count;
                let ends = [&parts.list[run.start].0, &parts.list[run.end - 1].0];
                return if is_one_list { own.tube().around_run(ends) } else { None };
            }
            let BoundingBody { body, .. } = own.body_of(run.start, parts);
            Some(([body.start(), body.end()], body.radius()))
        };
        tree.begin(parts.list.len(), count, &mut |run| capsule(run, parts));
        let trees = std::slice::from_mut(tree);
        let mut near = NearPairs::new(trees, waiting, upper + 2.0 * self.slack());
        let may_ask = move |runs| own.runs_may_turn_enough(&runs, count, turned, faces_before);
        Ok(std::iter::from_fn(move || {
            loop {
                let (_, places) = near.next(&may_ask, &mut |_, run| capsule(run, parts))?;
                let pair = own.pair(places, parts);
                if !own.turns_enough(&pair) {
                    continue;
                }
                let at_least = own.at_least(&pair);
                if at_least <= upper && own.may_count(&pair) {
                    return Some((places, at_least, pair));
                }
            }
        }))
    }

    fn at_least(&self, pair: &SelfPair) -> Real {
        self.both.at_least(pair.outers.each_ref().map(|outer| &outer.body))
    }

    /// Returns the body of an initial piece or face.
    fn body_of<'p>(&self, place: usize, parts: &'p mut Parts<SelfPart>) -> &'p BoundingBody {
        parts.body(place, |(piece, face)| match face {
            None => self.tube().outer(piece),
            Some(end) => {
                BoundingBody { body: self.body_of_face(piece, *end), excess: 0.0, narrows: 0.0 }
            }
        })
    }

    /// Returns two initial parts as a queried pair, in their order along the tube.
    fn pair(&self, places: [usize; 2], parts: &mut Parts<SelfPart>) -> SelfPair {
        let mut places = places;
        let along = |place: usize| {
            let (Piece { section, from, to }, _) = parts.list[place];
            (section, from, to)
        };
        if along(places[1]) < along(places[0]) {
            places.reverse();
        }
        let outers = places.map(|place| *self.body_of(place, parts));
        let of_each = places.map(|place| parts.list[place]);
        SelfPair {
            pieces: of_each.map(|(piece, _)| piece),
            outers,
            faces: of_each.map(|(_, face)| face),
            is_asked: true,
        }
    }

    /// Whether a pair of bodies of two runs may turn as required. The first `count` bodies are
    /// pieces.
    ///
    /// **Claim.** A pair turns by at most the turn from the start of the first body of one run to
    /// the end of the last body of the other, for one of both orders.
    ///
    /// **Proof.** Upper bounds on the turn up to a place increase along the tube. So the turn of a
    /// pair is at most the difference between the end of the run of its later body and the start of
    /// the run of its earlier one. Their rounding is part of the slack of [`TubeTurns`].
    fn runs_may_turn_enough(
        &self,
        runs: &[Range<usize>; 2],
        count: usize,
        turned: &[[Real; 2]],
        faces_before: &[[u32; 2]],
    ) -> bool {
        if runs.iter().any(|run| run.start < count && run.end > count) {
            return true;
        }
        let [one, two] = runs;
        let between =
            |from: &Range<usize>, to: &Range<usize>| turned[to.end - 1][1] - turned[from.start][0];
        let most = between(one, two).max(between(two, one));
        let has = |run: &Range<usize>, end: usize| {
            faces_before[run.end][end] > faces_before[run.start][end]
        };
        let angle = match runs.iter().filter(|run| run.start >= count).count() {
            0 => PI,
            2 if has(one, 1) && has(two, 0) => 0.0,
            _ => FRAC_PI_2,
        };
        let extra = self.moves.map_or(0.0, SectionMotions::max_extra_turn);
        most.is_nan() || self.turns.may_reach(most + extra, angle)
    }

    /// Adds all faces to the pieces: the tube's flat ends and the wider sides of its steps.
    fn push_faces(&self, parts: &mut Vec<SelfPart>) {
        let sections = self.tube().sections();
        for (number, section) in sections.iter().enumerate() {
            let before = number.checked_sub(1).and_then(|before| sections.get(before));
            for (end, neighbour) in [(0, before), (1, sections.get(number + 1))] {
                let is_flat = section.faces[end].is_some();
                if neighbour.map_or(is_flat, |neighbour| is_step(neighbour.radius, section.radius))
                {
                    let tick = if end == 0 { section.first } else { section.last };
                    let piece = Piece { section: number as u32, from: tick, to: tick };
                    parts.push((piece, Some(end)));
                }
            }
        }
    }

    /// Returns the flat face at an end of a section; `None` for a round cap, and for a face of
    /// unknown direction.
    fn face(&self, piece: &Piece, end: usize) -> Option<EndFace> {
        let tube = self.tube();
        let face = tube.faces(tube.section(piece.section))[end]?;
        (face.tilt < Real::INFINITY).then(|| tube.face(&face))
    }

    /// Returns the outward direction of a face or of a link's round cap at a step; `None` if
    /// unknown.
    fn outward(&self, piece: &Piece, end: usize) -> Option<Vector> {
        let tube = self.tube();
        let section = tube.section(piece.section);
        if section.faces[end].is_some() {
            return self.face(piece, end).map(|face| face.outward);
        }
        let [start, stop] = [section.first, section.last].map(|tick| tube.point(section, tick));
        Some((stop - start).normalize_or_zero() * if end == 0 { -1.0 } else { 1.0 })
    }

    /// Returns a bound on the error of the place of a face.
    fn off(&self, face: &EndFace, radius: Real) -> Real {
        radius * face.tilt + self.tube().tube.error() + self.tube().slack()
    }

    /// Returns how far the body of a face reaches ahead of the face, and into the tube.
    fn reach_of_face(&self, face: &EndFace, radius: Real) -> [Real; 2] {
        let off = self.off(face, radius);
        let into = INTO_TUBE * radius + off;
        [off + radius * self.tube().slack() / (16.0 * into), into]
    }

    fn body_of_face(&self, piece: &Piece, end: usize) -> PlacedLink {
        let tube = self.tube();
        let section = tube.section(piece.section);
        let (centre, radius) = (tube.point(section, piece.from), section.radius);
        let wider = tube.tube.error() + tube.slack();
        match self.face(piece, end).filter(|_| radius > 0.0) {
            Some(face) => {
                let off = self.off(&face, radius);
                let [ahead, into] = self.reach_of_face(&face, radius);
                let (tip, back) =
                    (face.centre + face.outward * ahead, face.centre - face.outward * into);
                PlacedLink::between(tip, back, radius + off + tube.slack(), [true; 2])
            }
            None => PlacedLink::between(centre, centre, radius + wider, [false; 2]),
        }
    }

    /// Returns upper bounds on the turn of a pair: between its places nearest along the tube, and
    /// between the farthest.
    fn turns(&self, pair: &SelfPair) -> [Real; 2] {
        let [one, two] = &pair.pieces;
        let turned = |piece: &Piece, tick: u32| {
            self.tube().tube.turned_at_most(self.turns, piece.section, tick)
        };
        [turned(two, two.from) - turned(one, one.to), turned(two, two.to) - turned(one, one.from)]
    }

    /// Returns the required turn.
    fn angle(pair: &SelfPair) -> Real {
        match pair.faces {
            [None, None] => PI,
            [Some(1), Some(0)] => 0.0,
            _ => FRAC_PI_2,
        }
    }

    fn is_queried(&self, pair: &SelfPair) -> bool {
        self.turns_enough(pair) && self.may_count(pair)
    }

    /// Whether two parts may turn as required; false for parts that share a joint.
    fn turns_enough(&self, pair: &SelfPair) -> bool {
        let [_, most] = self.turns(pair);
        let [one, two] = pair.pieces;
        // Neighbours of a chain share a joint. A face and itself are no pair.
        let apart = two.section - one.section;
        let is_same = pair.faces == [Some(0), Some(0)] || pair.faces == [Some(1), Some(1)];
        let share_joint = self.turns.has_joints() && apart < 2;
        !(share_joint || is_same && apart == 0) && self.may_turn_enough(pair, most)
    }

    /// Whether some place of two parts that turn enough may be a local minimum.
    fn may_count(&self, pair: &SelfPair) -> bool {
        if self.moves.is_none() && self.is_exact() {
            return self.counts_exactly(pair);
        }
        let Some(k) = pair.faces.iter().position(Option::is_some) else {
            return !self.is_exact() || self.may_count_while_moving(pair);
        };
        self.may_be_before(pair, k)
            && self.may_be_before(pair, 1 - k)
            && self.ways_leave(pair)
            && !self.leads_on(pair, k)
            && (!self.is_exact() || self.may_count_while_moving(pair))
    }

    /// Whether two links, a face and a link, or two faces may count at some time of the interval.
    fn may_count_while_moving(&self, pair: &SelfPair) -> bool {
        let Some(moves) = self.moves else { return true };
        let [one, two] = pair.pieces.map(|piece| self.joined(piece.section));
        let sections = self.tube().sections();
        // Over the link and its neighbours.
        let of = |number: u32| {
            let around = number.saturating_sub(1)..=(number + 1).min(sections.len() as u32 - 1);
            around.fold(MovedLinks::default(), |most, number| {
                let SectionMotion { points, turn } = moves.of(number);
                let axes = (points - sections[number as usize].radius * turn).max(0.0);
                // The rounding error of the difference is at most 2 u points.
                let axes = axes + 4.0 * Real::UNIT_ROUNDOFF * points;
                MovedLinks {
                    points: most.points.max(points),
                    axes: most.axes.max(axes),
                    turn: most.turn.max(turn),
                }
            })
        };
        let [first, second] = pair.pieces.map(|piece| of(piece.section));
        let moved = &MovedLinks {
            points: first.points + second.points,
            axes: first.axes + second.axes,
            turn: first.turn + second.turn,
        };
        if moved.points == 0.0 && moved.turn == 0.0 {
            return self.counts_exactly(pair);
        }
        match pair.faces {
            [None, None] => one.may_count_beside(&two, moved),
            [Some(end), None] => one.face_may_count(end, &two, moved),
            [None, Some(end)] => two.face_may_count(end, &one, moved),
            [Some(end), Some(other)] => one.faces_may_count(end, &two, other, moved),
        }
    }

    /// Whether all parts are links whose places are exact up to rounding.
    fn is_exact(&self) -> bool {
        self.turns.has_joints() && self.tube().tube.error() == 0.0
    }

    /// Whether two links of a chain, or their faces, count in this shape: decided as for a chain.
    fn counts_exactly(&self, pair: &SelfPair) -> bool {
        let [one, two] = pair.pieces.map(|piece| self.joined(piece.section));
        let tolerance = one.tolerance(&two);
        match pair.faces {
            [None, None] => one.counts_beside(&two, tolerance, || [one, two]),
            [Some(end), None] => {
                one.face_counts(end, &two, &one.face_to_link(end, &two.link), tolerance)
            }
            [None, Some(end)] => {
                two.face_counts(end, &one, &two.face_to_link(end, &one.link), tolerance)
            }
            [Some(end), Some(other)] => {
                let nearest = one.face_to_face(end, &two, other);
                one.faces_count(end, &two, other, &nearest, tolerance)
            }
        }
    }

    /// Returns a link of a chain with its neighbours.
    fn joined(&self, section: u32) -> JoinedLink {
        let sections = self.tube().sections();
        let number = section as usize;
        let link = |section: &Section| {
            let ends = [section.first, section.last].map(|tick| self.tube().point(section, tick));
            let flat = section.faces.map(|face| face.is_some());
            PlacedLink::between(ends[0], ends[1], section.radius, flat)
        };
        let (before, behind) = (&sections[..number], &sections[number + 1..]);
        JoinedLink::new(
            link(&sections[number]),
            before.iter().rev().map(link),
            behind.iter().map(link),
        )
    }

    /// Whether the robot leads nearer to a face from all places of the other piece, at all times.
    ///
    /// **Definitions.**
    /// - c, r, n: centre, radius and normal of the face. p: a point of the face, so |p - c| <= r
    ///   and p - c is perpendicular to n.
    /// - y: a place of the piece. t: the direction there. m: the direction of the piece's chord. e:
    ///   the largest angle between t and m.
    ///
    /// **Claim.** (y - p) . t >= (y - c) . m - |y - c| e - r (|n x m| + e), and (y - p) . t is at
    /// most the same with opposite signs.
    ///
    /// If the lower bound is above 0, the robot leads nearer backwards. If the upper bound is below
    /// 0, it leads nearer forwards. A piece is excepted if the robot ends or becomes thinner there.
    /// Errors, displacements and turns are added.
    ///
    /// **Short pieces.** If all places are balls, p is the point of the face nearest to y. Let p0
    /// be the point nearest to the middle of the chord. Then |p - p0| <= h + 2 s + (r + |y - c|) a,
    /// where h bounds the distance of y from that middle, s the displacement of c, and a the turn
    /// of the face. So c and r |n x m| may be replaced by p0 and that bound, which vanishes with
    /// the length of the piece.
    ///
    /// **Proof.** The nearest point of a convex set moves by at most as much as y. A point of the
    /// curve between two points is at most half of its length away from their middle. If a rigid
    /// displacement T moves the face, the point nearest to y is T applied to the point of the old
    /// face nearest to T^-1 y. T moves points of the face by at most s + r a, and T^-1 moves y by
    /// at most s + |y - c| a.
    fn leads_on(&self, pair: &SelfPair, k: usize) -> bool {
        let (tube, piece) = (self.tube(), &pair.pieces[1 - k]);
        let Some(end) = pair.faces[k] else { return false };
        if pair.faces[1 - k].is_some() {
            return false;
        }
        let section = tube.section(piece.section);
        let arcs = tube.arcs(piece);
        let length = (arcs[1] - arcs[0]) * section.stretch;
        let known = tube.tube.bound(section, [piece.from, piece.to]);
        let ends = [piece.from, piece.to].map(|tick| tube.point(section, tick));
        let chord = (ends[1] - ends[0]).length();
        let errors = tube.tube.error() + known.off + tube.slack();
        let bend = known.curvature * length;
        if bend > FRAC_PI_2 || chord <= 4.0 * errors {
            return false;
        }
        let chord_direction = (ends[1] - ends[0]) / chord;
        let tilt = bend + 2.0 * errors / chord + tube.tube.turn().unwrap_or(0.0);
        let moved = [0, 1].map(|turning| self.moved(pair, turning));
        let turn = moved[0].turn + moved[1].turn;
        let at_face = tube.section(pair.pieces[k].section);
        let centre = tube.point(at_face, pair.pieces[k].from);
        let side_excess = match (at_face.faces[end].is_some(), self.face(&pair.pieces[k], end)) {
            (true, Some(face)) => {
                let sine = face.outward.cross(chord_direction).length() + face.tilt + tilt + turn;
                at_face.radius * sine.min(1.0)
            }
            // The direction from the ball around a round shoulder is exact: the ball has its centre
            // at c. The shoulder may become flat while it moves.
            (false, _) if self.moves.is_none() => 0.0,
            _ => at_face.radius,
        };
        let farthest = |from: Vector| {
            let away = ends.map(|end| (end - from).length());
            away[0].max(away[1]) + length + moved[0].points
        };
        let off = |from: Vector, on_face: Real| {
            farthest(from) * (tilt + moved[1 - k].turn) + on_face + 4.0 * errors + moved[0].points
        };
        let leads_from = |from: Vector, off: Real| {
            let along = |place: Vector, direction: Vector| (place - from).dot(direction);
            if along(ends[0], chord_direction) > off {
                piece.from > section.first
                    || self.goes_on(piece.section, 0, |axis| along(ends[0], axis) > off)
            } else if along(ends[1], chord_direction) < -off {
                piece.to < section.last
                    || self.goes_on(piece.section, 1, |axis| along(ends[1], axis) < -off)
            } else {
                false
            }
        };
        if leads_from(centre, off(centre, side_excess)) {
            return true;
        }
        let Some(face) = self.face(&pair.pieces[k], end) else { return false };
        if tube.may_have_discs(section, arcs) {
            return false;
        }
        let nearest = point_of_face(&face, at_face.radius, 0.5 * (ends[0] + ends[1]));
        let shift = errors + moved[0].points;
        let turn_of_face = face.tilt + moved[k].turn;
        let on_face =
            0.5 * length + 3.0 * shift + (at_face.radius + farthest(centre)) * turn_of_face;
        leads_from(nearest, off(nearest, on_face))
    }

    /// Whether the robot certainly leads nearer to a face of the tested shape from a place.
    fn leads_on_from(&self, pair: &SelfPair, k: usize, arc: Real) -> bool {
        let (tube, number) = (self.tube(), pair.pieces[1 - k].section);
        let section = tube.section(number);
        let (length, around) = (section.end - section.start, AROUND_PLACE * section.radius);
        let shares = [arc - around, arc + around].map(|arc| (arc - section.start) / length);
        let mut near = *pair;
        near.pieces[1 - k] = tube.between(number, shares.map(|share| share.clamp(0.0, 1.0)));
        Self { moves: None, ..*self }.leads_on(&near, k)
    }

    /// Whether the robot continues beyond an end of a section, no thinner, in a direction for which
    /// `leads_on` holds too.
    fn goes_on(&self, section: u32, end: usize, leads_on: impl Fn(Vector) -> bool) -> bool {
        let sections = self.tube().sections();
        let here = &sections[section as usize];
        let next = if end == 0 { section.checked_sub(1) } else { Some(section + 1) };
        let Some(next) = next.and_then(|next| sections.get(next as usize)) else { return false };
        if is_step(next.radius, here.radius) {
            return false;
        }
        if !self.turns.has_joints() {
            return true;
        }
        let ends = [next.first, next.last].map(|tick| self.tube().point(next, tick));
        leads_on((ends[1] - ends[0]).normalize_or_zero())
    }

    /// Whether a pair with the upper bound `most` on its turn may turn as required.
    fn may_turn_enough(&self, pair: &SelfPair, most: Real) -> bool {
        self.turns.may_reach(most + self.extra_turn(pair), Self::angle(pair))
    }

    /// Whether a pair turns as required in this shape everywhere on its pieces, by the upper bound
    /// on its turn.
    fn surely_turns(&self, pair: &SelfPair) -> bool {
        self.turns.may_reach(self.turns(pair)[0], Self::angle(pair))
    }

    /// Whether the other body may be partly ahead of part k, if that is a face.
    fn may_be_before(&self, pair: &SelfPair, k: usize) -> bool {
        let face = pair.faces[k].and_then(|end| self.face(&pair.pieces[k], end));
        face.is_none_or(|face| self.ahead_of_face(pair, k, &face, 1.0, self.moved(pair, k)) >= 0.0)
    }

    /// Returns an upper bound on how far the other body is ahead of a face (`sign` = 1) or behind
    /// it (`sign` = -1), after the displacement `moved`.
    fn ahead_of_face(
        &self,
        pair: &SelfPair,
        k: usize,
        face: &EndFace,
        sign: Real,
        moved: SectionMotion,
    ) -> Real {
        let body = &pair.outers[1 - k].body;
        let ends = [body.start(), body.end()].map(|end| end - face.centre);
        let ahead = (sign * ends[0].dot(face.outward)).max(sign * ends[1].dot(face.outward))
            + body.radius();
        let away = ends[0].length().max(ends[1].length()) + body.radius() + moved.points;
        let off = self.off(face, self.tube().radius(&pair.pieces[k]));
        ahead + moved.points + away * (face.tilt + moved.turn) + 2.0 * off
    }

    /// Whether the whole pair is ahead of its faces.
    fn is_before(&self, pair: &SelfPair) -> bool {
        (0..2).all(|k| {
            let face = pair.faces[k].and_then(|end| self.face(&pair.pieces[k], end));
            face.is_none_or(|face| {
                self.ahead_of_face(pair, k, &face, -1.0, SectionMotion::default()) <= 0.0
            })
        })
    }

    /// Whether both parts are convex bodies that are queried as a whole: two faces, or links of a
    /// chain.
    fn is_whole(&self, pair: &SelfPair) -> bool {
        let count = pair.faces.iter().flatten().count();
        count == 2 || self.turns.has_joints()
    }

    /// Whether the shortest segment between a face and a face or link may leave all faces outwards.
    fn ways_leave(&self, pair: &SelfPair) -> bool {
        pair.faces == [None; 2] || !self.is_whole(pair) || {
            let nearest = self.between_faces(pair);
            self.leave(pair, &nearest, |k| {
                -self.uncertainty_of_way(pair, k, nearest.distance, self.moved(pair, k))
            })
        }
    }

    /// Whether the shortest segment certainly leaves all faces outwards, up to rounding.
    fn ways_surely_leave(&self, pair: &SelfPair, nearest: &NearestOfLinks) -> bool {
        let rounding =
            uncertainty_of_way(ROUNDING_OF_FACES * self.tube().slack(), nearest.distance, 0.0);
        let direction_gap =
            |k| self.uncertainty_of_way(pair, k, nearest.distance, SectionMotion::default());
        self.leave(pair, nearest, |k| direction_gap(k) - 2.0 * rounding)
    }

    /// Whether a segment leaves all faces of a pair by at least `least(k)` along their normals, as
    /// far as these are known.
    fn leave(
        &self,
        pair: &SelfPair,
        nearest: &NearestOfLinks,
        least: impl Fn(usize) -> Real,
    ) -> bool {
        let way = nearest.on_second - nearest.on_first;
        [(0, way), (1, -way)].into_iter().all(|(k, way)| {
            let outward = pair.faces[k].and_then(|end| self.outward(&pair.pieces[k], end));
            outward.is_none_or(|outward| way.dot(outward) >= least(k))
        })
    }

    /// Returns the nearest points of a face and a face or link. It measures the face of the body,
    /// since the body goes into the tube.
    fn between_faces(&self, pair: &SelfPair) -> NearestOfLinks {
        let [one, two] = &pair.outers;
        match pair.faces {
            [Some(_), Some(_)] => one.body.face_to_face([0, 0], &two.body),
            [Some(_), None] => one.body.face_to_link(0, &two.body),
            _ => two.body.face_to_link(0, &one.body).swapped(),
        }
    }

    /// Returns a bound on the error of a segment of length `distance` along the normal of face k,
    /// after the displacement `moved`.
    fn uncertainty_of_way(
        &self,
        pair: &SelfPair,
        k: usize,
        distance: Real,
        moved: SectionMotion,
    ) -> Real {
        let face = pair.faces[k].and_then(|end| self.face(&pair.pieces[k], end));
        let tilt = face.map_or(0.0, |face| face.tilt) + moved.turn;
        uncertainty_of_way(self.off_of_bodies(pair) + moved.points, distance, tilt)
    }

    /// Returns a bound on the distance of both bodies from the faces and links that they contain.
    fn off_of_bodies(&self, pair: &SelfPair) -> Real {
        let (error, slack) = (self.tube().tube.error(), self.tube().slack());
        let off = |k: usize| {
            let (piece, radius) = (&pair.pieces[k], self.tube().radius(&pair.pieces[k]));
            match pair.faces[k].and_then(|end| self.face(piece, end)).filter(|_| radius > 0.0) {
                // Ahead, sideways, and the place of the face.
                Some(face) => {
                    self.reach_of_face(&face, radius)[0] + 2.0 * self.off(&face, radius) + slack
                }
                None => 2.0 * (error + slack),
            }
        };
        off(0) + off(1) + 4.0 * slack
    }

    /// Returns the upper bound for two faces, a face and a link, or two links.
    fn found_whole(&self, pair: &SelfPair, nearest: &NearestOfLinks) -> PairUpperBound {
        let nearest = if pair.faces == [None; 2] { *nearest } else { self.between_faces(pair) };
        let points = [nearest.on_first, nearest.on_second];
        let arcs = [0, 1].map(|k: usize| {
            let [start, end] = self.tube().arcs(&pair.pieces[k]);
            start + (end - start) * pair.outers[k].body.share_of(points[k])
        });
        let is_known = (0..2).all(|k| {
            let piece = &pair.pieces[k];
            let has_face = |end: usize| self.tube().section(piece.section).faces[end].is_some();
            pair.faces[k].is_none_or(|end| !has_face(end) || self.face(piece, end).is_some())
        });
        // Only the tested shape counts: pairs that are queried at other times do not.
        let counts = self.surely_turns(pair)
            && if self.is_exact() {
                self.counts_exactly(pair)
            } else {
                pair.faces == [None; 2] || is_known && self.ways_surely_leave(pair, &nearest)
            };
        let sections = pair.pieces.map(|piece| piece.section);
        if !counts {
            return PairUpperBound { upper: Real::INFINITY, sections, arcs, points };
        }
        let off = self.off_of_bodies(pair);
        if nearest.distance <= off
            && let Some(common) = self.common_point(pair, arcs, [[None; 2]; 2])
        {
            return PairUpperBound { upper: 0.0, sections, arcs, points: [common; 2] };
        }
        PairUpperBound { upper: nearest.distance + off, sections, arcs, points }
    }

    /// Returns a point that certainly belongs to the tube on both sides of a pair whose bodies
    /// overlap: in the given ranges of both sections (`limit`).
    ///
    /// The body of a face goes into the tube behind it. So the parts of two faces that overlap have
    /// such a point, although the faces themselves have no thickness.
    fn common_point(
        &self,
        pair: &SelfPair,
        arcs: [Real; 2],
        limits: [[Option<Real>; 2]; 2],
    ) -> Option<Vector> {
        let tube = self.tube();
        let mut depth = 1.0;
        for _ in 0..MOST_CORES {
            let core = |k: usize| tube.core(&pair.pieces[k], &pair.outers[k], depth);
            let point = core(0)?.measure_link_within(0.0, &core(1)?)?.on_first;
            let is_within = |k: usize| {
                let section = pair.pieces[k].section;
                tube.near_between(section, arcs[k], point, limits[k]).upper <= 0.0
            };
            if is_within(0) && is_within(1) {
                return Some(point);
            }
            depth *= 8.0;
        }
        None
    }

    /// Returns the range of arc lengths of a section that counts beside the other part of a pair;
    /// `None` means the end of the section.
    fn limit(&self, k: usize, section: u32, arc: Real) -> [Option<Real>; 2] {
        let inner = 1 - k;
        let section = self.tube().section(section);
        let (reaches, end) = if inner == 1 {
            (arc >= section.end, section.end)
        } else {
            (arc <= section.start, section.start)
        };
        // At a round end of a curve the discs of the next section are as near as the ball.
        let is_own = self.turns.has_joints() || section.faces[inner].is_some();
        let limit = if !reaches {
            Some(arc)
        } else if is_own {
            None
        } else {
            Some(end)
        };
        if inner == 1 { [None, limit] } else { [limit, None] }
    }

    /// Returns the upper bound for two places with a turn of at least `pi`, found first from the
    /// point `from`.
    fn seen_at(&self, sections: [u32; 2], mut arcs: [Real; 2], mut from: Vector) -> PairUpperBound {
        let tube = self.tube();
        let mut best = self.nothing(sections, arcs);
        for _ in 0..MAX_MOVES {
            let Some(room) = self.turns.room(arcs, PI) else { break };
            let feet = [0, 1].map(|k: usize| {
                let x = tube.place_at(sections[1 - k], arcs[1 - k]);
                tube.tube.foot(tube.section(sections[k]), arcs[k], x)
            });
            let chord = self.chord_at(sections, arcs);
            best = if chord.upper < best.upper { chord } else { best };
            let limits = [0, 1].map(|k: usize| self.limit(k, sections[k], room[k]));
            let found = found_from(sections, arcs, from, |arcs, from| {
                [0, 1].map(|k: usize| tube.near_between(sections[k], arcs[k], from, limits[k]))
            });
            best = if found.upper < best.upper { found } else { best };
            arcs = feet.map(|foot| foot.arc);
            from = self.between(sections, arcs);
        }
        best
    }

    /// Returns the point half way between the surfaces at two places.
    fn between(&self, sections: [u32; 2], arcs: [Real; 2]) -> Vector {
        let places = [0, 1].map(|k: usize| self.tube().place_at(sections[k], arcs[k]));
        half_way(places, sections.map(|section| self.tube().section(section).radius))
    }

    fn nothing(&self, sections: [u32; 2], arcs: [Real; 2]) -> PairUpperBound {
        let points = [0, 1].map(|k: usize| self.tube().place_at(sections[k], arcs[k]));
        PairUpperBound { upper: Real::INFINITY, sections, arcs, points }
    }

    /// Returns the upper bound from the balls around two places; infinity if a ball may stick out
    /// of a face.
    fn chord_at(&self, sections: [u32; 2], arcs: [Real; 2]) -> PairUpperBound {
        let tube = self.tube();
        let both = sections.map(|section| tube.section(section));
        let is_exposed = |k: usize| tube.exposed(both[k], [arcs[k]; 2]) != [false; 2];
        if is_exposed(0) || is_exposed(1) {
            return self.nothing(sections, arcs);
        }
        let feet = [0, 1].map(|k: usize| {
            tube.tube.at_share(both[k], (arcs[k] - both[k].start) / (both[k].end - both[k].start))
        });
        let (way, rounding) = (feet[1].point - feet[0].point, tube.tube.error() + tube.slack());
        let away = way.length();
        let upper =
            away + feet[0].off + feet[1].off + 2.0 * rounding - both[0].radius - both[1].radius;
        if upper <= 0.0 {
            let common = half_way(feet.map(|foot| foot.point), both.map(|section| section.radius));
            return PairUpperBound { upper: 0.0, sections, arcs, points: [common; 2] };
        }
        let unit = way / away;
        let points = [feet[0].point + unit * both[0].radius, feet[1].point - unit * both[1].radius];
        PairUpperBound { upper, sections, arcs, points }
    }

    /// Returns the upper bound for a face and a piece ahead of it.
    fn seen_from_face(
        &self,
        pair: &SelfPair,
        k: usize,
        end: usize,
        nearest: &NearestOfLinks,
    ) -> PairUpperBound {
        let tube = self.tube();
        let (piece, other) = (&pair.pieces[k], &pair.pieces[1 - k]);
        let sections = pair.pieces.map(|piece| piece.section);
        let at_face = tube.arcs(piece)[0];
        let [start, stop] = tube.arcs(other);
        let body = &pair.outers[1 - k].body;
        let mut place = [nearest.on_first, nearest.on_second][1 - k];
        let mut arc = start + (stop - start) * body.share_of(place);
        let in_order = |arc: Real| if k == 0 { [at_face, arc] } else { [arc, at_face] };
        let mut best = self.nothing(sections, in_order(arc));
        // No place is certainly ahead of a face of unknown direction.
        let Some(face) = self.face(piece, end) else { return best };
        let Some(room) = self.turns.room(in_order(arc), FRAC_PI_2) else { return best };
        let limits = self.limit(1 - k, other.section, room[1 - k]);
        let radius = tube.section(piece.section).radius;
        let rounding = 4.0 * tube.slack();
        for _ in 0..=MAX_MOVES {
            // Move the place far enough ahead that everything found within rounding of it is ahead,
            // too.
            let offset = place - face.centre;
            let ahead = offset.dot(face.outward);
            let at_least = 4.0 * rounding + offset.length() * face.tilt;
            if ahead < at_least {
                place += face.outward * (2.0 * at_least - ahead);
            }
            let TubePoint { upper, arc: next, point } =
                tube.near_between(other.section, arc, place, limits);
            if upper == Real::INFINITY {
                break;
            }
            arc = next;
            if upper <= rounding {
                let (near_face, on_face) = self.near_face(&face, radius, place);
                let points = if k == 0 { [on_face, place] } else { [place, on_face] };
                best = PairUpperBound {
                    upper: near_face + upper,
                    sections,
                    arcs: in_order(arc),
                    points,
                };
                break;
            }
            place += (point - place) * 1.125;
        }
        if best.upper < Real::INFINITY && self.leads_on_from(pair, k, best.arcs[1 - k]) {
            return self.nothing(sections, best.arcs);
        }
        // A place ahead of the face is at some distance from it. But if the tube around that place
        // goes through the face, both have points in common.
        if best.upper < Real::INFINITY && nearest.distance <= 0.0 {
            let both = if k == 0 { [[None; 2], limits] } else { [limits, [None; 2]] };
            if let Some(common) = self.common_point(pair, best.arcs, both) {
                return PairUpperBound { upper: 0.0, points: [common; 2], ..best };
            }
        }
        best
    }

    /// Returns an upper bound on the distance of a place ahead of a face, and the point of the
    /// face. The bound is infinite if the place may not be ahead.
    fn near_face(&self, face: &EndFace, radius: Real, place: Vector) -> (Real, Vector) {
        let offset = place - face.centre;
        let ahead = offset.dot(face.outward);
        let is_before = ahead > 8.0 * self.tube().slack() + offset.length() * face.tilt;
        if !is_before {
            return (Real::INFINITY, face.centre);
        }
        let on_face = point_of_face(face, radius, place);
        ((place - on_face).length() + self.off(face, radius), on_face)
    }
}

/// Returns the point of a face that is nearest to a place.
fn point_of_face(face: &EndFace, radius: Real, place: Vector) -> Vector {
    let offset = place - face.centre;
    let across = offset - face.outward * offset.dot(face.outward);
    let size = across.length();
    face.centre + across * if size > radius { radius / size } else { 1.0 }
}

impl Refinable for TubeWithItself<'_> {
    type Piece = SelfPair;
    type Body = SelfPair;
    type Nearest = NearestOfLinks;
    type Upper = PairUpperBound;

    fn body(&self, pair: &SelfPair) -> SelfPair {
        *pair
    }

    fn place(&self, pair: &SelfPair) -> [u32; 4] {
        let [one, two] = pair.pieces;
        [one.section, one.from, two.section, two.from]
    }

    fn check_finite(&self, pair: &SelfPair, _: &SelfPair) -> Result<(), ProximityError> {
        let mut of_each = pair.pieces.iter().zip(&pair.outers);
        of_each.try_for_each(|(piece, outer)| self.tube().check_finite(piece, outer))
    }

    fn halves(&self, pair: &SelfPair, _: &SelfPair, aim: Real) -> Option<[SelfPair; 2]> {
        let (tube, [least, most]) = (self.tube(), self.turns(pair));
        // If the extra turn causes the direction gap, a shorter interval helps more than shorter
        // pieces.
        let open = MIN_TURN.max(MAX_SHARE_OF_EXTRA_TURN * self.extra_turn(pair));
        if least < Self::angle(pair) && most - least < open && most > least {
            return None;
        }
        let gains = |k: usize| pair.outers[k].narrows > 0.5 * tube.slack();
        let halves = |k: usize| {
            let halves = if gains(k) { tube.halves(&pair.pieces[k], aim) } else { None }?;
            Some(halves.map(|half| {
                let mut pair = *pair;
                (pair.pieces[k], pair.outers[k]) = (half, tube.outer(&half));
                SelfPair { is_asked: self.is_queried(&pair), ..pair }
            }))
        };
        let first = usize::from(pair.outers[1].narrows > pair.outers[0].narrows);
        halves(first).or_else(|| halves(1 - first))
    }

    fn may_meet(&mut self, pair: &SelfPair, bound: Real) -> bool {
        pair.is_asked && self.at_least(pair) <= bound
    }

    fn nearest(&mut self, pair: &SelfPair, bound: Real, _: Option<u32>) -> Option<NearestOfLinks> {
        if !pair.is_asked {
            return None;
        }
        if self.is_whole(pair) && pair.faces != [None; 2] {
            let mut nearest = self.between_faces(pair);
            nearest.distance = (nearest.distance - self.off_of_bodies(pair)).max(0.0);
            return (nearest.distance <= bound).then_some(nearest);
        }
        let [one, two] = &pair.outers;
        one.body.measure_link_within(bound, &two.body)
    }

    fn distance(nearest: &NearestOfLinks) -> Real {
        nearest.distance
    }

    fn found(&self, pair: &SelfPair, _: &SelfPair, nearest: &NearestOfLinks) -> PairUpperBound {
        let sections = pair.pieces.map(|piece| piece.section);
        let points = [nearest.on_first, nearest.on_second];
        if self.is_whole(pair) {
            return self.found_whole(pair, nearest);
        }
        match pair.faces {
            [Some(end), None] => self.seen_from_face(pair, 0, end, nearest),
            [None, Some(end)] => self.seen_from_face(pair, 1, end, nearest),
            _ => {
                let links = [&pair.outers[0].body, &pair.outers[1].body];
                let ends = pair.pieces.map(|piece| self.tube().arcs(&piece));
                let arcs_at = |points: [Vector; 2]| {
                    [0, 1].map(|k: usize| {
                        let [start, end] = ends[k];
                        start + (end - start) * links[k].share_of(points[k])
                    })
                };
                let found = self.seen_at(sections, arcs_at(points), (points[0] + points[1]) * 0.5);
                if nearest.distance > 0.0 && found.upper < Real::INFINITY || found.upper <= 0.0 {
                    return found;
                }
                // Try the nearest points of the axes, and the two ends with the most turn in
                // between.
                let (feet, _) = links[0].nearest_on_axes(links[1]);
                [arcs_at(feet), [ends[0][0], ends[1][1]]]
                    .into_iter()
                    .map(|arcs| self.seen_at(sections, arcs, self.between(sections, arcs)))
                    .fold(found, |best, found| if found.upper < best.upper { found } else { best })
            }
        }
    }

    fn is_in_first_half(&self, found: &PairUpperBound, halves: &[SelfPair; 2]) -> bool {
        let [low, high] = halves;
        let k = usize::from(
            low.pieces[0].to == high.pieces[0].to && low.pieces[0].from == high.pieces[0].from,
        );
        found.arcs[k] < self.tube().arcs(&low.pieces[k])[1]
    }

    fn radius(&self, pair: &SelfPair) -> Real {
        let [first, second] = pair.pieces.map(|piece| self.tube().radius(&piece));
        first.max(second)
    }

    fn direction_uncertainty(&self, pair: &SelfPair) -> Real {
        pair.pieces.iter().map(|piece| self.tube().direction_uncertainty(piece)).sum()
    }

    fn may_become_round(&self, pair: &SelfPair) -> bool {
        pair.pieces.iter().any(|piece| self.tube().may_become_round(piece))
    }

    fn is_entirely_queried(&self, pair: &SelfPair, found: &PairUpperBound) -> bool {
        // If a body is partly behind a face, that part may be nearer.
        let is_before = self.is_whole(pair) || self.is_before(pair);
        is_before && self.surely_turns(pair) && found.upper < Real::INFINITY
    }

    fn position_uncertainty(&self) -> Real {
        2.0 * self.tube().position_uncertainty()
    }

    fn slack(&self) -> Real {
        self.both.slack()
    }
}

/// Returns a bound on the error of a segment along a normal that is off by `tilt`, between bodies
/// that are off by `off` together (module head).
fn uncertainty_of_way(off: Real, distance: Real, tilt: Real) -> Real {
    // Two roots keep the product within the range of numbers.
    off + 2.0 * off.sqrt() * (distance + off).sqrt() + (distance + off) * tilt
}
