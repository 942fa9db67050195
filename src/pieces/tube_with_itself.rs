//! A tube beside itself: which of its parts are asked about, and what is found between two of them.
//!
//! The rule is that of a chain (`query::robots::robot_with_itself`, whose proofs hold for any
//! centreline with a direction: the angles of the joints are the integral of the curvature).
//! Neighbours are near for no other reason than that they are neighbours; places that are a local
//! minimum of the distance have a turn of at least pi between them, or pi / 2 where one of them is
//! a face (the base, the tip, the wider side of a step) that the other is in front of. Two faces
//! that look at one another, the end of a section and the start of a later one, are asked about at
//! any turn. From a place beside a face the robot must lead nowhere nearer: a piece is left out if
//! it does so from all of its places ([`TubeWithItself::leads_on`]). Of links `pair::JoinedLink`
//! decides, as of a chain. A place of the tube is the ball of its radius around its centreline,
//! which the tube holds as it
//! bends by less than 1 / radius; where that would stick out of a face nearby, it is the disc.
//!
//! So the least distance of all such pairs is what is bounded here. How far a curve turns is known
//! between two bounds (`robot::tube::turns`), and each is taken where it is safe:
//!
//! - **From below.** A pair of pieces is kept if the turn from the start of the first to the end of
//!   the second may be enough. That leaves out no pair of places that is asked about, so the bodies
//!   of what is kept bound the distance from below.
//! - **From above.** A pair of places counts if the turn between them is known to be enough.
//!
//! **Between the two** are pairs of which nobody knows whether they are asked about. They are kept,
//! but do not count. Let all radii between the two places be less than 1 / k, where k is the
//! largest curvature there.
//!
//! - *Those that are not asked about are not near.* Let the curve turn by u <= pi in truth, while
//!   the bound k allows pi: it is at least pi / k long. Let m be its direction where half of u is
//!   behind it. All directions are within u / 2 of m, and at the arc length s from there within k
//!   s. So the way y - x has at least (2 / k) f(u / 2) along m, where f(v) = sin v + (pi / 2 - v)
//!   cos v is 1 at v = pi / 2, and falls up to there. That is 2 / k - r1 - r2 between the surfaces,
//!   as wide as the tightest bend.
//! - *In front of a face that the curve leads away from* (the base, the tip, a step on its wider
//!   side) is nothing at u <= pi / 2: y is sin(u) / k behind the face or more, and its disc reaches
//!   less far ahead, r2 sin u. At u <= pi let p = y + w be a point of the disc in front of the
//!   face, c the face's centre. The way y - c has (2 / k) sin(u / 2) along m at least, and w at
//!   most r2 sin(u / 2) against it, as it is across a direction within u / 2 of m. So p - c has (2
//!   / k - r2) sin(u / 2) along m, and nothing along the direction of the curve at c, which is
//!   within u / 2 of m: it is 2 / k - r2 long or more. So p is 2 / k - r1 - r2 away from the face
//!   at least, as wide as the tightest bend again.
//! - *In front of a step*, where the thinner tube comes out of it, y is at least f(u) / k ahead at
//!   u <= pi / 2 (a curve pi / (2 k) long, by the same count from c on), so 1 / k or more, and its
//!   disc 1 / k - r2.
//!
//! So only of a margin as wide as a bend it matters whether parts are asked about that turn by no
//! more than is asked for. Of those that turn by more, a contact counts as soon as samples show the
//! turn. Pairs in question that turn by less than [`MIN_TURN`] are halved no more.
//!
//! **In front of a face.** Nothing is missed: a local minimum leaves the face on its outer side
//! (`one_robot`), so that its place is in front. A pair with a face is left out if the whole body
//! of the other piece is behind the plane of the face, as far as the normal is known. A place
//! counts if it is known to be in front: rather more is asked about than local minima, but
//! places beside the rim, at a distance as wide as a bend, or beside the wider part of a step,
//! which the tube is passing there. The face is held by a flat body that goes a little into the
//! tube, so that rounding does not turn it (`bounding_body`). A round cap at the wider side of a
//! chain's step is a ball around its centre.
//!
//! **Ways between two convex parts** (two faces, a chain's face and a link) are asked which side
//! they leave. The bodies measured are within D of the parts, both together. So the way w that is
//! measured, d long, is within D of one between the parts, w', of at most d + D; the shortest one,
//! w*, has at least d - D. As differences of convex sets are convex, |w' - w*|^2 <= |w'|^2 - |w*|^2
//! <= 4 D (d + D). So w* leaves w by D + 2 sqrt(D (d + D)) at most, and a normal that is off by a
//! tilt counts (d + D) tilt more. What leaves within rounding of the face's plane counts as what
//! leaves, as for a chain; all else that is in doubt is kept, but counts not.
//!
//! **Errors that are stated** say where the curve may be, not how it turns. So what is asked about
//! is decided by the curve as it is given, and errors count in every distance.
//!
//! **While it moves** places may be asked about that are not in the shape that is looked at:
//! `section_motions` has by how much more turn, and how much farther ahead. Of what is found in
//! that shape counts what counts at rest.
//!
//! **What counts on either side.** If two places turn by more than is asked for, what is left is
//! shared out: all places up to the first arc length and from the second on have enough between
//! them (`TubeTurns::room`). Within these two parts each point between them shows how near both are
//! (`tube_point`).

