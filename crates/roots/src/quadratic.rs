//! Degree 1 and 2 (paper, equations (34) to (36)).
//!
//! q = -(a1 + sgn(a1) sqrt(a1^2 - 4 a2 a0)) / 2 has no cancellation; the roots are q / a2 and a0 /
//! q. sgn(0) is +1: with 0, as the paper's sgn could be read, x^2 - 1 would have the roots infinity
//! and -0. A negative discriminant means a conjugate pair.

use super::{Real, Roots};

/// Adds the root of x + `constant`.
#[inline]
pub(super) fn linear<T: Real, const M: usize>(constant: T, roots: &mut Roots<T, M>) {
    roots.push(-constant, T::ZERO);
}

/// Adds the roots of x^2 + `u` x + `v`.
#[inline]
pub(super) fn quadratic<T: Real, const M: usize>(u: T, v: T, roots: &mut Roots<T, M>) {
    match split(u, v) {
        Pair::Real(large, small) => {
            roots.push(small, T::ZERO);
            roots.push(large, T::ZERO);
        }
        Pair::Complex(re, im) => roots.push_pair(re, im),
    }
}

/// The roots of a monic quadratic.
#[derive(Clone, Copy)]
pub(super) enum Pair<T> {
    /// The larger in magnitude first.
    Real(T, T),
    /// The real part, and the positive imaginary part.
    Complex(T, T),
}

/// The roots of x^2 + `u` x + `v`.
#[inline]
pub(super) fn split<T: Real>(u: T, v: T) -> Pair<T> {
    let half = u * T::of(0.5);
    let discriminant = half * half - v;
    if discriminant < T::ZERO {
        return Pair::Complex(-half, (-discriminant).sqrt());
    }
    let root = discriminant.sqrt();
    let q = if half >= T::ZERO { -(half + root) } else { root - half };
    let other = if q == T::ZERO { T::ZERO } else { v / q };
    Pair::Real(q, other)
}
