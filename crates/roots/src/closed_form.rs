//! Closed form for degree 1 to 4.
//!
//! **Cubic** x^3 + a x^2 + b x + c. With x = t - a / 3 it is t^3 - 3 Q t + 2 R, Q = (a^2 - 3b) / 9,
//! R = (2a^3 - 9ab + 27c) / 54. For R^2 < Q^3 there are three real roots -2 sqrt Q cos((theta + 2
//! pi k) / 3) - a / 3 with cos theta = R / Q^1.5 (Viete), else one, A + Q / A - a / 3 with A = -sgn
//! R cbrt(|R| + sqrt(R^2 - Q^3)) (Cardano). Only one real root is taken, the one whose terms do not
//! cancel, and polished by a Newton step; it is divided out from the end that its size calls for,
//! and the quadratic gives the others.
//!
//! **Quartic** x^4 + a x^3 + b x^2 + c x + d = (x^2 + a x / 2 + g)^2 - (r x + w)^2 (Ferrari), where
//! comparing coefficients gives r^2 = a^2 / 4 - b + 2g, w^2 = g^2 - d, 2 r w = a g - c, so y = 2g
//! satisfies the resolvent y^3 - b y^2 + (a c - 4d) y + 4bd - a^2 d - c^2 = 0. Its largest real
//! root makes r^2 and w^2 nonnegative, and the quartic two real quadratics. The one of r and w that
//! cancels less is rooted, the other divided, and Newton's method on the two quadratics (a step is
//! that of Bairstow's method) removes what rounding has done.

use super::method::{Method, Tilt};
use super::quadratic::{linear, quadratic};
use super::{Real, Roots};

/// Closed form for degree 1 to 4.
#[derive(Clone, Copy, Debug)]
pub struct ClosedForm;

impl Method for ClosedForm {
    const TILT: Tilt = Tilt::LargestRoot;
    const MAX_DEGREE: usize = 4;

    #[inline]
    fn approximate<T: Real, const M: usize>(
        monic: &[T; M],
        degree: usize,
        roots: &mut Roots<T, M>,
    ) {
        match degree {
            1 => linear(monic[0], roots),
            2 => quadratic(monic[1], monic[0], roots),
            3 => cubic(monic[2], monic[1], monic[0], roots),
            4 => quartic(monic[3], monic[2], monic[1], monic[0], roots),
            _ => {}
        }
    }
}

/// Adds the roots of x^3 + a x^2 + b x + c.
fn cubic<T: Real, const M: usize>(a: T, b: T, c: T, roots: &mut Roots<T, M>) {
    let third = a * T::of(1.0 / 3.0);
    let q = (a * a - b * T::of(3.0)) * T::of(1.0 / 9.0);
    let r = ((a * a * a * T::of(2.0) - a * b * T::of(9.0)) + c * T::of(27.0)) * T::of(1.0 / 54.0);
    // The root farthest from the centre -a / 3 of the three, or Cardano's: it lies on the side of
    // -r.
    let away = -largest(q, r);
    let mut x = away - third;
    for _ in 0..2 {
        x = polished(x, a, b, c);
    }
    roots.push(x, T::ZERO);
    if x == T::ZERO {
        return quadratic(a, b, roots);
    }
    // x^2 + u x + v: from the top where x is the smallest root, from the bottom where it is the
    // largest.
    if (x * x * x).abs() > c.abs() {
        let v = -(c / x);
        quadratic((v - b) / x, v, roots);
    } else {
        let u = a + x;
        quadratic(u, b + x * u, roots);
    }
}

/// The root of t^3 - 3 q t - 2 r of the sign of r, the one farthest from 0.
fn largest<T: Real>(q: T, r: T) -> T {
    let cube = q * q * q;
    let size = if r * r < cube {
        let root = q.sqrt();
        // Within rounding of 1 the quotient may pass it.
        let cos = (r.abs() / (root * q)).min(T::ONE);
        root * T::of(2.0) * (cos.acos() * T::of(1.0 / 3.0)).cos()
    } else {
        let a = (r.abs() + (r * r - cube).sqrt()).cbrt();
        if a == T::ZERO { T::ZERO } else { a + q / a }
    };
    if r < T::ZERO { -size } else { size }
}

/// The largest real root of y^3 - b y^2 + p y + s; or the middle of two larger roots, if rounding
/// may have hidden them.
fn largest_of_resolvent<T: Real>(b: T, p: T, s: T) -> [T; 2] {
    // t^3 - 3 q t - 2 r for y = t + b / 3.
    let third = b * T::of(1.0 / 3.0);
    let q = (third * third) - p * T::of(1.0 / 3.0);
    let r = third * third * third - (third * p + s) * T::of(0.5);
    if r * r < q * q * q {
        let root = q.sqrt();
        let cos = (r / (root * q)).max(-T::ONE).min(T::ONE);
        let y = root * T::of(2.0) * (cos.acos() * T::of(1.0 / 3.0)).cos() + third;
        return [y, y];
    }
    let t = largest(q, r);
    [third + t, third - t * T::of(0.5)]
}

/// Two quadratics x^2 + `u`[i] x + `v`[i] whose product is the quartic.
#[derive(Clone, Copy)]
struct Factors<T> {
    u: [T; 2],
    v: [T; 2],
}

