//! Construction of tubes: errors, measured points, and tests of a function.

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
    let refuse = |points: &[Vector], radii: &[f64], tangents| {
        Tube::from_samples(points, radii, tangents).unwrap_err()
    };
    assert_eq!(
        refuse(&points[..1], &[], None),
        RobotError::TooFewPoints { parameter: "points", count: 1 }
    );
    assert_eq!(
        refuse(&points, &[0.1; 3], None),
        RobotError::LengthsDiffer { parameter: "segment_radii", points: 5, expected: 4, radii: 3 }
    );
    assert!(matches!(
        refuse(&points, &[0.1, 0.1, -0.1, 0.1], None),
        RobotError::BadRadius { index: 2, .. }
    ));
    assert_eq!(refuse(&[Vector::X; 3], &[0.1; 2], None), RobotError::AllPointsEqual);
    for value in [f64::NAN, f64::INFINITY] {
        let mut bad = points.clone();
        bad[3].y = value;
        assert!(matches!(
            refuse(&bad, &[0.1; 4], None),
            RobotError::PointNotFinite { index: 3, .. }
        ));
    }
    let mut far = points.clone();
    far[2].x = 1e151;
    assert!(matches!(refuse(&far, &[0.1; 4], None), RobotError::PointOutOfRange { index: 2, .. }));
    for (tangents, index) in
        [([Vector::ZERO, Vector::Z], 0), ([Vector::Z, Vector::splat(f64::NAN)], 1)]
    {
        let expected =
            RobotError::BadTangent { parameter: "end_tangents", index, value: tangents[index] };
        // Compared as text: NaN is not itself.
        assert_eq!(refuse(&points, &[0.1; 4], Some(tangents)).to_string(), expected.to_string());
    }
    // A corner, and a bend that is tighter than the tube is wide.
    let corner = [Vector::ZERO, Vector::Z, Vector::new(1.0, 0.0, 1.0), Vector::new(1.0, 0.0, 0.0)];
    assert!(matches!(refuse(&corner, &[0.1; 3], None), RobotError::TurnsTooSharply { .. }));
    // A shaft of two points before a bend: it is the shaft that needs more, however many the bend
    // has.
    let mut shaft = vec![Vector::Z * -20.0, Vector::Z * -20.0];
    shaft.extend(
        (0..40)
            .map(|k| f64::from(k) * 0.02)
            .map(|a| Vector::new(1.0 - a.cos(), 0.0, a.sin()) * 5.0),
    );
    assert!(matches!(
        refuse(&shaft, &[0.1; 41], None),
        RobotError::TurnsTooSharply { after: 1, .. }
    ));
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
    let refuse = |sections: &[TubeSection]| {
        Tube::from_function(sections, |s| (Vector::Z * s, Vector::Z)).unwrap_err()
    };
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
fn bad_frames_are_named() {
    let along = [Vector::Z; 3];
    let refuse =
        |tangents: &[Vector]| Tube::from_frames(&line(3), tangents, &[0.1; 2]).unwrap_err();
    assert_eq!(refuse(&along[..2]), RobotError::TangentsDiffer { points: 3, tangents: 2 });
    for bad in [Vector::ZERO, Vector::X * f64::NAN, Vector::X * f64::INFINITY] {
        let RobotError::BadTangent { parameter: "tangents", index: 1, .. } =
            refuse(&[Vector::Z, bad, Vector::Z])
        else {
            panic!("{bad}");
        };
    }
    // Backwards, across, and a turn that is too much.
    for (bad, least) in [(-Vector::Z, 3.0), (Vector::X, 1.5), (Vector::new(0.9, 0.0, 0.5), 0.9)] {
        let found = refuse(&[Vector::Z, bad, Vector::Z]);
        let RobotError::TurnsTooSharply { index: 1, after: 0, turn } = found else {
            panic!("{found}")
        };
        assert!(turn >= least, "{found}");
    }
    assert_eq!(
        Tube::from_frames(&[Vector::X; 3], &along, &[0.1; 2]).unwrap_err(),
        RobotError::AllPointsEqual
    );
    let tube = |scale: f64| {
        let points: Vec<_> = line(3).iter().map(|point| *point * scale).collect();
        Tube::from_frames(&points, &along, &[0.1 * scale; 2]).unwrap().length()
    };
    assert_eq!(
        [tube(2.0_f64.powi(300)), tube(2.0_f64.powi(-300))].map(f64::log2),
        [300.0, -300.0].map(|k| k + tube(1.0).log2())
    );
}

