//! The operations that a kernel needs of a number: one text serves `f64`, `f32` and packs of
//! either.
//!
//! Kernels select with [`Mask::select`] and never branch, because the lanes of one pack may select
//! differently. Comparisons with NaN are false, so `x.max(lo).min(hi)` turns a NaN `x` into a
//! bound: `x` must come first.

use std::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Not, Sub};

/// Seals [`Scalar`] and [`Mask`], so that methods can be added. The project's own tests and studies
/// implement both, for numbers that count operations or imitate lanes.
pub trait Sealed {}

impl Sealed for bool {}
impl Sealed for f32 {}
impl Sealed for f64 {}

/// A truth value for each lane of a [`Scalar`]. The trait is sealed.
pub trait Mask<T>:
    Sealed + Copy + BitAnd<Output = Self> + BitOr<Output = Self> + Not<Output = Self>
{
    /// Returns `yes` where the mask is true, `no` elsewhere.
    fn select(self, yes: T, no: T) -> T;
}

/// A real number, or a pack of them, for the narrow phase. The trait is sealed.
///
/// Implemented for `f32` and `f64`. All operations are IEEE operations, so scalar answers are the
/// same on every machine. An implementation may use fused multiply-add where [`Scalar::mul_add`]
/// says so.
///
/// ```
/// use parry_continuum::distance::{Scalar, Vec3, segment_segment};
///
/// /// How far two rods are apart, in the precision that is given.
/// fn apart<T: Scalar>(one: [Vec3<T>; 2], other: [Vec3<T>; 2]) -> T {
///     segment_segment(one, other).distance
/// }
///
/// let (one, other) = ([[0.0_f32, 0.0, 0.0], [1.0, 0.0, 0.0]], [[0.0, 0.0, 2.0], [0.0, 1.0, 2.0]]);
/// assert_eq!(apart(one.map(Vec3::from), other.map(Vec3::from)), 2.0);
/// ```
pub trait Scalar:
    Sealed
    + Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    /// The result of a comparison: a truth value for each lane, `bool` for `f32` and `f64`.
    #[doc(hidden)]
    type Mask: Mask<Self>;

    /// The largest relative error of one rounding: 2^-24 or 2^-53.
    #[doc(hidden)]
    const UNIT_ROUNDOFF: f64;

    /// The number of refinement passes of a foot on a triangle's plane.
    ///
    /// Each pass adds the digits that the plane's basis has, which are few on a sliver. Two passes
    /// are enough for a height of 1e-5 of the length, three for 1e-12.
    #[doc(hidden)]
    const FACE_PASSES: usize;

    /// The number of Halley steps that bring segment-disc to rounding level: 2 in single, 3 in
    /// double precision.
    #[doc(hidden)]
    const HALLEY_STEPS: usize;

    /// Returns the constant `value` in the precision and lanes of `self`.
    #[doc(hidden)]
    fn lit(self, value: f64) -> Self;
    /// `self < other`
    #[doc(hidden)]
    fn lt(self, other: Self) -> Self::Mask;
    /// `self <= other`
    #[doc(hidden)]
    fn le(self, other: Self) -> Self::Mask;
    /// Returns the magnitude, +0 for -0.
    #[doc(hidden)]
    fn abs(self) -> Self;
    /// Returns the square root.
    #[doc(hidden)]
    fn sqrt(self) -> Self;
    /// Returns `self * factor + addend`, fused only where that is as fast as the two operations.
    #[doc(hidden)]
    fn mul_add(self, factor: Self, addend: Self) -> Self;
    /// Returns the cube root of the magnitude within 5 %: a start value, never an answer.
    #[doc(hidden)]
    fn cbrt_estimate(self) -> Self;
    /// Returns the power of two `p` with `1 <= self * p < 2`, or 1 for 0. Saturates at the ends of
    /// the range.
    #[doc(hidden)]
    fn power_of_two_to_unity(self) -> Self;

    /// Runs a step that kernels repeat: inlined, except for numbers whose operations are calls.
    #[doc(hidden)]
    #[inline(always)]
    fn step<R>(work: impl FnOnce() -> R) -> R {
        work()
    }

    /// Returns 0 in the precision and lanes of `self`.
    #[doc(hidden)]
    #[inline(always)]
    fn zero(self) -> Self {
        self.lit(0.0)
    }
    /// Returns 1 in the precision and lanes of `self`.
    #[doc(hidden)]
    #[inline(always)]
    fn one(self) -> Self {
        self.lit(1.0)
    }
    /// Returns the larger of two numbers; `other` if `self` is NaN.
    #[doc(hidden)]
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        other.lt(self).select(self, other)
    }
    /// Returns the smaller of two numbers; `other` if `self` is NaN.
    #[doc(hidden)]
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        self.lt(other).select(self, other)
    }
    /// Returns `self / divisor` for a positive divisor, 0 for any other.
    #[doc(hidden)]
    #[inline(always)]
    fn over(self, divisor: Self) -> Self {
        let positive = self.zero().lt(divisor);
        // Replace the divisor before the division: shading languages may assume that no NaN occurs.
        positive.select(self, self.zero()) / positive.select(divisor, self.one())
    }
    /// Returns `self.over(whole)` for a number between 0 and `whole`; `inverse` is
    /// `whole.one().over(whole)`.
    ///
    /// Packs of single precision multiply by `inverse`, since their results are only bounds.
    #[doc(hidden)]
    #[inline(always)]
    fn share_of(self, whole: Self, inverse: Self) -> Self {
        let _ = inverse;
        self.over(whole)
    }
}

