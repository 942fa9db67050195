//! How fast and how much nearer pieces may come in an interval of time, and how long its middle
//! shape decides.
//!
//! V bounds the speed of all points that the body of a piece must contain at other times of the
//! interval.
//!
//! # Claim
//! 1. **Round ends.** A body with two round ends contains the balls around all points of its piece
//!    of the centreline, and so the discs in every direction. V is the speed of the centreline.
//! 2. **Flat ends.** A body with a flat end contains discs. Their points are faster by at most
//!    radius x turn.
//! 3. **Round end of a section.** It needs no term of its own. Only the front half of its ball
//!    counts: the other half lies in the discs behind it, or beyond a face, where it is no part of
//!    the tube. The front half turns like a disc, so case 2 covers it.

use crate::answer::ProximityError;
use crate::distance::Scalar;
use crate::motion::{Speed, check_speed};
use crate::refine::{Body, SectionRange};
use crate::robot::RobotError;
use parry3d_f64::math::Real;

/// The most intervals into which time is divided; in each a point moves by the resolution. The
/// rounding of half of an interval ([`half_length`]), 2^-51, is far smaller. Few intervals become so
/// short: those around a contact. The number of shapes is limited elsewhere.
const MAX_INTERVALS: Real = (1_u64 << 40) as Real;

/// The motion in an interval of time, relative to its midpoint.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ApproachBound {
    /// Half of the length of the interval, rounded up.
    half_length: Real,
    /// How far the ends that may become round, and the rims of links that may lose their direction,
    /// move in that time; the larger of both.
    pub cap_change: Real,
    /// How long before and after the middle shape the unresolved pieces provably keep the margin.
    /// Infinite without unresolved pieces.
    pub hold: Real,
}

/// The motion of one piece, or one pair of pieces, in an interval of time.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Approach {
    /// The two speeds that the [relative motion](super::relative_motion::RelativeMotion::speeds)
    /// states.
    pub speeds: [Real; 2],
    /// V: an upper bound on the speed of approach, the sum of both.
    pub speed: Real,
    /// tau V: how much nearer the piece may come than in the middle shape.
    pub distance: Real,
    /// How much more the piece may turn than the middle shape shows; 0 where turns do not matter.
    pub extra_turn: Real,
}

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

/// Checks that time can be divided into intervals in which a point of this speed moves by the
/// resolution. `fastest` returns the fastest section and its speed.
///
/// # Errors
/// The speed exceeds [`MAX_INTERVALS`] times the resolution.
pub(super) fn check_subdivision(
    speed: Real,
    resolution: Real,
    fastest: impl FnOnce() -> (usize, Real),
) -> Result<(), ProximityError> {
    if speed > MAX_INTERVALS * resolution {
        let (section, speed) = fastest();
        return Err(ProximityError::TooFast { section, speed, resolution });
    }
    Ok(())
}

/// Returns the midpoint of an interval.
pub(crate) fn midpoint(times: [Real; 2]) -> Real {
    0.5 * times[0] + 0.5 * times[1]
}

/// Returns half of an interval, rounded up. The midpoint is rounded, and so is the time that a path
/// of motions passes to one of them: by less than 4 u, however short the interval.
pub(crate) fn half_length(times: [Real; 2]) -> Real {
    0.5 * (times[1] - times[0]) * (1.0 + 4.0 * Real::UNIT_ROUNDOFF) + 4.0 * Real::UNIT_ROUNDOFF
}

/// Returns the parts of an interval that remain if the middle shape decides for the time `hold`
/// before and after the midpoint.
pub(super) fn remaining_parts(times: [Real; 2], hold: Real) -> [Option<[Real; 2]>; 2] {
    let t = midpoint(times);
    [[times[0], t - hold], [t + hold, times[1]]].map(|rest| (rest[0] < rest[1]).then_some(rest))
}

impl ApproachBound {
    pub(super) fn new(times: [Real; 2], cap_change: Real) -> Self {
        Self { half_length: half_length(times), cap_change, hold: Real::INFINITY }
    }

    /// Returns the motion of a piece with these speeds.
    pub(super) fn of_piece(&self, speeds: [Real; 2], extra_turn: Real) -> Approach {
        let speed = (speeds[0] + speeds[1]) * (1.0 + 4.0 * Real::UNIT_ROUNDOFF);
        Approach { speeds, speed, distance: self.half_length * speed, extra_turn }
    }

    /// Whether flat ends that may become round are so fast that no interval is short enough to show
    /// whether they do.
    pub(super) fn caps_change_too_fast(&self, resolution: Real) -> bool {
        self.cap_change > MAX_INTERVALS * resolution * self.half_length
    }

    /// Limits `hold` to the time in which a piece comes nearer by at most `free`.
    pub(super) fn limit_hold(&mut self, piece: &Approach, free: Real) {
        // The quotient is rounded, and so are times, which are at most 1.
        let time = free.max(0.0) / piece.speed * (1.0 - 8.0 * Real::UNIT_ROUNDOFF)
            - 8.0 * Real::UNIT_ROUNDOFF;
        self.hold = self.hold.min(time.max(0.0));
    }
}
