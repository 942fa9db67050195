//! Unit vectors that keep their digits: along, across and perpendicular to other vectors.

use crate::distance::Scalar;
use parry3d_f64::math::{Real, Vector};
use std::ops::RangeInclusive;

/// Returns the unit vector along `v`, or `None` if `v` is zero or not finite.
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

/// The squared lengths that can be used directly: neither they nor any of their parts that matter
/// are rounded by the range of `f64`.
const SQUARES: RangeInclusive<Real> = 1e-200..=1e200;

/// Returns the unit vector along the part of `v` perpendicular to the unit vector `axis`, or `None`
/// if `v` is parallel to `axis` within rounding.
pub(crate) fn unit_across(v: Vector, axis: Vector) -> Option<Vector> {
    let across = v - axis * v.dot(axis);
    let first = unit(across)?;
    // The rounding of the difference is relative to `v`: below half of the length, refine.
    if 4.0 * across.length_squared() >= v.length_squared() {
        return Some(first);
    }
    // If the first difference consisted of rounding, it has a random direction, and its
    // perpendicular part is much shorter. Otherwise this second difference is perpendicular to the
    // last digit.
    let second = first - axis * first.dot(axis);
    let length = second.length();
    (length > 0.5).then(|| second / length)
}

/// Returns a unit vector perpendicular to the unit vector `axis`.
pub(crate) fn perpendicular(axis: Vector) -> Vector {
    axis.any_orthonormal_vector()
}
