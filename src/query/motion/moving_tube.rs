//! The pieces of a robot during an interval of time, whose shape is the one at its middle: how far
//! they move from there.

use super::approach_bound::{ApproachBound, half_length};
use super::approach_speed::ApproachSpeed;
use super::half_displacement::HalfDisplacement;
use super::pending_piece::PendingPiece;
use super::relative_motion::RelativeMotion;
use super::separating_planes::{PlaneTest, SeparatingPlanes};
use super::unresolved_piece::UnresolvedPiece;
use crate::answer::ProximityError;
use crate::distance::Scalar;
use crate::pair::Nearest;
use crate::pieces::{BoundedPiece, BoundingBody, Piece, Refinable, SectionRange, TubeInMesh};
use crate::robot::Motion;
use parry3d_f64::math::Real;

/// Of more pieces that failed in an interval, courses are not asked: that would take longer than
/// another shape.
const MAX_PIECES: usize = 8;

/// A piece with less room than this part of its reach seldom goes so much along the wall: one that
/// slides along it does.
const MIN_ROOM: Real = 0.1;

/// The pieces of a robot that moves, in an interval of time.
pub(crate) struct MovingTube<'a, M> {
    pub motion: &'a M,
    pub times: [Real; 2],
    /// When the shape is.
    pub t: Real,
    /// How fast the mesh moves at most.
    pub mesh_speed: Real,
    /// Pieces about which the shape decides nothing for the whole interval.
    pub unresolved: &'a mut Vec<PendingPiece>,
    /// Those before this one failed in earlier intervals.
    pub first: usize,
    /// The others, but for those that are too many.
    pub unresolved_bodies: &'a mut Vec<UnresolvedPiece>,
    /// The triangle that was found last.
    pub last: &'a mut Option<u32>,
    /// By how much faster a point of its body may be than the centreline, the mesh's speed
    /// included.
    pub beside: Real,
    pub planes: &'a mut SeparatingPlanes,
    pub small_rooms: &'a mut SmallRooms,
}

impl<'m, M: Motion> RelativeMotion<TubeInMesh<'m>, PendingPiece> for MovingTube<'_, M> {
    fn speed(
        &mut self,
        pending: &PendingPiece,
        piece: &Piece,
        outer: &BoundingBody,
        tube: &TubeInMesh<'m>,
    ) -> Result<Real, ProximityError> {
        let PendingPiece { section, shares, .. } = *pending;
        let stretch = SectionRange { section, shares, outer, radius: tube.radius(piece) };
        let ApproachSpeed { centreline, rim } =
            ApproachSpeed::of(self.motion, self.times, &stretch)?;
        self.beside = (rim + self.mesh_speed) * (1.0 + 2.0 * Real::UNIT_ROUNDOFF);
        Ok((centreline + self.beside) * (1.0 + 4.0 * Real::UNIT_ROUNDOFF))
    }

    fn seed_triangle(&self) -> Option<u32> {
        *self.last
    }

    fn record(&mut self, near: &BoundedPiece<TubeInMesh<'m>, PendingPiece>) {
        *self.last = Some(near.nearest.triangle);
    }

    fn record_unresolved(
        &mut self,
        near: &BoundedPiece<TubeInMesh<'m>, PendingPiece>,
        approach_bound: &ApproachBound,
    ) {
        self.unresolved.push(PendingPiece { is_left: [true; 2], ..*near.part });
        if self.unresolved_bodies.len() <= MAX_PIECES {
            let Nearest { distance: away, on_robot, on_mesh, .. } = *near.nearest;
            let normal = (on_robot - on_mesh).normalize_or_zero();
            let (body, beside) = (near.outer.body, self.beside * half_length(self.times));
            self.unresolved_bodies.push(UnresolvedPiece {
                body,
                away,
                normal,
                reach: approach_bound.max_approach(),
                beside,
            });
        }
    }

    fn fastest_section(
        &self,
        near: &BoundedPiece<TubeInMesh<'m>, PendingPiece>,
        speed: Real,
    ) -> (usize, Real) {
        (near.part.section as usize, speed)
    }
}

/// On which sides of the middle shape failed pieces are left.
pub(crate) struct Left {
    /// Before the shape, and after it.
    pub sides: [bool; 2],
    /// Whether a piece was settled on some side.
    pub is_any_settled: bool,
}

impl<M: Motion> MovingTube<'_, M> {
    /// Which of the pieces that failed keep the margin before the middle shape all the same, or
    /// after it, by where they go. The nearest one is asked first, and none after one that does
    /// not: that side has to be looked at anyway.
    pub(crate) fn clear_by_displacement(&mut self, tube: &mut TubeInMesh, margin: Real) -> Left {
        let nearest =
            self.unresolved_bodies.iter().enumerate().min_by(|a, b| a.1.away.total_cmp(&b.1.away));
        let mut left = Left { sides: [false; 2], is_any_settled: false };
        let Some((nearest, _)) = nearest else { return left };
        if self.unresolved_bodies.len() > MAX_PIECES {
            left.sides = [true; 2];
            return left;
        }
        let slack = tube.tube.slack();
        let room = |failure: &UnresolvedPiece| failure.away - margin - slack;
        let is_small = |failure: &UnresolvedPiece| room(failure) <= MIN_ROOM * failure.reach;
        let has_small = self.unresolved_bodies.iter().any(is_small);
        let asks_small = has_small
            && self.unresolved_bodies.iter().all(|it| room(it) > 0.0)
            && self.small_rooms.is_due();
        self.unresolved_bodies.swap(0, nearest);
        self.unresolved.swap(self.first, self.first + nearest);
        for (number, failure) in self.unresolved_bodies.iter().enumerate() {
            if is_small(failure) && !asks_small {
                left.sides = [true; 2];
                return left;
            }
            let part = &mut self.unresolved[self.first + number];
            for (side, is_left) in
                left.sides.iter_mut().enumerate().filter(|(_, is_left)| !**is_left)
            {
                let times =
                    if side == 0 { [self.times[0], self.t] } else { [self.t, self.times[1]] };
                let course = self.motion.course(part.section as usize, part.shares, times);
                let keeps = course
                    .and_then(|course| HalfDisplacement::of(&course, side, failure.beside))
                    .is_some_and(|side| {
                        let asked = PlaneTest { body: &failure.body, side: &side, margin, slack };
                        self.planes.clears(&mut tube.search, &asked, failure)
                    });
                part.is_left[side] = !keeps;
                *is_left = !keeps;
                left.is_any_settled |= keeps;
            }
            if left.sides == [true; 2] {
                break;
            }
        }
        if asks_small {
            self.small_rooms.note(left.sides != [true; 2]);
        }
        left
    }
}

/// How often pieces with little room are asked about their courses: seldom where it was in vain.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct SmallRooms {
    /// How many shapes are passed over after the last one that was asked.
    pause: u32,
    /// How many of these are still to come.
    left: u32,
}

/// The longest pause. A course costs up to as much as a shape: so it costs an eighth more at most
/// where it is always in vain.
const LONGEST_PAUSE: u32 = 15;

impl SmallRooms {
    /// Whether the next shape is asked.
    fn is_due(&mut self) -> bool {
        let is_due = self.left == 0;
        self.left = self.left.saturating_sub(1);
        is_due
    }

    /// Takes note of what one that was asked has shown.
    fn note(&mut self, is_settled: bool) {
        self.pause = if is_settled { 0 } else { (2 * self.pause + 1).min(LONGEST_PAUSE) };
        self.left = self.pause;
    }
}