use super::bounding_body::BoundingBody;
use super::nearest_pairs::NearestPairs;
use super::piece::Piece;
use super::placed_tube::PlacedTube;
use super::refinable::{Body, Refinable};
use super::refine::WorkItem;
use super::section_motions::{SectionMotion, SectionMotions};
use super::tube_pair::{PairUpperBound, SectionRange, TubePair, found_from, half_way};
use super::tube_point::TubePoint;
use crate::answer::ProximityError;
use crate::distance::Scalar;
use crate::pair::{JoinedLink, MovedLinks, NearestOfLinks, PlacedLink};
use crate::robot::{EndFace, Section, Tube, TubeTurns, is_step};
use parry3d_f64::math::{Pose, Real, Vector};
use std::f64::consts::{FRAC_PI_2, PI};

/// Pairs of which nobody knows whether they are asked about are not halved any more where both turn
/// by less.
const MIN_TURN: Real = 1.0 / 1024.0;

/// Nor are they where they turn by less than this part of what they may turn more while they move.
const MAX_SHARE_OF_EXTRA_TURN: Real = 1.0 / 16.0;

/// How far the body of a face goes into the tube, in radii.
const INTO_TUBE: Real = 1.0 / 1024.0;

/// What the bodies of two faces are off by rounding alone, in slacks: `off_of_bodies` without a
/// tilt and an error.
const ROUNDING_OF_FACES: Real = 140.0;

/// How often a place of two parts is moved to the other's.
const MAX_MOVES: u32 = 3;

/// A tube beside itself, in its own frame.
#[derive(Clone, Copy)]
pub(crate) struct TubeWithItself<'a> {
    /// Twice the same.
    both: TubePair<'a>,
    turns: &'a TubeTurns,
    /// What may change of it; none at rest.
    moves: Option<&'a SectionMotions>,
}

/// Two pieces, the first of which comes first along the tube. Either may be a face: a piece without
/// length.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SelfPair {
    pub(super) pieces: [Piece; 2],
    outers: [BoundingBody; 2],
    /// The end of its section at which a piece is a face.
    pub(super) faces: [Option<usize>; 2],
    is_asked: bool,
}

impl Body for SelfPair {
    fn excess(&self) -> Real {
        self.outers.excess()
    }
}

impl WorkItem<TubeWithItself<'_>> for SelfPair {
    fn piece(&self, _: &TubeWithItself) -> SelfPair {
        *self
    }

    fn halves(self, _: &TubeWithItself, halves: [SelfPair; 2]) -> [Self; 2] {
        halves
    }
}

/// A piece, what holds it, and of which end it is the face.
type SelfBody = (Piece, BoundingBody, Option<usize>);

/// What a tube is divided into to begin with, in memory that is used again.
#[derive(Clone, Debug, Default)]
pub(crate) struct SelfPairQueue {
    pieces: Vec<Piece>,
    bodies: Vec<SelfBody>,
    nearest: NearestPairs,
}

impl<'a> TubeWithItself<'a> {
    /// # Errors
    /// The tube has no section or is out of range.
    pub(crate) fn new(tube: &'a Tube, turns: &'a TubeTurns) -> Result<Self, ProximityError> {
        let placed = PlacedTube::new(tube, &Pose::IDENTITY, 0.0)?;
        Ok(Self { both: TubePair::new([placed; 2]), turns, moves: None })
    }

    /// The same tube as if its turn had not been stated, if that is another one. All bounds of that
    /// one hold for this one.
    pub(crate) fn less_known(&self) -> Option<Self> {
        let less = self.tube().without_turn()?;
        Some(Self { both: TubePair { tubes: [less; 2] }, ..*self })
    }

