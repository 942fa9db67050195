//! Double-double numbers of about 32 digits, to run a kernel's own text at twice the precision.
//!
//! A number is the unevaluated sum of two `f64` (Dekker 1971; Hida, Li and Bailey 2001).
//!
//! Relative errors, with v = 2^-53 (Joldes, Muller and Popescu 2017): at most 4 v^2 for sums, at
//! most 5 v^2 for products, below 16 v^2 for quotients and roots. They hold unless a result
//! overflows or falls below 1e-290.
//!
//! The operations are not inlined: a kernel has thousands of them, and a call costs little beside
//! an operation.

use super::scalar::{Scalar, Sealed};
use std::ops::{Add, Div, Mul, Neg, Sub};

/// A number of about 106 bits: a reference for the kernels, and the arithmetic of
/// [`certify`](crate::proximity::LinkProximity::certify).
///
/// ```
/// use parry_continuum::distance::DoubleDouble;
///
/// let third = DoubleDouble::from(1.0) / DoubleDouble::from(3.0);
/// let rest = DoubleDouble::from(1.0) - (third + third + third);
/// assert!(rest.rounded().abs() < 1e-31);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DoubleDouble {
    high: f64,
    low: f64,
}

impl DoubleDouble {
    /// 0
    pub const ZERO: Self = Self { high: 0.0, low: 0.0 };

    /// Returns the nearest `f64`.
    pub fn rounded(self) -> f64 {
        self.high
    }

    fn is_less(self, other: Self) -> bool {
        self.high < other.high || (self.high == other.high && self.low < other.low)
    }
}

impl From<f64> for DoubleDouble {
    fn from(high: f64) -> Self {
        Self { high, low: 0.0 }
    }
}

/// Returns `a + b` and its rounding error.
fn two_sum(a: f64, b: f64) -> DoubleDouble {
    let high = a + b;
    let part = high - a;
    DoubleDouble { high, low: (a - (high - part)) + (b - part) }
}

/// Same as [`two_sum`], for `|a| >= |b|`.
fn quick_two_sum(a: f64, b: f64) -> DoubleDouble {
    let high = a + b;
    DoubleDouble { high, low: b - (high - a) }
}

impl Add for DoubleDouble {
    type Output = Self;
    #[inline(never)]
    fn add(self, other: Self) -> Self {
        let (s, t) = (two_sum(self.high, other.high), two_sum(self.low, other.low));
        let s = quick_two_sum(s.high, s.low + t.high);
        quick_two_sum(s.high, s.low + t.low)
    }
}

impl Neg for DoubleDouble {
    type Output = Self;
    fn neg(self) -> Self {
        Self { high: -self.high, low: -self.low }
    }
}

impl Sub for DoubleDouble {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for DoubleDouble {
    type Output = Self;
    #[inline(never)]
    fn mul(self, other: Self) -> Self {
        let high = self.high * other.high;
        let low = self.high.mul_add(other.high, -high);
        quick_two_sum(high, low + (self.high * other.low + self.low * other.high))
    }
}

impl Div for DoubleDouble {
    type Output = Self;
    #[inline(never)]
    fn div(self, other: Self) -> Self {
        let first = self.high / other.high;
        let rest = self - other * first.into();
        let second = rest.high / other.high;
        let rest = rest - other * second.into();
        Self::from(first) + second.into() + (rest.high / other.high).into()
    }
}

impl Sealed for DoubleDouble {}

impl Scalar for DoubleDouble {
    type Mask = bool;
    const UNIT_ROUNDOFF: f64 = 4.930380657631324e-32; // 2^-104
    const FACE_PASSES: usize = 6;
    const HALLEY_STEPS: usize = 6;

    #[inline(never)] // compiled once, not once for each edge of each kernel
    fn step<R>(work: impl FnOnce() -> R) -> R {
        work()
    }
    fn lit(self, value: f64) -> Self {
        value.into()
    }
    fn lt(self, other: Self) -> bool {
        self.is_less(other)
    }
    fn le(self, other: Self) -> bool {
        self == other || self.is_less(other)
    }
    fn abs(self) -> Self {
        if self.is_less(Self::ZERO) { -self } else { self }
    }
    #[inline(never)]
    fn sqrt(self) -> Self {
        if self.high <= 0.0 {
            return Self::ZERO;
        }
        let root = self.high.sqrt();
        let rest = self - Self::from(root) * root.into();
        quick_two_sum(root, rest.high / (2.0 * root))
    }
    fn mul_add(self, factor: Self, addend: Self) -> Self {
        self * factor + addend
    }
    fn cbrt_estimate(self) -> Self {
        self.high.cbrt_estimate().into()
    }
    fn power_of_two_to_unity(self) -> Self {
        self.high.power_of_two_to_unity().into()
    }
}
