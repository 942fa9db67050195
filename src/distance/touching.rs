//! Decides when a computed distance at a flat cap counts as 0.
//!
//! # Definitions
//! - `extent`: the largest coordinate difference between two points of the pair, or the radius if
//!   that is larger.
//! - `u`: the unit roundoff of the scalar.
//!
//! # Problem
//! The deepest point of one body often lies in the plane of a flat cap of the other. Rounding puts
//! this point before or behind the plane. Every candidate is then a distance between two points
//! that are a few `u extent` apart, although the bodies overlap deeply. Example: two parallel
//! cylinders side by side whose ends are level.
//!
//! # Rule
//! If a flat cap decides, a computed distance of at most [`SETTLED_DISTANCE`] `u extent` becomes 0.
//! The witness of both bodies is the midpoint of the two points, at most half of
//! [`SETTLED_DISTANCE`] `u extent` from either.
//!
//! # Claim
//! If the kernel errs by at most `8 u extent`, every overlap has distance 0, and the answer errs by
//! at most `16 u extent`.
//!
//! # Proof
//! 1. The distance of bodies that overlap is 0, so the computed distance is at most `8 u extent`.
//!    The rule makes it 0.
//! 2. The rule changes a computed distance by at most `8 u extent`. The error of the kernel adds up
//!    to the same amount.
//!
//! # Rounding
//! The candidates at a flat cap are `hypot(l, max(0, rho - r))` for a point `x` relative to the
//! cap's centre: `l = <x, a>` is its height, and `rho` its distance from the axis. Let all numbers
//! be at most 1.
//! - A coordinate of `x` errs by `u`, which changes the height by less than `2 u`.
//! - The unit vector `a` errs by `2 u` along itself, and by less than `u` across.
//! - The sum of three products errs by up to `3 u` times the sum of their magnitudes.
//!
//! This bounds one candidate for a given `x`, but not the error of `x`. The iterations of the
//! kernels have no short error bound, so `8 u` is measured. 60,000 pairs of links in `f32` and
//! `f64` (level, coaxial, crossing and general): 1.1 u in deep overlap, 3.9 u near contact. The
//! largest error against all references is 6.1 u. Triangles deep in a link: 0.

use super::{Closest, Scalar, Vec3};

/// The largest computed distance that counts as 0, in units of `u extent`.
///
/// A larger value reports contact for bodies that are apart; a smaller value misses overlaps. The
/// measured errors are at most 6.1 (head of this file).
const SETTLED_DISTANCE: f64 = 8.0;

/// The largest `extent` in a frame where no coordinate exceeds 2 in magnitude.
const MOST: f64 = 4.0;

/// Returns whether [`settle`] may change this distance, in a frame where no coordinate exceeds 2.
#[inline(always)]
pub(crate) fn is_doubtful<T: Scalar>(distance: T) -> T::Mask {
    distance.zero().lt(distance)
        & distance.le(distance.lit(MOST * SETTLED_DISTANCE * T::UNIT_ROUNDOFF))
}

/// Returns the largest coordinate difference between two of these points and the origin, or
/// `length` if that is larger.
#[inline(always)]
pub(crate) fn extent<T: Scalar, const N: usize>(points: [Vec3<T>; N], length: T) -> T {
    let (mut low, mut high) = (Vec3::zero(length), Vec3::zero(length));
    for point in points {
        low = Vec3::new(point.x.min(low.x), point.y.min(low.y), point.z.min(low.z));
        high = Vec3::new(point.x.max(high.x), point.y.max(high.y), point.z.max(high.z));
    }
    (high - low).largest().max(length)
}

/// Applies the rule of this file: where the mask is true and the distance is within rounding of 0,
/// it becomes 0 with one common point.
#[inline(always)]
pub(crate) fn settle<T: Scalar>(closest: Closest<T>, at_cap: T::Mask, extent: T) -> Closest<T> {
    let (zero, limit) = (extent.zero(), extent * extent.lit(SETTLED_DISTANCE * T::UNIT_ROUNDOFF));
    let meets = at_cap & zero.lt(closest.distance) & closest.distance.le(limit);
    let middle = (closest.point1 + closest.point2) * zero.lit(0.5);
    Closest::select(meets, Closest { distance: zero, point1: middle, point2: middle }, closest)
}
