//! The solid angle of many triangles that are farther away than they are apart, and how far it is
//! from the true one.
//!
//! The solid angle is the integral of n f(x) over the triangles, where n is the normal and f(x) = x
//! / |x|^3 at the place x as seen from the point. Let d be the centre, R its distance, and every x
//! = d + s with |s| <= r < R. Taylor's series of f around d begins with
//!
//! d / R^3 + (s - 3 e (e s)) / R^3, where e = d / R.
//!
//! Integrated, the first term needs the sum N of all areas times their normals, and the second the
//! sum C of all areas times s n^T at their centroids, both known beforehand (the dipole and the
//! quadrupole):
//!
//! N e / R^2 + (trace C - 3 e^T C e) / R^3.
//!
//! **What is left out.** The k-th derivative of 1 / |x| along a unit vector is k! P_k / |x|^(k+1)
//! with a Legendre polynomial P_k <= 1, and a symmetric form is largest where all its arguments are
//! the same (Banach). f is the gradient of -1 / |x|, so the j-th term of its series, in any
//! direction n, is at most (j + 1) |s|^j / R^(j+2). The sum from j = 2 on is at most
//!
//! |s|^2 / R^4 (3 + 4 q + 5 q^2 ...) = |s|^2 (3 - 2 q) / (R (R - r))^2, where q = r / R,
//!
//! and the integral of |s|^2 over the triangles is known beforehand.
//!
//! **Rounding**, for m triangles of the area A, in units of u / R^2 with u = 2^-53. Edges and s are
//! at most 2 r and r long, and off by u of their length. A cross product is off by 4 u sqrt(3) of
//! its edges' product: half of it by 14 r^2. A centroid is off by 5 u r, so a term of C by (14 +
//! 1.3 (5 + 1)) r^3 < 24 r^3; a triangle in the ball has at most the area 1.3 r^2. Summing adds m u
//! times what is summed. C counts 4.74 times (sqrt(3) for its trace and 3), over R > r. That makes
//! m (14 + 114) r^2 + m (1 + 4.74) A. The evaluation itself takes at most 22 u of the first term
//! and 38 u of the second: 22 A + 4.74 x 38 A. All this is less than [`ROUNDING`] m (A + r^2). The
//! sums that are all positive, areas and squares, err by less than that share of A + r^2, and of
//! r^2 times it.
//!
//! All lengths are scaled by the power of two that brings the mesh to size one, so that their
//! powers neither overflow nor vanish.

use super::SolidAngle;
use crate::distance::Scalar;
use crate::robot::{direction, length};
use parry3d_f64::math::{Matrix, Real, Vector};

/// What rounding can do, for each triangle.
const ROUNDING: Real = 256.0 * f64::UNIT_ROUNDOFF;

/// Beyond this, fourth powers of a radius vanish beside a mesh of size one.
const SMALLEST: Real = 1.0 / (1_u128 << 100) as Real / (1_u128 << 100) as Real;

/// What is known beforehand of many triangles.
#[derive(Clone, Debug, Default)]
pub(crate) struct FarField {
    /// In the mesh's unit; all else is scaled.
    centre: Vector,
    /// No triangle reaches farther from the centre.
    radius: Real,
    /// The areas times the normals.
    dipole: Vector,
    /// trace C - 3 C, where C is the sum of areas times places times normals, all from the centre.
    quadrupole: Matrix,
    /// The integral of the squared distance from the centre, or more.
    second_moment: Real,
    /// What rounding can add, times the squared distance from the point.
    rounding: Real,
}

impl FarField {
    /// Of at least one triangle, in a unit in which the mesh is multiplied by `scale`.
    pub(crate) fn new(scale: Real, triangles: impl Iterator<Item = [Vector; 3]> + Clone) -> Self {
        let around = |[low, high]: [Vector; 2], point: Vector| [low.min(point), high.max(point)];
        let nothing = [Vector::INFINITY, Vector::NEG_INFINITY];
        let [low, high] = triangles.clone().flatten().fold(nothing, around);
        // Any centre serves. The middle is near every triangle, and cannot overflow.
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
        let radius = Real::sqrt(radius) * (1.0 + ROUNDING);
        let rounding = ROUNDING * count * (area + radius * radius);
        let trace = spread.x_axis.x + spread.y_axis.y + spread.z_axis.z;
        let second_moment = if radius >= SMALLEST {
            second_moment + rounding * radius * radius
        } else {
            // Never to be trusted.
            Real::INFINITY
        };
        let quadrupole = Matrix::from_diagonal(Vector::splat(trace)) - spread * 3.0;
        Self { centre, radius, dipole, quadrupole, second_moment, rounding }
    }

    /// The solid angle as seen from a point, in a unit in which the mesh is multiplied by `scale`.
    /// The error is infinite near the triangles.
    pub(crate) fn solid_angle(&self, scale: Real, point: Vector) -> SolidAngle {
        let offset = self.centre - point;
        let distance = length(offset) * scale;
        let gap = distance * (1.0 - ROUNDING) - self.radius;
        if gap <= 0.0 {
            return SolidAngle { value: 0.0, error: Real::INFINITY };
        }
        // Nothing is left at a distance that overflows.
        let (inverse, towards) = (1.0 / distance, direction(offset));
        let second = self.quadrupole.mul_vec3(towards).dot(towards) * inverse;
        let value = (self.dipole.dot(towards) + second) * (inverse * inverse);
        let left_out =
            (3.0 - 2.0 * self.radius * inverse) * self.second_moment * (inverse / gap).powi(2);
        SolidAngle { value, error: left_out + self.rounding * (inverse * inverse) }
    }
}
