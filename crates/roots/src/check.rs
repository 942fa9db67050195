//! The test that every returned root solves the polynomial within rounding.
//!
//! A number z is a root to rounding if |p(z)| <= c n u sum |a_k| |z|^k: then it is the exact root
//! of a polynomial whose coefficients differ from the given ones by c n u relative, and nothing
//! better can be said in working precision. Every approximation is tested so on the whole
//! polynomial. One that fails is polished by Newton's method, within a quarter of the distance to
//! its nearest neighbour so that no two can become one, and is not returned if it fails again.
//!
//! The powers of a large or small z leave the range, so the test is done in a variable near 1.

use super::pieces::Exponents;
use super::{Complex, Real};

/// How many rounding errors per degree |p(z)| may amount to.
const TOLERANCE: f64 = 16.0;

/// How many Newton steps an approximation is given.
const POLISH_STEPS: usize = 8;

/// A root 2^`shift` `value`.
#[derive(Clone, Copy)]
pub(super) struct Scaled<T> {
    pub value: Complex<T>,
    pub shift: i32,
}

impl<T: Real> Scaled<T> {
    pub(super) fn unscaled(&self) -> Complex<T> {
        if self.shift == 0 {
            return self.value;
        }
        Complex {
            re: self.value.re.times_power_of_two(self.shift),
            im: self.value.im.times_power_of_two(self.shift),
        }
    }
}

/// The polynomial against which roots are tested.
pub(super) enum Checker<T, const M: usize> {
    /// Monic, with coefficients of comparable size: lowest power first, and highest first.
    Close { up: [T; M], down: [T; M], degree: usize },
    /// Any other: the coefficients that are left when zero roots are taken out.
    Wide { coefficients: [T; M], degree: usize },
}

/// A polynomial in a scaled variable: the tested root is near 1, or at most 1.
struct View<T, const M: usize> {
    coefficients: [T; M],
    degree: usize,
    y: Complex<T>,
    /// Whether y stands for 1 / x.
    reversed: bool,
    /// x = 2^shift y otherwise.
    shift: i32,
}

impl<T: Real, const M: usize> Checker<T, M> {
    pub(super) fn close(monic: [T; M], degree: usize) -> Self {
        let mut down = [T::ZERO; M];
        for k in 0..=degree {
            down[degree - k] = monic[k];
        }
        Self::Close { up: monic, down, degree }
    }

    pub(super) fn wide(coefficients: &[T; M], low: usize, high: usize) -> Self {
        let mut shifted = [T::ZERO; M];
        shifted[..=high - low].copy_from_slice(&coefficients[low..=high]);
        Self::Wide { coefficients: shifted, degree: high - low }
    }

    fn view(&self, root: &Scaled<T>) -> View<T, M> {
        match self {
            Self::Close { up, down, degree } => {
                let one = T::ONE;
                let z = root.unscaled();
                if z.re.abs() <= one && z.im.abs() <= one {
                    return View {
                        coefficients: *up,
                        degree: *degree,
                        y: z,
                        reversed: false,
                        shift: 0,
                    };
                }
                View {
                    coefficients: *down,
                    degree: *degree,
                    y: inverse(z),
                    reversed: true,
                    shift: 0,
                }
            }
            Self::Wide { coefficients, degree } => {
                let size = root.value.re.abs().max(root.value.im.abs());
                let exponent = if size == T::ZERO { 0 } else { size.exponent() };
                let shift = root.shift + exponent;
                let exponents = Exponents::of(coefficients);
                let scale = exponents.scale_to_one(shift);
                let mut scaled = [T::ZERO; M];
                for (k, (to, from)) in scaled.iter_mut().zip(coefficients).enumerate() {
                    *to = from.times_power_of_two(scale + shift * k as i32);
                }
                let y = Complex {
                    re: root.value.re.times_power_of_two(-exponent),
                    im: root.value.im.times_power_of_two(-exponent),
                };
                View { coefficients: scaled, degree: *degree, y, reversed: false, shift }
            }
        }
    }

