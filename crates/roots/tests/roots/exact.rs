//! Polynomials in 256-bit arithmetic: the judge of the root finders.

use dashu_float::FBig;
use dashu_float::round::mode::HalfEven;
use real_polynomial_roots::{Complex, Real};

pub type Big = FBig<HalfEven>;

const BITS: usize = 256;

pub fn big(value: f64) -> Big {
    Big::try_from(value).expect("a finite number").with_precision(BITS).value()
}

/// A complex number.
#[derive(Clone, Debug)]
pub struct Z {
    pub re: Big,
    pub im: Big,
}

impl Z {
    pub fn new(re: f64, im: f64) -> Self {
        Self { re: big(re), im: big(im) }
    }

    pub fn of<T: Real + Into<f64>>(z: Complex<T>) -> Self {
        Self::new(z.re.into(), z.im.into())
    }

    pub fn plus(&self, other: &Z) -> Z {
        Z { re: &self.re + &other.re, im: &self.im + &other.im }
    }

    pub fn minus(&self, other: &Z) -> Z {
        Z { re: &self.re - &other.re, im: &self.im - &other.im }
    }

    pub fn times(&self, other: &Z) -> Z {
        Z {
            re: &self.re * &other.re - &self.im * &other.im,
            im: &self.re * &other.im + &self.im * &other.re,
        }
    }

    fn over(&self, other: &Z) -> Z {
        let squared = &other.re * &other.re + &other.im * &other.im;
        let conjugate = Z { re: other.re.clone(), im: -other.im.clone() };
        let product = self.times(&conjugate);
        Z { re: product.re / &squared, im: product.im / squared }
    }

    pub fn modulus(&self) -> Big {
        let squared = &self.re * &self.re + &self.im * &self.im;
        if squared == big(0.0) { squared } else { dashu_base::SquareRoot::sqrt(&squared) }
    }

    fn is_zero(&self) -> bool {
        self.re == big(0.0) && self.im == big(0.0)
    }
}

/// The ratio of two numbers of any size.
pub fn ratio(value: &Big, to: &Big) -> f64 {
    if *value == big(0.0) { 0.0 } else { (value / to).to_f64().value() }
}

/// p(z), and the sum of |a_k| |z|^k.
fn value_and_sum(coefficients: &[f64], z: &Z) -> (Z, Big) {
    let (mut value, mut sum) = (Z::new(0.0, 0.0), big(0.0));
    let size = z.modulus();
    for &a in coefficients.iter().rev() {
        value = value.times(z).plus(&Z::new(a, 0.0));
        sum = sum * &size + big(a.abs());
    }
    (value, sum)
}

/// The sum of |a_k| |z|^k.
pub fn sum_of_terms(coefficients: &[f64], z: &Z) -> Big {
    value_and_sum(coefficients, z).1
}

/// p'(z)
fn slope(coefficients: &[f64], z: &Z) -> Z {
    let mut slope = Z::new(0.0, 0.0);
    for (k, &a) in coefficients.iter().enumerate().skip(1).rev() {
        let term = Z { re: big(a) * big(k as f64), im: big(0.0) };
        slope = slope.times(z).plus(&term);
    }
    slope
}

/// |p(z)| / sum |a_k| |z|^k: by how much, relative, the coefficients must change to make z a root.
pub fn residual(coefficients: &[f64], z: &Z) -> f64 {
    let (value, sum) = value_and_sum(coefficients, z);
    ratio(&value.modulus(), &sum)
}

/// How far a relative change of the coefficients by 1 moves the simple root z, relative to |z|.
pub fn condition(coefficients: &[f64], z: &Z) -> f64 {
    let (_, sum) = value_and_sum(coefficients, z);
    ratio(&sum, &(slope(coefficients, z).modulus() * z.modulus()))
}

/// |z - w| / |w|
pub fn relative_distance(z: &Z, w: &Z) -> f64 {
    ratio(&z.minus(w).modulus(), &w.modulus())
}

/// The coefficients of `leading` times the product of (x - root), lowest power first.
pub fn expanded(leading: f64, roots: &[Z]) -> Vec<Z> {
    let mut product = vec![Z::new(leading, 0.0)];
    for root in roots {
        let mut next = vec![Z::new(0.0, 0.0); product.len() + 1];
        for (k, a) in product.iter().enumerate() {
            next[k + 1] = next[k + 1].plus(a);
            next[k] = next[k].minus(&a.times(root));
        }
        product = next;
    }
    product
}

