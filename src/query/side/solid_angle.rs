//! Solid angles with error bounds: of a triangle ([`solid_angle`]), of many triangles from afar
//! ([`FarField`]), and their sum with the side that it proves ([`SolidAngle`]).
//!
//! # A triangle
//! **Definitions.**
//! - a, b, c: the unit vectors from the point to the corners.
//! - `z = 1 + ab + bc + ca + i det(a, b, c)`.
//!
//! The solid angle is twice the argument of z (Van Oosterom and Strackee, "The solid angle of a
//! plane triangle", 1983). `|z|^2 = 2 (1 + ab) (1 + bc) (1 + ca)` is 0 only on the edges. z is a
//! negative number only inside the triangle: there the solid angle jumps from `2 pi` to `-2 pi`.
//!
//! ## Rounding
//! With `u = 2^-53`:
//!
//! 1. A difference of coordinates errs by u of itself. A length errs by `3.5 u`, including u from
//!    the differences. A quotient errs by one u more. So the unit vectors err by at most `6 u`.
//! 2. A dot product errs by `2 x 6 u`, and by its own `3 u`. Three of them and 1 are summed at
//!    sizes of at most 2, 3 and 4. The sum errs by `3 x 15 u + 9 u = 54 u`.
//! 3. The determinant errs by `3 x 6 u` from its vectors. It also errs by `3.5 u` from a cross
//!    product and by `3 u` from a dot product: `25 u`.
//! 4. Together z errs by less than `60 u`. [`Z_ROUNDING`] has room for squares of u.
//!
//! Let z err by e, and let the negative numbers be farther from z than e. Then its argument errs by
//! `asin(e / |z|) < pi / 2 e / |z|`. For `e = 64 u` and `|z|` up to 4 these two differ by at least
//! `9 u`. That covers an arc tangent that errs by two units in the last place.
//!
//! # Many triangles from afar: a series of two terms
//! **Definitions.**
//! - x: a point of a triangle as seen from the query point; n: the normal there.
//! - d: the centre of the triangles; `R = |d|`; `e = d / R`.
//! - `x = d + s` with `|s| <= r < R`; `q = r / R`.
//! - N: the sum of all areas times normals (the dipole).
//! - C: the sum of all areas times `s n^T` at the centroids (the quadrupole).
//!
//! ## Series
//! The solid angle is the integral of `n . f(x)` over the triangles, with `f(x) = x / |x|^3`.
//! Taylor's series of f around d begins with
//!
//! ```text
//! d / R^3 + (s - 3 e (e . s)) / R^3.
//! ```
//!
//! Integrated, these two terms are
//!
//! ```text
//! N . e / R^2 + (trace C - 3 e^T C e) / R^3.
//! ```
//!
//! N and C are computed once for each group of triangles.
//!
//! ## Truncation
//! **Claim.** The rest of the series is at most the integral over the triangles of
//!
//! ```text
//! |s|^2 / R^4 (3 + 4 q + 5 q^2 + ...) = |s|^2 (3 - 2 q) / (R (R - r))^2.
//! ```
//!
//! **Proof.** The k-th derivative of `1 / |x|` along a unit vector is `k! P_k / |x|^(k+1)`, with a
//! Legendre polynomial `P_k <= 1`. A symmetric form is largest where all its arguments are equal
//! (Banach). f is the gradient of `-1 / |x|`. So the j-th term of its series, in any direction n,
//! is at most `(j + 1) |s|^j / R^(j+2)`. The claim is the sum from `j = 2` on.
//!
//! The integral of `|s|^2` over the triangles is computed once too.
//!
//! ## Rounding
//! For m triangles of the total area A, in units of `u / R^2` with `u = 2^-53`:
//!
//! - Edges are at most `2 r` long and s at most r; both err by u of their length.
//! - A cross product errs by `4 u sqrt(3)` of the product of its edges: half of it by `14 r^2`.
//! - A centroid errs by `5 u r`. A triangle in the ball has at most the area `1.3 r^2`. So a term
//!   of C errs by `(14 + 1.3 (5 + 1)) r^3 < 24 r^3`.
//! - A sum adds m u times its magnitude.
//! - C counts 4.74 times (`sqrt(3)` for its trace, and 3), over `R > r`. Together that is
//!   `m (14 + 114) r^2 + m (1 + 4.74) A`.
//! - The evaluation takes at most 22 u of the first term and 38 u of the second:
//!   `22 A + 4.74 x 38 A`.
//!
//! The total is less than [`FAR_ROUNDING`] `m (A + r^2)`. The sums of areas and squares have
//! positive terms only. They err by less than the same share of `A + r^2`, and of `r^2` times it.
//!
//! All lengths are scaled by the power of two that brings the mesh to size one. So their powers
//! stay in range.