    /// A tube that moves, in the shape at the middle of an interval of time.
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

    /// The sections of a pair and the shares of them between which its pieces lie, with their
    /// bodies and radii.
    pub(crate) fn section_ranges<'p>(&self, pair: &'p SelfPair) -> [SectionRange<'p>; 2] {
        [0, 1].map(|k: usize| self.tube().section_range(&pair.pieces[k], &pair.outers[k]))
    }

    /// By how much more a pair may turn, as far as it matters, while the tube moves.
    pub(crate) fn extra_turn(&self, pair: &SelfPair) -> Real {
        self.moves.map_or(0.0, |moves| moves.extra_turn(pair.pieces[1].section))
    }

    /// By how much both pieces of a pair may move, and the first or the second turn.
    fn moved(&self, pair: &SelfPair, turning: usize) -> SectionMotion {
        let Some(moves) = self.moves else { return SectionMotion::default() };
        let [one, two] = pair.pieces.map(|piece| moves.of(piece.section));
        SectionMotion { points: one.points + two.points, turn: [one, two][turning].turn }
    }

    fn tube(&self) -> &PlacedTube<'a> {
        &self.both.tubes[0]
    }

    /// The pairs of pieces to begin with, the nearest one last: all that are asked about and not
    /// farther apart than `upper`. Where these are more than `most` the nearest ones, and
    /// false.
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
        let SelfPairQueue { pieces, bodies, nearest } = beginning;
        let tube = self.tube();
        tube.begin(scale.max(0.25 * tube.widest()), pieces);
        pieces.sort_unstable_by_key(|piece| (piece.section, piece.from));
        bodies.clear();
        for piece in pieces.iter() {
            let outer = tube.outer(piece);
            tube.check_finite(piece, &outer)?;
            bodies.push((*piece, outer, None));
        }
        self.push_faces(bodies);
        nearest.begin(most);
        for i in 0..bodies.len() {
            for j in i..bodies.len() {
                let pair = pair(&bodies[i], &bodies[j]);
                if !self.turns_enough(&pair) {
                    continue;
                }
                let at_least = self.both.at_least(&pair.outers);
                if at_least <= upper && self.may_count(&pair) {
                    nearest.push(at_least, [i, j]);
                }
            }
        }
        let (order, is_all) = nearest.farthest_first();
        pairs.clear();
        pairs.extend(order.map(|[i, j]| pair(&bodies[i], &bodies[j])));
        Ok(is_all)
    }

    /// Adds all faces to the pieces: the tube's ends, where they are flat, and the wider sides of
    /// its steps.
    fn push_faces(&self, bodies: &mut Vec<SelfBody>) {
        let sections = self.tube().sections();
        for (number, section) in sections.iter().enumerate() {
            let before = number.checked_sub(1).and_then(|before| sections.get(before));
            for (end, neighbour) in [(0, before), (1, sections.get(number + 1))] {
                let is_flat = section.faces[end].is_some();
                if neighbour.map_or(is_flat, |neighbour| is_step(neighbour.radius, section.radius))
                {
                    let tick = if end == 0 { section.first } else { section.last };
                    let piece = Piece { section: number as u32, from: tick, to: tick };
                    let body = self.body_of_face(&piece, end);
                    bodies.push((
                        piece,
                        BoundingBody { body, excess: 0.0, narrows: 0.0 },
                        Some(end),
                    ));
                }
            }
        }
    }

    /// The flat face at an end of a section; none of a round cap, and of one whose direction nobody
    /// knows.
    fn face(&self, piece: &Piece, end: usize) -> Option<EndFace> {
        let tube = self.tube();
        let face = tube.faces(tube.section(piece.section))[end]?;
        (face.tilt < Real::INFINITY).then(|| tube.face(&face))
    }

    /// The way out of a link's round cap at a step, or that of a face; none if nobody knows.
    fn outward(&self, piece: &Piece, end: usize) -> Option<Vector> {
        let tube = self.tube();
        let section = tube.section(piece.section);
        if section.faces[end].is_some() {
            return self.face(piece, end).map(|face| face.outward);
        }
        let [start, stop] = [section.first, section.last].map(|tick| tube.point(section, tick));
        Some((stop - start).normalize_or_zero() * if end == 0 { -1.0 } else { 1.0 })
    }

    /// How far a face may be from where it is said to be.
    fn off(&self, face: &EndFace, radius: Real) -> Real {
        radius * face.tilt + self.tube().tube.error() + self.tube().slack()
    }

    /// How far the body of a face reaches ahead of it, and into the tube.
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

    /// By how much a pair may turn between places that are as near along the tube as they can be,
    /// and as far.
    fn turns(&self, pair: &SelfPair) -> [Real; 2] {
        let [one, two] = &pair.pieces;
        let turned = |piece: &Piece, tick: u32| {
            self.tube().tube.turned_at_most(self.turns, piece.section, tick)
        };
        [turned(two, two.from) - turned(one, one.to), turned(two, two.to) - turned(one, one.from)]
    }

    /// The turn that is asked for: none of two faces that look at one another.
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

    /// Whether the turn between two parts that share no joint may be one that is asked for.
    fn turns_enough(&self, pair: &SelfPair) -> bool {
        let [_, most] = self.turns(pair);
        let [one, two] = pair.pieces;
        // Neighbours of a chain share a joint; and of a piece and itself nothing is asked but what
        // turns.
        let apart = two.section - one.section;
        let is_same = pair.faces == [Some(0), Some(0)] || pair.faces == [Some(1), Some(1)];
        let share_joint = self.turns.has_joints() && apart < 2;
        !share_joint && !(is_same && apart == 0) && self.may_turn_enough(pair, most)
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

    /// Whether two links, a face and a link, or two faces may count at some time.
    fn may_count_while_moving(&self, pair: &SelfPair) -> bool {
        let Some(moves) = self.moves else { return true };
        let [one, two] = pair.pieces.map(|piece| self.joined(piece.section));
        let sections = self.tube().sections();
        // Of the links and of their neighbours.
        let of = |number: u32| {
            let around = number.saturating_sub(1)..=(number + 1).min(sections.len() as u32 - 1);
            around.fold(MovedLinks::default(), |most, number| {
                let SectionMotion { points, turn } = moves.of(number);
                let axes = (points - sections[number as usize].radius * turn).max(0.0);
                // The difference errs by 2 u of the points.
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

    /// Whether all parts are links whose places are known but for rounding.
    fn is_exact(&self) -> bool {
        self.turns.has_joints() && self.tube().tube.error() == 0.0
    }

    /// Whether two links of a chain, or their faces, count in this shape: the same decision as of a
    /// chain.
    fn counts_exactly(&self, pair: &SelfPair) -> bool {
        let [one, two] = pair.pieces.map(|piece| self.joined(piece.section));
        let tolerance = one.tolerance(&two);
        match pair.faces {
            [None, None] => one.counts_beside(&two, tolerance),
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

    /// A link of a chain and its neighbours.
    fn joined(&self, section: u32) -> JoinedLink {
        let sections = self.tube().sections();
        let number = section as usize;
        let link = |section: &Section| {
            let ends = [section.first, section.last].map(|tick| self.tube().point(section, tick));
            let flat = section.faces.map(|face| face.is_some());
            PlacedLink::between(ends[0], ends[1], section.radius, flat)
        };
        let beyond = [
            number.checked_sub(1).and_then(|before| sections.get(before)),
            sections.get(number + 1),
        ];
        JoinedLink {
            link: link(&sections[number]),
            beyond: beyond.map(|section| section.map(link)),
        }
    }

    /// Whether the robot leads nearer to a face from all places of the other piece, at all times.
    ///
    /// Let c be the face's centre, r its radius and n its normal, y a place of the piece, t the
    /// direction there, m that of the piece's chord, and e the largest angle between t and m. A
    /// point p of the face is at most r from c and perpendicular to n. So (y - p) . t >= (y - c) .
    /// m - |y - c| e - r (|n x m| + e), and it is no more than the same with the other signs. If
    /// that is above 0 the robot leads nearer backwards, and if it is below 0, forwards, unless it
    /// ends there or is thinner beyond. Errors, and what may move and turn, are counted in
    /// addition.
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
            // The ball around a round shoulder is seen as its centre is. It may become flat while
            // it moves.
            (false, _) if self.moves.is_none() => 0.0,
            _ => at_face.radius,
        };
        let away = ends.map(|end| (end - centre).length());
        let away = away[0].max(away[1]) + length + moved[0].points;
        let off = away * (tilt + moved[1 - k].turn) + side_excess + 4.0 * errors + moved[0].points;
        let along = |place: Vector, direction: Vector| (place - centre).dot(direction);
        if along(ends[0], chord_direction) > off {
            piece.from > section.first
                || self.goes_on(piece.section, 0, |axis| along(ends[0], axis) > off)
        } else if along(ends[1], chord_direction) < -off {
            piece.to < section.last
                || self.goes_on(piece.section, 1, |axis| along(ends[1], axis) < -off)
        } else {
            false
        }
    }

    /// Whether the robot goes on beyond an end of a section, no thinner, and in a direction that
    /// leads on too.
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

    /// Whether a pair that turns by `most` at most may turn by what is asked for.
    fn may_turn_enough(&self, pair: &SelfPair, most: Real) -> bool {
        self.turns.may_reach(most + self.extra_turn(pair), Self::angle(pair))
    }

    /// Whether a pair turns by what is asked for in this shape, anywhere on its pieces.
    fn surely_turns(&self, pair: &SelfPair) -> bool {
        self.turns.may_reach(self.turns(pair)[0], Self::angle(pair))
    }

    /// Whether the one body of a pair may be in front of the other, a face, somewhere.
    fn may_be_before(&self, pair: &SelfPair, k: usize) -> bool {
        let face = pair.faces[k].and_then(|end| self.face(&pair.pieces[k], end));
        face.is_none_or(|face| self.ahead_of_face(pair, k, &face, 1.0, self.moved(pair, k)) >= 0.0)
    }

    /// How far ahead of a face some place of the other body is at most (`sign` 1), or how far
    /// behind it at most (-1), after both have moved so much.
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

    /// Whether all of a pair is in front of its faces.
    fn is_before(&self, pair: &SelfPair) -> bool {
        (0..2).all(|k| {
            let face = pair.faces[k].and_then(|end| self.face(&pair.pieces[k], end));
            face.is_none_or(|face| {
                self.ahead_of_face(pair, k, &face, -1.0, SectionMotion::default()) <= 0.0
            })
        })
    }

    /// Whether both pieces are convex bodies, all of which are asked about: two faces, or links of
    /// a chain.
    fn is_whole(&self, pair: &SelfPair) -> bool {
        let count = pair.faces.iter().flatten().count();
        count == 2 || self.turns.has_joints()
    }

    /// Whether the shortest way between a face and another, or a link, may leave it outwards, and
    /// the other too.
    fn ways_leave(&self, pair: &SelfPair) -> bool {
        pair.faces == [None; 2] || !self.is_whole(pair) || {
            let nearest = self.between_faces(pair);
            self.leave(pair, &nearest, |k| {
                -self.doubt_of_way(pair, k, nearest.distance, self.moved(pair, k))
            })
        }
    }

    /// Whether it certainly does, but for rounding.
    fn ways_surely_leave(&self, pair: &SelfPair, nearest: &NearestOfLinks) -> bool {
        let rounding = doubt_of_way(ROUNDING_OF_FACES * self.tube().slack(), nearest.distance, 0.0);
        let doubt = |k| self.doubt_of_way(pair, k, nearest.distance, SectionMotion::default());
        self.leave(pair, nearest, |k| doubt(k) - 2.0 * rounding)
    }

    /// Whether a way leaves all faces of a pair by at least so much along their normals, as far as
    /// these are known.
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

    /// How near a face and another, or a link, are by their bodies: of the faces themselves, since
    /// bodies go into the tube.
    fn between_faces(&self, pair: &SelfPair) -> NearestOfLinks {
        let [one, two] = &pair.outers;
        match pair.faces {
            [Some(_), Some(_)] => one.body.face_to_face([0, 0], &two.body),
            [Some(_), None] => one.body.face_to_link(0, &two.body),
            _ => two.body.face_to_link(0, &one.body).swapped(),
        }
    }

    /// By how much a way of the length `distance` may err along the normal of a face, after both
    /// bodies have moved so much.
    fn doubt_of_way(
        &self,
        pair: &SelfPair,
        k: usize,
        distance: Real,
        moved: SectionMotion,
    ) -> Real {
        let face = pair.faces[k].and_then(|end| self.face(&pair.pieces[k], end));
        let tilt = face.map_or(0.0, |face| face.tilt) + moved.turn;
        doubt_of_way(self.off_of_bodies(pair) + moved.points, distance, tilt)
    }

    /// How far the bodies of faces and links may be from what they stand for, together.
    fn off_of_bodies(&self, pair: &SelfPair) -> Real {
        let (error, slack) = (self.tube().tube.error(), self.tube().slack());
        let off = |k: usize| {
            let (piece, radius) = (&pair.pieces[k], self.tube().radius(&pair.pieces[k]));
            match pair.faces[k].and_then(|end| self.face(piece, end)).filter(|_| radius > 0.0) {
                // Ahead, and aside; and where the face is.
                Some(face) => {
                    self.reach_of_face(&face, radius)[0] + 2.0 * self.off(&face, radius) + slack
                }
                None => 2.0 * (error + slack),
            }
        };
        off(0) + off(1) + 4.0 * slack
    }

    /// How near two faces are, or a face and a link, or two links.
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
        // What may be asked about at another time does not count in this shape.
        let counts = self.surely_turns(pair)
            && if self.is_exact() {
                self.counts_exactly(pair)
            } else {
                pair.faces == [None; 2] || is_known && self.ways_surely_leave(pair, &nearest)
            };
        let upper =
            if counts { nearest.distance + self.off_of_bodies(pair) } else { Real::INFINITY };
        PairUpperBound { upper, sections: pair.pieces.map(|piece| piece.section), arcs, points }
    }

    /// Up to where, or from where on, a part of a section counts beside the other of a pair; none
    /// where it goes to the end.
    fn limit(&self, k: usize, section: u32, arc: Real) -> [Option<Real>; 2] {
        let inner = 1 - k;
        let section = self.tube().section(section);
        let (reaches, end) = if inner == 1 {
            (arc >= section.end, section.end)
        } else {
            (arc <= section.start, section.start)
        };
        // The discs of a curve's other section are as near as the ball at a round end.
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

    /// How near two places are, which have a turn of `pi` between them, as seen from a point first.
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

    /// A point half way between the surfaces at two places.
    fn between(&self, sections: [u32; 2], arcs: [Real; 2]) -> Vector {
        let places = [0, 1].map(|k: usize| self.tube().place_at(sections[k], arcs[k]));
        half_way(places, sections.map(|section| self.tube().section(section).radius))
    }

    fn nothing(&self, sections: [u32; 2], arcs: [Real; 2]) -> PairUpperBound {
        let points = [0, 1].map(|k: usize| self.tube().place_at(sections[k], arcs[k]));
        PairUpperBound { upper: Real::INFINITY, sections, arcs, points }
    }

    /// How near the balls around two places are, where these are in the tube.
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

    /// How near a piece is to a face that it is in front of.
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
        // In front of a face whose direction nobody knows is nothing for certain.
        let Some(face) = self.face(piece, end) else { return best };
        let Some(room) = self.turns.room(in_order(arc), FRAC_PI_2) else { return best };
        let limits = self.limit(1 - k, other.section, room[1 - k]);
        let radius = tube.section(piece.section).radius;
        let rounding = 4.0 * tube.slack();
        for _ in 0..=MAX_MOVES {
            // Into what is in front of the face for certain, with all that is found within rounding
            // of it.
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
        best
    }

    /// How near a place is to a face at most if it is in front of it, and where.
    fn near_face(&self, face: &EndFace, radius: Real, place: Vector) -> (Real, Vector) {
        let offset = place - face.centre;
        let ahead = offset.dot(face.outward);
        let is_before = ahead > 8.0 * self.tube().slack() + offset.length() * face.tilt;
        if !is_before {
            return (Real::INFINITY, face.centre);
        }
        let across = offset - face.outward * ahead;
        let size = across.length();
        let share = if size > radius { radius / size } else { 1.0 };
        let beyond = (size - radius).max(0.0);
        (
            Vector::new(ahead, beyond, 0.0).length() + self.off(face, radius),
            face.centre + across * share,
        )
    }
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
        // Where time is to blame for the doubt, a shorter interval is better than shorter pieces.
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
        pair.is_asked && self.both.at_least(&pair.outers) <= bound
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
                // Where the axes are nearest, and where most of the turn is between the two.
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
        // Of a body that is partly behind a face, that part may be nearer.
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

/// Two pieces as one that is asked about, in the order in which they come along the tube.
fn pair(one: &SelfBody, other: &SelfBody) -> SelfPair {
    let place = |piece: &Piece| (piece.section, piece.from, piece.to);
    let [one, other] = if place(&one.0) <= place(&other.0) { [one, other] } else { [other, one] };
    SelfPair {
        pieces: [one.0, other.0],
        outers: [one.1, other.1],
        faces: [one.2, other.2],
        is_asked: true,
    }
}

/// By how much a way may err along a normal that is off by `tilt`, between bodies that are so far
/// off together.
fn doubt_of_way(off: Real, distance: Real, tilt: Real) -> Real {
    // Two roots, so that no product leaves the range of numbers.
    off + 2.0 * off.sqrt() * (distance + off).sqrt() + (distance + off) * tilt
}
