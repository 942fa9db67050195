//! A number that counts what is done with it.

use crate::Number;
use parry_continuum::distance::Scalar;
use parry_continuum::distance::laboratory::Sealed;
use real_polynomial_roots::Real;
use std::cell::Cell;
use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub};

/// Operations, as a processor's tables of instructions tell them apart. Comparisons, selects and
/// operations on bits are left out.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Counts {
    /// Additions, subtractions and multiplications.
    pub simple: f64,
    pub divisions: f64,
    pub roots: f64,
    /// Cube roots, cosines and their inverses.
    pub functions: f64,
}

impl AddAssign for Counts {
    fn add_assign(&mut self, other: Self) {
        self.simple += other.simple;
        self.divisions += other.divisions;
        self.roots += other.roots;
        self.functions += other.functions;
    }
}

thread_local! {
    static COUNTS: Cell<Counts> = Cell::default();
}

/// What `job` does on average, called `times` times.
pub fn count(times: usize, job: impl FnOnce()) -> Counts {
    COUNTS.set(Counts::default());
    job();
    let Counts { simple, divisions, roots, functions } = COUNTS.get();
    let times = times as f64;
    Counts {
        simple: simple / times,
        divisions: divisions / times,
        roots: roots / times,
        functions: functions / times,
    }
}

fn note(done: Counts) {
    let mut counts = COUNTS.get();
    counts += done;
    COUNTS.set(counts);
}

const SIMPLE: Counts = Counts { simple: 1.0, divisions: 0.0, roots: 0.0, functions: 0.0 };
const DIVISION: Counts = Counts { simple: 0.0, divisions: 1.0, roots: 0.0, functions: 0.0 };
const ROOT: Counts = Counts { simple: 0.0, divisions: 0.0, roots: 1.0, functions: 0.0 };
const FUNCTION: Counts = Counts { simple: 0.0, divisions: 0.0, roots: 0.0, functions: 1.0 };

/// A number of type `T` that counts.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct Counted<T>(pub T);

macro_rules! operator {
    ($Trait:ident $method:ident $operator:tt $count:ident) => {
        impl<T: Scalar> $Trait for Counted<T> {
            type Output = Self;
            fn $method(self, other: Self) -> Self {
                note($count);
                Self(self.0 $operator other.0)
            }
        }
    };
}

operator!(Add add + SIMPLE);
operator!(Sub sub - SIMPLE);
operator!(Mul mul * SIMPLE);
operator!(Div div / DIVISION);

impl<T: Scalar> Neg for Counted<T> {
    type Output = Self;
    fn neg(self) -> Self {
        Self(-self.0)
    }
}

impl<T> Sealed for Counted<T> {}

impl<T: Number> Scalar for Counted<T> {
    type Mask = bool;
    const UNIT_ROUNDOFF: f64 = <T as Scalar>::UNIT_ROUNDOFF;
    const FACE_PASSES: usize = T::FACE_PASSES;
    const HALLEY_STEPS: usize = T::HALLEY_STEPS;

    fn lit(self, value: f64) -> Self {
        Self(T::of(value))
    }
    fn lt(self, other: Self) -> bool {
        self.0 < other.0
    }
    fn le(self, other: Self) -> bool {
        self.0 <= other.0
    }
    fn abs(self) -> Self {
        Self(Scalar::abs(self.0))
    }
    fn sqrt(self) -> Self {
        note(ROOT);
        Self(Scalar::sqrt(self.0))
    }
    fn mul_add(self, factor: Self, addend: Self) -> Self {
        self * factor + addend
    }
    fn cbrt_estimate(self) -> Self {
        Self(self.0.cbrt_estimate())
    }
    fn power_of_two_to_unity(self) -> Self {
        Self(self.0.power_of_two_to_unity())
    }
}

impl<T: Number> Real for Counted<T> {
    const ZERO: Self = Self(T::ZERO);
    const ONE: Self = Self(T::ONE);
    const UNIT_ROUNDOFF: f64 = <T as Real>::UNIT_ROUNDOFF;
    const MANTISSA_BITS: i32 = T::MANTISSA_BITS;
    const SAFE_EXPONENT: i32 = T::SAFE_EXPONENT;

    fn of(value: f64) -> Self {
        Self(T::of(value))
    }
    fn abs(self) -> Self {
        Scalar::abs(self)
    }
    fn sqrt(self) -> Self {
        Scalar::sqrt(self)
    }
    fn exponent(self) -> i32 {
        self.0.exponent()
    }
    fn times_power_of_two(self, exponent: i32) -> Self {
        Self(self.0.times_power_of_two(exponent))
    }
    fn is_finite(self) -> bool {
        self.0.is_finite()
    }
    fn cbrt(self) -> Self {
        note(FUNCTION);
        Self(self.0.cbrt())
    }
    fn cos(self) -> Self {
        note(FUNCTION);
        Self(self.0.cos())
    }
    fn acos(self) -> Self {
        note(FUNCTION);
        Self(self.0.acos())
    }
}
