//! The solid angle of a triangle, with a bound on its rounding.
//!
//! # Definitions
//! - a, b, c: the unit vectors from the point to the corners.
//! - `z = 1 + ab + bc + ca + i det(a, b, c)`.
//!
//! The solid angle is twice the argument of z (Van Oosterom and Strackee, "The solid angle of a
//! plane triangle", 1983). `|z|^2 = 2 (1 + ab) (1 + bc) (1 + ca)` is 0 only on the edges. z is a
//! negative number only inside the triangle: there the solid angle jumps from `2 pi` to `-2 pi`.
//!
//! # Rounding
//! With `u = 2^-53`:
//!
//! 1. A difference of coordinates errs by u of itself. A length errs by `3.5 u`, including u from
//!    the differences. A quotient errs by one u more. So the unit vectors err by at most `6 u`.
//! 2. A dot product errs by `2 x 6 u`, and by its own `3 u`. Three of them and 1 are summed at
//!    sizes of at most 2, 3 and 4. The sum errs by `3 x 15 u + 9 u = 54 u`.
//! 3. The determinant errs by `3 x 6 u` from its vectors. It also errs by `3.5 u` from a cross
//!    product and by `3 u` from a dot product: `25 u`.
//! 4. Together z errs by less than `60 u`. [`ROUNDING`] has room for squares of u.
//!
//! Let z err by e, and let the negative numbers be farther from z than e. Then its argument errs by
//! `asin(e / |z|) < pi / 2 e / |z|`. For `e = 64 u` and `|z|` up to 4 these two differ by at least
//! `9 u`. That covers an arc tangent that errs by two units in the last place.

use super::SolidAngle;
use crate::distance::Scalar;
use crate::robot::direction;
use parry3d_f64::math::{Real, Vector};
use std::f64::consts::{PI, TAU};

/// A bound on the rounding of z.
const ROUNDING: Real = 64.0 * f64::UNIT_ROUNDOFF;

/// Returns the solid angle of a triangle, between `-2 pi` and `2 pi`. The error is `2 pi` if the
/// point may lie on the triangle.
///
/// It is positive if the corners turn counter-clockwise as seen from behind. So the triangles of an
/// outward mesh are positive from inside.
pub(crate) fn solid_angle(corners: [Vector; 3], point: Vector) -> SolidAngle {
    let [a, b, c] = corners.map(|corner| direction(corner - point));
    let across = a.dot(b.cross(c));
    let along = 1.0 + a.dot(b) + b.dot(c) + c.dot(a);
    let is_on_corner = [a, b, c].contains(&Vector::ZERO);
    if is_on_corner || (across.abs() <= ROUNDING && along <= ROUNDING) {
        return SolidAngle { value: 0.0, error: TAU };
    }
    let size = (across * across + along * along).sqrt();
    SolidAngle { value: 2.0 * across.atan2(along), error: PI * ROUNDING / size }
}
