//! The pieces of a robot during an interval of time, whose shape is the one at its middle: how far they move from there.

use super::failure::Failure;
use super::fast::Fast;
use super::moves::Moves;
use super::own_directions::{Asked, OwnDirections};
use super::pace::{Pace, half};
use super::side::Side;
use super::waiting::Waiting;
use crate::answer::ProximityError;
use crate::distance::Scalar;
use crate::pair::Nearest;
use crate::pieces::{Divided, Near, Outer, Piece, Stretch, TubeInMesh};
use crate::robot::Motion;
use parry3d_f64::math::Real;

/// Of more pieces that failed in an interval, courses are not asked: that would take longer than another shape.
const MOST_PIECES: usize = 8;

/// A piece with less room than this part of its reach seldom goes so much along the wall: one that
/// slides along it does.
const LEAST_ROOM: Real = 0.1;

/// The pieces of a robot that moves, in an interval of time.
pub(crate) struct Moving<'a, M> {
    pub motion: &'a M,
    pub times: [Real; 2],
    /// When the shape is.
    pub t: Real,
    /// How fast the mesh moves at most.
    pub mesh_speed: Real,
    /// Pieces about which the shape decides nothing for the whole interval.
    pub failed: &'a mut Vec<Waiting>,
    /// Those before this one failed in earlier intervals.
    pub first: usize,
    /// The others, but for those that are too many.
    pub failures: &'a mut Vec<Failure>,
    /// The triangle that was found last.
    pub last: &'a mut Option<u32>,
    /// By how much faster a point of its body may be than the centreline, the mesh's speed included.
    pub beside: Real,
    pub directions: &'a mut OwnDirections,
    pub small_rooms: &'a mut SmallRooms,
}

impl<'m, M: Motion> Moves<TubeInMesh<'m>, Waiting> for Moving<'_, M> {
    fn speed(
        &mut self,
        waiting: &Waiting,
        piece: &Piece,
        outer: &Outer,
        tube: &TubeInMesh<'m>,
    ) -> Result<Real, ProximityError> {
        let Waiting { section, shares, .. } = *waiting;
        let stretch = Stretch { section, shares, outer, radius: tube.radius(piece) };
        let Fast { centreline, rim } = Fast::of(self.motion, self.times, &stretch)?;
        self.beside = (rim + self.mesh_speed) * (1.0 + 2.0 * Real::UNIT_ROUNDOFF);
        Ok((centreline + self.beside) * (1.0 + 4.0 * Real::UNIT_ROUNDOFF))
    }

    fn start(&self) -> Option<u32> {
        *self.last
    }

    fn note(&mut self, near: &Near<TubeInMesh<'m>, Waiting>) {
        *self.last = Some(near.nearest.triangle);
    }

    fn fail(&mut self, near: &Near<TubeInMesh<'m>, Waiting>, pace: &Pace) {
        self.failed.push(Waiting { is_left: [true; 2], ..*near.part });
        if self.failures.len() <= MOST_PIECES {
            let Nearest { distance: away, on_robot, on_mesh, .. } = *near.nearest;
            let normal = (on_robot - on_mesh).normalize_or_zero();
            let (body, beside) = (near.outer.body, self.beside * half(self.times));
            self.failures.push(Failure { body, away, normal, reach: pace.reach(), beside });
        }
    }

    fn fastest(&self, near: &Near<TubeInMesh<'m>, Waiting>, speed: Real) -> (usize, Real) {
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

impl<M: Motion> Moving<'_, M> {
    /// Which of the pieces that failed keep the margin before the middle shape all the same, or after it, by where they go. The
    /// nearest one is asked first, and none after one that does not: that side has to be looked at
    /// anyway.
    pub(crate) fn leave_by_courses(&mut self, tube: &mut TubeInMesh, margin: Real) -> Left {
        let nearest = self.failures.iter().enumerate().min_by(|a, b| a.1.away.total_cmp(&b.1.away));
        let mut left = Left { sides: [false; 2], is_any_settled: false };
        let Some((nearest, _)) = nearest else { return left };
        if self.failures.len() > MOST_PIECES {
            left.sides = [true; 2];
            return left;
        }
        let slack = tube.tube.slack();
        let room = |failure: &Failure| failure.away - margin - slack;
        let is_small = |failure: &Failure| room(failure) <= LEAST_ROOM * failure.reach;
        let has_small = self.failures.iter().any(is_small);
        let asks_small =
            has_small && self.failures.iter().all(|it| room(it) > 0.0) && self.small_rooms.is_due();
        self.failures.swap(0, nearest);
        self.failed.swap(self.first, self.first + nearest);
        for (number, failure) in self.failures.iter().enumerate() {
            if is_small(failure) && !asks_small {
                left.sides = [true; 2];
                return left;
            }
            let part = &mut self.failed[self.first + number];
            for (side, is_left) in left.sides.iter_mut().enumerate().filter(|(_, is_left)| !**is_left) {
                let times = if side == 0 { [self.times[0], self.t] } else { [self.t, self.times[1]] };
                let course = self.motion.course(part.section as usize, part.shares, times);
                let keeps =
                    course.and_then(|course| Side::of(&course, side, failure.beside)).is_some_and(|side| {
                        let asked = Asked { body: &failure.body, side: &side, margin, slack };
                        self.directions.keeps(&mut tube.search, &asked, failure)
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