/// The largest difference between a coefficient and that of the polynomial with these roots,
/// relative to the largest coefficient.
pub fn backward_error(coefficients: &[f64], roots: &[Z]) -> f64 {
    let leading = coefficients[coefficients.len() - 1];
    let rebuilt = expanded(leading, roots);
    let largest = coefficients.iter().fold(0.0_f64, |most, a| most.max(a.abs()));
    let off = |(a, b): (&f64, &Z)| ratio(&b.minus(&Z::new(*a, 0.0)).modulus(), &big(largest));
    coefficients.iter().zip(&rebuilt).map(off).fold(0.0, f64::max)
}

/// The relative errors of the sum and of the product of the roots, the sum's relative to the sum of
/// magnitudes.
pub fn vieta_errors(coefficients: &[f64], roots: &[Z]) -> [f64; 2] {
    let degree = coefficients.len() - 1;
    let (mut sum, mut sizes, mut product) = (Z::new(0.0, 0.0), big(0.0), Z::new(1.0, 0.0));
    for root in roots {
        sum = sum.plus(root);
        sizes += root.modulus();
        product = product.times(root);
    }
    let leading = big(coefficients[degree]);
    let sum_error = sum.plus(&Z { re: big(coefficients[degree - 1]) / &leading, im: big(0.0) });
    let sign = if degree.is_multiple_of(2) { 1.0 } else { -1.0 };
    let expected = Z { re: big(sign * coefficients[0]) / leading, im: big(0.0) };
    [ratio(&sum_error.modulus(), &sizes), relative_distance(&product, &expected)]
}

/// The roots of a polynomial without multiple roots, by Aberth's method, to 200 bits.
pub fn reference(coefficients: &[f64]) -> Vec<Z> {
    let degree = coefficients.len() - 1;
    // Cauchy's bounds.
    let size = |over: f64, rest: &[f64]| {
        1.0 + rest.iter().fold(0.0_f64, |most, a| most.max((a / over).abs()))
    };
    let outer = size(coefficients[degree], &coefficients[..degree]);
    let inner = 1.0 / size(coefficients[0], &coefficients[1..]);
    let mut roots: Vec<Z> = (0..degree)
        .map(|k| {
            let share = (k as f64 + 0.5) / degree as f64;
            let radius = inner * (outer / inner).powf(share);
            let (sin, cos) = (2.399_963 * k as f64 + 0.7).sin_cos();
            Z::new(radius * cos, radius * sin)
        })
        .collect();
    let limit = 2.0_f64.powi(-200);
    for _ in 0..300 {
        let mut worst = 0.0_f64;
        for i in 0..degree {
            let (value, _) = value_and_sum(coefficients, &roots[i]);
            if value.is_zero() {
                continue;
            }
            let newton = value.over(&slope(coefficients, &roots[i]));
            let mut repulsion = Z::new(0.0, 0.0);
            for j in (0..degree).filter(|&j| j != i) {
                repulsion = repulsion.plus(&Z::new(1.0, 0.0).over(&roots[i].minus(&roots[j])));
            }
            let step = newton.over(&Z::new(1.0, 0.0).minus(&newton.times(&repulsion)));
            worst = worst.max(ratio(&step.modulus(), &roots[i].modulus()));
            roots[i] = roots[i].minus(&step);
        }
        if worst < limit {
            return roots;
        }
    }
    panic!("no reference for {coefficients:?}");
}

/// Pairs each of `roots` with one of `expected`, the closest pairs first.
pub fn matched(roots: &[Z], expected: &[Z]) -> Vec<(usize, usize)> {
    assert_eq!(roots.len(), expected.len());
    let mut distances = Vec::new();
    for (i, z) in roots.iter().enumerate() {
        for (j, w) in expected.iter().enumerate() {
            distances.push((z.minus(w).modulus(), i, j));
        }
    }
    distances.sort_by(|a, b| a.0.partial_cmp(&b.0).expect("numbers"));
    let (mut taken, mut used) = (vec![false; roots.len()], vec![false; roots.len()]);
    let mut pairs = Vec::new();
    for (_, i, j) in distances {
        if !taken[i] && !used[j] {
            (taken[i], used[j]) = (true, true);
            pairs.push((i, j));
        }
    }
    pairs
}
