//! How fast a stretch of a robot moves.
//!
//! **How fast.** A body with two round ends holds the balls around all points of its piece of the
//! centreline, and so whatever the discs become when they turn: V is the speed of the centreline.
//! One with a flat end holds discs, whose points move by the radius times the turn more. The ball
//! at a round end of a section counts with its front half alone: the other half is in the discs
//! behind it, or beyond a face, where it is no part of the tube. That half turns like a disc.

use crate::distance::Scalar;
use crate::pieces::SectionRange;
use crate::robot::{Motion, RobotError, check_speed};
use parry3d_f64::math::Real;

/// How fast the points of a stretch move at most.
#[derive(Clone, Copy, Debug)]
pub(super) struct ApproachSpeed {
    /// Those of its centreline.
    pub centreline: Real,
    /// By how much faster those of its discs are, as far as its body needs them.
    pub rim: Real,
}

impl ApproachSpeed {
    /// What a motion states of a section between two shares, whose body is known.
    ///
    /// # Errors
    /// A stated speed is not finite and at least 0.
    pub(super) fn of<M: Motion>(
        motion: &M,
        times: [Real; 2],
        &SectionRange { section, shares, outer, radius }: &SectionRange,
    ) -> Result<Self, RobotError> {
        let section = section as usize;
        let stated = motion.speed(section, shares, times);
        // A wire has no rim.
        let turn = if outer.is_flat() && radius > 0.0 { stated.turn } else { 0.0 };
        let centreline = check_speed(section, stated.point)?;
        let turn = check_speed(section, turn)?;
        Ok(Self { centreline, rim: radius * turn * (1.0 + 2.0 * Real::UNIT_ROUNDOFF) })
    }
}
