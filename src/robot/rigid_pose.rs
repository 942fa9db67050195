//! Poses that keep lengths, and rotations that are equal on every machine.
//!
//! A rotation by the quaternion q multiplies lengths by `|q|^2`, so it is rigid only if `|q| = 1`.
//!
//! # Rounding
//! A unit quaternion rounded to single precision is off unit length by at most 2^-24. A product of
//! a few such quaternions is off by a small multiple. So a deviation up to 2^-20 counts as rounding
//! and q is normalised. A larger deviation has no clear meaning and is refused. Chains, tubes and
//! motions all use this rule.

use crate::distance::Scalar;
use crate::robot::scale::length;
use parry3d_f64::math::{Pose, Real, Rotation, Vector};

/// Largest deviation of `|q|` from 1 that counts as rounding of single precision: 2^-20.
const MAX_OFF: Real = Real::from_bits((1023 - 20) << 52);

/// The error for a quaternion whose length is not 1.
#[derive(Clone, Copy, Debug)]
pub(crate) struct NotRigid {
    pub length: Real,
}

/// Returns the pose with a unit quaternion. A pose that is rigid up to the rounding of a few
/// operations is returned unchanged.
///
/// # Errors
/// The quaternion's length differs from 1 by more than 2^-20, or is NaN.
#[inline]
pub(crate) fn rigid(pose: &Pose) -> Result<Pose, NotRigid> {
    // If the square overflows or underflows, the length is not near 1 either.
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

/// The length of a quaternion, without overflow or underflow.
fn quaternion_length(q: Rotation) -> Real {
    let across = length(Vector::new(q.x, q.y, q.z));
    length(Vector::new(across, q.w, 0.0))
}

/// Returns the rotation by a rotation vector: about its direction, by its length in rad.
///
/// `libm` makes the result bit-identical on every machine; the standard library's sine does not.
pub(crate) fn rotation_by(turn: Vector) -> Rotation {
    let half = 0.5 * length(turn);
    // `sin(half) / |turn|`; its limit is 1/2 at 0.
    let share = if half > 0.0 { 0.5 * (libm::sin(half) / half) } else { 0.5 };
    let axis = turn * share;
    Rotation::from_xyzw(axis.x, axis.y, axis.z, libm::cos(half))
}
