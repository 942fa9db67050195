//! The pieces of a robot during an interval of time, whose shape is the one at its middle: how far they move from there.
//!
//! **How fast.** A body with two round ends holds the balls around all points of its piece of the centreline, and so
//! whatever the discs become when they turn: V is the speed of the centreline. One with a flat end holds discs, whose
//! points move by the radius times the turn more. The ball at a round end of a section counts with its front half alone:
//! the other half is in the discs behind it, or beyond a face, where it is no part of the tube. That half turns like a
//! disc.

use super::own_directions::{Asked, OwnDirections};
use super::side::Side;
use super::waiting::Waiting;
use crate::distance::Scalar;
use crate::pair::Nearest;
use crate::pieces::{Divided, Near, Outer, Part, Piece, PlacedTube, TubeInMesh};
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
        let Nearest { distance: away, triangle, .. } = *near.nearest;
        self.failed.push(Waiting { is_left: [true; 2], away, triangle, ..*near.part });
    }

    /// Which of the pieces that failed keep the margin before the middle shape all the same, or after it, by where they go. The
    /// nearest one is asked first, and none after one that does not: that side has to be looked at anyway. Whether any is left
    /// on either side.
    ///
    /// # Errors
    /// A stated speed is not finite and at least 0.
    pub(crate) fn leave_by_courses(
        &mut self,
        tube: &mut TubeInMesh,
        margin: Real,
    ) -> Result<[bool; 2], RobotError> {
        let last = self.failed.len();
        let nearest = (self.first..last).min_by(|a, b| self.failed[*a].away.total_cmp(&self.failed[*b].away));
        let Some(nearest) = nearest else { return Ok([false; 2]) };
        if last - self.first > MOST_PIECES {
            return Ok([true; 2]);
        }
        self.failed.swap(self.first, nearest);
        let mut is_left = [false; 2];
        for number in self.first..last {
            let part = self.failed[number];
            let piece = part.piece(tube);
            let outer = tube.body(&piece);
            self.turn_to(&part, &piece, &outer, &tube.tube)?;
            let slack = tube.tube.slack();
            if part.away - margin - slack <= LEAST_ROOM * self.reach() {
                return Ok([true; 2]);
            }
            for (side, is_left) in is_left.iter_mut().enumerate().filter(|(_, is_left)| !**is_left) {
                let keeps = self.side(&part, side).is_some_and(|side| {
                    let asked = Asked { body: &outer.body, side: &side, margin, slack };
                    self.directions.keeps(&mut tube.search, &asked, part.triangle)
                });
                self.failed[number].is_left[side] = !keeps;
                *is_left = !keeps;
            }
            if is_left == [true; 2] {
                break;
            }
        }
        Ok(is_left)
    }

    fn side(&self, part: &Waiting, side: usize) -> Option<Side> {
        let times = if side == 0 { [self.times[0], self.t] } else { [self.t, self.times[1]] };
        let course = self.motion.course(part.section as usize, part.shares, times)?;
        let is_known =
            course.ways.iter().all(|way| way.is_finite()) && (0.0..Real::INFINITY).contains(&course.off);
        let sign = if side == 0 { -1.0 } else { 1.0 };
        let off = course.off + self.beside * self.half;
        is_known.then(|| Side { ways: course.ways.map(|way| way * sign), off })
    }
}

/// For how long before and after the middle what moves at a speed does not come nearer by more than `room`.
fn still(room: Real, speed: Real) -> Real {
    // The quotient is rounded, and so are times, which are at most 1.
    let time = room.max(0.0) / speed * (1.0 - 8.0 * Real::UNIT_ROUNDOFF) - 8.0 * Real::UNIT_ROUNDOFF;
    time.max(0.0)
}
