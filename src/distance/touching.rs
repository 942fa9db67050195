//! When a computed distance at a flat cap counts as 0.
//!
//! # Definitions
//! - `extent`: the largest difference of two points of the pair in a coordinate, or the radius.
//! - `u`: the unit roundoff of the scalar.
//!
//! # Why
//! The point of one body that lies deepest in the other is often one of a flat cap's plane.
//! Rounding puts it before or behind the plane. Then every candidate is the distance of two points
//! that lie a few u of the extent apart, although the bodies overlap deeply: two cylinders side by
//! side whose ends are level, for example.
//!
//! # Rule
//! Where a flat cap decides, a computed distance of at most [`ROUNDING`] u extent is 0. The witness
//! of both bodies is the middle between the two points, half of [`ROUNDING`] u extent from either.
//!
//! # Claim
//! If the kernel errs by at most 8 u extent, bodies that overlap are never apart, and the answer
//! errs by at most 16 u extent.
//!
//! # Proof
//! 1. Bodies that overlap are 0 apart, so the computed distance is at most 8 u extent: the rule
//!    makes it 0.
//! 2. The rule changes a computed distance by at most 8 u extent, which adds to the error of the
//!    kernel.
//!
//! # Rounding
//! The candidates at a flat cap are `hypot(l, max(0, rho - r))` of a point `x`, seen from the cap's
//! centre: `l = <x, a>` is its height and `rho` its distance from the axis. Let all numbers be at
//! most 1.
//! - A coordinate of `x` errs by u, and the height of `x` by less than 2 u for that.
//! - The unit vector `a` errs by 2 u along itself, and by less than u across.
//! - The sum of three products errs by up to 3 u of the sum of their magnitudes.
//!
//! This bounds one candidate for a given `x`, not the place of `x`: the kernels' iterations have no
//! short bound, so 8 u is measured. 60,000 pairs of links in `f32` and `f64`, level, coaxial,
//! crossing and in general: 1.1 u if they overlap deeply, 3.9 u if they nearly touch. The worst of
//! all references is 6.1 u. Triangles deep in a link: 0.

use super::{Closest, Scalar, Vec3};

/// How far apart two points may be computed that are one, in units of u and the extent.
const ROUNDING: f64 = 8.0;

/// Of numbers at most 2 in magnitude, the largest difference.
const MOST: f64 = 4.0;

/// Whether a distance in numbers near one is so short that [`settle`] may have to be asked.
#[inline(always)]
pub(crate) fn is_doubtful<T: Scalar>(distance: T) -> T::Mask {
    distance.zero().lt(distance) & distance.le(distance.lit(MOST * ROUNDING * T::UNIT_ROUNDOFF))
}

/// The largest difference in a coordinate of two of these points and the origin, or the length.
#[inline(always)]
pub(crate) fn extent<T: Scalar, const N: usize>(points: [Vec3<T>; N], length: T) -> T {
    let (mut low, mut high) = (Vec3::zero(length), Vec3::zero(length));
    for point in points {
        low = Vec3::new(point.x.min(low.x), point.y.min(low.y), point.z.min(low.z));
        high = Vec3::new(point.x.max(high.x), point.y.max(high.y), point.z.max(high.z));
    }
    (high - low).largest().max(length)
}

/// The same, but where the mask is true and the distance is no more than rounding it is 0, with one
/// common point.
#[inline(always)]
pub(crate) fn settle<T: Scalar>(closest: Closest<T>, at_cap: T::Mask, extent: T) -> Closest<T> {
    let (zero, limit) = (extent.zero(), extent * extent.lit(ROUNDING * T::UNIT_ROUNDOFF));
    let meets = at_cap & zero.lt(closest.distance) & closest.distance.le(limit);
    let middle = (closest.point1 + closest.point2) * zero.lit(0.5);
    Closest::select(meets, Closest { distance: zero, point1: middle, point2: middle }, closest)
}
