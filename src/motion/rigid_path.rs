//! A frame that moves from one pose to another, and how fast it carries a curve.
//!
//! # Definitions
//! The frame turns at constant speed about an axis a that is fixed in it, by the angle w in total.
//! Its origin moves straight by v.
//!
//! # Speed
//! A point p of the frame has the velocity `v + w R (a x p)`, at most `|v| + w |a x p|`. No
//! direction turns faster than w. `|a x p|`, the distance from the axis, is a convex function of p.
//! A piece of the centreline is within `k l^2 / 8` of its chord, and on the chord the larger of the
//! two ends' distances counts.
//!
//! # Displacement
//! The acceleration is `w^2` times the distance from the axis. From one time to another, T apart,
//! the point moves by `v T + (R' - R) p`, which is linear in p, and `R' - R` turns by at most
//! `w T`. So the distance of p from the chord adds at most `w T` times itself.

use super::{DisplacementBound, Speed};
use crate::curve::{CurveBound, Section, Tube};
use crate::distance::Scalar;
use crate::robot::{COORDINATE_LIMIT, NotRigid, RobotError, length, rigid, rotation_by};
use parry3d_f64::math::{Pose, Real, Rotation, Vector};

/// A moving frame.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RigidPath {
    from: Pose,
    /// v: the displacement of the origin.
    shift: Vector,
    /// The axis a, in the frame, times the angle w.
    turn: Vector,
}

impl RigidPath {
    /// Builds the path from one pose to another.
    ///
    /// # Errors
    /// A pose is not finite or out of range, or its quaternion is not of unit length.
    pub(crate) fn new([from, to]: [Pose; 2]) -> Result<Self, RobotError> {
        let (from, to) = (rigid_pose("from", &from)?, rigid_pose("to", &to)?);
        let way = (from.rotation.inverse() * to.rotation).normalize();
        let way = if way.w < 0.0 { -way } else { way };
        Ok(Self { from, shift: to.translation - from.translation, turn: scaled_axis(way) })
    }

    /// Returns the part of a speed bound that is due to turning.
    pub(super) fn of_turning(&self, point: Real) -> Real {
        (point * UP - length(self.shift)).max(0.0)
    }

    /// Returns the pose at a time.
    pub(crate) fn pose(&self, t: Real) -> Pose {
        let rotation = self.from.rotation * rotation_by(self.turn * t);
        Pose::from_parts(self.from.translation + self.shift * t, rotation.normalize())
    }

    /// Returns v, and the angular velocity in the frame in which the path moves.
    pub(super) fn velocities(&self) -> (Vector, Vector) {
        (self.shift, self.from.rotation * self.turn)
    }

    /// Returns an upper bound on w.
    pub(crate) fn angle(&self) -> Real {
        length(self.turn) * UP
    }

    /// Returns the displacement bound of a piece of a tube at rest in the frame.
    pub(super) fn displacement(
        &self,
        tube: &Tube,
        section: usize,
        shares: [Real; 2],
        times: [Real; 2],
    ) -> Option<DisplacementBound> {
        let number = section;
        let section = tube.sections().get(number)?;
        let apart = times[1] - times[0];
        let ends = shares.map(|share| tube.at_share(section, share).point);
        let [here, there] = times.map(|t| {
            let pose = self.pose(t);
            ends.map(|end| pose * end)
        });
        let turn = self.angle() * apart;
        let turning = self.of_turning(self.speed(tube, &Pose::IDENTITY, number, shares).point);
        let beside = Self::beside(tube, section, shares);
        let places = here.into_iter().chain(there);
        let reach =
            places.fold(2.0 * tube.reach(), |most: Real, p| most.max(p.abs().max_element()));
        let rounding = 64.0 * Real::UNIT_ROUNDOFF * reach;
        let off = (0.125 * turn * turning * apart + turn * beside + rounding) * UP;
        Some(DisplacementBound::between(here, there, off))
    }

    /// Returns the largest distance of a point of a piece from the interpolation between the
    /// piece's ends at the same share.
    pub(super) fn beside(tube: &Tube, section: &Section, shares: [Real; 2]) -> Real {
        let off = shares.map(|share| tube.at_share(section, share).off);
        let known = tube.bound(section, tube.ticks_around(section, shares));
        Self::beside_of(tube, section, shares, off, &known)
    }

    /// As [`beside`](Self::beside), from the errors of the ends and a bound on the piece.
    pub(super) fn beside_of(
        tube: &Tube,
        section: &Section,
        shares: [Real; 2],
        off: [Real; 2],
        known: &CurveBound,
    ) -> Real {
        let length = (section.end - section.start) * section.stretch * (shares[1] - shares[0]);
        // The errors of the ends between samples, and of the curve.
        let beside = off[0].max(off[1]).max(known.off);
        // Samples may divide a section differently from its arc length.
        let uneven = 2.0 * (section.stretch - 1.0) * length;
        0.125 * known.curvature * length * length + beside + uneven + tube.error()
    }

    /// Returns the speed bound of a piece of a tube at rest in the frame, at a pose there.
    pub(super) fn speed(
        &self,
        tube: &Tube,
        pose: &Pose,
        section: usize,
        shares: [Real; 2],
    ) -> Speed {
        let angle = self.angle();
        let Some(section) = tube.sections().get(section) else {
            return Speed { point: 0.0, turn: 0.0 };
        };
        let ends = shares.map(|share| tube.at_share(section, share));
        let [a, b] = ends.map(|end| length(self.turn.cross(*pose * end.point)));
        let off = Self::beside(tube, section, shares);
        let reach = pose.translation.abs().max_element() + 2.0 * tube.reach();
        let rounding = 32.0 * Real::UNIT_ROUNDOFF * reach;
        Speed {
            point: (length(self.shift) + a.max(b) + angle * (off + rounding)) * UP,
            turn: angle,
        }
    }
}

/// Covers fewer than 32 roundings, each of a number no larger than the terms that are added.
const UP: Real = 1.0 + 32.0 * Real::UNIT_ROUNDOFF;

/// Returns the axis of a rotation times its angle, for angles up to pi. (`to_scaled_axis` treats
/// angles below 2e-8 as zero.)
fn scaled_axis(rotation: Rotation) -> Vector {
    let half = Vector::new(rotation.x, rotation.y, rotation.z);
    let sine = half.length();
    // `half` is the sine of half the angle. For tiny angles, whose sine's square underflows, twice
    // the sine is the angle.
    half * if sine > 0.0 { 2.0 * libm::atan2(sine, rotation.w) / sine } else { 2.0 }
}

/// Returns a motion's pose with a rotation of unit length, if it is finite, in range and rigid.
pub(super) fn rigid_pose(parameter: &'static str, pose: &Pose) -> Result<Pose, RobotError> {
    // A finite rotation may still be too long; `rigid` reports that.
    let is_out = |place: &Real| !place.is_finite() || place.abs() > COORDINATE_LIMIT;
    let places = pose.translation.to_array().into_iter().filter(is_out);
    let parts = pose.rotation.to_array().into_iter().filter(|part| !part.is_finite());
    if let Some(value) = places.chain(parts).next() {
        return Err(RobotError::BadPose { parameter, value, limit: COORDINATE_LIMIT });
    }
    rigid(pose).map_err(|NotRigid { length }| RobotError::PoseNotRigid { parameter, length })
}
