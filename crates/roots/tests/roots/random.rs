//! The root finders on the paper's polynomials, coefficients at random in [-100, 100], against
//! 256-bit arithmetic.

use crate::exact::{self, Z};
use continuum_testing::Random;
use real_polynomial_roots::*;

/// What the roots of many polynomials of one degree came to; errors in units of roundoff.
#[derive(Debug, Default)]
struct Tally {
    not_converged: usize,
    real_roots: usize,
    complex_roots: usize,
    residual: f64,
    backward: f64,
    sum: f64,
    product: f64,
    /// Of the distance from the reference over the condition.
    forward: f64,
}

fn tally<F: RootFinder, T: Real + Into<f64>, const M: usize>(
    count: usize,
    references: usize,
) -> Tally {
    let mut random = Random::new(M as u64);
    let mut tally = Tally::default();
    for index in 0..count {
        let coefficients: [T; M] = std::array::from_fn(|_| T::of(random.between(-100.0, 100.0)));
        let exact = coefficients.map(Into::into);
        let roots = match F::roots(coefficients) {
            Ok(roots) => roots,
            Err(RootsError::NotConverged { found }) => {
                tally.not_converged += 1;
                for root in &found {
                    tally.residual = tally
                        .residual
                        .max(exact::residual(&exact, &Z::of(root)) / T::UNIT_ROUNDOFF);
                }
                continue;
            }
            Err(error) => panic!("{error}: {exact:?}"),
        };
        assert_eq!(roots.len(), M - 1);
        let real = roots.real().count();
        tally.real_roots += real;
        tally.complex_roots += roots.len() - real;
        let exact_roots: Vec<Z> = roots.iter().map(Z::of).collect();
        let unit = |error: f64| error / T::UNIT_ROUNDOFF;
        for root in &exact_roots {
            tally.residual = tally.residual.max(unit(exact::residual(&exact, root)));
        }
        tally.backward = tally.backward.max(unit(exact::backward_error(&exact, &exact_roots)));
        let [sum, product] = exact::vieta_errors(&exact, &exact_roots);
        tally.sum = tally.sum.max(unit(sum));
        tally.product = tally.product.max(unit(product));
        if index < references {
            let expected = exact::reference(&exact);
            for (i, j) in exact::matched(&exact_roots, &expected) {
                let off = exact::relative_distance(&exact_roots[i], &expected[j]);
                tally.forward =
                    tally.forward.max(unit(off / exact::condition(&exact, &expected[j])));
            }
        }
    }
    tally
}

/// Each root solves the polynomial to rounding, and all of them together are its roots.
fn check<F: RootFinder, T: Real + Into<f64>, const M: usize>(count: usize) {
    let tally = tally::<F, T, M>(count, 8);
    let name = format!("{} {}", std::any::type_name::<F>(), std::any::type_name::<T>());
    println!("{name} degree {} {tally:.0?}", M - 1);
    let n = (M - 1) as f64;
    assert_eq!(tally.not_converged, 0, "{name} {tally:?}");
    // 16 n are promised; evaluating p there to test it costs a few more.
    assert!(tally.residual <= 20.0 * n, "{name} {tally:?}");
    // To first order the residual times the condition.
    assert!(tally.forward <= 20.0 * n, "{name} {tally:?}");
    // n roots, each off by this much.
    assert!(tally.backward.max(tally.sum).max(tally.product) <= 20.0 * n * n, "{name} {tally:?}");
    if M > 2 {
        let roots = tally.real_roots + tally.complex_roots;
        assert!(
            tally.real_roots * 10 > roots && tally.complex_roots * 3 > roots,
            "{name} {tally:?}"
        );
    }
}

fn every_degree<F: RootFinder, T: Real + Into<f64>>() {
    up_to_degree_four::<F, T>();
    check::<F, T, 6>(200);
    check::<F, T, 7>(200);
    check::<F, T, 9>(150);
    check::<F, T, 11>(100);
    check::<F, T, 13>(60);
    check::<F, T, 16>(60);
}

fn up_to_degree_four<F: RootFinder, T: Real + Into<f64>>() {
    check::<F, T, 2>(500);
    check::<F, T, 3>(500);
    check::<F, T, 4>(500);
    check::<F, T, 5>(500);
}

#[test]
fn closed_form() {
    up_to_degree_four::<ClosedForm, f32>();
    up_to_degree_four::<ClosedForm, f64>();
}

#[test]
fn bairstow() {
    every_degree::<Bairstow, f32>();
    every_degree::<Bairstow, f64>();
}

#[test]
fn companion() {
    every_degree::<Companion, f32>();
    every_degree::<Companion, f64>();
}

#[test]
fn jenkins_traub() {
    every_degree::<JenkinsTraub, f32>();
    every_degree::<JenkinsTraub, f64>();
}
