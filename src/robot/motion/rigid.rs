//! A tube that keeps its shape and moves.
//!
//! The pose turns evenly about an axis a that is fixed in the robot, by the angle w in all, while the robot's origin moves
//! evenly by v. The point p of the robot then moves at v + w R(a x p), at most |v| + w |a x p| fast, and no direction
//! turns faster than w. |a x p|, the distance from the axis, is a convex function of p; a piece of the centreline is
//! within k l^2 / 8 of its chord, where the larger of the chord's two ends counts.

use super::{Motion, Speed, rigid_pose};
use crate::distance::Scalar;
use crate::robot::rigid_pose::rotation_by;
use crate::robot::{RobotError, Tube};
use parry3d_f64::math::{Pose, Real, Rotation, Vector};

/// The motion of a tube that does not change its shape, evenly from one pose to another.
///
/// The robot's origin moves straight and evenly while the robot turns evenly about one axis by the lesser angle. Poses
/// are the tube's in the mesh's frame.
///
/// ```
/// use parry_continuum::{Chain, RigidMotion, Tube, verify_motion};
/// use parry_continuum::parry::math::{Pose, Vector};
///
/// let needle = Chain::capsules(&[Vector::ZERO, 40.0 * Vector::Z], &[0.5])?;
/// let motion = RigidMotion::new(Tube::from(&needle), [Pose::IDENTITY, Pose::new(Vector::Z, Vector::X * 0.3)])?;
/// verify_motion(&motion, 100)?;
/// # Ok::<(), parry_continuum::RobotError>(())
/// ```
#[derive(Clone, Debug)]
pub struct RigidMotion {
    tube: Tube,
    from: Pose,
    /// By how much the origin moves.
    shift: Vector,
    /// The axis in the robot's frame, times the angle.
    turn: Vector,
}

impl RigidMotion {
    /// The motion of `tube` from the first pose to the second.
    ///
    /// # Errors
    /// A pose is not finite or out of range, or its rotation is not of unit length.
    pub fn new(tube: Tube, [from, to]: [Pose; 2]) -> Result<Self, RobotError> {
        let (from, to) = (rigid_pose("from", &from)?, rigid_pose("to", &to)?);
        let way = (from.rotation.inverse() * to.rotation).normalize();
        let way = if way.w < 0.0 { -way } else { way };
        let shift = to.translation - from.translation;
        Ok(Self { tube, from, shift, turn: scaled_axis(way) })
    }
}

/// The axis of a rotation by half a turn or less, times its angle. (`to_scaled_axis` takes angles below 2e-8 for none.)
fn scaled_axis(rotation: Rotation) -> Vector {
    let half = Vector::new(rotation.x, rotation.y, rotation.z);
    let sine = half.length();
    // The sine of half of the angle, which is as long as the angle where its square vanishes.
    half * if sine > 0.0 { 2.0 * libm::atan2(sine, rotation.w) / sine } else { 2.0 }
}

impl Motion for RigidMotion {
    fn shape(&self, t: Real, tube: &mut Tube) -> Result<Pose, RobotError> {
        tube.clone_from(&self.tube);
        let rotation = self.from.rotation * rotation_by(self.turn * t);
        Ok(Pose::from_parts(self.from.translation + self.shift * t, rotation.normalize()))
    }

    fn speed(&self, section: usize, shares: [Real; 2], _times: [Real; 2]) -> Speed {
        // Fewer than 32 roundings, each of a number no larger than those that are added up here.
        let up = 1.0 + 32.0 * Real::UNIT_ROUNDOFF;
        let angle = self.turn.length() * up;
        let Some(section) = self.tube.sections().get(section) else { return Speed { point: 0.0, turn: 0.0 } };
        let ends = shares.map(|share| self.tube.at_share(section, share));
        let [a, b] = ends.map(|end| self.turn.cross(end.point).length());
        let known = self.tube.bound(section, self.tube.ticks_around(section, shares));
        let length = (section.end - section.start) * section.stretch * (shares[1] - shares[0]);
        // The ends are between samples, and the curve beside them.
        let beside = ends[0].off.max(ends[1].off).max(known.off);
        let off = 0.125 * known.curvature * length * length + beside + self.tube.error();
        let rounding = 32.0 * Real::UNIT_ROUNDOFF * self.tube.reach();
        Speed { point: (self.shift.length() + a.max(b) + angle * (off + rounding)) * up, turn: angle * up }
    }
}
