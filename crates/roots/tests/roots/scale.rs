//! The root finders on coefficients of any size, on degenerate polynomials and on bad input.

use crate::exact::{self, Z};
use continuum_testing::Random;
use real_polynomial_roots::*;

/// Coefficients whose exponents are uniform in +-`spread`, some of them 0.
fn wild<T: Real, const M: usize>(random: &mut Random, spread: f64) -> [T; M] {
    std::array::from_fn(|_| {
        let value = random.between(1.0, 2.0)
            * random.between(-spread, spread).exp2().max(f64::MIN_POSITIVE);
        let signed = if random.unit() < 0.5 { -value } else { value };
        T::of(if random.unit() < 0.1 { 0.0 } else { signed })
    })
}

#[derive(Debug, Default)]
struct Tally {
    polynomials: usize,
    complete: usize,
    residual: f64,
    /// Of the product of the roots, in units of roundoff times degree squared.
    product: f64,
    /// The sizes of roots, as powers of two.
    smallest: f64,
    largest: f64,
}

fn tally<F: RootFinder, T: Real + Into<f64>, const M: usize>(count: usize, spread: f64) -> Tally {
    let mut random = Random::new(M as u64);
    let mut tally = Tally::default();
    while tally.polynomials < count {
        let coefficients: [T; M] = wild(&mut random, spread);
        let exact = coefficients.map(Into::into);
        if exact[M - 1] == 0.0 || exact[0] == 0.0 {
            continue;
        }
        tally.polynomials += 1;
        let found = match F::roots(coefficients) {
            Ok(found) => {
                tally.complete += 1;
                let roots: Vec<Z> = found.iter().map(Z::of).collect();
                let [_, product] = exact::vieta_errors(&exact, &roots);
                let square = ((M - 1) * (M - 1)) as f64;
                tally.product = tally.product.max(product / T::UNIT_ROUNDOFF / square);
                found
            }
            Err(RootsError::NotConverged { found }) => found,
            Err(error) => panic!("{error}: {exact:?}"),
        };
        for root in &found {
            let z = Z::of(root);
            tally.residual = tally.residual.max(exact::residual(&exact, &z) / T::UNIT_ROUNDOFF);
            let size = z.modulus().to_f64().value().log2();
            tally.smallest = tally.smallest.min(size);
            tally.largest = tally.largest.max(size);
        }
    }
    tally
}

fn check<F: RootFinder, T: Real + Into<f64>, const M: usize>(spread: f64) {
    let tally = tally::<F, T, M>(60, spread);
    let name =
        format!("{} {} degree {}", std::any::type_name::<F>(), std::any::type_name::<T>(), M - 1);
    println!("{name} spread {spread} {tally:.1?}");
    assert_eq!(tally.complete, tally.polynomials, "{name} {tally:?}");
    assert!(tally.residual <= 20.0 * (M - 1) as f64, "{name} {tally:?}");
    // No root is missing in favour of another found twice.
    assert!(tally.product <= 20.0, "{name} {tally:?}");
    assert!(tally.smallest < -0.5 * spread && tally.largest > 0.5 * spread, "{name} {tally:?}");
}

fn every_size<F: RootFinder, const M: usize>() {
    for spread in [20.0, 60.0, 498.0] {
        check::<F, f64, M>(spread);
    }
    for spread in [10.0, 20.0, 60.0] {
        check::<F, f32, M>(spread);
    }
}

fn high_degrees<F: RootFinder>() {
    every_size::<F, 6>();
    every_size::<F, 8>();
    every_size::<F, 11>();
    every_size::<F, 16>();
}

fn low_degrees<F: RootFinder>() {
    every_size::<F, 2>();
    every_size::<F, 3>();
    every_size::<F, 4>();
    every_size::<F, 5>();
}

#[test]
fn closed_form_at_any_size() {
    low_degrees::<ClosedForm>();
}

#[test]
fn bairstow_at_any_size() {
    low_degrees::<Bairstow>();
    high_degrees::<Bairstow>();
}

#[test]
fn companion_at_any_size() {
    low_degrees::<Companion>();
    high_degrees::<Companion>();
}

#[test]
fn jenkins_traub_at_any_size() {
    low_degrees::<JenkinsTraub>();
    high_degrees::<JenkinsTraub>();
}

fn a_common_factor_changes_nothing<F: RootFinder>() {
    let coefficients = [3.0, -7.5, 1.25, 4.0, -1.0];
    let roots = F::roots(coefficients).expect("distinct roots");
    for k in [-900, -50, 3, 900] {
        let factor = 2.0_f64.powi(k);
        assert_eq!(F::roots(coefficients.map(|a| a * factor)).as_ref(), Ok(&roots), "2^{k}");
    }
}

fn zeros<F: RootFinder>() {
    let values = |roots: Roots<f64, 5>| {
        let mut real: Vec<f64> = roots.real().collect();
        assert_eq!(real.len(), roots.len());
        real.sort_by(f64::total_cmp);
        real
    };
    // Leading zeros: 2 x - 6.
    assert_eq!(F::roots([-6.0, 2.0, 0.0, 0.0, 0.0]).map(values), Ok(vec![3.0]));
    // Zero roots: x^2 (x - 1) (x - 4), and -0 counts as 0.
    assert_eq!(F::roots([0.0, -0.0, 4.0, -5.0, 1.0]).map(values), Ok(vec![0.0, 0.0, 1.0, 4.0]));
    // Both: x^2.
    assert_eq!(F::roots([0.0, 0.0, 5.0, 0.0, 0.0]).map(values), Ok(vec![0.0, 0.0]));
    // Constants.
    assert_eq!(F::roots([7.0, 0.0, 0.0, 0.0, 0.0]).map(values), Ok(vec![]));
    assert!(F::roots([7.0_f32]).is_ok_and(|roots| roots.is_empty()));
    assert_eq!(F::roots([0.0_f64; 5]), Err(RootsError::Zero));
    assert_eq!(F::roots::<f64, 0>([]), Err(RootsError::Zero));
}

fn bad_input<F: RootFinder>() {
    assert_eq!(F::roots([1.0, f64::NAN, 2.0]), Err(RootsError::NotFinite { power: 1 }));
    assert_eq!(F::roots([1.0, 2.0, f32::INFINITY]), Err(RootsError::NotFinite { power: 2 }));
    // The root -1e600.
    assert_eq!(F::roots([1e300, 1e-300]), Err(RootsError::OutOfRange));
    // Subnormal numbers: the root -1/2.
    let tiny = f64::from_bits(3);
    let roots = F::roots([tiny, tiny + tiny]).expect("one root");
    assert_eq!(roots.as_slice(), [Complex { re: -0.5, im: 0.0 }]);
}

#[test]
fn common_factors() {
    a_common_factor_changes_nothing::<ClosedForm>();
    a_common_factor_changes_nothing::<Bairstow>();
    a_common_factor_changes_nothing::<Companion>();
    a_common_factor_changes_nothing::<JenkinsTraub>();
}

#[test]
fn degenerate_polynomials() {
    zeros::<ClosedForm>();
    zeros::<Bairstow>();
    zeros::<Companion>();
    zeros::<JenkinsTraub>();
}

#[test]
fn refused() {
    bad_input::<ClosedForm>();
    bad_input::<Bairstow>();
    bad_input::<Companion>();
    bad_input::<JenkinsTraub>();
    let degree_five = [1.0, 0.0, 0.0, 0.0, 0.0, 1.0];
    assert_eq!(ClosedForm::roots(degree_five), Err(RootsError::NoClosedForm { degree: 5 }));
}
