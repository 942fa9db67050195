//! Any polynomial: each finder returns all roots, and each solves the polynomial, or an error.

use super::source::Source;
use real_polynomial_roots::{Bairstow, ClosedForm, Companion, JenkinsTraub, Real, RootFinder};

/// Asserts that the residual of each root, relative to the sum of the magnitudes of the terms,
/// stays below the square root of the unit roundoff.
pub fn root_finders(bytes: &[u8]) {
    let mut source = Source::new(bytes);
    let coefficients: [f64; 10] = std::array::from_fn(|_| source.number());
    let low = [0, 1, 2, 3, 4].map(|power| coefficients[power]);
    check::<ClosedForm, f64, 5>(low);
    check::<ClosedForm, f32, 5>(low.map(|a| a as f32));
    all(coefficients);
    all(coefficients.map(|a| a as f32));
}

fn all<T: Real + Into<f64>>(coefficients: [T; 10]) {
    check::<Bairstow, T, 10>(coefficients);
    check::<Companion, T, 10>(coefficients);
    check::<JenkinsTraub, T, 10>(coefficients);
}

fn check<F: RootFinder, T: Real + Into<f64>, const M: usize>(coefficients: [T; M]) {
    let Ok(roots) = F::roots(coefficients) else { return };
    let coefficients = coefficients.map(Into::<f64>::into);
    let degree = coefficients.iter().rposition(|&a| a != 0.0);
    assert_eq!(Some(roots.len()), degree);
    let smallest =
        if size_of::<T>() == 4 { f64::from(f32::MIN_POSITIVE) } else { f64::MIN_POSITIVE };
    for root in roots.as_slice() {
        let (re, im): (f64, f64) = (root.re.into(), root.im.into());
        assert!(re.is_finite() && im.is_finite());
        // Subnormal roots have an absolute rounding error.
        if [re, im].iter().any(|part| *part != 0.0 && part.abs() < smallest) {
            continue;
        }
        // Overflow and underflow are left to the tests with longer numbers.
        let (mut sum, mut terms, mut power) = ((0.0, 0.0), 0.0, (1.0, 0.0));
        for a in coefficients {
            sum = (sum.0 + a * power.0, sum.1 + a * power.1);
            terms += a.abs() * f64::hypot(power.0, power.1);
            power = (power.0 * re - power.1 * im, power.0 * im + power.1 * re);
        }
        if terms.is_finite()
            && terms > f64::MIN_POSITIVE / f64::EPSILON
            && f64::hypot(power.0, power.1) > 1e-300
        {
            let share = f64::hypot(sum.0, sum.1) / terms;
            let rounding = if size_of::<T>() == 4 { f64::from(f32::EPSILON) } else { f64::EPSILON };
            assert!(
                share <= rounding.sqrt(),
                "{}: {share} at {re} + {im} i of {coefficients:?}",
                std::any::type_name::<F>()
            );
        }
    }
}
