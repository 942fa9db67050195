//! An upper bound on the speed of a range of a section.
//!
//! V bounds the speed of all points that the body must contain at other times of the interval.
//!
//! # Claim
//! 1. **Round ends.** A body with two round ends contains the balls around all points of its piece
//!    of the centreline, and so the discs in every direction. V is the speed of the centreline.
//! 2. **Flat ends.** A body with a flat end contains discs. Their points are faster by at most
//!    radius x turn.
//! 3. **Round end of a section.** It needs no term of its own. Only the front half of its ball
//!    counts: the other half lies in the discs behind it, or beyond a face, where it is no part of
//!    the tube. The front half turns like a disc, so case 2 covers it.

use crate::distance::Scalar;
use crate::motion::{Speed, check_speed};
use crate::refine::{Body, SectionRange};
use crate::robot::RobotError;
use parry3d_f64::math::Real;

/// Upper bounds on the speed of the points of a range of a section.
#[derive(Clone, Copy, Debug)]
pub(super) struct ApproachSpeed {
    /// The speed of the centreline.
    pub centreline: Real,
    /// How much faster the points of the discs are; 0 if the body contains their balls.
    pub rim: Real,
}

impl ApproachSpeed {
    /// Returns the speed of a range of a section whose body is known, from the stated one.
    ///
    /// # Errors
    /// A stated speed is negative or not finite.
    pub(super) fn of(
        stated: Speed,
        &SectionRange { section, outer, radius, .. }: &SectionRange,
    ) -> Result<Self, RobotError> {
        let section = section as usize;
        // A section of radius 0 has no rim.
        let turn = if outer.is_flat() && radius > 0.0 { stated.turn } else { 0.0 };
        let centreline = check_speed(section, stated.point)?;
        let turn = check_speed(section, turn)?;
        Ok(Self { centreline, rim: radius * turn * (1.0 + 2.0 * Real::UNIT_ROUNDOFF) })
    }
}
