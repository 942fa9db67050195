//! Packs of `f32` or `f64` as a [`Scalar`]: the kernels run on 2 to 16 triangles at once.
//!
//! The width is that of the instruction set that [`dispatch!`](super::dispatch) selects at run
//! time. A constant needs the instruction set's token, which every pack carries. This is why
//! [`Scalar::lit`] takes a `self`.

use super::Widest;
use super::scalar::{CBRT_BITS_F32, CBRT_BITS_F64, Mask, Scalar, Sealed};
use fearless_simd::prelude::*;
use fearless_simd::{Select, Simd};
use std::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Not, Sub};

/// A pack of numbers that can be loaded from memory.
pub(crate) trait Pack: Scalar {
    /// The number in one lane.
    type Element: Scalar<Mask = bool> + Send + Sync + 'static;
    /// The proof that the instruction set is present.
    type Token: Simd;
    /// The number of lanes.
    const LANES: usize;

    /// Returns the token that this pack was made with.
    fn token(self) -> Self::Token;
    /// Returns a pack with the same number in every lane.
    fn splat(token: Self::Token, value: Self::Element) -> Self;
    /// Loads the first [`Pack::LANES`] numbers of a slice.
    fn load(token: Self::Token, from: &[Self::Element]) -> Self;
    /// Writes the lanes to the front of a slice.
    fn store(self, to: &mut [Self::Element]);
    /// Returns one bit per lane, the first lane lowest.
    fn bits(mask: Self::Mask) -> u64;
}

/// Returns the indices of the bits that are set, lowest first. [`Pack::bits`] returns such bits.
pub(crate) fn set_bits(mut left: u64) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        let bit = (left != 0).then(|| left.trailing_zeros() as usize)?;
        left &= left - 1;
        Some(bit)
    })
}

/// Whether the target's instructions for minimum and maximum implement [`Scalar::min`] and
/// [`Scalar::max`].
///
/// The instructions of x86 return their second operand if one operand is NaN, and for two zeros.
/// `fearless_simd` does not promise this; a test checks it.
const COMPARES_AND_SELECTS: bool = cfg!(all(target_arch = "x86_64", target_feature = "sse2"));

