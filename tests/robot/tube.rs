//! Tubes as they are built: what is refused, what is measured, and that a function is tried.

use continuum_testing::{Arcs, Random, Stretch};
use parry_continuum::parry::math::Vector;
use parry_continuum::{Chain, RobotError, Tube, TubeSection};
use std::sync::Arc;

fn line(count: usize) -> Vec<Vector> {
    (0..count).map(|k| Vector::Z * k as f64).collect()
}

#[test]
fn bad_samples_are_named() {
    let points = line(5);
    let refuse =
        |points: &[Vector], radii: &[f64], tangents| Tube::from_samples(points, radii, tangents).unwrap_err();
    assert_eq!(refuse(&points[..1], &[], None), RobotError::TooFewPoints { parameter: "points", count: 1 });
    assert_eq!(
        refuse(&points, &[0.1; 3], None),
        RobotError::LengthsDiffer { parameter: "segment_radii", points: 5, expected: 4, radii: 3 }
    );
    assert!(matches!(refuse(&points, &[0.1, 0.1, -0.1, 0.1], None), RobotError::BadRadius { index: 2, .. }));
    assert_eq!(refuse(&[Vector::X; 3], &[0.1; 2], None), RobotError::AllPointsEqual);
    for value in [f64::NAN, f64::INFINITY] {
        let mut bad = points.clone();
        bad[3].y = value;
        assert!(matches!(refuse(&bad, &[0.1; 4], None), RobotError::PointNotFinite { index: 3, .. }));
    }
    let mut far = points.clone();
    far[2].x = 1e151;
    assert!(matches!(refuse(&far, &[0.1; 4], None), RobotError::PointOutOfRange { index: 2, .. }));
    for (tangents, index) in [([Vector::ZERO, Vector::Z], 0), ([Vector::Z, Vector::splat(f64::NAN)], 1)] {
        let expected = RobotError::BadTangent { parameter: "end_tangents", index, value: tangents[index] };
        // Compared as text: NaN is not itself.
        assert_eq!(refuse(&points, &[0.1; 4], Some(tangents)).to_string(), expected.to_string());
    }
    // A corner, and a bend that is tighter than the tube is wide.
    let corner = [Vector::ZERO, Vector::Z, Vector::new(1.0, 0.0, 1.0), Vector::new(1.0, 0.0, 0.0)];
    assert!(matches!(refuse(&corner, &[0.1; 3], None), RobotError::TurnsTooSharply { .. }));
    // A shaft of two points before a bend: it is the shaft that needs more, however many the bend has.
    let mut shaft = vec![Vector::Z * -20.0, Vector::Z * -20.0];
    shaft
        .extend((0..40).map(|k| f64::from(k) * 0.02).map(|a| Vector::new(1.0 - a.cos(), 0.0, a.sin()) * 5.0));
    assert!(matches!(refuse(&shaft, &[0.1; 41], None), RobotError::TurnsTooSharply { after: 1, .. }));
    let arc: Vec<_> =
        (0..40).map(|k| f64::from(k) * 0.1).map(|a| Vector::new(a.cos(), a.sin(), 0.0)).collect();
    assert!(matches!(refuse(&arc, &[1.01; 39], None), RobotError::BendsWithinRadius { .. }));
    assert!(Tube::from_samples(&arc, &[0.99; 39], None).is_ok());
    // Repeated points before the bend do not count themselves away.
    let mut shaft =
        vec![Vector::new(1.0, -0.2, 0.0), Vector::new(1.0, -0.2, 0.0), Vector::new(1.0, -0.1, 0.0)];
    shaft.extend([shaft[2], Vector::X]);
    shaft.extend(&arc);
    let radii: Vec<_> = (1..shaft.len()).map(|k| if k < 5 { 0.1 } else { 1.01 }).collect();
    let refused = refuse(&shaft, &radii, None);
    assert!(matches!(refused, RobotError::BendsWithinRadius { index: 4, .. }), "{refused:?}");
}

