//! What a root finder returns.

use super::Real;
use std::fmt;

/// A complex number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Complex<T> {
    /// The real part.
    pub re: T,
    /// The imaginary part, exactly 0 for a real root.
    pub im: T,
}

/// The roots of a polynomial with `M` coefficients, a root of multiplicity k k times.
///
/// A real root's imaginary part is exactly 0. Complex roots come as conjugate pairs, side by side,
/// the one with the positive imaginary part first. There is no other order.
#[derive(Clone, Copy, PartialEq)]
pub struct Roots<T, const M: usize> {
    values: [Complex<T>; M],
    count: usize,
}

impl<T: Real, const M: usize> Roots<T, M> {
    pub(super) fn none() -> Self {
        Self { values: [Complex { re: T::ZERO, im: T::ZERO }; M], count: 0 }
    }

    #[inline]
    pub(super) fn push(&mut self, re: T, im: T) {
        // A finder never pushes more roots than the degree, which is below M.
        if let Some(place) = self.values.get_mut(self.count) {
            *place = Complex { re, im };
            self.count += 1;
        }
    }

    #[inline]
    pub(super) fn push_pair(&mut self, re: T, im: T) {
        let im = im.abs();
        self.push(re, im);
        self.push(re, -im);
    }

    /// The roots.
    pub fn as_slice(&self) -> &[Complex<T>] {
        &self.values[..self.count]
    }

    /// The roots, one by one.
    pub fn iter(&self) -> std::iter::Copied<std::slice::Iter<'_, Complex<T>>> {
        self.as_slice().iter().copied()
    }

    /// The real roots.
    pub fn real(&self) -> impl Iterator<Item = T> + '_ {
        self.iter().filter(|root| root.im == T::ZERO).map(|root| root.re)
    }

    /// How many roots there are, each counted as often as its multiplicity.
    pub fn len(&self) -> usize {
        self.count
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.count == 0
    }
}

impl<T: Real, const M: usize> fmt::Debug for Roots<T, M> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_list().entries(self.as_slice()).finish()
    }
}

impl<'a, T: Real, const M: usize> IntoIterator for &'a Roots<T, M> {
    type Item = Complex<T>;
    type IntoIter = std::iter::Copied<std::slice::Iter<'a, Complex<T>>>;
    fn into_iter(self) -> Self::IntoIter {
        self.iter()
    }
}

/// Why a polynomial's roots were not found.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RootsError<T: Real, const M: usize> {
    /// A coefficient is NaN or infinite.
    #[error("the coefficient of x^{power} is not finite")]
    NotFinite {
        /// The power of x that it belongs to.
        power: usize,
    },
    /// All coefficients are 0.
    #[error("every coefficient is 0, so every number is a root")]
    Zero,
    /// The closed form ends at degree 4.
    #[error("a polynomial of degree {degree} has no closed form: use JenkinsTraub or Companion")]
    NoClosedForm {
        /// The polynomial's degree.
        degree: usize,
    },
    /// A root exceeds the largest number of this precision.
    #[error(
        "a root is beyond the range of this precision: multiply the coefficient of x^k by c^k, c > 1"
    )]
    OutOfRange,
    /// Not every root was found to rounding.
    #[error("only {} roots converged: try another finder", found.len())]
    NotConverged {
        /// The roots found so far: each is a root within rounding.
        found: Roots<T, M>,
    },
}
