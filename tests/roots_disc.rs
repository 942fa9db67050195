//! Segment against disc by every route, on plain and nasty problems, against twice the digits.

mod common;
#[path = "../examples/studies/disc_problems.rs"]
mod disc_problems;

use common::Random;
use disc_problems::{DiscProblem, Kind};
use parry_continuum::distance::{Convex, DiscSolver, Scalar, Vec3, segment_disc_by};
use parry_continuum::parry::math::Vector;
use parry_continuum::roots::*;

/// The error of a route on a problem, relative to the problem's extent.
fn error<S: DiscSolver<T>, T: Real + Into<f64>>(problem: &DiscProblem, distance: f64) -> f64 {
    let point = |p: Vector| Vec3::from(p.to_array().map(T::of));
    let (centre, normal) = (point(problem.centre), point(problem.normal));
    let found = segment_disc_by::<S, T>(problem.ends.map(point), centre, normal, T::of(problem.radius));
    let error = (found.distance.into() - distance).abs() / problem.extent();
    if error.is_nan() { f64::INFINITY } else { error }
}

/// As many problems of each kind, as the precision sees them, with their distances.
fn problems<T: Real>(of_each: usize) -> Vec<(Kind, DiscProblem, f64)> {
    let mut random = Random::new(7);
    let mut all = Vec::new();
    for kind in Kind::ALL {
        let before = all.len();
        while all.len() < before + of_each {
            let mut problem = DiscProblem::new(&mut random, kind);
            if T::MANTISSA_BITS == 24 {
                problem = problem.rounded();
            }
            if problem.extent() > 0.0 && problem.normal != Vector::ZERO {
                all.push((kind, problem, problem.distance()));
            }
        }
    }
    all
}

/// The largest error in units of roundoff.
fn worst<S: DiscSolver<T>, T: Real + Into<f64>>(problems: &[(Kind, DiscProblem, f64)]) -> f64 {
    let errors = problems.iter().map(|(_, problem, distance)| error::<S, T>(problem, *distance));
    errors.fold(0.0, f64::max) / T::UNIT_ROUNDOFF
}

/// The share of gross errors, above 1e-4 of the extent, among the problems of some kinds.
fn gross<S: DiscSolver<f64>>(problems: &[(Kind, DiscProblem, f64)], kinds: &[Kind]) -> f64 {
    let some = || problems.iter().filter(|(kind, ..)| kinds.contains(kind));
    let wrong = some().filter(|(_, problem, distance)| error::<S, f64>(problem, *distance) > 1e-4);
    wrong.count() as f64 / some().count() as f64
}

#[test]
fn the_convex_route_is_right_to_rounding_on_every_kind() {
    assert!(worst::<Convex, f64>(&problems::<f64>(3000)) <= 8.0);
    assert!(worst::<Convex, f32>(&problems::<f32>(3000)) <= 8.0);
}

#[test]
fn the_recentred_quartic_is_right_to_rounding_with_every_finder() {
    fn check<T: Real + Into<f64>>() {
        let problems = problems::<T>(300);
        let errors = [
            worst::<RecentredQuartic<ClosedForm>, T>(&problems),
            worst::<RecentredQuartic<Bairstow>, T>(&problems),
            worst::<RecentredQuartic<Companion>, T>(&problems),
            worst::<RecentredQuartic<JenkinsTraub>, T>(&problems),
            worst::<RecentredQuartic<ClosedForm, 1>, T>(&problems),
        ];
        assert!(errors.iter().all(|&error| error <= 16.0), "{errors:?}");
    }
    check::<f64>();
    check::<f32>();
}

#[test]
fn the_printed_quartic_is_right_on_tame_problems_and_grossly_wrong_on_others() {
    let problems = problems::<f64>(500);
    let shares = |kinds: &[Kind]| {
        [
            gross::<QuarticAsPrinted<ClosedForm>>(&problems, kinds),
            gross::<QuarticAsPrinted<Bairstow>>(&problems, kinds),
            gross::<QuarticAsPrinted<Companion>>(&problems, kinds),
            gross::<QuarticAsPrinted<JenkinsTraub>>(&problems, kinds),
        ]
    };
    let tame =
        shares(&[Kind::Random, Kind::ParallelOver, Kind::ThroughRim, Kind::ThroughAxis, Kind::NearAxis]);
    assert_eq!(tame, [0.0; 4]);
    let all = shares(&Kind::ALL);
    assert!(all.iter().all(|&share| share > 0.01), "{all:?}");
    // A double root splits into a complex pair by rounding.
    let [double_root @ .., _] = shares(&[Kind::ParallelOutside]);
    assert!(double_root.iter().all(|&share| share > 0.1), "{double_root:?}");
    // Along the normal (18) has no root that matters, and (16) knows only the rim.
    let along = shares(&[Kind::AlongNormal, Kind::BesideBarrel]);
    assert!(along.iter().all(|&share| share > 0.05), "{along:?}");
}

#[test]
fn a_double_root_is_lost_where_only_real_roots_count() {
    // Parallel to the plane: rounding splits the root into a complex pair, and an end of the segment is left.
    let problem = DiscProblem {
        ends: [Vector::new(3.0, 1.1, 1.0), Vector::new(3.0, -0.3, 1.0)],
        centre: Vector::ZERO,
        normal: Vector::Z,
        radius: 2.0,
    };
    let right = 2.0_f64.sqrt();
    assert_eq!(problem.distance(), right);
    // The end (3, -0.3, 1) is sqrt(9.09) from the axis.
    let end = (1.0 + (9.09_f64.sqrt() - 2.0).powi(2)).sqrt();
    let off = error::<QuarticAsPrinted<Companion>, f64>(&problem, right) * problem.extent();
    assert!((off - (end - right)).abs() < 1e-12, "{off}");
}

#[test]
fn the_convex_route_where_it_once_failed() {
    // Two steps of Halley's method from a start too far to the left of the root, and a step that rounding led astray.
    let touching_the_rim = DiscProblem {
        ends: [
            Vector::new(0.3158080279827118, -0.5550690293312073, -0.9345921874046326),
            Vector::new(-0.9483529925346375, -2.2700159549713135, 1.1725966930389404),
        ],
        centre: Vector::new(-0.3020027279853821, -0.3507661819458008, 0.6647735834121704),
        normal: Vector::new(-0.33829623460769653, -0.23519772291183472, 0.9111738204956055),
        radius: 1.2715799808502197,
    };
    let flat_to_rounding = DiscProblem {
        ends: [
            Vector::new(1.8183904886245728, -0.29342177510261536, 1.5228297710418701),
            Vector::new(1.7374763488769531, -0.11341158300638199, 1.8671146631240845),
        ],
        centre: Vector::new(0.6104958653450012, -0.22664667665958405, 0.8624231219291687),
        normal: Vector::new(0.26559582352638245, 0.8785749077796936, -0.396944522857666),
        radius: 1.3460198640823364,
    };
    for problem in [touching_the_rim, flat_to_rounding] {
        assert!(
            error::<Convex, f32>(&problem, problem.distance()) <= 8.0 * <f32 as Scalar>::UNIT_ROUNDOFF,
            "{problem:?}"
        );
    }
}
