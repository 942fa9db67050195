//! The quality of the fitted curve, compared with an independently computed smoothing spline.

use super::fit::smooth;
use super::smoothing_spline::SmoothingSpline;
use nalgebra::DMatrix;
use parry3d_f64::math::{Real, Vector};

/// The integral of the squared second derivative. It equals the squared curvature if the parameter
/// is the arc length.
fn bending(spline: &SmoothingSpline) -> Real {
    let pairs = spline.seconds.windows(2).zip(spline.knots.windows(2));
    let of = |(seconds, knots): (&[Vector], &[Real])| {
        let [m, n] = [seconds[0], seconds[1]];
        (knots[1] - knots[0]) * (m.dot(m) + m.dot(n) + n.dot(n)) / 3.0
    };
    pairs.map(of).sum()
}

/// For evenly spaced points: the matrix whose quadratic form is the integral of the squared second
/// derivative of the natural spline through the values.
fn roughness(count: usize, spacing: Real) -> DMatrix<Real> {
    let inner = count - 2;
    let mut differences = DMatrix::zeros(count, inner);
    let mut mass = DMatrix::zeros(inner, inner);
    for k in 0..inner {
        for (place, factor) in [1.0, -2.0, 1.0].into_iter().enumerate() {
            differences[(k + place, k)] = factor / spacing;
        }
        mass[(k, k)] = spacing * 2.0 / 3.0;
        if k + 1 < inner {
            mass[(k, k + 1)] = spacing / 6.0;
            mass[(k + 1, k)] = spacing / 6.0;
        }
    }
    &differences * mass.try_inverse().unwrap() * differences.transpose()
}

#[test]
fn a_fit_bends_little_more_than_the_smoothest_spline_that_is_as_far_from_the_points() {
    const LENGTH: Real = 80.0;
    // A linear congruential generator, and the sum of twelve numbers.
    let mut state = 1_u64;
    let mut normal = || {
        let mut sum = -6.0;
        for _ in 0..12 {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            sum += (state >> 11) as Real / (1_u64 << 53) as Real;
        }
        sum
    };
    let mut worst: Real = 0.0;
    for count in [50, 120] {
        let spacing = LENGTH / (count - 1) as Real;
        let rough = roughness(count, spacing);
        for noise in [0.01, 0.03, 0.1, 0.2, 0.5] {
            for round in 0..4 {
                // Two arcs that bend to opposite sides.
                let (bend, half) = (0.01 + 0.01 * Real::from(round), 0.5 * LENGTH);
                let (sin, cos) = (bend * half).sin_cos();
                let place = |s: Real| {
                    let a = bend * s.min(half);
                    let first = Vector::new(1.0 - a.cos(), a.sin(), 0.0) / bend;
                    let b = 0.5 * bend * (s - half).max(0.0);
                    let [ahead, up] = [b.sin(), 1.0 - b.cos()].map(|value| value / (0.5 * bend));
                    first + Vector::new(sin, cos, 0.0) * ahead + Vector::Z * up
                };
                let points: Vec<_> = (0..count)
                    .map(|k| {
                        place(spacing * k as Real)
                            + Vector::new(normal(), normal(), normal()) * noise
                    })
                    .collect();
                let fitted = smooth(&points, &vec![1.0; points.len() - 1], 5.0 * noise);
                let residual = fitted.largest_residual(&points);
                assert!(residual <= 5.0 * noise);
                let given = DMatrix::from_fn(count, 3, |k, axis| points[k][axis]);
                let smoothed = |weight: Real| {
                    let matrix = DMatrix::identity(count, count) + &rough * weight;
                    matrix.cholesky().unwrap().solve(&given)
                };
                let away = |values: &DMatrix<Real>| {
                    (values - &given).row_iter().fold(0.0, |most: Real, row| most.max(row.norm()))
                };
                let (mut low, mut high) = (-20.0, 40.0);
                for _ in 0..40 {
                    let middle = 0.5 * (low + high);
                    if away(&smoothed(libm::exp2(middle))) < residual {
                        low = middle
                    } else {
                        high = middle
                    }
                }
                let values = smoothed(libm::exp2(low));
                let reference = (values.transpose() * &rough * &values).trace();
                worst = worst.max(bending(&fitted) / reference);
            }
        }
    }
    assert!(worst < 1.5, "{worst}");
}