impl<T> Mask<T> for bool {
    #[inline(always)]
    fn select(self, yes: T, no: T) -> T {
        if self { yes } else { no }
    }
}

/// The offset that turns a third of a number's bits into the bits of its cube root, within 5 %: two
/// thirds of the exponent's bias, minus a term that centres the error.
pub(super) const CBRT_BITS_F32: u32 = 0x2a51_0554;
/// Same as [`CBRT_BITS_F32`], for `f64`.
pub(super) const CBRT_BITS_F64: u64 = 0x2a9f_7893_782d_a1ce;

macro_rules! scalar {
    ($float:ident, $halley_steps:literal, $face_passes:literal, $mantissa_bits:literal, $bias:literal, $cbrt_bits:ident) => {
        impl Scalar for $float {
            type Mask = bool;
            const UNIT_ROUNDOFF: f64 = $float::EPSILON as f64 / 2.0;
            const FACE_PASSES: usize = $face_passes;
            const HALLEY_STEPS: usize = $halley_steps;

            #[inline(always)]
            fn lit(self, value: f64) -> Self {
                value as $float
            }
            #[inline(always)]
            fn lt(self, other: Self) -> bool {
                self < other
            }
            #[inline(always)]
            fn le(self, other: Self) -> bool {
                self <= other
            }
            #[inline(always)]
            fn abs(self) -> Self {
                $float::abs(self)
            }
            #[inline(always)]
            fn sqrt(self) -> Self {
                $float::sqrt(self)
            }
            #[inline(always)]
            fn mul_add(self, factor: Self, addend: Self) -> Self {
                self * factor + addend
            }
            #[inline(always)]
            fn cbrt_estimate(self) -> Self {
                // A third of the exponent; the constant restores the bias and centres the error.
                $float::from_bits(self.abs().to_bits() / 3 + $cbrt_bits)
            }
            #[inline(always)]
            fn power_of_two_to_unity(self) -> Self {
                // The exponent mirrored at 0, limited so that a quarter of the power and its
                // inverse are normal.
                let exponent = (self.to_bits() >> $mantissa_bits) & (2 * $bias + 1);
                let mirrored = (2 * $bias - exponent.min(2 * $bias - 3)).min(2 * $bias - 3);
                if self == 0.0 { 1.0 } else { $float::from_bits(mirrored << $mantissa_bits) }
            }
        }
    };
}

scalar!(f32, 2, 2, 23, 127, CBRT_BITS_F32);
scalar!(f64, 3, 3, 52, 1023, CBRT_BITS_F64);
