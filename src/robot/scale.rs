//! Lengths and directions that neither overflow nor underflow.
//!
//! The square of a length leaves the range of f64 beyond about 1e154 and below 1e-154, while
//! coordinates up to 1e150 are accepted. Multiplying by a power of two is exact, so a square that
//! comes near either end is taken at a size near 1 instead.

use crate::distance::Scalar;
use parry3d_f64::math::{Real, Vector};

/// Between these no square of a length loses a bit that counts.
const PLAIN_SQUARES: std::ops::Range<Real> = 1.0e-270..1.0e270;

/// The length of `v`.
pub(crate) fn length(v: Vector) -> Real {
    let squared = v.length_squared();
    if PLAIN_SQUARES.contains(&squared) {
        return squared.sqrt();
    }
    let scale = v.abs().max_element().power_of_two_to_unity();
    (v * scale).length() / scale
}

/// The direction of `v`, or zero for the zero vector.
pub(crate) fn direction(v: Vector) -> Vector {
    length_and_direction(v).1
}

/// The length and the [`direction`] of `v`.
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
