//! The root finders on polynomials whose roots are known: Wilkinson's, clusters, multiple roots,
//! roots of unity.
//!
//! A computed root z has |p(z)| <= c u S with S the sum of |a_k| |z|^k, and near a root r of
//! multiplicity m p(z) is about p^(m)(r) / m! (z - r)^m. So |z - r| <= (c u S m! /
//! |p^(m)(r)|)^(1/m): the most that rounding allows.

use crate::exact::{self, Big, Z, big, ratio};
use real_polynomial_roots::*;

/// A polynomial with integer coefficients, and its roots with their multiplicities.
struct Known {
    name: String,
    /// Lowest power first.
    coefficients: Vec<i128>,
    roots: Vec<(Complex<f64>, usize)>,
}

impl Known {
    fn new(name: &str) -> Self {
        Self { name: name.into(), coefficients: vec![1], roots: Vec::new() }
    }

    fn times(mut self, factor: &[i128]) -> Self {
        let mut product = vec![0; self.coefficients.len() + factor.len() - 1];
        for (i, a) in self.coefficients.iter().enumerate() {
            for (j, b) in factor.iter().enumerate() {
                product[i + j] += a * b;
            }
        }
        self.coefficients = product;
        self
    }

    /// Times (q x - p)^multiplicity.
    fn root(mut self, p: i128, q: i128, multiplicity: usize) -> Self {
        for _ in 0..multiplicity {
            self = self.times(&[-p, q]);
        }
        self.roots.push((Complex { re: p as f64 / q as f64, im: 0.0 }, multiplicity));
        self
    }

    /// Times ((x - re)^2 + im^2)^multiplicity.
    fn pair(mut self, re: i128, im: i128, multiplicity: usize) -> Self {
        for _ in 0..multiplicity {
            self = self.times(&[re * re + im * im, -2 * re, 1]);
        }
        for im in [im, -im] {
            self.roots.push((Complex { re: re as f64, im: im as f64 }, multiplicity));
        }
        self
    }
}

fn known() -> Vec<Known> {
    let mut all = Vec::new();
    for n in [2, 3, 4, 5, 8, 10, 12, 15] {
        let roots = 1..=n;
        all.push(roots.fold(Known::new(&format!("Wilkinson {n}")), |p, root| p.root(root, 1, 1)));
    }
    all.push(
        (-7..=7).filter(|&r| r != 0).fold(Known::new("both signs"), |p, root| p.root(root, 1, 1)),
    );
    all.push(Known::new("double").root(1, 1, 2).root(-2, 1, 1));
    all.push(Known::new("two double").root(1, 1, 2).root(2, 1, 2));
    all.push(Known::new("double and pair").root(3, 1, 2).pair(1, 2, 1));
    all.push(Known::new("triple").root(2, 1, 3).root(-1, 1, 1));
    all.push(Known::new("cube").root(2, 1, 3));
    all.push(Known::new("square").root(-3, 1, 2));
    all.push(Known::new("fourth power").root(1, 1, 4));
    all.push(Known::new("double pair").pair(0, 1, 2));
    all.push(Known::new("double pair off the axis").pair(2, 1, 2));
    all.push(Known::new("triple and double").root(1, 1, 3).root(-2, 1, 2).pair(1, 3, 1));
    all.push(Known::new("cluster of 3").root(256, 256, 1).root(257, 256, 1).root(255, 256, 1));
    all.push(
        Known::new("cluster of 2")
            .root(1024, 1024, 1)
            .root(1025, 1024, 1)
            .root(-3, 1, 1)
            .root(2, 1, 1),
    );
    all.push(Known::new("near pair of pairs").pair(10, 1, 1).pair(10, 2, 1).root(7, 1, 1));
    all.push(Known::new("biquadratic").root(1, 1, 1).root(-1, 1, 1).pair(0, 3, 1));
    for n in 2..=15 {
        for sign in [-1, 1] {
            let mut p = Known::new(&format!("x^{n} {sign:+}"));
            p.coefficients = vec![0; n + 1];
            (p.coefficients[0], p.coefficients[n]) = (sign, 1);
            let turn = if sign < 0 { 0.0 } else { 0.5 };
            p.roots = (0..n)
                .map(|k| {
                    let (im, re) = (std::f64::consts::TAU * (k as f64 + turn) / n as f64).sin_cos();
                    (Complex { re, im }, 1)
                })
                .collect();
            all.push(p);
        }
    }
    // Chebyshev: T_(n+1) = 2 x T_n - T_(n-1).
    let (mut before, mut now) = (vec![1], vec![0, 1]);
    for n in 2..=15_usize {
        let mut next = vec![0; n + 1];
        for k in 0..n {
            next[k + 1] += 2 * now[k];
        }
        for k in 0..n - 1 {
            next[k] -= before[k];
        }
        (before, now) = (now, next);
        let mut p = Known::new(&format!("Chebyshev {n}"));
        p.coefficients = now.clone();
        let root = |k: usize| (std::f64::consts::PI * (2 * k + 1) as f64 / (2 * n) as f64).cos();
        // The middle root of an odd polynomial is 0, and is taken out exactly.
        let exact = |k: usize| if 2 * k + 1 == n { 0.0 } else { root(k) };
        p.roots = (0..n).map(|k| (Complex { re: exact(k), im: 0.0 }, 1)).collect();
        all.push(p);
    }
    all
}

