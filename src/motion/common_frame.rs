//! A rigid frame that carries a whole robot for an interval of time.
//!
//! # Definitions
//! - T: the time since the middle of the interval; h: half of its length.
//! - F: the velocity field of a frame, `F(x) = v + w x (x - a - v T)`. The frame turns at w, and
//!   its point a (at T = 0) moves straight at v.
//! - off, e: the true field of the frame differs from F at x by at most `off + e |x - a - v T|`.
//! - p(t): a point of the robot. s: a bound on its speed relative to the true field. So p has the
//!   velocity `F(p) + d` with `|d| <= U`, where `U = s + off + e D`, and D bounds `|p - a - v T|`.
//! - g: the largest `|w x (p - a - v T)|` in the interval; g0: its value at T = 0.
//!
//! # Claim 1
//! `g <= g0 + h |w| U`, and `D <= 2 (D0 + h (s + off))` if `h e <= 1/2`, where D0 is D at T = 0.
//!
//! **Proof.** The velocity of `p - a - v T` is `w x (p - a - v T) + d`. The first part changes
//! neither its length nor its distance from the axis w. So its length grows at most at the rate
//! `s + off + e D`, and `exp(1/2) < 2`.
//!
//! # A frame on a base
//! A base has the field F1 with w1, v1, its origin b. In its frame another field F2 carries the
//! robot. R is the base's rotation at T = 0. The point `c = b + R a2` of both moves at
//! `v = v1 + w1 x R a2 + R v2`, and both turn at `w = w1 + R w2`. At the time T the rotation
//! differs from R by a turn about w1 of at most `|w1| h`, which moves a vector y by at most
//! `|w1 x y| h`. So
//! - w errs by at most `k = |w1 x R w2| h`;
//! - the velocity of the carried point c(T) errs by `h |w1| (|w1 x R a2| + |w1| h |v2| + 2 |v2|)`,
//!   which is at most off1;
//! - `c(T)` is within `h off1` of `c + v T`.
//!
//! The field errs by `e = e2 + k` and `off = off2 + off1 + (|w| + e + k) h off1`. If the base does
//! not turn, off1 and k are 0. If F2 is a shift, a2 is arbitrary and 0.
//!
//! **Rounding.** A field is computed from v, w and coordinates up to `reach`: it errs by less than
//! `64 u (|v| + |w| reach)`, for either frame.

use super::Speed;
use super::rigid_path::RigidPath;
use crate::distance::Scalar;
use crate::robot::{RobotError, length, rotation_by};
use parry3d_f64::math::{Pose, Real, Rotation, Vector};

/// A rigid frame that carries a robot for an interval of time:
/// [`Motion::common_frame`](crate::Motion::common_frame).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CommonFrame {
    /// a: the place in the middle of the interval of the point that moves straight.
    pub(super) at: Vector,
    /// v, the velocity of that point.
    pub(super) velocity: Vector,
    /// w, the angular velocity.
    pub(super) turn: Vector,
    pub(super) off: Real,
    /// e.
    pub(super) turn_off: Real,
}

/// Returns a product of numbers that are at least 0; it is 0 for the factor 0, even if the other
/// number is infinite, which then need not be known.
pub(super) fn product(factor: Real, other: impl FnOnce() -> Real) -> Real {
    if factor == 0.0 { 0.0 } else { factor * other() }
}

/// Covers fewer than 64 roundings of positive terms.
pub(super) const UP: Real = 1.0 + 64.0 * Real::UNIT_ROUNDOFF;

impl CommonFrame {
    /// The frame at rest.
    pub(crate) const REST: Self = Self {
        at: Vector::ZERO,
        velocity: Vector::ZERO,
        turn: Vector::ZERO,
        off: 0.0,
        turn_off: 0.0,
    };

    /// Builds the frame that is at the first pose at the first time and at the second pose at the
    /// last time, in the mesh's frame.
    ///
    /// Its origin moves straight at constant speed, and it turns at constant speed about one axis
    /// by the smaller angle, as in a [`RigidMotion`](crate::RigidMotion).
    ///
    /// # Errors
    /// A pose is not finite or out of range, or its quaternion is not of unit length.
    pub fn between(poses: [Pose; 2], times: [Real; 2]) -> Result<Self, RobotError> {
        let path = RigidPath::new(poses)?;
        let duration = times[1] - times[0];
        // Without time nothing moves.
        let rate = if duration > 0.0 { 1.0 / duration } else { 0.0 };
        Ok(Self { at: path.pose(0.5).translation, ..Self::of_path(&path, 0.5).sped_up(rate) })
    }

    /// Builds the frame that moves without turning, at a constant velocity per unit of the motion's
    /// time.
    pub fn shifting(velocity: Vector) -> Self {
        Self { velocity, ..Self::REST }
    }

    /// The frame of a path around a time, per unit of the path's time.
    pub(super) fn of_path(path: &RigidPath, t: Real) -> Self {
        let (velocity, turn) = path.velocities();
        Self { at: path.pose(t).translation, velocity, turn, ..Self::REST }
    }

