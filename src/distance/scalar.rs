//! What a kernel needs of a number, so that one text serves `f64`, `f32` and lanes of either.
//!
//! Kernels choose by [`Mask::select`] and never branch, because lanes of one pack may choose
//! differently. Comparisons with NaN are false, so `x.max(lo).min(hi)` turns a NaN `x` into a
//! bound: `x` comes first.

use std::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Not, Sub};

/// Keeps [`Scalar`] and [`Mask`] from being implemented elsewhere, so that they can grow. The
/// project's own tests and studies do: their numbers count or imitate lanes.
pub trait Sealed {}

impl Sealed for bool {}
impl Sealed for f32 {}
impl Sealed for f64 {}

/// A truth value for each lane of a [`Scalar`]. It is sealed.
pub trait Mask<T>:
    Sealed + Copy + BitAnd<Output = Self> + BitOr<Output = Self> + Not<Output = Self>
{
    /// `yes` where the mask is true, `no` elsewhere.
    fn select(self, yes: T, no: T) -> T;
}

/// A real number, or a pack of them, that the narrow phase can compute with. It is sealed.
///
/// Implemented for `f32` and `f64`. Only IEEE operations are used (and fused multiply-add where an
/// implementation says so in [`Scalar::mul_add`]), so scalar answers are the same on every machine.
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

    /// How many times a foot on a triangle's plane is refined: each time wins the digits that the
    /// plane's basis has, which are few on a sliver. Two serve a height of 1e-5 of the length,
    /// three one of 1e-12.
    #[doc(hidden)]
    const FACE_PASSES: usize;

    /// How many Halley steps bring segment-disc to rounding level: 2 in single, 3 in double
    /// precision.
    #[doc(hidden)]
    const HALLEY_STEPS: usize;

    /// The constant `value` in the precision and lanes of `self`.
    #[doc(hidden)]
    fn lit(self, value: f64) -> Self;
    /// `self < other`
    #[doc(hidden)]
    fn lt(self, other: Self) -> Self::Mask;
    /// `self <= other`
    #[doc(hidden)]
    fn le(self, other: Self) -> Self::Mask;
    /// The magnitude, +0 for -0.
    #[doc(hidden)]
    fn abs(self) -> Self;
    /// The square root.
    #[doc(hidden)]
    fn sqrt(self) -> Self;
    /// `self * factor + addend`, fused only where that is as fast as the two operations.
    #[doc(hidden)]
    fn mul_add(self, factor: Self, addend: Self) -> Self;
    /// The cube root of the magnitude within 5 %: a start value, never an answer.
    #[doc(hidden)]
    fn cbrt_estimate(self) -> Self;
    /// The power of two `p` with `1 <= self * p < 2`, or 1 for 0. Saturates at the ends of the
    /// range.
    #[doc(hidden)]
    fn power_of_two_to_unity(self) -> Self;

    /// 0 in the precision and lanes of `self`.
    #[doc(hidden)]
    #[inline(always)]
    fn zero(self) -> Self {
        self.lit(0.0)
    }
    /// 1 in the precision and lanes of `self`.
    #[doc(hidden)]
    #[inline(always)]
    fn one(self) -> Self {
        self.lit(1.0)
    }
    /// The larger of two numbers; `other` where `self` is NaN.
    #[doc(hidden)]
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        other.lt(self).select(self, other)
    }
    /// The smaller of two numbers; `other` where `self` is NaN.
    #[doc(hidden)]
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        self.lt(other).select(self, other)
    }
    /// `self / divisor` for a positive divisor, 0 for any other.
    #[doc(hidden)]
    #[inline(always)]
    fn over(self, divisor: Self) -> Self {
        let positive = self.zero().lt(divisor);
        // The divisor is replaced before the division: shading languages may assume that no NaN
        // arises.
        positive.select(self, self.zero()) / positive.select(divisor, self.one())
    }
    /// `self.over(whole)` for a number between 0 and `whole`, where `inverse`, which is
    /// `whole.one().over(whole)`, is at hand. Packs of single precision multiply by it: they
    /// only rule out.
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

/// Added to a third of a number's bits, gives the bits of its cube root within 5 %: two thirds of
/// the exponent's bias, less what centres the error.
pub(super) const CBRT_BITS_F32: u32 = 0x2a51_0554;
/// As [`CBRT_BITS_F32`].
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
                // The exponent mirrored at 0, and kept where a quarter of the power and its inverse
                // are normal.
                let exponent = (self.to_bits() >> $mantissa_bits) & (2 * $bias + 1);
                let mirrored = (2 * $bias - exponent.min(2 * $bias - 3)).min(2 * $bias - 3);
                if self == 0.0 { 1.0 } else { $float::from_bits(mirrored << $mantissa_bits) }
            }
        }
    };
}

scalar!(f32, 2, 2, 23, 127, CBRT_BITS_F32);
scalar!(f64, 3, 3, 52, 1023, CBRT_BITS_F64);
