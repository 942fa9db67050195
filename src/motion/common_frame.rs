//! A rigid frame that carries a whole robot for an interval of time, and the speeds that it gives
//! the robot's points.
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
//! # Claim 2
//! Let G be the field of another frame, with v', w', a'. In the interval `|F(p) - G(p)|` is at most
//! its value at T = 0 plus h times `|w - w'| (g + U) + |w' x (v - v')|`. If w' = 0 it is also at
//! most `|v - v'| + g`.
//!
//! **Proof.** The rate of F(p) - G(p) is `w x (p' - v) - w' x (p' - v')`, which is
//! `(w - w') x (p' - v) - w' x (v - v')`; and `|p' - v| <= g + U`.
//!
//! # Claim 3
//! Two points p and q, carried by F and G, come nearer at most at the rate
//! `U + U' + |F(p) - G(p)|`.
//! **Proof.** `F(p) + d - G(q) - d'` is `F(p) - G(p) + G(p) - G(q) + d - d'`, and `G(p) - G(q)` is
//! perpendicular to `p - q`. So what moves together comes no nearer.
//!
//! # Directions
//! A disc moves with its centre and with the tangent t, and may spin about t at any rate. Seen from
//! G, the tangent turns at most at the rate `turn + |(w - w') x t|`, where `turn` bounds its turn
//! relative to F. `|w x t|` changes at most at the rate `|w| turn`, because the frame's own turn
//! keeps it. If w' differs from 0, `|(w - w') x t|` changes at most at the rate
//! `|w - w'| (|w| + turn)`, and is at most `|w - w'|`.
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

use super::rigid::RigidPath;
use super::{Motion, Speed};
use crate::curve::{Section, Tube};
use crate::distance::Scalar;
use crate::robot::{RobotError, length, rotation_by};
use parry3d_f64::math::{Pose, Real, Rotation, Vector};

/// A rigid frame that carries a robot for an interval of time: [`Motion::common_frame`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CommonFrame {
    /// a: the place in the middle of the interval of the point that moves straight.
    at: Vector,
    /// v, the velocity of that point.
    velocity: Vector,
    /// w, the angular velocity.
    turn: Vector,
    off: Real,
    /// e.
    turn_off: Real,
}

/// Covers fewer than 64 roundings of positive terms.
const UP: Real = 1.0 + 64.0 * Real::UNIT_ROUNDOFF;

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
        let apart = times[1] - times[0];
        // Without time nothing moves.
        let rate = if apart > 0.0 { 1.0 / apart } else { 0.0 };
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
    fn is_shift(&self) -> bool {
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

    /// Returns how the field F moves points during the whole interval, of the length `apart`: the
    /// rotation, and the centre before and after it.
    pub(super) fn carries(&self, apart: Real) -> (Rotation, [Vector; 2]) {
        let half = self.velocity * (0.5 * apart);
        (rotation_by(self.turn * apart).normalize(), [self.at - half, self.at + half])
    }

    /// Returns a bound on the speed relative to the field F of a point that is at `point` at first
    /// (claim 1), and on its turn.
    pub(super) fn stray(&self, point: Vector, apart: Real, stated: Speed) -> Speed {
        let away = (point - self.at).length() + length(self.velocity) * apart;
        let own = stated.point + self.off;
        let twist = if self.turn_off == 0.0 {
            0.0
        } else if 2.0 * apart * self.turn_off <= 1.0 {
            2.0 * self.turn_off * (away + apart * own)
        } else {
            Real::INFINITY
        };
        Speed { point: own + twist, turn: stated.turn + self.turn_off }
    }

    /// The largest coordinate of a, and the terms of the rounding of the field.
    fn rounding(&self, reach: Real) -> Real {
        length(self.velocity) + length(self.turn) * (reach + self.at.abs().max_element())
    }

    /// F at a point in the middle of the interval.
    fn field(&self, point: Vector) -> Vector {
        self.velocity + self.turn.cross(point - self.at)
    }
}

/// A piece of a centreline in the middle of an interval, in the mesh's frame.
#[derive(Clone, Copy, Debug)]
pub(crate) struct CarriedPiece {
    ends: [Vector; 2],
    /// The largest distance of its points from the chord, and a bound on their rounding.
    beside: Real,
    directions: [Vector; 2],
    /// The largest angle of a tangent to the nearer one of the directions.
    bend: Real,
    reach: Real,
}

