//! Lengths and directions that neither overflow nor underflow; conversions between parry's vectors
//! and the vectors of the distance kernels.
//!
//! The square of a length leaves the range of f64 beyond about 1e154 and below 1e-154; coordinates
//! up to 1e150 are accepted. If a square comes near either end of the range, the vector is first
//! scaled near 1 by a power of two, which is exact.

use crate::distance::{Scalar, Vec3};
use parry3d_f64::math::{Real, Vector};

/// Axes that open by less than this angle (rad) run level. It exceeds the rounding that a simulator
/// leaves in the directions of parallel legs; intended angles are far larger.
#[cfg(feature = "robots")]
pub(crate) const LEVEL: Real = 1.0 / (1_u64 << 24) as Real;

/// Squares of lengths in this range lose no significant bit.
const PLAIN_SQUARES: std::ops::Range<Real> = 1.0e-270..1.0e270;

/// Returns the length of `v`.
pub(crate) fn length(v: Vector) -> Real {
    let squared = v.length_squared();
    if PLAIN_SQUARES.contains(&squared) {
        return squared.sqrt();
    }
    let scale = v.abs().max_element().power_of_two_to_unity();
    (v * scale).length() / scale
}

/// Returns the direction of `v`, or zero for the zero vector.
pub(crate) fn direction(v: Vector) -> Vector {
    length_and_direction(v).1
}

/// Returns the length and the [`direction`] of `v`.
pub(crate) fn length_and_direction(v: Vector) -> (Real, Vector) {
    let squared = v.length_squared();
    if PLAIN_SQUARES.contains(&squared) {
        let length = squared.sqrt();
        return (length, v / length);
    }
    let scale = v.abs().max_element().power_of_two_to_unity();
    let scaled = v * scale;
    let length = scaled.length();
    (length / scale, if scaled == Vector::ZERO { scaled } else { scaled / length })
}

impl From<Vector> for Vec3<f64> {
    #[inline(always)]
    fn from(vector: Vector) -> Self {
        Self::new(vector.x, vector.y, vector.z)
    }
}

impl From<Vec3<f64>> for Vector {
    #[inline(always)]
    fn from(vector: Vec3<f64>) -> Self {
        Self::new(vector.x, vector.y, vector.z)
    }
}