#[test]
fn bad_functions_are_named() {
    let good = TubeSection { length: 2.0, radius: 0.5, curvature: 0.1 };
    let refuse =
        |sections: &[TubeSection]| Tube::from_function(sections, |s| (Vector::Z * s, Vector::Z)).unwrap_err();
    assert_eq!(refuse(&[]), RobotError::NoSections { parameter: "sections" });
    for (section, expected) in [
        (
            TubeSection { length: 0.0, ..good },
            RobotError::BadLength { parameter: "sections", index: 1, value: 0.0 },
        ),
        (
            TubeSection { length: f64::INFINITY, ..good },
            RobotError::BadLength { parameter: "sections", index: 1, value: f64::INFINITY },
        ),
        (
            TubeSection { curvature: -1.0, ..good },
            RobotError::BadCurvature { parameter: "sections", index: 1, value: -1.0 },
        ),
        (
            TubeSection { radius: -1.0, ..good },
            RobotError::BadRadius { parameter: "sections", index: 1, value: -1.0, limit: 1e150 },
        ),
    ] {
        assert_eq!(refuse(&[good, section]), expected);
    }
    assert!(matches!(
        refuse(&[TubeSection { curvature: 2.0, ..good }]),
        RobotError::BendsWithinRadius { index: 0, .. }
    ));
    let zero = Tube::from_function(&[good], |s| (Vector::Z * s, Vector::ZERO)).unwrap_err();
    assert_eq!(zero, RobotError::BadTangent { parameter: "curve", index: 0, value: Vector::ZERO });
    assert!(Tube::from_samples(&line(3), &[0.1; 2], None).unwrap().with_error(f64::NAN).is_err());
}

#[test]
fn broken_promises_of_functions_are_found() {
    let section = TubeSection { length: 2.0, radius: 0.5, curvature: 0.1 };
    let verify =
        |curve: fn(f64) -> (Vector, Vector)| Tube::from_function(&[section], curve).unwrap().verify(50);
    let arc = |s: f64, k: f64| {
        let (sin, cos) = (k * s).sin_cos();
        (Vector::new(1.0 - cos, 0.0, sin) / k, Vector::new(sin, 0.0, cos))
    };
    assert_eq!(verify(|s| (Vector::Z * s, Vector::Z * 3.0)), Ok(()));
    let bends = Tube::from_function(&[section], move |s| arc(s, 0.101)).unwrap().verify(50);
    assert!(matches!(bends, Err(RobotError::BendsMoreThanStated { .. })), "{bends:?}");
    assert_eq!(Tube::from_function(&[section], move |s| arc(s, 0.0999)).unwrap().verify(50), Ok(()));
    let fast = verify(|s| (Vector::Z * (1.01 * s), Vector::Z));
    assert!(matches!(fast, Err(RobotError::NotByArcLength { .. })), "{fast:?}");
    let off = verify(|s| (Vector::Z * s, Vector::new(0.01, 0.0, 1.0)));
    assert!(matches!(off, Err(RobotError::TangentOff { .. })), "{off:?}");
}

/// Arcs of many kinds keep their own promises, so `verify` accuses no one.
#[test]
fn functions_that_keep_their_promises_pass() {
    let mut random = Random::new(1);
    for _ in 0..300 {
        let frame = random.pose(20.0);
        let arcs = Arc::new(Arcs::random(&mut random, frame, 1.0));
        let sections: Vec<_> = arcs
            .stretches
            .iter()
            .map(|&Stretch { length, radius, curvature }| TubeSection { length, radius, curvature })
            .collect();
        let length = arcs.length();
        let tube = Tube::from_function(&sections, move |s| arcs.at(s)).unwrap();
        assert!((tube.length() - length).abs() <= 1e-12 * length);
        for steps in [1, 7, 300] {
            tube.verify(steps).unwrap();
        }
    }
}

#[test]
fn lengths_are_those_of_the_lines() {
    let tube = Tube::from_samples(&line(5), &[0.5, 0.5, 0.2, 0.2], None).unwrap();
    assert_eq!(tube.length(), 4.0);
    let chain = Chain::from_centreline(&line(5), &[0.5, 0.5, 0.2, 0.2]).unwrap();
    assert_eq!(Tube::from(&chain).length(), 4.0);
    // Repeated points, with whatever radius, change nothing.
    let points = [0.0, 0.0, 1.0, 1.0, 2.0].map(|z| Vector::Z * z);
    assert_eq!(Tube::from_samples(&points, &[9.0, 0.5, 9.0, 0.5], None).unwrap().length(), 2.0);
}
