//! What the root finders need of a number.

use std::fmt::Debug;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// A single real number in which polynomials are solved: `f32` or `f64`.
///
/// Root finders branch on every step, so a pack of lanes cannot take its place.
pub trait Real:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + PartialOrd
    + Debug
{
    /// 0
    const ZERO: Self;
    /// 1
    const ONE: Self;
    /// The largest relative error of one rounding: 2^-24 or 2^-53.
    const UNIT_ROUNDOFF: f64;
    /// How many bits a number's magnitude has: 24 or 53.
    const MANTISSA_BITS: i32;
    /// Numbers up to 2 to this power can still be multiplied by a few others of modest size: 90 or
    /// 900.
    const SAFE_EXPONENT: i32;

    /// The nearest number.
    fn of(value: f64) -> Self;
    /// The magnitude, +0 for -0.
    fn abs(self) -> Self;
    /// The square root.
    fn sqrt(self) -> Self;
    /// The `e` with 2^e <= |self| < 2^(e+1), for a finite number other than 0.
    fn exponent(self) -> i32;
    /// `self` 2^`exponent`: exact unless it leaves the range of normal numbers.
    fn times_power_of_two(self, exponent: i32) -> Self;
    /// Whether the number is finite.
    fn is_finite(self) -> bool;
    /// The cube root.
    fn cbrt(self) -> Self;
    /// The cosine of an angle in radians.
    fn cos(self) -> Self;
    /// The angle in `[0, pi]` with this cosine.
    fn acos(self) -> Self;

    /// The larger of two numbers; `other` where `self` is NaN.
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        if other < self { self } else { other }
    }
    /// The smaller of two numbers; `other` where `self` is NaN.
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        if self < other { self } else { other }
    }
}

macro_rules! real {
    ($float:ident, $bits:ident, $mantissa_bits:literal, $safe_exponent:literal, $bias:literal) => {
        impl Real for $float {
            const ZERO: Self = 0.0;
            const ONE: Self = 1.0;
            const UNIT_ROUNDOFF: f64 = $float::EPSILON as f64 / 2.0;
            const MANTISSA_BITS: i32 = $mantissa_bits;
            const SAFE_EXPONENT: i32 = $safe_exponent;

            #[inline(always)]
            fn of(value: f64) -> Self {
                value as $float
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
            fn exponent(self) -> i32 {
                let biased =
                    |x: $float| ((x.to_bits() >> ($mantissa_bits - 1)) & (2 * $bias + 1)) as i32;
                match biased(self) {
                    // Subnormal: 2^bias times as large it is not.
                    0 => {
                        biased(self * $float::from_bits((2 * $bias) << ($mantissa_bits - 1)))
                            - 2 * $bias
                    }
                    biased => biased - $bias,
                }
            }
            #[inline(always)]
            fn times_power_of_two(self, exponent: i32) -> Self {
                let power =
                    |e: i32| $float::from_bits(((e + $bias) as $bits) << ($mantissa_bits - 1));
                let mut left = exponent;
                let mut scaled = self;
                while left < 1 - $bias {
                    scaled *= power(1 - $bias);
                    left -= 1 - $bias;
                    if scaled == 0.0 {
                        return scaled;
                    }
                }
                while left > $bias {
                    scaled *= power($bias);
                    left -= $bias;
                    if scaled == 0.0 || scaled.is_infinite() {
                        return scaled;
                    }
                }
                scaled * power(left)
            }
            #[inline(always)]
            fn is_finite(self) -> bool {
                $float::is_finite(self)
            }
            #[inline(always)]
            fn cbrt(self) -> Self {
                $float::cbrt(self)
            }
            #[inline(always)]
            fn cos(self) -> Self {
                $float::cos(self)
            }
            #[inline(always)]
            fn acos(self) -> Self {
                $float::acos(self)
            }
        }
    };
}

real!(f32, u32, 24, 90, 127);
real!(f64, u64, 53, 900, 1023);