macro_rules! lanes {
    ($Lanes:ident, $LaneMask:ident, $element:ty, $vector:ident, $mask:ident, $bits:ty, $mantissa_bits:literal,
     $bias:literal, $cbrt_bits:ident) => {
        #[doc = concat!("A pack of `", stringify!($element), "`.")]
        #[derive(Clone, Copy)]
        pub(crate) struct $Lanes<S: Simd>(S::$vector);

        #[doc = concat!("Truth values of [`", stringify!($Lanes), "`].")]
        #[derive(Clone, Copy)]
        pub(crate) struct $LaneMask<S: Simd>(S::$mask);

        lanes!(@operator $Lanes Add add +);
        lanes!(@operator $Lanes Sub sub -);
        lanes!(@operator $Lanes Mul mul *);
        lanes!(@operator $Lanes Div div /);
        lanes!(@operator $LaneMask BitAnd bitand &);
        lanes!(@operator $LaneMask BitOr bitor |);

        impl<S: Simd> Neg for $Lanes<S> {
            type Output = Self;
            #[inline(always)]
            fn neg(self) -> Self {
                Self(-self.0)
            }
        }

        impl<S: Simd> Not for $LaneMask<S> {
            type Output = Self;
            #[inline(always)]
            fn not(self) -> Self {
                Self(!self.0)
            }
        }

        impl<S: Simd> Sealed for $LaneMask<S> {}
        impl<S: Simd> Sealed for $Lanes<S> {}

        impl<S: Simd> Mask<$Lanes<S>> for $LaneMask<S> {
            #[inline(always)]
            fn select(self, yes: $Lanes<S>, no: $Lanes<S>) -> $Lanes<S> {
                $Lanes(Select::select(self.0, yes.0, no.0))
            }
        }

        impl<S: Simd> Scalar for $Lanes<S> {
            type Mask = $LaneMask<S>;
            const UNIT_ROUNDOFF: f64 = <$element as Scalar>::UNIT_ROUNDOFF;
            const FACE_PASSES: usize = <$element as Scalar>::FACE_PASSES;
            const HALLEY_STEPS: usize = <$element as Scalar>::HALLEY_STEPS;

            #[inline(always)]
            fn lit(self, value: f64) -> Self {
                Self(S::$vector::splat(self.0.token(), value as $element))
            }
            #[inline(always)]
            fn lt(self, other: Self) -> $LaneMask<S> {
                $LaneMask(self.0.simd_lt(other.0))
            }
            #[inline(always)]
            fn le(self, other: Self) -> $LaneMask<S> {
                $LaneMask(self.0.simd_le(other.0))
            }
            #[inline(always)]
            fn abs(self) -> Self {
                Self(self.0.abs())
            }
            #[inline(always)]
            fn sqrt(self) -> Self {
                Self(self.0.sqrt())
            }
            #[inline(always)]
            fn mul_add(self, factor: Self, addend: Self) -> Self {
                Self(self.0.mul_add(factor.0, addend.0))
            }
            #[inline(always)]
            fn max(self, other: Self) -> Self {
                if COMPARES_AND_SELECTS { Self(self.0.max(other.0)) } else { other.lt(self).select(self, other) }
            }
            #[inline(always)]
            fn min(self, other: Self) -> Self {
                if COMPARES_AND_SELECTS { Self(self.0.min(other.0)) } else { self.lt(other).select(self, other) }
            }
            #[inline(always)]
            fn over(self, divisor: Self) -> Self {
                // The quotient of a divisor that is not positive is discarded, so it does no harm
                // here.
                self.zero().lt(divisor).select(self / divisor, self.zero())
            }
            #[inline(always)]
            fn share_of(self, whole: Self, inverse: Self) -> Self {
                if <$element>::MANTISSA_DIGITS > f32::MANTISSA_DIGITS {
                    return self.over(whole);
                }
                // The inverse of a subnormal number is infinite: for a length that small any share
                // is correct.
                (self * inverse).min(self.one())
            }
            #[inline(always)]
            fn cbrt_estimate(self) -> Self {
                // A third of the bit pattern, computed in floating point: the leading bits become
                // the mantissa of a number in [2^k, 2^(k+1)), with k the mantissa's width, so they
                // are its integer part.
                const SHIFT: u32 = <$bits>::BITS - $mantissa_bits;
                let two_to_k = self.lit((1_u64 << $mantissa_bits) as f64);
                let leading = (self.abs().0.to_bits() >> SHIFT) | two_to_k.0.to_bits();
                let number = Self(S::$vector::from_bits(leading)) - two_to_k;
                let third = number.mul_add(self.lit(1.0 / 3.0), self.lit(($cbrt_bits >> SHIFT) as f64)) + two_to_k;
                Self(S::$vector::from_bits(third.0.to_bits() << SHIFT))
            }
            #[inline(always)]
            fn power_of_two_to_unity(self) -> Self {
                const LARGEST: f64 = <$element>::from_bits((2 * $bias - 3) << $mantissa_bits) as f64;
                const SMALLEST: f64 = <$element>::from_bits(3 << $mantissa_bits) as f64;
                let inside = self.max(self.lit(SMALLEST)).min(self.lit(LARGEST));
                let two_exponents = (2 * $bias) << $mantissa_bits;
                let exponent = inside.0.to_bits() & (((2 * $bias + 1) as $bits) << $mantissa_bits);
                let mirrored = S::$vector::from_bits(!(exponent - 1 - two_exponents));
                self.zero().lt(self).select(Self(mirrored), self.one())
            }
        }

        impl<S: Simd> Pack for $Lanes<S> {
            type Element = $element;
            type Token = S;
            const LANES: usize = <S::$vector as SimdBase<S>>::LEN;

            #[inline(always)]
            fn token(self) -> S {
                self.0.token()
            }
            #[inline(always)]
            fn splat(token: S, value: $element) -> Self {
                Self(S::$vector::splat(token, value))
            }
            #[inline(always)]
            fn load(token: S, from: &[$element]) -> Self {
                Self(S::$vector::from_slice(token, &from[..Self::LANES]))
            }
            #[inline(always)]
            fn store(self, to: &mut [$element]) {
                self.0.store_slice(&mut to[..Self::LANES]);
            }
            #[inline(always)]
            fn bits(mask: Self::Mask) -> u64 {
                mask.0.to_bitmask()
            }
        }
    };
    (@operator $Type:ident $Trait:ident $method:ident $operator:tt) => {
        impl<S: Simd> $Trait for $Type<S> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Self(self.0 $operator other.0)
            }
        }
    };
}

lanes!(F32s, F32Mask, f32, f32s, mask32s, u32, 23, 127, CBRT_BITS_F32);
lanes!(F64s, F64Mask, f64, f64s, mask64s, u64, 52, 1023, CBRT_BITS_F64);

/// A precision that has packs.
pub(crate) trait Lane:
    Scalar<Mask = bool> + Default + PartialOrd + Into<f64> + Send + Sync + 'static
{
    /// The pack of an instruction set.
    type Pack<S: Simd>: Pack<Element = Self, Token = S>;

    /// The largest length whose products stay finite in the bounds and distances of a search.
    const FARTHEST: f64;

    /// The widest instruction set for the search by the hierarchy.
    const WIDEST_SEARCH: Widest;

    /// Rounds to the nearest number of this precision.
    fn round(value: f64) -> Self;
}

impl Lane for f32 {
    type Pack<S: Simd> = F32s<S>;
    const FARTHEST: f64 = 1.0e6;
    const WIDEST_SEARCH: Widest = Widest::Avx512;

    #[inline(always)]
    fn round(value: f64) -> Self {
        value as f32
    }
}

impl Lane for f64 {
    type Pack<S: Simd> = F64s<S>;
    const FARTHEST: f64 = 1.0e30;
    const WIDEST_SEARCH: Widest = Widest::Sse2;

    #[inline(always)]
    fn round(value: f64) -> Self {
        value
    }
}

#[cfg(test)]
#[path = "lanes_tests.rs"]
pub(crate) mod tests;
