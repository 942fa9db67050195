//! When a computed distance at a flat cap counts as 0.
//!
//! # Definitions
//! - `extent`: the largest difference of two points of the pair in a coordinate, or the radius.
//! - `u`: the unit roundoff of the scalar.
//!
//! # Why
//! The point of one body that lies deepest in the other is often one of a flat cap's plane. Rounding puts it before or behind the
//! plane. Then every candidate is the distance of two points that lie a few u of the extent apart, although the bodies
//! overlap deeply: two cylinders side by side whose ends are level, for example.
//!
//! # Rule
//! Where a flat cap decides, a computed distance of at most [`ROUNDING`] u extent is 0. The kernels err by less, so bodies
//! that overlap are never apart. The answer errs by twice as much at most: it is 0 only for a true distance of at most
//! 16 u extent.
//! The witness of both bodies is the middle between the two points, half of [`ROUNDING`] u extent from either.

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

/// The same, but where the mask is true and the distance is no more than rounding it is 0, with one common point.
#[inline(always)]
pub(crate) fn settle<T: Scalar>(closest: Closest<T>, at_cap: T::Mask, extent: T) -> Closest<T> {
    let (zero, limit) = (extent.zero(), extent * extent.lit(ROUNDING * T::UNIT_ROUNDOFF));
    let meets = at_cap & zero.lt(closest.distance) & closest.distance.le(limit);
    let middle = (closest.point1 + closest.point2) * zero.lit(0.5);
    Closest::select(meets, Closest { distance: zero, point1: middle, point2: middle }, closest)
}
