//! Directions that keep their digits: unit vectors along, across and perpendicular to others.

use crate::distance::Scalar;
use parry3d_f64::math::{Real, Vector};
use std::ops::RangeInclusive;

/// The unit vector along `v`, or nothing when `v` is zero or not finite.
pub(crate) fn unit(v: Vector) -> Option<Vector> {
    let squared = v.length_squared();
    if SQUARES.contains(&squared) {
        return Some(v / squared.sqrt());
    }
    let largest = v.abs().max_element();
    if !v.is_finite() || largest == 0.0 {
        return None;
    }
    let v = v * largest.power_of_two_to_unity();
    Some(v / v.length())
}

/// Squares that have lost nothing to the range of f64, nor has any that is part of them and
/// matters.
const SQUARES: RangeInclusive<Real> = 1e-200..=1e200;

/// The unit vector along the part of `v` perpendicular to the unit vector `axis`, or nothing when
/// `v` is along the axis as far as rounding can tell.
pub(crate) fn unit_across(v: Vector, axis: Vector) -> Option<Vector> {
    let across = v - axis * v.dot(axis);
    let first = unit(across)?;
    // The rounding of the difference is that of `v`.
    if 4.0 * across.length_squared() >= v.length_squared() {
        return Some(first);
    }
    // Where the first difference was mere rounding it points anywhere, along the axis too. A second
    // one is far shorter then, and otherwise perpendicular to the last digit.
    let second = first - axis * first.dot(axis);
    let length = second.length();
    (length > 0.5).then(|| second / length)
}

/// Some unit vector perpendicular to the unit vector `axis`.
pub(crate) fn perpendicular(axis: Vector) -> Vector {
    axis.any_orthonormal_vector()
}
