//! Vectors of three [`Scalar`]s.

use super::scalar::{Mask, Scalar};
use std::ops::{Add, Mul, Neg, Sub};

/// A point or a direction.
///
/// ```
/// use parry_continuum::distance::Vec3;
///
/// let (a, b) = (Vec3::new(3.0, 4.0, 0.0), Vec3::from([0.0, 0.0, 2.0]));
/// assert_eq!((a.norm(), a.norm_squared(), a.dot(b)), (5.0, 25.0, 0.0));
/// assert_eq!(a.cross(b), Vec3::new(8.0, -6.0, 0.0));
/// // The square of such a length is infinite.
/// assert_eq!((b * 2.0_f64.powi(600)).normalised(), Vec3::new(0.0, 0.0, 1.0));
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Vec3<T> {
    /// First coordinate.
    pub x: T,
    /// Second coordinate.
    pub y: T,
    /// Third coordinate.
    pub z: T,
}

impl<T> Vec3<T> {
    /// Returns the vector with these coordinates.
    #[inline(always)]
    pub const fn new(x: T, y: T, z: T) -> Self {
        Self { x, y, z }
    }
}

impl<T> From<[T; 3]> for Vec3<T> {
    #[inline(always)]
    fn from([x, y, z]: [T; 3]) -> Self {
        Self { x, y, z }
    }
}

impl<T> From<Vec3<T>> for [T; 3] {
    #[inline(always)]
    fn from(v: Vec3<T>) -> Self {
        [v.x, v.y, v.z]
    }
}

impl<T: Scalar> Add for Vec3<T> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self::new(self.x + other.x, self.y + other.y, self.z + other.z)
    }
}

impl<T: Scalar> Sub for Vec3<T> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self::new(self.x - other.x, self.y - other.y, self.z - other.z)
    }
}

impl<T: Scalar> Mul<T> for Vec3<T> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, factor: T) -> Self {
        Self::new(self.x * factor, self.y * factor, self.z * factor)
    }
}

impl<T: Scalar> Neg for Vec3<T> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self::new(-self.x, -self.y, -self.z)
    }
}

impl<T: Scalar> Vec3<T> {
    /// Returns the inner product.
    #[inline(always)]
    pub fn dot(self, other: Self) -> T {
        self.z.mul_add(other.z, self.y.mul_add(other.y, self.x * other.x))
    }

    /// Returns the cross product.
    #[inline(always)]
    pub fn cross(self, other: Self) -> Self {
        Self::new(
            self.y.mul_add(other.z, -(self.z * other.y)),
            self.z.mul_add(other.x, -(self.x * other.z)),
            self.x.mul_add(other.y, -(self.y * other.x)),
        )
    }

    /// Returns `self + factor * direction`.
    #[inline(always)]
    pub(crate) fn along(self, direction: Self, factor: T) -> Self {
        Self::new(
            direction.x.mul_add(factor, self.x),
            direction.y.mul_add(factor, self.y),
            direction.z.mul_add(factor, self.z),
        )
    }

    /// Returns the squared length.
    #[inline(always)]
    pub fn norm_squared(self) -> T {
        self.dot(self)
    }

    /// Returns the length. Squares must not overflow: see [`Vec3::normalised`] for vectors of any
    /// length.
    #[inline(always)]
    pub fn norm(self) -> T {
        self.norm_squared().sqrt()
    }

    /// Returns the largest magnitude of a coordinate.
    #[inline(always)]
    pub(crate) fn largest(self) -> T {
        self.x.abs().max(self.y.abs()).max(self.z.abs())
    }

    /// Returns the unit vector of a vector of any finite length; zero for zero.
    #[inline(always)]
    pub fn normalised(self) -> Self {
        let near_one = self * self.largest().power_of_two_to_unity();
        near_one * near_one.x.one().over(near_one.norm())
    }

    /// Returns `yes` where the mask is true, `no` elsewhere.
    #[inline(always)]
    pub(crate) fn select(mask: T::Mask, yes: Self, no: Self) -> Self {
        Self::new(mask.select(yes.x, no.x), mask.select(yes.y, no.y), mask.select(yes.z, no.z))
    }

    /// Returns the zero vector, in the lanes of `like`.
    #[inline(always)]
    pub(crate) fn zero(like: T) -> Self {
        Self::new(like.zero(), like.zero(), like.zero())
    }
}
