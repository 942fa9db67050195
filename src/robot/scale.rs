//! Lengths and directions that neither overflow nor underflow.
//!
//! The square of a length leaves the range of f64 beyond about 1e154 and below 1e-154, while coordinates up to
//! 1e150 are accepted. Multiplying by a power of two is exact, so every square below is taken at a size near 1.

use parry3d_f64::math::{Real, Vector};

/// The power of two that brings `size` (finite, not negative) into [1, 2), or as near as f64 allows.
pub(super) fn to_unit(size: Real) -> Real {
    let exponent = size.to_bits() >> 52;
    Real::from_bits(2046_u64.saturating_sub(exponent).max(1) << 52)
}

/// The length of `v`.
pub(crate) fn length(v: Vector) -> Real {
    let scale = to_unit(v.abs().max_element());
    (v * scale).length() / scale
}

/// The direction of `v`, or zero for the zero vector.
pub(super) fn direction(v: Vector) -> Vector {
    let v = v * to_unit(v.abs().max_element());
    if v == Vector::ZERO { v } else { v / v.length() }
}
