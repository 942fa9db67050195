//! Segment against disc by every route, on random and nasty problems, against twice the digits.

#[path = "../examples/studies/double_double.rs"]
#[allow(dead_code)]
mod double_double;
#[path = "../examples/studies/problems.rs"]
mod problems;
#[path = "../examples/studies/random.rs"]
mod random;

use parry_continuum::distance::{Convex, DiscSolver, Vec3, segment_disc_by};
use parry_continuum::roots::*;
use problems::{KINDS, Problem, problem};
use random::Random;

/// The error of a route on a problem, in units of roundoff times the problem's extent.
fn error<S: DiscSolver<T>, T: Real + Into<f64>>(problem: &Problem, distance: f64) -> f64 {
    let point = |p: [f64; 3]| Vec3::from(p.map(T::of));
    let found = segment_disc_by::<S, T>(
        problem.ends.map(point),
        point(problem.centre),
        point(problem.normal),
        T::of(problem.radius),
    );
    (found.distance.into() - distance).abs() / problem.extent() / T::UNIT_ROUNDOFF
}

/// Problems of every kind, as many of each, with their distances.
fn problems(rounds: usize) -> Vec<Problem> {
    let mut random = Random::new(7);
    (0..rounds * KINDS.len()).map(|index| problem(&mut random, index)).collect()
}

/// The largest error, and the share of problems above 8 units.
fn errors<S: DiscSolver<T>, T: Real + Into<f64>>(problems: &[Problem]) -> (f64, f64) {
    let (mut worst, mut above) = (0.0_f64, 0);
    for problem in problems {
        let problem = if size_of::<T>() == 4 { problem.rounded() } else { *problem };
        let error = error::<S, T>(&problem, problem.distance());
        // NaN counts.
        above += usize::from(!(error <= 8.0));
        worst = if error.is_nan() { f64::INFINITY } else { worst.max(error) };
    }
    (worst, above as f64 / problems.len() as f64)
}

#[test]
fn the_convex_route_is_right_to_rounding_on_every_kind() {
    let problems = problems(2500);
    assert!(errors::<Convex, f64>(&problems).0 <= 8.0);
    assert!(errors::<Convex, f32>(&problems).0 <= 8.0);
}

#[test]
fn the_convex_route_where_it_once_failed() {
    // Two steps of Halley's method were too few (38 units), and a third without a bracket led astray (9e5).
    let touching_the_rim = Problem {
        ends: [
            [0.3158080279827118, -0.5550690293312073, -0.9345921874046326],
            [-0.9483529925346375, -2.2700159549713135, 1.1725966930389404],
        ],
        centre: [-0.3020027279853821, -0.3507661819458008, 0.6647735834121704],
        normal: [-0.33829623460769653, -0.23519772291183472, 0.9111738204956055],
        radius: 1.2715799808502197,
    };
    let flat_to_rounding = Problem {
        ends: [
            [1.8183904886245728, -0.29342177510261536, 1.5228297710418701],
            [1.7374763488769531, -0.11341158300638199, 1.8671146631240845],
        ],
        centre: [0.6104958653450012, -0.22664667665958405, 0.8624231219291687],
        normal: [0.26559582352638245, 0.8785749077796936, -0.396944522857666],
        radius: 1.3460198640823364,
    };
    for problem in [touching_the_rim, flat_to_rounding] {
        assert!(error::<Convex, f32>(&problem, problem.distance()) <= 8.0, "{problem:?}");
    }
}
