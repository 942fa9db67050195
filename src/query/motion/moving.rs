//! The pieces of a robot during an interval of time, whose shape is the one at its middle: how far they move from there.
//!
//! **How fast.** A body with two round ends holds the balls around all points of its piece of the centreline, and so
//! whatever the discs become when they turn: V is the speed of the centreline. One with a flat end holds discs, whose
//! points move by the radius times the turn more. The ball at a round end of a section counts with its front half alone:
//! the other half is in the discs behind it, or beyond a face, where it is no part of the tube. That half turns like a
//! disc.

use super::waiting::Waiting;
use crate::distance::Scalar;
use crate::pieces::{Near, Outer, Piece, PlacedTube, TubeInMesh};
use crate::robot::{Motion, RobotError};
use parry3d_f64::math::Real;

/// The pieces of a robot that moves, in an interval of time.
pub(crate) struct Moving<'a, M> {
    pub motion: &'a M,
    pub times: [Real; 2],
    /// Half of its length, or a little more.
    pub half: Real,
    /// By how much those flat ends that may become round move in that time.
    pub opening: Real,
    /// How fast the mesh moves at most.
    pub mesh_speed: Real,
    /// Pieces about which the shape decides nothing for the whole interval.
    pub failed: &'a mut Vec<Waiting>,
    /// The triangle that was found last.
    pub last: &'a mut Option<u32>,
    /// How fast the piece that is looked at and the mesh move towards each other at most.
    pub speed: Real,
    /// For how long before and after the shape the pieces that failed are decided.
    pub still: Real,
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
        self.speed = (stated.point + radius * turn + self.mesh_speed) * (1.0 + 8.0 * Real::UNIT_ROUNDOFF);
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
        self.failed.push(*near.part);
    }
}

/// For how long before and after the middle what moves at a speed does not come nearer by more than `room`.
fn still(room: Real, speed: Real) -> Real {
    // The quotient is rounded, and so are times, which are at most 1.
    let time = room.max(0.0) / speed * (1.0 - 8.0 * Real::UNIT_ROUNDOFF) - 8.0 * Real::UNIT_ROUNDOFF;
    time.max(0.0)
}
