//! Poses that keep lengths, and rotations that are the same on every machine.
//!
//! A rotation by the quaternion q multiplies lengths by |q|^2. So a pose with another length of q
//! is no rigid motion. What rounding leaves is made good: a unit quaternion in single precision
//! whose four numbers are rounded is off by 2^-24 of its length at most, and one that comes out of
//! a few products in single precision by some times that. Up to 2^-20 counts as rounding, and q is
//! made a unit; beyond that nobody knows what was meant, and the pose is refused. Chains, tubes and
//! motions are placed by the same rule.

use crate::distance::Scalar;
use crate::robot::scale::length;
use parry3d_f64::math::{Pose, Real, Rotation, Vector};

/// Rounding of single precision: 2^-20.
const MAX_OFF: Real = Real::from_bits((1023 - 20) << 52);

/// A rotation whose quaternion has another length than 1.
#[derive(Clone, Copy, Debug)]
pub(crate) struct NotRigid {
    pub length: Real,
}

/// The pose with a rotation of unit length; as it is, if it has that but for the rounding of a few
/// operations.
///
/// # Errors
/// The length of its quaternion is not 1 even in single precision, or NaN.
#[inline]
pub(crate) fn rigid(pose: &Pose) -> Result<Pose, NotRigid> {
    // The square of a length near 1; one that leaves the range of numbers is not near 1 either.
    let off = (pose.rotation.length_squared() - 1.0).abs();
    if off <= 8.0 * Real::UNIT_ROUNDOFF {
        return Ok(*pose);
    }
    // (1 + x)^2 = 1 + 2 x + x^2. Written so that NaN is refused.
    if off <= 2.0 * MAX_OFF {
        return Ok(Pose::from_parts(pose.translation, pose.rotation.normalize()));
    }
    Err(NotRigid { length: quaternion_length(pose.rotation) })
}

/// Without overflow and underflow.
fn quaternion_length(q: Rotation) -> Real {
    let across = length(Vector::new(q.x, q.y, q.z));
    length(Vector::new(across, q.w, 0.0))
}

/// The rotation about an axis by its length. The same to the last bit on every machine, as sines of
/// the standard library are not.
pub(crate) fn rotation_by(turn: Vector) -> Rotation {
    let half = 0.5 * length(turn);
    // Half of the sine's argument, where the sine's square vanishes.
    let share = if half > 0.0 { 0.5 * (libm::sin(half) / half) } else { 0.5 };
    let axis = turn * share;
    Rotation::from_xyzw(axis.x, axis.y, axis.z, libm::cos(half))
}
