//! A frame in which a problem's numbers are near one.
//!
//! Kernels multiply up to eight lengths, so lengths far from one would overflow or vanish. Every
//! public function of `distance` therefore moves its problem to an origin of its own and multiplies
//! it by a power of two, which is exact: multiplying the input by 2^k multiplies the answer by 2^k
//! bit for bit. The move makes the rounding depend on the problem's extent and not on where it
//! lies.

use super::{Closest, Scalar, Vec3};

/// The way into and out of the coordinates near one.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Frame<T> {
    origin: Vec3<T>,
    /// Brings coordinates above 1 down to 1 before they are subtracted, lest the difference
    /// overflow.
    shrink: T,
    /// Brings the differences to 1.
    fit: T,
}

impl<T: Scalar> Frame<T> {
    /// The frame at `origin` in which all `points` and `length` are at most 2, and some is at least
    /// 1.
    #[inline(always)]
    pub(crate) fn around<const N: usize>(origin: Vec3<T>, points: [Vec3<T>; N], length: T) -> Self {
        let mut largest = origin.largest().max(length);
        for point in points {
            largest = largest.max(point.largest());
        }
        // A quarter more, so that the difference of the two largest numbers is finite too.
        let shrink = (largest.power_of_two_to_unity() * largest.lit(0.25)).min(largest.one());
        let mut extent = length * shrink;
        for point in points {
            extent = extent.max((point * shrink - origin * shrink).largest());
        }
        Self { origin, shrink, fit: extent.power_of_two_to_unity() }
    }

    /// A point in this frame.
    #[inline(always)]
    pub(crate) fn point(&self, point: Vec3<T>) -> Vec3<T> {
        self.way(self.origin, point)
    }

    /// The way from one point to another in this frame, as exact as their difference.
    #[inline(always)]
    pub(crate) fn way(&self, from: Vec3<T>, to: Vec3<T>) -> Vec3<T> {
        (to * self.shrink - from * self.shrink) * self.fit
    }

    /// A length in this frame.
    #[inline(always)]
    pub(crate) fn length(&self, length: T) -> T {
        length * self.shrink * self.fit
    }

    /// An answer of this frame in the caller's coordinates.
    #[inline(always)]
    pub(crate) fn answer(&self, local: Closest<T>) -> Closest<T> {
        let one = self.fit.one();
        // Two exact factors: their product may be beyond the range where each is not.
        let (grow, unfit) = (one / self.shrink, one / self.fit);
        // The way from the origin may be longer than the largest number; a quarter of it is not.
        let origin = self.origin * self.shrink;
        Closest {
            distance: local.distance * unfit * grow,
            point1: (origin + local.point1 * unfit) * grow,
            point2: (origin + local.point2 * unfit) * grow,
        }
        .met()
    }
}
