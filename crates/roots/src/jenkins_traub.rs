//! Jenkins and Traub's three-stage algorithm for real polynomials, from their description (SIAM
//! Journal on Numerical Analysis 7, 1970, 545-566).
//!
//! A sequence of polynomials K of degree n - 1 turns towards P / (z - smallest root), or towards
//! the part of P without its two smallest roots. One step, with a quadratic divisor s of two
//! conjugate or real shifts, is
//!
//! ```text
//! K := (K - (A z + B) P) / s,   A and B such that s divides.
//! ```
//!
//! With P = Qp s + b (z + u) + a and K = Qk s + d (z + u) + c that means A = (a d - b c) / D,
//! B = (a c + (a u + b v) d) / D, D = a^2 + u a b + v b^2, and the new K is Qk - (A z + B) Qp - A
//! b, which is kept monic. From any K a better divisor follows: let K0 = K and z K(i+1) = K(i) -
//! K(i)(0) / P(0) P; the divisor whose roots K0, K1 and K2 agree on is [K1,K2] z^2 - [K0,K2] z +
//! [K0,K1], where [.,.] is the determinant of two remainders modulo s.
//!
//! 1. **No shift**: five steps with s = z, from K = P', favour the small roots.
//! 2. **Fixed shift**: s has its roots on the circle that bounds the roots of P from below, at 49
//!    degrees and, after each failure, 94 degrees on. When the estimates of a real root (-P(0) /
//!    K(0)) or of a quadratic factor have settled twice to within half, stage 3 is tried with them.
//! 3. **Variable shift**: the estimate becomes the shift of the next step, which converges faster
//!    than Newton's method, until P at the estimate is within rounding.
//!
//! The factor is divided out. Since small roots come first, that is stable.

use super::bairstow::{ROUNDINGS, first_direction, refine, turned};
use super::division::{Division, by_linear, by_quadratic, magnitude, smallest_root_bound};
use super::method::{Method, Tilt};
use super::quadratic::{Pair, linear, quadratic, split};
use super::{Real, Roots};

/// Jenkins and Traub's algorithm for any degree.
#[derive(Clone, Copy, Debug)]
pub struct JenkinsTraub;

/// Steps without a shift.
pub(crate) const NO_SHIFT_STEPS: usize = 5;
/// Directions in which a fixed shift is tried; the k-th for 20 k steps.
pub(crate) const DIRECTIONS: usize = 20;
/// Steps of stage 3.
pub(crate) const LINEAR_STEPS: usize = 10;
pub(crate) const QUADRATIC_STEPS: usize = 20;

impl Method for JenkinsTraub {
    const TILT: Tilt = Tilt::Balanced;

    fn approximate<T: Real, const M: usize>(
        monic: &[T; M],
        degree: usize,
        roots: &mut Roots<T, M>,
    ) {
        let mut p = *monic;
        let mut degree = degree;
        while degree > 2 {
            match (Stages { p: &p, degree }).factor() {
                Some(Factor::Linear { root, quotient }) => {
                    roots.push(root, T::ZERO);
                    p = quotient;
                    degree -= 1;
                }
                Some(Factor::Quadratic { u, v, quotient }) => {
                    quadratic(u, v, roots);
                    p = quotient;
                    degree -= 2;
                }
                None => return,
            }
        }
        if degree == 2 { quadratic(p[1], p[0], roots) } else { linear(p[0], roots) }
    }
}

/// A factor and the quotient.
enum Factor<T, const M: usize> {
    Linear { root: T, quotient: [T; M] },
    Quadratic { u: T, v: T, quotient: [T; M] },
}

/// The stages for one factor of a monic polynomial.
struct Stages<'a, T, const M: usize> {
    p: &'a [T; M],
    degree: usize,
}

