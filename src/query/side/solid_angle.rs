//! The solid angle of a triangle, and what rounding can do to it.
//!
//! With the unit vectors a, b and c from the point to the corners, the solid angle is twice the
//! argument of
//!
//! z = 1 + ab + bc + ca + i det(a, b, c)
//!
//! (Van Oosterom and Strackee, "The solid angle of a plane triangle", 1983). |z|^2 = 2 (1 + ab) (1
//! + bc) (1 + ca) is 0 on the edges alone, and z is a negative number inside of the triangle alone:
//! there the solid angle jumps from 2 pi to -2 pi.
//!
//! **Rounding**, with u = 2^-53. A difference of coordinates is off by u of itself, a length by 3.5
//! u (u of it from the differences), a quotient by one u more: the unit vectors are off by 6 u at
//! most. Then a dot product is off by 2 x 6 u and its own 3 u. Three of them and 1, added up at
//! sizes of at most 2, 3 and 4, are off by 3 x 15 u + 9 u = 54 u. The determinant is off by 3 x 6 u
//! from its vectors, and by 3.5 u and 3 u from a cross and a dot product: 25 u. Together z is off
//! by less than 60 u, and [`ROUNDING`] has room for squares of u.
//!
//! If z is off by e and the negative numbers are farther away than that, its argument is off by
//! asin(e / |z|), which is less than pi / 2 e / |z|. At e = 64 u and |z| up to 4 the difference
//! between the two is 9 u or more: enough for an arc tangent that is off by two units in the last
//! place.

use super::SolidAngle;
use crate::distance::Scalar;
use crate::robot::direction;
use parry3d_f64::math::{Real, Vector};
use std::f64::consts::{PI, TAU};

/// How far rounding can move z.
const ROUNDING: Real = 64.0 * f64::UNIT_ROUNDOFF;

/// The solid angle of a triangle, positive where its corners turn counter-clockwise as seen from
/// behind, so that outward triangles are positive from inside. Between -2 pi and 2 pi, where the
/// point may lie on the triangle.
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
