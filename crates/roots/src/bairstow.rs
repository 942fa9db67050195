//! Bairstow's method: one quadratic factor after another, by Newton's method in its two
//! coefficients.
//!
//! Divide P by z^2 + u z + v, and the quotient again: P mod = b (z + u) + a, Q mod = d (z + u) + c.
//! A change (du, dv) changes the first remainder by -(du z + dv) Q modulo the divisor, and with z
//! (d (z + u) + c) = c (z + u) - (c u + d v) the Newton equations are
//!
//! ```text
//! c du + d dv = b,   -(c u + d v) du + c dv = a,   determinant c^2 + u c d + v d^2.
//! ```
//!
//! The paper uses a custom implementation, "sensitive to initial guesses". Here the guesses lie on
//! the circle that bounds the roots from below, turned by 94 degrees after a failure, so that small
//! factors come first and leave the rest undisturbed.

use super::division::{by_quadratic, deflated, smallest_root_bound};
use super::method::{Method, Tilt};
use super::quadratic::{linear, quadratic};
use super::{Real, Roots};

/// Bairstow's method for any degree.
#[derive(Clone, Copy, Debug)]
pub struct Bairstow;

/// Steps from one guess.
pub(crate) const STEPS: usize = 40;
/// Guesses for one factor.
pub(crate) const GUESSES: usize = 40;
/// Rounding errors per step of the division that the remainder may amount to.
pub(crate) const ROUNDINGS: f64 = 8.0;

impl Method for Bairstow {
    const TILT: Tilt = Tilt::Balanced;

    fn approximate<T: Real, const M: usize>(
        monic: &[T; M],
        degree: usize,
        roots: &mut Roots<T, M>,
    ) {
        let mut rest = *monic;
        let mut degree = degree;
        while degree > 2 {
            let Some((u, v)) = factor(&rest, degree) else { return };
            rest = deflated(&rest, degree, u, v, roots);
            degree -= 2;
        }
        if degree == 2 { quadratic(rest[1], rest[0], roots) } else { linear(rest[0], roots) }
    }
}

/// u and v of a quadratic factor.
fn factor<T: Real, const M: usize>(p: &[T; M], degree: usize) -> Option<(T, T)> {
    let mut radius = smallest_root_bound(p, degree);
    let mut direction = first_direction::<T>();
    for _ in 0..GUESSES {
        let (u, v) = (-(direction.0 * radius + direction.0 * radius), radius * radius);
        if let Some(found) = refine(p, degree, u, v) {
            return Some(found);
        }
        direction = turned(direction);
        radius = radius * T::of(1.5);
    }
    None
}

/// The cosine and the sine of 49 degrees.
pub(crate) const FIRST_DIRECTION: [f64; 2] = [0.656_059_028_990_507_3, 0.754_709_580_222_772];
/// The cosine and the sine of 94 degrees.
pub(crate) const TURN: [f64; 2] = [-0.069_756_473_744_125_3, 0.997_564_050_259_824_2];

/// The direction in which iterations start first.
pub(super) fn first_direction<T: Real>() -> (T, T) {
    (T::of(FIRST_DIRECTION[0]), T::of(FIRST_DIRECTION[1]))
}

/// A direction turned by 94 degrees.
pub(super) fn turned<T: Real>((x, y): (T, T)) -> (T, T) {
    let [cos, sin] = TURN.map(T::of);
    (cos * x - sin * y, sin * x + cos * y)
}

/// Newton's method from the factor z^2 + `u` z + `v`.
pub(super) fn refine<T: Real, const M: usize>(
    p: &[T; M],
    degree: usize,
    u: T,
    v: T,
) -> Option<(T, T)> {
    let (mut u, mut v) = (u, v);
    for _ in 0..STEPS {
        let first = by_quadratic(p, degree, u, v);
        if first.is_exact(degree, u, v, ROUNDINGS) {
            return Some((u, v));
        }
        let second = by_quadratic(&first.quotient, degree - 2, u, v);
        let (a, b, c, d) = (first.a, first.b, second.a, second.b);
        let e = c * u + d * v;
        let determinant = c * c + d * e;
        u = u + (b * c - a * d) / determinant;
        v = v + (a * c + b * e) / determinant;
        if !(u.is_finite() && v.is_finite()) {
            return None;
        }
    }
    None
}