#[test]
fn bad_measurements_are_named() {
    let refuse = |deviation| Tube::fit(&line(3), &[0.1; 2], deviation).unwrap_err();
    for value in [-1.0, f64::INFINITY] {
        assert_eq!(refuse(value), RobotError::Negative { parameter: "deviation", value });
    }
    assert_eq!(Tube::fit(&[Vector::X; 3], &[0.1; 2], 0.5).unwrap_err(), RobotError::AllPointsEqual);
    assert!(Tube::fit(&line(1), &[], 0.5).is_err() && Tube::fit(&line(3), &[0.1], 0.5).is_err());
    let tube = Tube::fit(&line(2), &[0.1], 0.0).unwrap();
    assert!(tube.residual() == 0.0 && tube.length() == line(2)[1].length());
    let tube = tube.with_turn(0.1).unwrap();
    for value in [-0.1, f64::INFINITY] {
        let found = tube.clone().with_turn(value).unwrap_err();
        assert_eq!(found, RobotError::Negative { parameter: "turn", value });
    }
    assert!(tube.with_turn(f64::NAN).is_err());
}

#[test]
fn one_radius_serves_all_segments() {
    let (points, tangents) = (line(4), Some([Vector::Z; 2]));
    let [all, one] =
        [Chain::from_centreline(&points, &[0.3; 3]), Chain::with_constant_radius(&points, 0.3)];
    assert_eq!(all.unwrap(), one.unwrap());
    let one = Tube::with_constant_radius(&points, 0.3, tangents).unwrap();
    assert_eq!(
        format!("{one:?}"),
        format!("{:?}", Tube::from_samples(&points, &[0.3; 3], tangents).unwrap())
    );
    for radius in [-1.0, f64::INFINITY] {
        let expected =
            RobotError::BadRadius { parameter: "radius", index: 0, value: radius, limit: 1e150 };
        assert_eq!(Chain::with_constant_radius(&points, radius).unwrap_err(), expected);
        assert_eq!(Tube::with_constant_radius(&points, radius, None).unwrap_err(), expected);
    }
    assert!(Chain::with_constant_radius(&[], 0.3).is_err());
}

#[test]
fn broken_promises_of_functions_are_found() {
    let section = TubeSection { length: 2.0, radius: 0.5, curvature: 0.1 };
    let verify = |curve: fn(f64) -> (Vector, Vector)| {
        Tube::from_function(&[section], curve).unwrap().verify(50)
    };
    let arc = |s: f64, k: f64| {
        let (sin, cos) = (k * s).sin_cos();
        (Vector::new(1.0 - cos, 0.0, sin) / k, Vector::new(sin, 0.0, cos))
    };
    assert_eq!(verify(|s| (Vector::Z * s, Vector::Z * 3.0)), Ok(()));
    let bends = Tube::from_function(&[section], move |s| arc(s, 0.101)).unwrap().verify(50);
    assert!(matches!(bends, Err(RobotError::BendsMoreThanStated { .. })), "{bends:?}");
    assert_eq!(
        Tube::from_function(&[section], move |s| arc(s, 0.0999)).unwrap().verify(50),
        Ok(())
    );
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
    // Repeated points, with any radius, change nothing.
    let points = [0.0, 0.0, 1.0, 1.0, 2.0].map(|z| Vector::Z * z);
    assert_eq!(Tube::from_samples(&points, &[9.0, 0.5, 9.0, 0.5], None).unwrap().length(), 2.0);
}