    /// The root if it is one to rounding, polished if need be. `others` are the other
    /// approximations.
    pub(super) fn settle(
        &self,
        root: Scaled<T>,
        others: impl Iterator<Item = Scaled<T>>,
    ) -> Option<Scaled<T>> {
        let mut view = self.view(&root);
        if view.is_root() {
            return Some(root);
        }
        if !(root.value.re.is_finite() && root.value.im.is_finite()) {
            return None;
        }
        let start = view.y;
        let mut room = modulus(start);
        for other in others {
            room = room.min(modulus(minus(view.local(&other), start)));
        }
        let room = room * T::of(0.25);
        for _ in 0..POLISH_STEPS {
            let next = minus(view.y, view.newton_step());
            let is_near = modulus(minus(next, start)) <= room;
            // NaN is not near either.
            if !is_near {
                return None;
            }
            view.y =
                if root.value.im == T::ZERO { Complex { re: next.re, im: T::ZERO } } else { next };
            if view.is_root() {
                return Some(view.root());
            }
        }
        None
    }
}

impl<T: Real, const M: usize> View<T, M> {
    /// Whether y is a root to rounding.
    fn is_root(&self) -> bool {
        let Complex { re, im } = self.y;
        let size = if im == T::ZERO { re.abs() } else { modulus(self.y) };
        let (mut value_re, mut value_im, mut sum) = (T::ZERO, T::ZERO, T::ZERO);
        for &a in self.coefficients[..=self.degree].iter().rev() {
            (value_re, value_im) =
                (value_re * re - value_im * im + a, value_re * im + value_im * re);
            sum = sum * size + a.abs();
        }
        let tolerance = T::of(TOLERANCE * T::UNIT_ROUNDOFF * self.degree as f64) * sum;
        let value = if im == T::ZERO {
            value_re.abs()
        } else {
            modulus(Complex { re: value_re, im: value_im })
        };
        value <= tolerance
    }

    fn newton_step(&self) -> Complex<T> {
        let zero = Complex { re: T::ZERO, im: T::ZERO };
        let (mut value, mut slope) = (zero, zero);
        for &a in self.coefficients[..=self.degree].iter().rev() {
            let product = times(slope, self.y);
            slope = Complex { re: product.re + value.re, im: product.im + value.im };
            let product = times(value, self.y);
            value = Complex { re: product.re + a, im: product.im };
        }
        times(value, inverse(slope))
    }

    /// Another root in this variable.
    fn local(&self, other: &Scaled<T>) -> Complex<T> {
        if self.reversed {
            return inverse(other.unscaled());
        }
        let shift = other.shift - self.shift;
        Complex {
            re: other.value.re.times_power_of_two(shift),
            im: other.value.im.times_power_of_two(shift),
        }
    }

    fn root(&self) -> Scaled<T> {
        if self.reversed {
            return Scaled { value: inverse(self.y), shift: 0 };
        }
        Scaled { value: self.y, shift: self.shift }
    }
}

#[inline]
fn minus<T: Real>(z: Complex<T>, w: Complex<T>) -> Complex<T> {
    Complex { re: z.re - w.re, im: z.im - w.im }
}

#[inline]
fn times<T: Real>(z: Complex<T>, w: Complex<T>) -> Complex<T> {
    Complex { re: z.re * w.re - z.im * w.im, im: z.re * w.im + z.im * w.re }
}

#[inline]
fn inverse<T: Real>(z: Complex<T>) -> Complex<T> {
    if z.im == T::ZERO {
        return Complex { re: T::ONE / z.re, im: T::ZERO };
    }
    let squared = z.re * z.re + z.im * z.im;
    Complex { re: z.re / squared, im: -z.im / squared }
}

#[inline]
fn modulus<T: Real>(z: Complex<T>) -> T {
    (z.re * z.re + z.im * z.im).sqrt()
}
