//! Packs of `f64` whose lanes have the bits of single numbers, on every instruction set.
//!
//! [`F64s`] fuses a product and a sum if the instruction set can, and estimates cube roots
//! differently from a single number. Here every lane computes exactly the operations of `f64`. So
//! an answer depends neither on the machine nor on the other lanes.

use super::lanes::{F64Mask, F64s, Pack};
use super::scalar::{Mask, Scalar, Sealed};
use fearless_simd::Simd;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// The number of lanes of the widest pack.
const WIDEST: usize = 8;

/// A pack of `f64`; each lane has the bits of a single `f64`.
#[derive(Clone, Copy)]
pub(crate) struct Unfused<S: Simd>(F64s<S>);

macro_rules! operator {
    ($Trait:ident $method:ident $operator:tt) => {
        impl<S: Simd> $Trait for Unfused<S> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Self(self.0 $operator other.0)
            }
        }
    };
}

operator!(Add add +);
operator!(Sub sub -);
operator!(Mul mul *);
operator!(Div div /);

impl<S: Simd> Neg for Unfused<S> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self(-self.0)
    }
}

impl<S: Simd> Sealed for Unfused<S> {}

impl<S: Simd> Mask<Unfused<S>> for F64Mask<S> {
    #[inline(always)]
    fn select(self, yes: Unfused<S>, no: Unfused<S>) -> Unfused<S> {
        Unfused(Mask::<F64s<S>>::select(self, yes.0, no.0))
    }
}

impl<S: Simd> Scalar for Unfused<S> {
    type Mask = F64Mask<S>;
    const UNIT_ROUNDOFF: f64 = <f64 as Scalar>::UNIT_ROUNDOFF;
    const FACE_PASSES: usize = <f64 as Scalar>::FACE_PASSES;
    const HALLEY_STEPS: usize = <f64 as Scalar>::HALLEY_STEPS;

    #[inline(always)]
    fn lit(self, value: f64) -> Self {
        Self(self.0.lit(value))
    }
    #[inline(always)]
    fn lt(self, other: Self) -> F64Mask<S> {
        self.0.lt(other.0)
    }
    #[inline(always)]
    fn le(self, other: Self) -> F64Mask<S> {
        self.0.le(other.0)
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
        self * factor + addend
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        Self(self.0.max(other.0))
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        Self(self.0.min(other.0))
    }
    #[inline(always)]
    fn over(self, divisor: Self) -> Self {
        Self(self.0.over(divisor.0))
    }
    #[inline(always)]
    fn cbrt_estimate(self) -> Self {
        let mut lanes = [0.0; WIDEST];
        self.0.store(&mut lanes);
        for lane in &mut lanes[..F64s::<S>::LANES] {
            *lane = lane.cbrt_estimate();
        }
        Self(F64s::load(self.0.token(), &lanes))
    }
    #[inline(always)]
    fn power_of_two_to_unity(self) -> Self {
        Self(self.0.power_of_two_to_unity())
    }
}

impl<S: Simd> Pack for Unfused<S> {
    type Element = f64;
    type Token = S;
    const LANES: usize = F64s::<S>::LANES;

    #[inline(always)]
    fn token(self) -> S {
        self.0.token()
    }
    #[inline(always)]
    fn splat(token: S, value: f64) -> Self {
        Self(F64s::splat(token, value))
    }
    #[inline(always)]
    fn load(token: S, from: &[f64]) -> Self {
        Self(F64s::load(token, from))
    }
    #[inline(always)]
    fn store(self, to: &mut [f64]) {
        self.0.store(to);
    }
    #[inline(always)]
    fn bits(mask: F64Mask<S>) -> u64 {
        F64s::<S>::bits(mask)
    }
}