impl<T: Real, const M: usize> Stages<'_, T, M> {
    fn factor(&self) -> Option<Factor<T, M>> {
        let start = self.without_shift();
        let bound = smallest_root_bound(self.p, self.degree);
        let mut direction = first_direction::<T>();
        for attempt in 1..=DIRECTIONS {
            let x = direction.0 * bound;
            if let Some(factor) =
                self.with_fixed_shift(start, -(x + x), bound * bound, 20 * attempt)
            {
                return Some(factor);
            }
            direction = turned(direction);
        }
        None
    }

    /// Stage 1.
    fn without_shift(&self) -> [T; M] {
        let n = self.degree;
        let mut k = [T::ZERO; M];
        for (i, place) in k.iter_mut().enumerate().take(n) {
            *place = self.p[i + 1] * T::of((i + 1) as f64 / n as f64);
        }
        for _ in 0..NO_SHIFT_STEPS {
            let scale = -(self.p[0] / k[0]);
            // K(0) = 0, or so little that the quotient drowns P: z divides K as it is.
            let is_usual = (scale * T::of(T::UNIT_ROUNDOFF)).abs() < T::ONE;
            for i in 0..n {
                let above = if i + 1 < n { k[i + 1] } else { T::ZERO };
                k[i] = if is_usual { self.p[i + 1] + scale * above } else { above };
            }
        }
        k
    }

    /// Stages 2 and 3.
    fn with_fixed_shift(&self, k: [T; M], u: T, v: T, steps: usize) -> Option<Factor<T, M>> {
        let n = self.degree;
        let of_p = by_quadratic(self.p, n, u, v);
        let mut k = k;
        let mut of_k = by_quadratic(&k, n - 1, u, v);
        let mut linear = Settling::new(T::of(0.5));
        let mut quadratic = Settling::new(T::of(0.5));
        for _ in 0..steps {
            k = next(&of_p, &of_k, n, u, v);
            of_k = by_quadratic(&k, n - 1, u, v);
            let estimate = self.estimate(&k, &of_p, &of_k, u, v);
            let root = -(self.p[0] / k[0]);
            let linear_settled = linear.settles(root);
            let quadratic_settled = estimate.is_some_and(|(_, v)| quadratic.settles(v));
            if quadratic_settled && let Some((u, v)) = estimate {
                if let Some(factor) = self.quadratic_stage(k, u, v) {
                    return Some(factor);
                }
                quadratic.demand_more();
            }
            if linear_settled {
                match self.linear_stage(k, root) {
                    Ok(factor) => return Some(factor),
                    Err(near) => {
                        // Two roots close together stop the linear iteration near them. Where they
                        // are so close that the estimates lose their
                        // digits, Newton's method finds the factor.
                        let (u, v) = (-(near + near), near * near);
                        if let Some(factor) = self.quadratic_stage(k, u, v) {
                            return Some(factor);
                        }
                        if let Some((u, v)) = refine(self.p, n, u, v) {
                            let quotient = by_quadratic(self.p, n, u, v).quotient;
                            return Some(Factor::Quadratic { u, v, quotient });
                        }
                    }
                }
                linear.demand_more();
            }
        }
        None
    }

    /// The divisor that K, K1 and K2 agree on, given the divisions by z^2 + `u` z + `v`.
    fn estimate(
        &self,
        k: &[T; M],
        of_p: &Division<T, M>,
        of_k: &Division<T, M>,
        u: T,
        v: T,
    ) -> Option<(T, T)> {
        // Remainders x z + y, as (x, y).
        let p = (of_p.b, of_p.a + u * of_p.b);
        let k0 = (of_k.b, of_k.a + u * of_k.b);
        let divided_by_z = |(x, y): (T, T)| (-(y / v), x - u * y / v);
        let less = |(x, y): (T, T), factor: T| (x - factor * p.0, y - factor * p.1);
        let first = k[0] / self.p[0];
        let k1 = divided_by_z(less(k0, first));
        let second = (k[1] - first * self.p[1]) / self.p[0];
        let k2 = divided_by_z(less(k1, second));
        let determinant = |(a, b): (T, T), (c, d): (T, T)| a * d - b * c;
        let leading = determinant(k1, k2);
        let (u, v) = (-(determinant(k0, k2) / leading), determinant(k0, k1) / leading);
        (u.is_finite() && v.is_finite() && v != T::ZERO).then_some((u, v))
    }

    /// The factor, or where the iteration was when it ran out of steps.
    fn linear_stage(&self, k: [T; M], root: T) -> Result<Factor<T, M>, T> {
        let n = self.degree;
        let (mut k, mut s) = (k, root);
        for _ in 0..LINEAR_STEPS {
            let (of_p, p_at) = by_linear(self.p, n, s);
            let limit =
                magnitude(&of_p, n - 1, s.abs()) * s.abs() * T::of(ROUNDINGS * T::UNIT_ROUNDOFF);
            if p_at.abs() <= limit && limit.is_finite() {
                return Ok(Factor::Linear { root: s, quotient: of_p });
            }
            let (of_k, k_at) = by_linear(&k, n - 1, s);
            let scale = p_at / k_at;
            for i in 0..n {
                k[i] = if scale.is_finite() { of_p[i] - scale * of_k[i] } else { of_k[i] };
            }
            let step = p_at / by_linear(&k, n - 1, s).1;
            if !step.is_finite() {
                return Err(s);
            }
            s = s - step;
        }
        Err(s)
    }

    fn quadratic_stage(&self, k: [T; M], u: T, v: T) -> Option<Factor<T, M>> {
        let n = self.degree;
        let (mut k, mut u, mut v) = (k, u, v);
        for _ in 0..QUADRATIC_STEPS {
            // Two real roots far apart are better found one by one.
            if let Pair::Real(large, small) = split(u, v)
                && (large.abs() - small.abs()) > small.abs() * T::of(0.01)
            {
                return None;
            }
            let of_p = by_quadratic(self.p, n, u, v);
            if of_p.is_exact(n, u, v, ROUNDINGS) {
                return Some(Factor::Quadratic { u, v, quotient: of_p.quotient });
            }
            let of_k = by_quadratic(&k, n - 1, u, v);
            k = next(&of_p, &of_k, n, u, v);
            let of_k = by_quadratic(&k, n - 1, u, v);
            (u, v) = self.estimate(&k, &of_p, &of_k, u, v)?;
        }
        None
    }
}