use crate::answer::Side;
use crate::distance::Scalar;
use crate::robot::{direction, length};
use parry3d_f64::math::{Matrix, Real, Vector};
use std::f64::consts::{PI, TAU};

/// A bound on the rounding of z.
const Z_ROUNDING: Real = 64.0 * f64::UNIT_ROUNDOFF;

/// Returns the solid angle of a triangle, between `-2 pi` and `2 pi`. The error is `2 pi` if the
/// point may lie on the triangle.
///
/// It is positive if the corners turn counter-clockwise as seen from behind. So the triangles of an
/// outward mesh are positive from inside.
pub(crate) fn solid_angle(corners: [Vector; 3], point: Vector) -> SolidAngle {
    // Written out: a closure of `map` is not inlined where the library is compiled in parts, and
    // takes a third of the time of a query.
    let [a, b, c] = corners;
    let (a, b, c) = (direction(a - point), direction(b - point), direction(c - point));
    let across = a.dot(b.cross(c));
    let along = 1.0 + a.dot(b) + b.dot(c) + c.dot(a);
    let is_on_corner = [a, b, c].contains(&Vector::ZERO);
    if is_on_corner || (across.abs() <= Z_ROUNDING && along <= Z_ROUNDING) {
        return SolidAngle { value: 0.0, error: TAU };
    }
    let size = (across * across + along * along).sqrt();
    SolidAngle { value: 2.0 * across.atan2(along), error: PI * Z_ROUNDING / size }
}

/// How much of the whole solid angle `4 pi` a sum may lack, or exceed zero by, where holes in the
/// mesh are seen. A proven side is wrong only if lids over the holes cover more than the rest.
const HOLE: Real = PI;

/// A signed solid angle in steradians, and a bound on its error.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct SolidAngle {
    pub(super) value: Real,
    pub(super) error: Real,
}

impl SolidAngle {
    /// Returns the side that the sum of all solid angles proves. None if a smaller error might
    /// prove one.
    pub(crate) fn side(self) -> Option<Side> {
        // Covers the rounding in the sum of the errors.
        let error = self.error * (1.0 + 1e-6);
        let (least, most) = (self.value.abs() - error, self.value.abs() + error);
        if least > 4.0 * PI - HOLE {
            Some(Side::Inside)
        } else if most < HOLE {
            Some(Side::Outside)
        } else if least > HOLE && most < 4.0 * PI - HOLE {
            Some(Side::Undecided)
        } else {
            None
        }
    }

    pub(crate) fn error(&self) -> Real {
        self.error
    }
}

impl std::ops::AddAssign for SolidAngle {
    /// Adds a solid angle, and counts the rounding of the sum as an error.
    ///
    /// The errors are summed with rounding too. For 2^32 summands that is less than 2^-20 of the
    /// sum. [`side`](Self::side) allows for it, and for the few roundings of each error.
    fn add_assign(&mut self, other: Self) {
        self.value += other.value;
        self.error += other.error + f64::UNIT_ROUNDOFF * self.value.abs();
    }
}

/// The relative rounding for each triangle.
const FAR_ROUNDING: Real = 256.0 * f64::UNIT_ROUNDOFF;