impl CarriedPiece {
    /// The piece between two shares of a section of a tube at a pose.
    pub(crate) fn new(tube: &Tube, pose: &Pose, section: &Section, shares: [Real; 2]) -> Self {
        let ends = shares.map(|share| tube.at_share(section, share));
        let known = tube.bound(section, tube.ticks_around(section, shares));
        let long = (section.end - section.start) * section.stretch * (shares[1] - shares[0]);
        let reach = pose.translation.abs().max_element() + 2.0 * tube.reach();
        let rounding = 32.0 * Real::UNIT_ROUNDOFF;
        let is_link = section.last - section.first == 1;
        let turned = if is_link { rounding * reach / (section.end - section.start) } else { 0.0 };
        let tilt = ends[0].tilt.max(ends[1].tilt) + tube.turn().unwrap_or(0.0) + turned + rounding;
        Self {
            ends: [0, 1].map(|end| *pose * ends[end].point),
            beside: RigidPath::beside_of(tube, section, shares, ends.map(|end| end.off), &known)
                + rounding * reach,
            directions: [0, 1].map(|end| pose.rotation * ends[end].direction),
            bend: 0.5 * known.curvature * long + tilt,
            reach,
        }
    }

    /// The largest value of a length that is linear in the point and changes by at most `slope` per
    /// unit of length.
    fn most(&self, slope: Real, value: impl Fn(Vector) -> Vector) -> Real {
        let [start, end] = self.ends.map(|end| length(value(end)));
        start.max(end) + slope * self.beside
    }

    /// The largest `|turn x tangent|`.
    fn across(&self, turn: Vector) -> Real {
        let size = length(turn);
        let [start, end] = self.directions.map(|direction| length(turn.cross(direction)));
        // Without a direction the tilt is infinite or NaN.
        let across = start.max(end) + size * self.bend;
        if across < size && self.directions.iter().all(|way| *way != Vector::ZERO) {
            across
        } else {
            size
        }
    }
}

/// A motion in an interval of time, and its frame if it states one.
#[derive(Clone, Copy)]
pub(crate) struct CarriedMotion<'a> {
    pub motion: &'a dyn Motion,
    pub times: [Real; 2],
    /// Half of the interval, rounded up.
    pub half: Real,
    frame: Option<CommonFrame>,
}

/// The speeds of a piece relative to another frame.
#[derive(Clone, Copy, Debug)]
pub(crate) struct CarriedSpeed {
    /// U: relative to its own frame.
    #[cfg_attr(not(feature = "robots"), expect(dead_code, reason = "pairs alone need it"))]
    pub own: Speed,
    /// Relative to the other frame.
    pub seen: Speed,
}

impl<'a> CarriedMotion<'a> {
    pub(crate) fn new(motion: &'a dyn Motion, times: [Real; 2], half: Real) -> Self {
        // Claim 1 bounds no speed in a frame that is known less well.
        let is_known = |frame: &CommonFrame| half * frame.turn_off <= 0.5;
        Self { motion, times, half, frame: motion.common_frame(times).filter(is_known) }
    }

    /// Whether the motion states a frame.
    pub(crate) fn has_frame(&self) -> bool {
        self.frame.is_some()
    }

    /// Whether the stated speeds are relative to the field F itself.
    #[cfg(feature = "robots")]
    pub(crate) fn is_exact(&self) -> bool {
        self.frame.is_none_or(|frame| frame.off == 0.0 && frame.turn_off == 0.0)
    }

    /// An upper bound on the angular speed of the frame.
    pub(crate) fn turning(&self) -> Real {
        self.frame.map_or(0.0, |frame| (length(frame.turn) + frame.turn_off) * UP)
    }

    /// Upper bounds on the angular speeds of the frames of two robots, seen from the frame in which
    /// their sum is least: the frame at rest, or that of the first robot.
    #[cfg(feature = "robots")]
    pub(crate) fn least_turning(motions: &[Self; 2]) -> [Real; 2] {
        let at_rest = motions.each_ref().map(Self::turning);
        let [first, second] = motions.each_ref().map(Self::frame);
        let beside = (length(first.turn - second.turn) + first.turn_off + second.turn_off) * UP;
        if beside < at_rest[0] + at_rest[1] { [0.0, beside] } else { at_rest }
    }

