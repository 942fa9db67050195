//! Synthetic division, by which linear and quadratic factors are tested and taken out.
//!
//! Polynomials are monic or not, lowest power first. Dividing P by z^2 + u z + v gives P = Q (z^2 +
//! u z + v) + b (z + u) + a; the remainder in that form is what the recurrence yields by itself.

use super::quadratic::{Pair, quadratic, split};
use super::{Real, Roots};

/// Quotient and remainder of a division by z^2 + u z + v.
#[derive(Clone, Copy)]
pub(super) struct Division<T, const M: usize> {
    pub quotient: [T; M],
    /// The remainder's coefficient of z + u.
    pub b: T,
    /// The remainder's constant.
    pub a: T,
}

/// Divides the polynomial of this degree, at least 1, by z^2 + `u` z + `v`.
#[inline]
pub(super) fn by_quadratic<T: Real, const M: usize>(
    p: &[T; M],
    degree: usize,
    u: T,
    v: T,
) -> Division<T, M> {
    let mut quotient = [T::ZERO; M];
    let (mut q1, mut q2) = (T::ZERO, T::ZERO);
    for k in (2..=degree).rev() {
        let q = (p[k] - v * q2) - u * q1; // the newest factor last: it is what one waits for
        quotient[k - 2] = q;
        (q1, q2) = (q, q1);
    }
    let b = p[1] - u * q1 - v * q2;
    Division { quotient, b, a: p[0] - u * b - v * q1 }
}

/// Divides by z - `s`: the quotient and the value at `s`.
#[inline]
pub(super) fn by_linear<T: Real, const M: usize>(p: &[T; M], degree: usize, s: T) -> ([T; M], T) {
    let mut quotient = [T::ZERO; M];
    let mut value = p[degree];
    for k in (0..degree).rev() {
        quotient[k] = value;
        value = value * s + p[k];
    }
    (quotient, value)
}

/// The sum of |q_k| `size`^k. Dividing by a factor with roots of that size and of degree m leaves a
/// remainder of rounding that is about `size`^m units of roundoff times this.
#[inline]
pub(super) fn magnitude<T: Real, const M: usize>(quotient: &[T; M], degree: usize, size: T) -> T {
    let mut sum = T::ZERO;
    for k in (0..=degree).rev() {
        sum = sum * size + quotient[k].abs();
    }
    sum
}

impl<T: Real, const M: usize> Division<T, M> {
    /// Whether the divisor divides the polynomial of this degree, within rounding.
    #[inline]
    pub(super) fn is_exact(&self, degree: usize, u: T, v: T, roundings: f64) -> bool {
        // P at a root of the divisor is b (z + u) + a.
        let limit = |size: T| {
            let roundoff = T::of(roundings * T::UNIT_ROUNDOFF);
            magnitude(&self.quotient, degree - 2, size) * size * size * roundoff
        };
        let within = |value: T, limit: T| value <= limit && limit.is_finite();
        match split(u, v) {
            Pair::Real(large, small) => {
                let (high, low) =
                    ((self.b * (large + u) + self.a).abs(), (self.b * (small + u) + self.a).abs());
                // The division rounds what the larger root calls for, also at the smaller one.
                let low = low.max((self.b * small).abs());
                within(high, limit(large.abs()))
                    && within(low * small.abs(), limit(small.abs()) * large.abs())
            }
            Pair::Complex(re, im) => {
                let size = (re * re + im * im).sqrt();
                let value = (self.b * (re + u) + self.a).abs() + (self.b * size).abs();
                within(value, limit(size))
            }
        }
    }
}