/// The least radius, beside a mesh of size one, whose fourth power does not underflow.
const SMALLEST: Real = 1.0 / (1_u128 << 100) as Real / (1_u128 << 100) as Real;

/// The moments of a group of triangles.
#[derive(Clone, Debug, Default)]
pub(crate) struct FarField {
    /// The centre, in the mesh's unit; all other fields are scaled.
    centre: Vector,
    /// No triangle reaches farther from the centre.
    radius: Real,
    /// N: the sum of areas times normals.
    dipole: Vector,
    /// `trace C - 3 C`.
    quadrupole: Matrix,
    /// An upper bound on the integral of the squared distance from the centre.
    second_moment: Real,
    /// A bound on the rounding, times the squared distance from the query point.
    rounding: Real,
}

impl FarField {
    /// The moments of at least one triangle. `scale` brings the mesh to size one.
    pub(crate) fn new(scale: Real, triangles: impl Iterator<Item = [Vector; 3]> + Clone) -> Self {
        let around = |[low, high]: [Vector; 2], point: Vector| [low.min(point), high.max(point)];
        let nothing = [Vector::INFINITY, Vector::NEG_INFINITY];
        let [low, high] = triangles.clone().flatten().fold(nothing, around);
        // Any centre is valid. The middle of the box is near every triangle, and cannot overflow.
        let centre = low.midpoint(high);
        let mut count = 0.0;
        let (mut radius, mut area, mut second_moment) = (0.0, 0.0, 0.0);
        let (mut dipole, mut spread) = (Vector::ZERO, Matrix::ZERO);
        for corners in triangles {
            let places = corners.map(|corner| (corner - centre) * scale);
            let [a, b, c] = places;
            let across =
                ((corners[1] - corners[0]) * scale).cross((corners[2] - corners[0]) * scale) * 0.5;
            let (size, sum) = (across.length(), a + b + c);
            let middle = sum / 3.0;
            let squares = places.map(Vector::length_squared);
            count += 1.0;
            radius = squares.into_iter().fold(radius, Real::max);
            area += size;
            // The integral of a square over a triangle, by its corners.
            second_moment +=
                size / 12.0 * (squares.into_iter().sum::<Real>() + sum.length_squared());
            dipole += across;
            spread += Matrix::from_cols(middle * across.x, middle * across.y, middle * across.z);
        }
        let radius = Real::sqrt(radius) * (1.0 + FAR_ROUNDING);
        let rounding = FAR_ROUNDING * count * (area + radius * radius);
        let trace = spread.x_axis.x + spread.y_axis.y + spread.z_axis.z;
        let second_moment = if radius >= SMALLEST {
            second_moment + rounding * radius * radius
        } else {
            // The error is then infinite, so this field is never used.
            Real::INFINITY
        };
        let quadrupole = Matrix::from_diagonal(Vector::splat(trace)) - spread * 3.0;
        Self { centre, radius, dipole, quadrupole, second_moment, rounding }
    }

    /// Returns the solid angle from a point; `scale` brings the mesh to size one. The error is
    /// infinite near the triangles.
    pub(crate) fn solid_angle(&self, scale: Real, point: Vector) -> SolidAngle {
        let offset = self.centre - point;
        let distance = length(offset) * scale;
        let gap = distance * (1.0 - FAR_ROUNDING) - self.radius;
        if gap <= 0.0 {
            return SolidAngle { value: 0.0, error: Real::INFINITY };
        }
        // At a distance that overflows, the solid angle is 0.
        let (inverse, towards) = (1.0 / distance, direction(offset));
        let second = self.quadrupole.mul_vec3(towards).dot(towards) * inverse;
        let value = (self.dipole.dot(towards) + second) * (inverse * inverse);
        let left_out =
            (3.0 - 2.0 * self.radius * inverse) * self.second_moment * (inverse / gap).powi(2);
        SolidAngle { value, error: left_out + self.rounding * (inverse * inverse) }
    }
}
