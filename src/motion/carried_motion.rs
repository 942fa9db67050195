//! The speeds of a robot's points relative to its own frame and to another one, from the speeds in
//! a frame that carries the robot.
//!
//! Symbols and claim 1 are in [`common_frame`](super::common_frame).
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

use super::common_frame::{CommonFrame, FrameSizes, UP, product};
use super::rigid_path::RigidPath;
use super::{Motion, Speed};
use crate::curve::{Section, Tube};
use crate::distance::Scalar;
use crate::robot::length;
use parry3d_f64::math::{Pose, Real, Vector};

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
    /// The piece between two shares of a section of a tube at a pose. `has_rim`: whether the turn
    /// of its discs matters. Otherwise its directions are not computed.
    pub(crate) fn new(
        tube: &Tube,
        pose: &Pose,
        section: &Section,
        shares: [Real; 2],
        has_rim: bool,
    ) -> Self {
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
            directions: if has_rim {
                [0, 1].map(|end| pose.rotation * ends[end].direction)
            } else {
                [Vector::ZERO; 2]
            },
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

    /// The largest `|turn x tangent|`; `size` is `|turn|`.
    fn across(&self, turn: Vector, size: Real) -> Real {
        if self.directions.contains(&Vector::ZERO) {
            return size;
        }
        let [start, end] = self.directions.map(|direction| length(turn.cross(direction)));
        // Without a direction the tilt is infinite or NaN.
        let across = start.max(end) + size * self.bend;
        if across < size { across } else { size }
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

    /// Returns the frame beside another one.
    pub(crate) fn beside(&self, other: &CommonFrame) -> FramePair {
        FramePair::new([self.frame(), *other], self.half)
    }

    /// Bounds the speeds of a piece relative to its own frame and to another one. `stated` is the
    /// stated speed of the piece. Two frames that do not turn need no `piece`.
    pub(crate) fn speeds(
        &self,
        stated: Speed,
        piece: impl FnOnce() -> CarriedPiece,
        other: &CommonFrame,
    ) -> CarriedSpeed {
        self.beside(other).speeds(stated, piece)
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
        let piece = || CarriedPiece::new(tube, pose, part, shares, true);
        self.speeds(stated, piece, &CommonFrame::REST).seen
    }
}

/// The frame that carries a robot and another frame, in an interval of time, with the terms of
/// claims 1 and 2 that are the same for all pieces.
#[derive(Clone, Copy)]
pub(crate) struct FramePair {
    frame: CommonFrame,
    other: CommonFrame,
    /// Half of the interval, rounded up.
    half: Real,
    sizes: [FrameSizes; 2],
    /// |v - v'|.
    between: Real,
    /// |w - w'|.
    relative_turn: Real,
    /// |w' x (v - v')|.
    rate: Real,
}

impl FramePair {
    fn new([frame, other]: [CommonFrame; 2], half: Real) -> Self {
        let between = frame.velocity - other.velocity;
        Self {
            frame,
            other,
            half,
            sizes: [frame.sizes(), other.sizes()],
            between: length(between),
            relative_turn: length(frame.turn - other.turn),
            rate: other.turn.cross(between).length(),
        }
    }

    /// Bounds the speeds of a piece relative to its own frame and to the other one (claims 1 and
    /// 2). `stated` is the stated speed of the piece. Two frames that do not turn need no `piece`.
    pub(crate) fn speeds(
        &self,
        stated: Speed,
        piece: impl FnOnce() -> CarriedPiece,
    ) -> CarriedSpeed {
        let Self { frame, other, half, sizes, between, relative_turn, .. } = *self;
        if frame.is_shift() && other.is_shift() {
            let own = stated.point + frame.off;
            let rounding = sizes[0].speed + sizes[1].speed;
            let difference = between + other.off + 64.0 * Real::UNIT_ROUNDOFF * rounding;
            return CarriedSpeed {
                own: Speed { point: own * UP, turn: stated.turn * UP },
                seen: Speed { point: (own + difference) * UP, turn: stated.turn * UP },
            };
        }
        let piece = &piece();
        // Claim 1: `away` is D0, `own` U, `carried` g.
        let turning = sizes[0].turning;
        let twist = product(2.0 * frame.turn_off, || {
            let away = piece.most(1.0, |point| point - frame.at);
            away + half * (stated.point + frame.off)
        });
        let own = stated.point + frame.off + twist;
        let carried = if turning == 0.0 {
            0.0
        } else {
            piece.most(turning, |point| frame.turn.cross(point - frame.at)) + half * turning * own
        };
        // Claim 2: `difference` is |F - G|.
        let mut rate = self.rate;
        if relative_turn > 0.0 {
            rate += relative_turn * (carried + own);
        }
        let mut difference =
            piece.most(relative_turn, |point| frame.field(point) - other.field(point));
        difference += half * rate;
        if other.turn == Vector::ZERO {
            difference = difference.min(between + carried);
        }
        let other_off = other.off
            + product(other.turn_off, || {
                let moved = half * (own + carried + (sizes[0].speed + sizes[1].speed));
                piece.most(1.0, |point| point - other.at) + moved
            });
        let [rounding, other_rounding] = sizes.map(|sizes| sizes.rounding(piece.reach));
        let difference =
            difference + other_off + 64.0 * Real::UNIT_ROUNDOFF * (rounding + other_rounding);
        // Directions.
        let turn = stated.turn + frame.turn_off;
        let twisted = if relative_turn == 0.0 {
            0.0
        } else {
            let still = if other.turn == Vector::ZERO { 0.0 } else { turning };
            let change = half * relative_turn * (still + turn);
            (piece.across(frame.turn - other.turn, relative_turn) + change).min(relative_turn)
        };
        let twisted =
            twisted + other.turn_off + 64.0 * Real::UNIT_ROUNDOFF * (turning + sizes[1].turning);
        CarriedSpeed {
            own: Speed { point: own * UP, turn: turn * UP },
            seen: Speed { point: (own + difference) * UP, turn: (turn + twisted) * UP },
        }
    }
}