/// Takes z^2 + `u` z + `v` out of p, adds its roots and returns the quotient.
///
/// The recurrence from the highest power down keeps its digits for a factor with small roots, the
/// recurrence from the lowest power up for a factor with large roots. In between the two are joined
/// at the polynomial's largest term at the factor's roots, so that each handles only smaller terms
/// (Peters and Wilkinson).
///
/// Of two real roots of different size a quadratic determines the smaller one only within rounding
/// of the larger. So they are polished and taken out one by one.
pub(super) fn deflated<T: Real, const M: usize>(
    p: &[T; M],
    degree: usize,
    u: T,
    v: T,
    roots: &mut Roots<T, M>,
) -> [T; M] {
    let pair = split(u, v);
    if let Pair::Real(large, small) = pair
        && large.abs() > small.abs() * T::of(2.0)
    {
        let (small, large) = (polished(p, degree, small), polished(p, degree, large));
        roots.push(small, T::ZERO);
        roots.push(large, T::ZERO);
        let rest = composite_linear(p, degree, small);
        return composite_linear(&rest, degree - 1, large);
    }
    quadratic(u, v, roots);
    let join = largest_term(p, degree, v.abs().sqrt());
    let mut quotient = by_quadratic(p, degree, u, v).quotient;
    let (mut q1, mut q2) = (T::ZERO, T::ZERO);
    for k in 0..join.min(degree).saturating_sub(1) {
        let q = (p[k] - u * q1 - q2) / v;
        quotient[k] = q;
        (q1, q2) = (q, q1);
    }
    quotient
}

/// The real root after two Newton steps; a step that does not lower |p| is not taken.
fn polished<T: Real, const M: usize>(p: &[T; M], degree: usize, s: T) -> T {
    let mut s = s;
    let (mut quotient, mut value) = by_linear(p, degree, s);
    for _ in 0..2 {
        let next = s - value / by_linear(&quotient, degree - 1, s).1;
        let (next_quotient, next_value) = by_linear(p, degree, next);
        // False where the slope was 0.
        if next_value.abs() < value.abs() {
            (s, quotient, value) = (next, next_quotient, next_value);
        }
    }
    s
}

fn composite_linear<T: Real, const M: usize>(p: &[T; M], degree: usize, s: T) -> [T; M] {
    let (mut quotient, _) = by_linear(p, degree, s);
    let mut q = T::ZERO;
    for k in 0..largest_term(p, degree, s.abs()) {
        q = (q - p[k]) / s;
        quotient[k] = q;
    }
    quotient
}

/// The power whose term is largest at |z| = `size`.
fn largest_term<T: Real, const M: usize>(p: &[T; M], degree: usize, size: T) -> usize {
    let (mut power, mut most, mut place) = (T::ONE, T::ZERO, 0);
    for (k, &a) in p[..=degree].iter().enumerate() {
        let term = a.abs() * power;
        if term > most {
            (most, place) = (term, k);
        }
        power = power * size;
    }
    place
}

/// The positive root of x^n + |p_(n-1)| x^(n-1) + ... + |p_1| x - |p_0|, to a few per cent: no root
/// of p is nearer to 0 (Cauchy). `p` is monic and p_0 is not 0.
pub(super) fn smallest_root_bound<T: Real, const M: usize>(p: &[T; M], degree: usize) -> T {
    let constant = p[0].abs();
    let mut exponent = i32::MAX;
    for (k, &a) in p[1..=degree].iter().enumerate() {
        if a != T::ZERO {
            // Where this term alone reaches the constant.
            exponent =
                exponent.min((constant.exponent() + 1 - a.exponent()).div_euclid(k as i32 + 1) + 1);
        }
    }
    // From above on a convex increasing function, Newton's method only comes down.
    let mut x = T::ONE.times_power_of_two(exponent);
    for _ in 0..16 {
        let (mut value, mut slope) = (T::ZERO, T::ZERO);
        for k in (1..=degree).rev() {
            slope = slope * x + value;
            value = value * x + p[k].abs();
        }
        slope = slope * x + value;
        value = value * x - constant;
        let step = value / slope;
        x = x - step;
        if step <= x * T::of(0.02) {
            break;
        }
    }
    x
}
