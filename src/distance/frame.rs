//! A frame in which the numbers of a problem are near one.
//!
//! Kernels multiply up to eight lengths, so lengths far from one would overflow or underflow. Every
//! public function of `distance` therefore moves its problem to an origin of its own and multiplies
//! it by a power of two. The multiplication is exact: multiplying the input by 2^k multiplies the
//! answer by 2^k bit for bit. After the move the rounding depends on the problem's extent, and not
//! on its position.

use super::{Closest, Scalar, Vec3};

/// The transform into coordinates near one, and back.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Frame<T> {
    origin: Vec3<T>,
    /// Scales coordinates of 1/2 or more down to between 1/4 and 1/2 before the subtraction, so
    /// that differences stay finite.
    shrink: T,
    /// Scales the largest difference to between 1 and 2.
    fit: T,
}

impl<T: Scalar> Frame<T> {
    /// Returns the frame at `origin` in which all `points` and `length` are at most 2, and one is
    /// at least 1.
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

    /// Transforms a point into this frame.
    #[inline(always)]
    pub(crate) fn point(&self, point: Vec3<T>) -> Vec3<T> {
        self.way(self.origin, point)
    }

    /// Returns the vector from one point to another in this frame, as exact as their difference.
    #[inline(always)]
    pub(crate) fn way(&self, from: Vec3<T>, to: Vec3<T>) -> Vec3<T> {
        (to * self.shrink - from * self.shrink) * self.fit
    }

    /// Transforms a length into this frame.
    #[inline(always)]
    pub(crate) fn length(&self, length: T) -> T {
        length * self.shrink * self.fit
    }

    /// Transforms an answer of this frame back into the caller's coordinates.
    #[inline(always)]
    pub(crate) fn answer(&self, local: Closest<T>) -> Closest<T> {
        let one = self.fit.one();
        // Two exact factors: their product may leave the range although each is inside.
        let (grow, unfit) = (one / self.shrink, one / self.fit);
        // The vector from the origin may exceed the largest number; a quarter of it does not.
        let origin = self.origin * self.shrink;
        Closest {
            distance: local.distance * unfit * grow,
            point1: (origin + local.point1 * unfit) * grow,
            point2: (origin + local.point2 * unfit) * grow,
        }
        .met()
    }
}