/// The next K, monic, with the divisor z^2 + `u` z + `v`.
fn next<T: Real, const M: usize>(
    of_p: &Division<T, M>,
    of_k: &Division<T, M>,
    n: usize,
    u: T,
    v: T,
) -> [T; M] {
    let (a, b, c, d) = (of_p.a, of_p.b, of_k.a, of_k.b);
    let e = a * u + b * v;
    let (p, q) = (&of_p.quotient, &of_k.quotient);
    // -K / A = z Qp + (B / A) Qp + b - Qk / A.
    let numerator = a * d - b * c;
    let (ratio, inverse) = ((a * c + e * d) / numerator, (a * a + b * e) / numerator);
    let mut k = [T::ZERO; M];
    if ratio.is_finite() && inverse.is_finite() {
        k[0] = b + ratio * p[0] - inverse * q[0];
        for i in 1..n {
            k[i] = p[i - 1] + ratio * p[i] - inverse * q[i];
        }
    } else {
        k = *q;
    }
    k
}

/// Whether a sequence has settled: two successive relative changes at most `within`.
struct Settling<T> {
    last: T,
    was_close: bool,
    within: T,
}

impl<T: Real> Settling<T> {
    fn new(within: T) -> Self {
        Self { last: T::ZERO, was_close: false, within }
    }

    fn settles(&mut self, value: T) -> bool {
        let close = (value - self.last).abs() <= self.within * self.last.abs();
        self.last = value;
        std::mem::replace(&mut self.was_close, close) && close
    }

    fn demand_more(&mut self) {
        self.within = self.within * T::of(0.25);
    }
}
