//! Segment against disc by the paper's quartic, on plain and nasty problems, against twice the
//! digits.

use continuum_studies::Number;
use continuum_studies::quartic::{QuarticAsPrinted, RecentredQuartic};
use continuum_testing::disc_problems::{DiscProblem, Kind, problems, worst};
use continuum_testing::precision::Precision;
use parry_continuum::distance::laboratory::{DiscSolver, segment_disc_by};
use parry_continuum::parry::math::Vector;
use real_polynomial_roots::*;

/// The share of gross errors, above 1e-4 of the extent, among the problems of some kinds.
fn gross<S: DiscSolver<f64>>(problems: &[(Kind, DiscProblem, f64)], kinds: &[Kind]) -> f64 {
    let some = || problems.iter().filter(|(kind, ..)| kinds.contains(kind));
    let wrong = some().filter(|(_, problem, distance)| {
        problem.error(segment_disc_by::<S, f64>, *distance) > 1e-4
    });
    wrong.count() as f64 / some().count() as f64
}

#[test]
fn the_recentred_quartic_is_right_to_rounding_with_every_finder() {
    fn check<T: Number + Precision>() {
        let problems = problems::<T>(300);
        let errors = [
            worst(segment_disc_by::<RecentredQuartic<ClosedForm>, T>, &problems),
            worst(segment_disc_by::<RecentredQuartic<Bairstow>, T>, &problems),
            worst(segment_disc_by::<RecentredQuartic<Companion>, T>, &problems),
            worst(segment_disc_by::<RecentredQuartic<JenkinsTraub>, T>, &problems),
            worst(segment_disc_by::<RecentredQuartic<ClosedForm, 1>, T>, &problems),
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
    let tame = shares(&[
        Kind::Random,
        Kind::ParallelOver,
        Kind::ThroughRim,
        Kind::ThroughAxis,
        Kind::NearAxis,
    ]);
    assert_eq!(tame, [0.0; 4]);
    let all = shares(&Kind::ALL);
    assert!(all.iter().all(|&share| share > 0.01), "{all:?}");
    // A double root splits into a complex pair by rounding.
    let [double_root @ .., _] = shares(&[Kind::ParallelOutside]);
    assert!(double_root.iter().all(|&share| share > 0.1), "{double_root:?}");
    // Along the normal (18) has no relevant root, and (16) covers only the rim.
    let along = shares(&[Kind::AlongNormal, Kind::BesideBarrel]);
    assert!(along.iter().all(|&share| share > 0.05), "{along:?}");
}

#[test]
fn a_double_root_is_lost_where_only_real_roots_count() {
    // Parallel to the plane: rounding splits the root into a complex pair, and an end of the
    // segment is left.
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
    let off = problem.error(segment_disc_by::<QuarticAsPrinted<Companion>, f64>, right)
        * problem.extent();
    assert!((off - (end - right)).abs() < 1e-12, "{off}");
}