/// p^(m)(z) / m! as a magnitude.
fn taylor(coefficients: &[f64], m: usize, z: &Z) -> Big {
    let mut value = Z::new(0.0, 0.0);
    for k in (m..coefficients.len()).rev() {
        let binomial = (0..m).fold(1.0, |b, i| b * (k - i) as f64 / (i + 1) as f64).round();
        value = value.times(z).plus(&Z::new(binomial, 0.0).times(&Z::new(coefficients[k], 0.0)));
    }
    value.modulus()
}

/// How often each kind of thing was checked.
#[derive(Debug, Default)]
struct Visits {
    polynomials: usize,
    multiple_roots: usize,
}

fn check<F: RootFinder, T: Real + Into<f64>, const M: usize>(known: &Known) -> bool {
    let exact: Vec<f64> = known.coefficients.iter().map(|&a| a as f64).collect();
    let coefficients: [T; M] = std::array::from_fn(|k| T::of(exact.get(k).copied().unwrap_or(0.0)));
    let fits = |(a, b): (&i128, &T)| {
        let b: f64 = (*b).into();
        b as i128 == *a
    };
    if !known.coefficients.iter().zip(&coefficients).all(fits) {
        return false; // not this polynomial in this precision
    }
    let name =
        format!("{} {} {}", known.name, std::any::type_name::<F>(), std::any::type_name::<T>());
    let roots = F::roots(coefficients).unwrap_or_else(|error| panic!("{name}: {error}"));
    let found: Vec<Z> = roots.iter().map(Z::of).collect();
    let expected: Vec<(Z, usize)> = known
        .roots
        .iter()
        .flat_map(|&(root, m)| std::iter::repeat_n((Z::of(root), m), m))
        .collect();
    let places: Vec<Z> = expected.iter().map(|(z, _)| z.clone()).collect();
    let n = found.len() as f64;
    for (i, j) in exact::matched(&found, &places) {
        let (root, m) = &expected[j];
        let allowed = if root.modulus() == big(0.0) {
            0.0
        } else {
            let sum = exact::sum_of_terms(&exact, root);
            let curvature = ratio(&sum, &taylor(&exact, *m, root));
            // Twice, for what the first term leaves out; and the rounding of the expected root
            // itself.
            2.0 * (20.0 * n * T::UNIT_ROUNDOFF * curvature).powf(1.0 / *m as f64) + 1e-15
        };
        let off = ratio(&found[i].minus(root).modulus(), &big(1.0));
        assert!(
            off <= allowed,
            "{name}: {:?} is {off:e} off, allowed {allowed:e}",
            roots.as_slice()[i]
        );
    }
    // Conjugates side by side, the upper one first.
    let slice = roots.as_slice();
    for (index, root) in slice.iter().enumerate() {
        if root.im > T::ZERO {
            assert_eq!(slice[index + 1], Complex { re: root.re, im: -root.im }, "{name}");
        } else if root.im < T::ZERO {
            assert!(slice[index - 1].im > T::ZERO, "{name}");
        }
    }
    true
}

fn check_all<F: RootFinder, T: Real + Into<f64>>(closed_form: bool) {
    let mut visits = Visits::default();
    for known in known() {
        let degree = known.coefficients.len() - 1;
        if closed_form && degree > 4 {
            continue;
        }
        let visited =
            if degree <= 4 { check::<F, T, 5>(&known) } else { check::<F, T, 16>(&known) };
        if visited {
            visits.polynomials += 1;
            visits.multiple_roots += usize::from(known.roots.iter().any(|&(_, m)| m > 1));
        }
    }
    println!("{visits:?}");
    assert!(
        visits.polynomials >= if closed_form { 20 } else { 60 } && visits.multiple_roots >= 9,
        "{visits:?}"
    );
}

#[test]
fn closed_form() {
    check_all::<ClosedForm, f32>(true);
    check_all::<ClosedForm, f64>(true);
}

#[test]
fn bairstow() {
    check_all::<Bairstow, f32>(false);
    check_all::<Bairstow, f64>(false);
}

#[test]
fn companion() {
    check_all::<Companion, f32>(false);
    check_all::<Companion, f64>(false);
}

#[test]
fn jenkins_traub() {
    check_all::<JenkinsTraub, f32>(false);
    check_all::<JenkinsTraub, f64>(false);
}

#[test]
fn quartics_of_discs_with_two_roots_close_together() {
    // A line nearly through a disc's axis: the small roots agree in 6 digits, or in all.
    let nearly = [
        -0.005239248482233007,
        -0.14057355461233376,
        -0.9375319446868632,
        0.14476530637183768,
        0.9710445004776409,
    ];
    let double = [
        -0.0158611543001949,
        -0.24899091670855739,
        -0.9611293978916027,
        0.2518821494286159,
        0.988521486232283,
    ];
    let largest = |roots: &Roots<f64, 5>| roots.real().fold(0.0, f64::max);
    for (coefficients, root) in [(nearly, 0.985415902285435), (double, 0.994244178374851)] {
        for found in [
            ClosedForm::roots(coefficients),
            Bairstow::roots(coefficients),
            Companion::roots(coefficients),
            JenkinsTraub::roots(coefficients),
        ] {
            let found = found.unwrap();
            assert_eq!(found.len(), 4);
            assert!((largest(&found) - root).abs() < 1e-14, "{found:?}");
        }
    }
}