/// Adds the roots of x^4 + a x^3 + b x^2 + c x + d.
fn quartic<T: Real, const M: usize>(a: T, b: T, c: T, d: T, roots: &mut Roots<T, M>) {
    let half = a * T::of(0.5);
    let (p, s) = (a * c - d * T::of(4.0), (b * d * T::of(4.0) - a * a * d) - c * c);
    let [y, hidden] = largest_of_resolvent(b, p, s);
    // r^2 and w^2, and what rounds them: y does with everything of its dimension in the resolvent.
    let size = b.abs() + d.abs().sqrt();
    let squares = |y: T| {
        let g = y * T::of(0.5);
        let (r2, w2) = ((half * half - b) + y, g * g - d);
        (g, r2, w2, half * half + y.abs() + size, g * g + d.abs())
    };
    let (mut g, mut r2, mut w2, mut r_terms, mut w_terms) = squares(polished(y, -b, p, s));
    if r2 < -(r_terms * T::of(1.0 / 256.0)) {
        (g, r2, w2, r_terms, w_terms) = squares(polished(hidden, -b, p, s));
    }
    let product = (a * g - c) * T::of(0.5);
    let (r, w) = if r2 * w_terms >= w2 * r_terms {
        let r = r2.max(T::ZERO).sqrt();
        (r, if r > T::ZERO { product / r } else { w2.max(T::ZERO).sqrt() })
    } else {
        let w = w2.max(T::ZERO).sqrt();
        (if w > T::ZERO { product / w } else { T::ZERO }, w)
    };
    let mut factors = Factors { u: [half - r, half + r], v: [g - w, g + w] };
    // The smaller constant by division: the sum may have cancelled.
    let [low, high] = &mut factors.v;
    if low.abs() < high.abs() {
        *low = d / *high;
    } else if *low != T::ZERO {
        *high = d / *low;
    }
    let factors = factors.refined(a, b, c, d);
    quadratic(factors.u[0], factors.v[0], roots);
    quadratic(factors.u[1], factors.v[1], roots);
}

/// A Newton step on x^3 + a x^2 + b x + c, if it brings the value down.
#[inline]
fn polished<T: Real>(x: T, a: T, b: T, c: T) -> T {
    let value = |x: T| ((x + a) * x + b) * x + c;
    let slope = (x * T::of(3.0) + a * T::of(2.0)) * x + b;
    let before = value(x);
    let next = x - before / slope;
    // False where the slope was 0.
    if value(next).abs() < before.abs() { next } else { x }
}

/// Newton steps on the two quadratics: one or two, unless their roots nearly coincide.
pub(crate) const FACTOR_STEPS: usize = 20;
/// How many roundings the product of the factors may be off.
pub(crate) const FACTOR_ROUNDINGS: f64 = 2.0;

impl<T: Real> Factors<T> {
    /// The differences of the quartic's coefficients from the product's, highest power first, and
    /// the largest one relative to its terms.
    fn lack(&self, a: T, b: T, c: T, d: T) -> ([T; 4], T) {
        let ([u0, u1], [v0, v1]) = (self.u, self.v);
        let (uu, uv, vu, vv) = (u0 * u1, u0 * v1, u1 * v0, v0 * v1);
        let lack = [a - (u0 + u1), (b - (v0 + v1)) - uu, (c - uv) - vu, d - vv];
        let terms =
            [u0.abs() + u1.abs(), v0.abs() + v1.abs() + uu.abs(), uv.abs() + vu.abs(), vv.abs()];
        let mut worst = T::ZERO;
        for (lack, terms) in lack.iter().zip(terms) {
            let share = if terms > T::ZERO { lack.abs() / terms } else { T::ZERO };
            worst = worst.max(share);
        }
        (lack, worst)
    }

    /// Newton's method until the product is the quartic to rounding or no longer comes closer.
    fn refined(self, a: T, b: T, c: T, d: T) -> Self {
        let mut best = self;
        let (mut lack, mut worst) = self.lack(a, b, c, d);
        for _ in 0..FACTOR_STEPS {
            if worst <= T::of(FACTOR_ROUNDINGS * T::UNIT_ROUNDOFF) {
                break;
            }
            let next = best.step(lack);
            let (next_lack, next_worst) = next.lack(a, b, c, d);
            if next.is_finite() && next_worst < worst {
                (best, lack, worst) = (next, next_lack, next_worst);
            } else {
                break;
            }
        }
        best
    }

    fn is_finite(&self) -> bool {
        self.u.iter().chain(&self.v).all(|value| value.is_finite())
    }

    fn step(&self, [r3, r2, r1, r0]: [T; 4]) -> Self {
        let ([u0, u1], [v0, v1]) = (self.u, self.v);
        // Eliminating the second factor's changes leaves two equations for the first's.
        let (du, dv) = (u1 - u0, v1 - v0);
        let right1 = (r1 - u0 * r2) + (u0 * u0 - v0) * r3;
        let right0 = (r0 - v0 * r2) + u0 * v0 * r3;
        let (m11, m21) = (dv - u0 * du, -(v0 * du));
        let determinant = m11 * dv - m21 * du;
        let du0 = (right1 * dv - right0 * du) / determinant;
        let dv0 = (m11 * right0 - m21 * right1) / determinant;
        let du1 = r3 - du0;
        let dv1 = ((r2 - dv0) - u0 * du1) - u1 * du0;
        Self { u: [u0 + du0, u1 + du1], v: [v0 + dv0, v1 + dv1] }
    }
}