    /// The same frame if time passes faster by a factor.
    pub(super) fn sped_up(self, rate: Real) -> Self {
        Self {
            velocity: self.velocity * rate,
            turn: self.turn * rate,
            off: self.off * rate * UP,
            turn_off: self.turn_off * rate * UP,
            ..self
        }
    }

    /// The same frame if the time errs by this much.
    pub(super) fn at_unsure_time(self, unsure: Real) -> Self {
        let more = length(self.turn) * length(self.velocity) * unsure;
        Self { off: self.off + more * UP, ..self }
    }

    /// This frame, which carries a robot in the frame of a base, in the frame in which the base
    /// moves. `pose`: the base in the middle of the interval. `half`: half of the interval. `None`
    /// if the interval is so long that this frame is not known better than its own speed.
    pub(super) fn on_base(self, base: &Self, pose: &Pose, half: Real) -> Option<Self> {
        let at = if self.is_shift() { Vector::ZERO } else { self.at };
        let lever = pose.rotation * at;
        let [turning, speed] = [base.turn, self.velocity].map(length);
        let carried = base.turn.cross(lever);
        let own = if turning > 0.0 {
            half * turning * (length(carried) + turning * half * speed + 2.0 * speed) * UP
        } else {
            0.0
        };
        let inner = pose.rotation * self.turn;
        let rounding = 16.0 * Real::UNIT_ROUNDOFF * turning * length(inner);
        let twist = (length(base.turn.cross(inner)) + rounding) * half * UP;
        let spins = length(inner);
        if twist > 0.5 * spins || own > 0.5 * (speed + spins * length(at)) {
            return None;
        }
        let turn = base.turn + inner;
        let turn_off = self.turn_off + twist;
        let off = self.off + own + (length(turn) + turn_off + twist) * half * own * UP;
        let velocity = base.velocity + carried + pose.rotation * self.velocity;
        let frame = Self { at: pose.translation + lever, velocity, turn, off, turn_off };
        Some(frame.rounded(pose))
    }

    /// Whether the frame does not turn.
    pub(super) fn is_shift(&self) -> bool {
        self.turn == Vector::ZERO && self.turn_off == 0.0
    }

    /// This frame in another frame at rest, into which `pose` leads.
    #[cfg(feature = "robots")]
    pub(crate) fn seen_from(self, pose: &Pose) -> Self {
        Self {
            at: pose * self.at,
            velocity: pose.rotation * self.velocity,
            turn: pose.rotation * self.turn,
            ..self
        }
        .rounded(pose)
    }

    /// Adds the rounding of the field after a pose.
    fn rounded(self, pose: &Pose) -> Self {
        let reach = self.at.abs().max(pose.translation.abs()).max_element();
        let [speed, turning] = [self.velocity, self.turn].map(length);
        let rounding = 64.0 * Real::UNIT_ROUNDOFF;
        Self {
            off: self.off + rounding * (speed + turning * reach),
            turn_off: self.turn_off + rounding * turning,
            ..self
        }
    }

    /// Returns how the field F moves points during the whole interval, of the length `duration`:
    /// the rotation, and the centre before and after it.
    pub(super) fn carries(&self, duration: Real) -> (Rotation, [Vector; 2]) {
        let half = self.velocity * (0.5 * duration);
        (rotation_by(self.turn * duration).normalize(), [self.at - half, self.at + half])
    }

    /// Returns a bound on the speed relative to the field F of a point that is at `point` at first
    /// (claim 1), and on its turn.
    pub(super) fn stray(&self, point: Vector, duration: Real, stated: Speed) -> Speed {
        let away = (point - self.at).length() + length(self.velocity) * duration;
        let own = stated.point + self.off;
        let is_bounded = 2.0 * duration * self.turn_off <= 1.0;
        let twist = product(2.0 * self.turn_off, || {
            if is_bounded { away + duration * own } else { Real::INFINITY }
        });
        Speed { point: own + twist, turn: stated.turn + self.turn_off }
    }

    /// The sizes of the frame's vectors.
    pub(super) fn sizes(&self) -> FrameSizes {
        FrameSizes {
            speed: length(self.velocity),
            turning: length(self.turn),
            reach: self.at.abs().max_element(),
        }
    }

    /// F at a point in the middle of the interval.
    pub(super) fn field(&self, point: Vector) -> Vector {
        self.velocity + self.turn.cross(point - self.at)
    }
}

/// The sizes of the vectors of a frame.
#[derive(Clone, Copy)]
pub(super) struct FrameSizes {
    /// |v|.
    pub speed: Real,
    /// |w|.
    pub turning: Real,
    /// The largest coordinate of a.
    reach: Real,
}

impl FrameSizes {
    /// Returns `|v| + |w| reach`, the size of the terms of the field at points whose coordinates
    /// are at most `reach`.
    pub(super) fn rounding(self, reach: Real) -> Real {
        self.speed + self.turning * (reach + self.reach)
    }
}
