//! Roots of real polynomials by four methods, to be compared and chosen from.
//!
//! | method | best at | cost |
//! |---|---|---|
//! | [`ClosedForm`] | degree 1 to 4, the fastest there | fixed |
//! | [`Bairstow`] | a few degrees more; sensitive to its start | quadratic factors by Newton's method |
//! | [`Companion`] | the steadiest, and the slowest | eigenvalues by QR, n^2 a sweep |
//! | [`JenkinsTraub`] | the all-rounder for high degrees | three stages per root |
//!
//! **Which to choose.** Up to degree 4 the closed form: at degree 4 in `f64` it took 0.22 us a
//! polynomial, Bairstow 2.3, Jenkins-Traub 2.8 and the companion matrix 4.4 times as long. Above,
//! Bairstow and Jenkins-Traub are about equal (degree 10: 3.5 us) and the companion matrix takes
//! 1.3 to 1.8 times as long. Of the roots of a million random polynomials of degree 15,
//! Jenkins-Traub and the companion matrix found all in `f64`, Bairstow all but 13 in a
//! million. (Table V of the repository's
//! `docs/internals/studies.md`.)
//!
//! Coefficients come lowest power first: `coefficients[k]` belongs to x^k. Nothing is allocated.
//! All methods are tested up to degree 15 and share what surrounds the method itself:
//!
//! - **Leading zeros** lower the degree. A constant other than 0 has no roots; of 0 every number is
//!   a root, which is an error.
//! - **Zero roots**, trailing coefficients of exactly 0, are taken out first and are exactly 0.
//! - **Scale**: the polynomial is scaled by powers of two, exactly, so that coefficients of any
//!   size will do.
//! - **Multiplicity**: a root of multiplicity k comes k times, in general as k near values:
//!   rounding a coefficient moves them by about the k-th root of the rounding.
//! - **Convergence**: each root returned solves the polynomial to rounding (its residual is no
//!   larger than that of coefficients changed in their last digits). If one does not, the answer is
//!   [`RootsError::NotConverged`] with the others.
//!
//! ```
//! use real_polynomial_roots::{JenkinsTraub, RootFinder};
//!
//! // x^3 - x^2 + x - 1 = (x - 1) (x^2 + 1)
//! let roots = JenkinsTraub::roots([-1.0, 1.0, -1.0, 1.0])?;
//! assert_eq!(roots.len(), 3);
//! let real: Vec<f64> = roots.real().collect();
//! assert_eq!(real.len(), 1);
//! assert!((real[0] - 1.0).abs() < 1e-15);
//! # Ok::<(), real_polynomial_roots::RootsError<f64, 4>>(())
//! ```
//!
//! The methods are from section IV of Leibrandt and Yang, "Efficient Proximity Queries for
//! Continuum Robots on Parallel Computing Hardware".
#![forbid(unsafe_code)]
#![warn(missing_docs)]

mod bairstow;
mod check;
mod closed_form;
mod companion;
mod division;
mod found;
#[cfg(feature = "gpu")]
pub mod gpu;
mod jenkins_traub;
mod pieces;
mod quadratic;
mod real;

use check::{Checker, Scaled};
use pieces::Exponents;

pub use bairstow::Bairstow;
pub use closed_form::ClosedForm;
pub use companion::Companion;
pub use found::{Complex, Roots, RootsError};
pub use jenkins_traub::JenkinsTraub;
pub use real::Real;

pub(crate) mod method {
    use super::{Real, Roots};

    pub use super::pieces::Tilt;

    /// What tells one method from another.
    pub trait Method {
        const TILT: Tilt;
        const MAX_DEGREE: usize = usize::MAX;

        /// Approximates the roots of a monic polynomial whose constant coefficient is not 0, at
        /// least of degree
        /// 1. Fewer than `degree` roots mean that some did not converge.
        fn approximate<T: Real, const M: usize>(
            monic: &[T; M],
            degree: usize,
            roots: &mut Roots<T, M>,
        );
    }
}

/// A way to find the roots of a real polynomial.
pub trait RootFinder: method::Method {
    /// The roots of the sum of `coefficients[k]` x^k.
    ///
    /// # Errors
    /// See [`RootsError`].
    fn roots<T: Real, const M: usize>(
        coefficients: [T; M],
    ) -> Result<Roots<T, M>, RootsError<T, M>>;

    /// The roots as they come, without the test by which [`RootFinder::roots`] vouches for them:
    /// fewer where some did not converge, none where it refuses the coefficients. For callers
    /// who judge every candidate themselves.
    fn approximations<T: Real, const M: usize>(coefficients: &[T; M]) -> Roots<T, M>;
}