    /// The frame; without one the frame at rest.
    pub(crate) fn frame(&self) -> CommonFrame {
        self.frame.unwrap_or(CommonFrame::REST)
    }

    /// The stated speed of a piece relative to the frame.
    pub(crate) fn stated(&self, section: usize, shares: [Real; 2]) -> Speed {
        if self.has_frame() {
            self.motion.speed_in_frame(section, shares, self.times)
        } else {
            self.motion.speed(section, shares, self.times)
        }
    }

    /// Bounds the speeds of a piece relative to its own frame and to another one (claims 1 and 2).
    /// `stated` is the stated speed of the piece. Two frames that do not turn need no `piece`.
    pub(crate) fn speeds(
        &self,
        stated: Speed,
        piece: impl FnOnce() -> CarriedPiece,
        other: &CommonFrame,
    ) -> CarriedSpeed {
        let (frame, half) = (self.frame(), self.half);
        if frame.is_shift() && other.is_shift() {
            let own = stated.point + frame.off;
            let rounding = length(frame.velocity) + length(other.velocity);
            let apart = length(frame.velocity - other.velocity)
                + other.off
                + 64.0 * Real::UNIT_ROUNDOFF * rounding;
            return CarriedSpeed {
                own: Speed { point: own * UP, turn: stated.turn * UP },
                seen: Speed { point: (own + apart) * UP, turn: stated.turn * UP },
            };
        }
        let piece = &piece();
        // Claim 1: `away` is D0, `own` U, `carried` g.
        let [turning, beside] = [frame.turn, frame.turn - other.turn].map(length);
        let away = piece.most(1.0, |point| point - frame.at);
        let twist = if frame.turn_off == 0.0 {
            0.0
        } else {
            2.0 * frame.turn_off * (away + half * (stated.point + frame.off))
        };
        let own = stated.point + frame.off + twist;
        let carried = if turning == 0.0 {
            0.0
        } else {
            piece.most(turning, |point| frame.turn.cross(point - frame.at)) + half * turning * own
        };
        // Claim 2: `between` is v - v', `beside` |w - w'|, `apart` |F - G|.
        let between = frame.velocity - other.velocity;
        let mut rate = other.turn.cross(between).length();
        if beside > 0.0 {
            rate += beside * (carried + own);
        }
        let mut apart = piece.most(beside, |point| frame.field(point) - other.field(point));
        apart += half * rate;
        if other.turn == Vector::ZERO {
            apart = apart.min(length(between) + carried);
        }
        let other_off = if other.turn_off == 0.0 {
            other.off
        } else {
            let moved = half * (own + carried + length(frame.velocity) + length(other.velocity));
            other.off + other.turn_off * (piece.most(1.0, |point| point - other.at) + moved)
        };
        let rounding = frame.rounding(piece.reach) + other.rounding(piece.reach);
        let apart = apart + other_off + 64.0 * Real::UNIT_ROUNDOFF * rounding;
        // Directions.
        let turn = stated.turn + frame.turn_off;
        let twisted = if beside == 0.0 {
            0.0
        } else {
            let still = if other.turn == Vector::ZERO { 0.0 } else { turning };
            let change = half * beside * (still + turn);
            (piece.across(frame.turn - other.turn) + change).min(beside)
        };
        let twisted =
            twisted + other.turn_off + 64.0 * Real::UNIT_ROUNDOFF * (turning + length(other.turn));
        CarriedSpeed {
            own: Speed { point: own * UP, turn: turn * UP },
            seen: Speed { point: (own + apart) * UP, turn: (turn + twisted) * UP },
        }
    }

    /// Bounds the speed of a piece of the middle shape in the mesh's frame.
    pub(crate) fn speed(
        &self,
        (tube, pose): (&Tube, &Pose),
        section: usize,
        shares: [Real; 2],
    ) -> Speed {
        let stated = self.stated(section, shares);
        let Some(part) = tube.sections().get(section).filter(|_| self.has_frame()) else {
            return stated;
        };
        let piece = || CarriedPiece::new(tube, pose, part, shares);
        self.speeds(stated, piece, &CommonFrame::REST).seen
    }
}
