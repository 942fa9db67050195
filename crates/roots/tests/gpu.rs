//! The root finders on the GPU: what they call a root is one, and they find nearly all.
//!
//! Without a GPU these tests pass without doing anything, unless PARRY_CONTINUUM_REQUIRE_GPU is
//! set: then they fail.

use continuum_testing::Random;
use real_polynomial_roots::Complex;
use real_polynomial_roots::gpu::gpu_batch::{Device, Precision};
use real_polynomial_roots::gpu::{Finder, GpuRoots};

const DEGREES: [usize; 5] = [2, 3, 4, 6, 15];
const PRECISIONS: [(&str, Precision); 2] =
    [("GPU f32", Precision::F32), ("GPU f64", Precision::F64)];

/// The GPU in this precision; None if there is none and none is required.
fn open(precision: Precision) -> Option<Device> {
    let opened = Device::open(precision);
    if std::env::var_os("PARRY_CONTINUUM_REQUIRE_GPU").is_some() {
        return Some(opened.unwrap());
    }
    opened.ok()
}

/// |p(z)| in units of what rounding the coefficients to the precision does to it.
fn residual(coefficients: &[f64], root: Complex<f64>, unit: f64) -> f64 {
    let size = root.re.hypot(root.im);
    let (mut re, mut im, mut sum) = (0.0, 0.0, 0.0);
    for &a in coefficients.iter().rev() {
        (re, im) = (re * root.re - im * root.im + a, re * root.im + im * root.re);
        sum = sum * size + a.abs();
    }
    re.hypot(im) / (unit * coefficients.len() as f64 * sum)
}

fn polynomials(degree: usize, count: usize, precision: Precision) -> Vec<f64> {
    let mut random = Random::new(degree as u64);
    let round =
        |value: f64| if precision == Precision::F32 { f64::from(value as f32) } else { value };
    (0..count * (degree + 1)).map(|_| round(random.between(-100.0, 100.0))).collect()
}

/// Deflation and the matrix lose some digits: a root is exact for a polynomial whose coefficients
/// differ by some hundred units. Most roots must satisfy that, and none may be meaningless.
#[test]
fn what_is_found_are_roots() {
    const COUNT: usize = 400;
    for (name, precision) in PRECISIONS {
        let Some(device) = open(precision) else { continue };
        let unit = if precision == Precision::F32 { 2.0_f64.powi(-24) } else { 2.0_f64.powi(-53) };
        for degree in DEGREES {
            let coefficients = polynomials(degree, COUNT, precision);
            for finder in Finder::ALL {
                if finder == Finder::ClosedForm && degree > 4 {
                    continue;
                }
                let mut roots = Vec::new();
                GpuRoots::new(&device, finder, degree)
                    .unwrap()
                    .solve(&coefficients, &mut roots)
                    .unwrap();
                assert_eq!(roots.len(), COUNT * degree);
                let mut residuals = Vec::new();
                for (p, roots) in coefficients.chunks(degree + 1).zip(roots.chunks(degree)) {
                    for root in roots.iter().filter(|root| !root.re.is_nan()) {
                        residuals.push(residual(p, *root, unit));
                    }
                    conjugates(roots);
                }
                residuals.sort_by(f64::total_cmp);
                let found = residuals.len() as f64 / roots.len() as f64;
                let exact = residuals.iter().filter(|residual| **residual <= 100.0).count() as f64;
                let (exact, worst) =
                    (exact / residuals.len() as f64, residuals[residuals.len() - 1]);
                println!(
                    "{name} {finder:?} {degree}: {found:.4} found, {exact:.4} to rounding, worst {worst:.0}"
                );
                assert!(found > 0.99, "{name} {finder:?} {degree}: {found} found");
                assert!(exact > 0.97, "{name} {finder:?} {degree}: {exact} to rounding");
            }
        }
    }
}

/// The sum of the imaginary parts vanishes: complex roots come with their conjugates.
fn conjugates(roots: &[Complex<f64>]) {
    let found: Vec<_> = roots.iter().filter(|root| !root.re.is_nan()).collect();
    assert_eq!(found.iter().map(|root| root.im).sum::<f64>(), 0.0, "{roots:?}");
}

#[test]
fn known_roots_and_lower_degrees() {
    // (x - 1) (x - 2) (x + 3) (x^2 + 1), times x; x^5 - 1 with a leading zero; a constant.
    let known = [0.0, 6.0, -7.0, 6.0, -6.0, 0.0, 1.0];
    let lower = [-1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0];
    let constant = [2.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    let coefficients: Vec<f64> = [known, lower, constant].concat();
    for (name, precision) in PRECISIONS {
        let Some(device) = open(precision) else { continue };
        let tolerance = if precision == Precision::F32 { 1e-4 } else { 1e-12 };
        for finder in [Finder::Bairstow, Finder::Companion, Finder::JenkinsTraub] {
            let mut roots = Vec::new();
            GpuRoots::new(&device, finder, 6).unwrap().solve(&coefficients, &mut roots).unwrap();
            let (known, rest) = roots.split_at(6);
            for (re, im) in
                [(0.0, 0.0), (1.0, 0.0), (2.0, 0.0), (-3.0, 0.0), (0.0, 1.0), (0.0, -1.0)]
            {
                let near = |root: &&Complex<f64>| (root.re - re).hypot(root.im - im) < tolerance;
                assert_eq!(
                    known.iter().filter(near).count(),
                    1,
                    "{name} {finder:?}: {re} {im} in {known:?}"
                );
            }
            let (lower, constant) = rest.split_at(6);
            assert_eq!(
                lower.iter().filter(|root| root.re.is_nan()).count(),
                1,
                "{name} {finder:?} {lower:?}"
            );
            for root in lower.iter().filter(|root| !root.re.is_nan()) {
                assert!(
                    (root.re.hypot(root.im) - 1.0).abs() < tolerance,
                    "{name} {finder:?}: {root:?}"
                );
            }
            assert!(constant.iter().all(|root| root.re.is_nan()));
        }
    }
}
