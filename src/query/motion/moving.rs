//! The pieces of a robot during an interval of time, whose shape is the one at its middle: how far they move from there.
//!
//! **How fast.** A body with two round ends holds the balls around all points of its piece of the centreline, and so
//! whatever the discs become when they turn: V is the speed of the centreline. One with a flat end holds discs, whose
//! points move by the radius times the turn more. The ball at a round end of a section counts with its front half alone:
//! the other half is in the discs behind it, or beyond a face, where it is no part of the tube. That half turns like a
//! disc.

use super::failure::Failure;
use super::own_directions::{Asked, OwnDirections};
use super::side::Side;
use super::waiting::Waiting;
use crate::distance::Scalar;
use crate::pair::Nearest;
use crate::pieces::{Near, Outer, Piece, PlacedTube, TubeInMesh};
use crate::robot::{Motion, RobotError};
use parry3d_f64::math::Real;

/// Of more pieces that failed in an interval, courses are not asked: that would take longer than another shape.
const MOST_PIECES: usize = 8;

/// A piece with less room than this part of its reach seldom goes so much along the wall.
const LEAST_ROOM: Real = 0.1;

/// The pieces of a robot that moves, in an interval of time.
pub(crate) struct Moving<'a, M> {
    pub motion: &'a M,
    pub times: [Real; 2],
    /// When the shape is.
    pub t: Real,
    /// Half of its length, or a little more.
    pub half: Real,
    /// By how much those flat ends that may become round move in that time.
    pub opening: Real,
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
    /// How fast the piece that is looked at and the mesh move towards each other at most.
    pub speed: Real,
    /// By how much faster a point of its body may be than the centreline, the mesh's speed included.
    pub beside: Real,
    /// For how long before and after the shape the pieces that failed are decided.
    pub still: Real,
    pub directions: &'a mut OwnDirections,
}

impl<M: Motion> Moving<'_, M> {
    /// Turns to a piece.
    ///
    /// # Errors
    /// A stated speed is not finite and at least 0.
    pub(crate) fn turn_to(
        &mut self,
        waiting: &Waiting,
        piece: &Piece,
        outer: &Outer,
        tube: &PlacedTube,
    ) -> Result<(), RobotError> {
        let section = waiting.section as usize;
        let stated = self.motion.speed(section, waiting.shares, self.times);
        let radius = tube.radius(piece);
        // A wire has no rim.
        let turn = if outer.is_flat() && radius > 0.0 { stated.turn } else { 0.0 };
        for value in [stated.point, turn] {
            if !(0.0..Real::INFINITY).contains(&value) {
                return Err(RobotError::BadSpeed { section, value });
            }
        }
        self.beside = (radius * turn + self.mesh_speed) * (1.0 + 4.0 * Real::UNIT_ROUNDOFF);
        self.speed = (stated.point + self.beside) * (1.0 + 4.0 * Real::UNIT_ROUNDOFF);
        Ok(())
    }

    /// How much nearer to the mesh the piece may be than in the middle shape.
    pub(crate) fn reach(&self) -> Real {
        self.half * self.speed
    }

    /// Takes note of a piece that is decided for a while before and after the middle shape: as long as it has not come nearer
    /// by `room`.
    pub(crate) fn fail(&mut self, near: &Near<TubeInMesh, Waiting>, room: Real) {
        self.still = self.still.min(still(room, self.speed));
        self.failed.push(Waiting { is_left: [true; 2], ..*near.part });
        if self.failures.len() <= MOST_PIECES {
            let Nearest { distance: away, on_robot, on_mesh, .. } = *near.nearest;
            let normal = (on_robot - on_mesh).normalize_or_zero();
            let (body, reach) = (near.outer.body, self.reach());
            self.failures.push(Failure { body, away, normal, reach, beside: self.beside * self.half });
        }
    }

    /// Which of the pieces that failed keep the margin before the middle shape all the same, or after it, by where they go. The
    /// nearest one is asked first, and none after one that does not: that side has to be looked at anyway. Whether any is left
    /// on either side.
    pub(crate) fn leave_by_courses(&mut self, tube: &mut TubeInMesh, margin: Real) -> [bool; 2] {
        let nearest = self.failures.iter().enumerate().min_by(|a, b| a.1.away.total_cmp(&b.1.away));
        let Some((nearest, _)) = nearest else { return [false; 2] };
        if self.failures.len() > MOST_PIECES {
            return [true; 2];
        }
        self.failures.swap(0, nearest);
        self.failed.swap(self.first, self.first + nearest);
        let slack = tube.tube.slack();
        let mut is_left = [false; 2];
        for (number, failure) in self.failures.iter().enumerate() {
            if failure.away - margin - slack <= LEAST_ROOM * failure.reach {
                return [true; 2];
            }
            let part = &mut self.failed[self.first + number];
            for (side, is_left) in is_left.iter_mut().enumerate().filter(|(_, is_left)| !**is_left) {
                let times = if side == 0 { [self.times[0], self.t] } else { [self.t, self.times[1]] };
                let course = self.motion.course(part.section as usize, part.shares, times);
                let keeps =
                    course.and_then(|course| Side::of(&course, side, failure.beside)).is_some_and(|side| {
                        let asked = Asked { body: &failure.body, side: &side, margin, slack };
                        self.directions.keeps(&mut tube.search, &asked, failure)
                    });
                part.is_left[side] = !keeps;
                *is_left = !keeps;
            }
            if is_left == [true; 2] {
                break;
            }
        }
        is_left
    }
}

/// For how long before and after the middle what moves at a speed does not come nearer by more than `room`.
fn still(room: Real, speed: Real) -> Real {
    // The quotient is rounded, and so are times, which are at most 1.
    let time = room.max(0.0) / speed * (1.0 - 8.0 * Real::UNIT_ROUNDOFF) - 8.0 * Real::UNIT_ROUNDOFF;
    time.max(0.0)
}
