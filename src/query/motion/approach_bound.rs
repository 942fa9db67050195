//! How fast pieces approach in an interval of time, and for how long its middle shape decides.

use crate::answer::ProximityError;
use crate::distance::Scalar;
use parry3d_f64::math::Real;

/// Into how many intervals time may be divided: in each a point moves by the resolution. Each
/// rounding of a time is 2^-53, far less; and more shapes than this nobody waits for.
const MAX_INTERVALS: Real = (1_u64 << 24) as Real;

/// What moves in an interval of time, seen from its middle.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ApproachBound {
    /// Half of its length, or a little more.
    half_length: Real,
    /// By how much those flat ends that may become round move in that time.
    pub cap_change: Real,
    /// How fast what is looked at approaches at most.
    pub speed: Real,
    /// By how much more it may turn than the middle shape shows, where that matters.
    pub growth: Real,
    /// For how long before and after the middle shape what failed is decided.
    pub hold: Real,
}

/// Whether time can be divided into intervals in which something so fast moves by the resolution.
/// `fastest` names the fastest section of it, and its speed.
///
/// # Errors
/// It cannot.
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

/// The middle of an interval.
pub(super) fn midpoint(times: [Real; 2]) -> Real {
    0.5 * times[0] + 0.5 * times[1]
}

/// Half of an interval. The middle is rounded, and so is a motion's own time in a path: by less
/// than 4 u, however short the interval.
pub(super) fn half_length(times: [Real; 2]) -> Real {
    0.5 * (times[1] - times[0]) * (1.0 + 4.0 * Real::UNIT_ROUNDOFF) + 4.0 * Real::UNIT_ROUNDOFF
}

/// What is left of an interval before and after its middle, which decides for a while.
pub(super) fn remaining_parts(times: [Real; 2], hold: Real) -> [Option<[Real; 2]>; 2] {
    let t = midpoint(times);
    [[times[0], t - hold], [t + hold, times[1]]].map(|rest| (rest[0] < rest[1]).then_some(rest))
}

impl ApproachBound {
    pub(super) fn new(times: [Real; 2], cap_change: Real) -> Self {
        Self {
            half_length: half_length(times),
            cap_change,
            speed: 0.0,
            growth: 0.0,
            hold: Real::INFINITY,
        }
    }

    /// How much nearer it may come than in the middle shape.
    pub(super) fn max_approach(&self) -> Real {
        self.half_length * self.speed
    }

    /// Whether flat ends that may become round are so fast that no interval is short enough to tell
    /// whether they do.
    pub(super) fn caps_change_too_fast(&self, resolution: Real) -> bool {
        self.cap_change > MAX_INTERVALS * resolution * self.half_length
    }

    /// Takes note of something that is decided for as long as it has not come nearer by `room`.
    pub(super) fn limit_hold(&mut self, room: Real) {
        // The quotient is rounded, and so are times, which are at most 1.
        let time = room.max(0.0) / self.speed * (1.0 - 8.0 * Real::UNIT_ROUNDOFF)
            - 8.0 * Real::UNIT_ROUNDOFF;
        self.hold = self.hold.min(time.max(0.0));
    }
}