impl<F: method::Method> RootFinder for F {
    fn roots<T: Real, const M: usize>(
        coefficients: [T; M],
    ) -> Result<Roots<T, M>, RootsError<T, M>> {
        if let Some(power) = coefficients.iter().position(|a| !a.is_finite()) {
            return Err(RootsError::NotFinite { power });
        }
        let Some((low, high)) = extent(&coefficients) else { return Err(RootsError::Zero) };
        if high - low > F::MAX_DEGREE {
            return Err(RootsError::NoClosedForm { degree: high - low });
        }
        let (approximations, checker) = approximate::<F, T, M>(&coefficients, low, high);
        approximations.settle(&checker, low, high)
    }

    // Only what the cutting of a wide polynomial has moved is polished.
    fn approximations<T: Real, const M: usize>(coefficients: &[T; M]) -> Roots<T, M> {
        let mut found = Roots::none();
        let Some((low, high)) = extent(coefficients) else { return found };
        if high - low > F::MAX_DEGREE || coefficients.iter().any(|a| !a.is_finite()) {
            return found;
        }
        for _ in 0..low {
            found.push(T::ZERO, T::ZERO);
        }
        let (approximations, checker) = approximate::<F, T, M>(coefficients, low, high);
        for index in 0..approximations.values.len() {
            let mut root = approximations.at(index);
            if matches!(checker, Checker::Wide { .. }) {
                root = approximations.settled(index, &checker).unwrap_or(root);
            }
            let Complex { re, im } = root.unscaled();
            found.push(re, im);
        }
        found
    }
}

/// The roots other than 0 by the method `F`, and what they are tested against.
#[inline]
fn approximate<F: method::Method, T: Real, const M: usize>(
    coefficients: &[T; M],
    low: usize,
    high: usize,
) -> (Approximations<T, M>, Checker<T, M>) {
    let exponents = Exponents::of(coefficients);
    let mut approximations = Approximations::new();
    if exponents.are_close::<T>() {
        let piece = pieces::whole(coefficients, low, high);
        approximations.add::<F>(&piece.monic, piece.degree, 0);
        return (approximations, Checker::close(piece.monic, piece.degree));
    }
    let mut from = low;
    while from < high {
        let to = exponents.piece_end::<T>(from, high, F::TILT);
        let piece = exponents.piece(coefficients, from, to, F::TILT);
        approximations.add::<F>(&piece.monic, piece.degree, piece.shift);
        from = to;
    }
    (approximations, Checker::wide(coefficients, low, high))
}

/// The lowest and the highest power with a coefficient other than 0.
fn extent<T: Real, const M: usize>(coefficients: &[T; M]) -> Option<(usize, usize)> {
    let low = coefficients.iter().position(|&a| a != T::ZERO)?;
    let high = coefficients.iter().rposition(|&a| a != T::ZERO)?;
    Some((low, high))
}

/// The approximations of all pieces.
struct Approximations<T: Real, const M: usize> {
    values: Roots<T, M>,
    shifts: [i32; M],
}

impl<T: Real, const M: usize> Approximations<T, M> {
    fn new() -> Self {
        Self { values: Roots::none(), shifts: [0; M] }
    }

    fn add<F: method::Method>(&mut self, monic: &[T; M], degree: usize, shift: i32) {
        let before = self.values.len();
        F::approximate(monic, degree, &mut self.values);
        self.shifts[before..self.values.len()].fill(shift);
    }

    fn at(&self, index: usize) -> Scaled<T> {
        Scaled { value: self.values.as_slice()[index], shift: self.shifts[index] }
    }

    /// The root that an approximation stands for, if it does.
    fn settled(&self, index: usize, checker: &Checker<T, M>) -> Option<Scaled<T>> {
        let others =
            (0..self.values.len()).filter(|&other| other != index).map(|other| self.at(other));
        checker.settle(self.at(index), others)
    }

    /// The roots among the approximations, after the `low` zero roots.
    fn settle(
        &self,
        checker: &Checker<T, M>,
        low: usize,
        high: usize,
    ) -> Result<Roots<T, M>, RootsError<T, M>> {
        let mut found = Roots::none();
        for _ in 0..low {
            found.push(T::ZERO, T::ZERO);
        }
        let count = self.values.len();
        for index in 0..count {
            if self.at(index).value.im < T::ZERO {
                continue; // with its conjugate
            }
            let Some(root) = self.settled(index, checker) else { continue };
            let Complex { re, im } = root.unscaled();
            if !(re.is_finite() && im.is_finite()) {
                return Err(RootsError::OutOfRange);
            }
            if root.value.im == T::ZERO {
                found.push(re, T::ZERO);
            } else {
                found.push_pair(re, im);
            }
        }
        if found.len() == high { Ok(found) } else { Err(RootsError::NotConverged { found }) }
    }
}

/// Runs the code in the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
