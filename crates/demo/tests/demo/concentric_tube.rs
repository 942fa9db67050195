//! The concentric tube robot of the examples follows the published model.
//!
//! `data/ctr_oracle.json` holds centrelines of two robots, three and four tubes, solved by an
//! integrator that shares nothing with `ctr` and `torsion` and printed to 1e-9 mm: each pair of
//! joints with tubes that do not twist and with tubes that do.

use continuum_demo::ctr::{Joints, Robot, Section, Tube, three_tubes};
use continuum_demo::ventricle;
use parry_continuum::parry::math::{Real, Vector};
use serde::Deserialize;
use std::collections::BTreeMap;

#[derive(Deserialize)]
struct Oracle {
    robots: BTreeMap<String, Vec<OracleSection>>,
    cases: Vec<Case>,
}

#[derive(Deserialize)]
struct OracleSection {
    length: Real,
    outer_radius: Real,
    tubes: Vec<OracleTube>,
}

#[derive(Deserialize)]
struct OracleTube {
    rel_stiffness: Real,
    kappa_per_mm: Real,
}

#[derive(Deserialize)]
struct Case {
    robot: String,
    model: String,
    phi: Vec<Real>,
    psi_tip: Vec<Real>,
    /// Where the tubes twist.
    #[serde(default)]
    psi_base: Vec<Real>,
    s: Vec<Real>,
    radius: Vec<Real>,
    centreline: Vec<[Real; 3]>,
    #[serde(rename = "tip_R")]
    tip: [[Real; 3]; 3],
}

/// The robots, and their cases with tubes that twist or do not.
fn oracle(model: &str) -> Oracle {
    let mut oracle: Oracle = serde_json::from_str(include_str!("../data/ctr_oracle.json")).unwrap();
    oracle.cases.retain(|case| case.model == model);
    oracle
}

const RIGID: &str = "torsionally_rigid";
const COMPLIANT: &str = "torsion";

fn robot(sections: &[OracleSection]) -> Robot {
    let tube = |t: &OracleTube| Tube { stiffness: t.rel_stiffness, curvature: t.kappa_per_mm };
    let section = |s: &OracleSection| Section {
        length: s.length,
        radius: s.outer_radius,
        tubes: s.tubes.iter().map(tube).collect(),
    };
    Robot { sections: sections.iter().map(section).collect() }
}

/// The oracle prints 9 decimals of a millimetre: half of the last one in each coordinate is 0.87e-9
/// mm.
const TOLERANCE: Real = 0.9e-9;

/// And 11 decimals of the tip's frame.
const TURN: Real = 1e-11;

#[test]
fn centrelines_and_tips_match_the_oracle() {
    let oracle = oracle(RIGID);
    let (mut worst, mut points, mut by_robot) = (0.0, 0, BTreeMap::new());
    for case in &oracle.cases {
        let robot = robot(&oracle.robots[&case.robot]);
        let joints = Joints { extensions: case.phi.clone(), angles: case.psi_tip.clone() };
        let frames = robot.frames(&joints, &case.s);
        for (frame, &expected) in frames.iter().zip(&case.centreline) {
            worst = Real::max(worst, (frame.translation - Vector::from(expected)).length());
            points += 1;
        }
        let tip = frames.last().unwrap().rotation;
        for (column, unit) in [Vector::X, Vector::Y, Vector::Z].into_iter().enumerate() {
            let expected = Vector::from(case.tip.map(|row| row[column]));
            assert!((tip * unit - expected).length() < TURN, "{} {:?}", case.robot, case.phi);
        }
        *by_robot.entry(case.robot.as_str()).or_insert(0) += 1;
    }
    assert!(worst < TOLERANCE, "worst {worst:e} mm");
    assert_eq!(points, 18 * 65);
    assert_eq!(by_robot, BTreeMap::from([("ctr_sec3_tub3", 9), ("ctr_sec3_tub4", 9)]));
}

/// The oracle integrates too, to 6e-9 mm.
#[test]
fn twisted_centrelines_match_the_oracle() {
    let oracle = oracle(COMPLIANT);
    let (mut worst, mut turned, mut points, mut twisted) = (0.0, 0.0, 0, 0);
    for case in &oracle.cases {
        let robot = robot(&oracle.robots[&case.robot]);
        let joints = Joints { extensions: case.phi.clone(), angles: case.psi_tip.clone() };
        let found = robot.twisted(&joints, &case.s);
        assert_eq!(found.points.len(), case.centreline.len());
        for (point, &expected) in found.points.iter().zip(&case.centreline) {
            worst = Real::max(worst, (*point - Vector::from(expected)).length());
            points += 1;
        }
        for (column, unit) in [Vector::X, Vector::Y, Vector::Z].into_iter().enumerate() {
            let expected = Vector::from(case.tip.map(|row| row[column]));
            turned = Real::max(turned, (found.tip.rotation * unit - expected).length());
        }
        for (angle, expected) in found.base_angles.iter().zip(&case.psi_base) {
            turned = Real::max(turned, (angle - expected).abs());
        }
        twisted += usize::from(
            case.psi_tip.iter().zip(&case.psi_base).any(|(tip, base)| (tip - base).abs() > 0.1),
        );
    }
    assert!(worst < 1e-7 && turned < 1e-8, "worst {worst:e} mm, {turned:e} rad");
    assert_eq!((points, oracle.cases.len()), (18 * 65, 18));
    assert!(twisted > 8, "{twisted}");
}

#[test]
fn the_three_tubes_of_the_examples_are_the_oracle_s() {
    let expected = robot(&oracle(RIGID).robots["ctr_sec3_tub3"]);
    assert_eq!(format!("{:?}", three_tubes()), format!("{expected:?}"));
}

/// The chain's vertices lie on the oracle's curve, and its radius changes exactly where a tube
/// ends.
#[test]
fn centreline_changes_radius_where_a_tube_ends() {
    let oracle = oracle(RIGID);
    let mut compared = 0;
    for case in &oracle.cases {
        let robot = robot(&oracle.robots[&case.robot]);
        let joints = Joints { extensions: case.phi.clone(), angles: case.psi_tip.clone() };
        let centreline = robot.centreline(&joints, 30);
        assert_eq!(centreline.points.len(), centreline.radii.len() + 1);
        assert!((29..=32).contains(&centreline.radii.len()), "{} links", centreline.radii.len());

        let ends: Vec<Real> = (1..=3).map(|count| case.phi[..count].iter().sum()).collect();
        for (&end, section) in ends.iter().zip(&robot.sections) {
            let tip = robot.frames(&joints, &[end])[0].translation;
            let vertex = centreline.radii.iter().rposition(|&r| r == section.radius).unwrap() + 1;
            assert!((centreline.points[vertex] - tip).length() < 1e-12 * end);
        }
        // The segment nearest to a point of the oracle's has the oracle's radius, except next to a
        // tube's end.
        for ((&s, &point), &radius) in case.s.iter().zip(&case.centreline).zip(&case.radius) {
            let near_end = ends.iter().any(|end| (end - s).abs() < 0.01 * ends.last().unwrap());
            if !near_end {
                let to_segment = |k: &usize| {
                    let (a, b) = (centreline.points[*k], centreline.points[k + 1]);
                    let t = ((Vector::from(point) - a).dot(b - a) / (b - a).length_squared())
                        .clamp(0.0, 1.0);
                    (Vector::from(point) - a.lerp(b, t)).length()
                };
                let nearest = (0..centreline.radii.len())
                    .min_by(|k, l| to_segment(k).total_cmp(&to_segment(l)))
                    .unwrap();
                assert_eq!(
                    centreline.radii[nearest], radius,
                    "{} {:?} at {s}",
                    case.robot, case.phi
                );
                compared += 1;
            }
        }
    }
    assert!(compared > 900, "{compared}");
}

/// Against a derivation: three tubes at the same angle bend in one plane, along circles of known
/// curvature.
#[test]
fn aligned_tubes_follow_circles() {
    let robot = three_tubes();
    let joints = Joints { extensions: vec![20.0, 15.0, 8.0], angles: vec![0.0; 3] };
    let [first, second]: [Real; 2] =
        [(5.0 * 0.0522 + 0.05263 + 0.05e-9) / 6.05, (0.05263 + 0.05e-9) / 1.05];
    // The third tube is straight where it is alone, except for its nominal 1e-9 / mm.
    let heading = first * 20.0 + second * 15.0;
    let tip = robot.frames(&joints, &[43.0])[0];
    let expected = Vector::new(
        (1.0 - (first * 20.0).cos()) / first
            + ((first * 20.0).cos() - heading.cos()) / second
            + 8.0 * heading.sin(),
        0.0,
        (first * 20.0).sin() / first
            + (heading.sin() - (first * 20.0).sin()) / second
            + 8.0 * heading.cos(),
    );
    assert!((tip.translation - expected).length() < 1e-6, "{} {expected}", tip.translation);
}

/// The quick function and the frames are one curve, and it keeps what its tube relies on.
#[test]
fn the_curve_as_a_function_is_the_same() {
    let (robot, goal) = (three_tubes(), ventricle::goal());
    let curve = robot.curve(&goal);
    let length = robot.length(&goal);
    let arcs: Vec<_> = (0..=500).map(|k| length * f64::from(k) / 500.0).collect();
    for (&s, frame) in arcs.iter().zip(robot.frames(&goal, &arcs)) {
        let (point, direction) = curve.at(s);
        assert!((point - frame.translation).length() < 1e-12 * length, "{s}");
        assert!((direction - frame.rotation * Vector::Z).length() < 1e-12, "{s}");
    }
    robot.shape(&goal).unwrap().verify(200).unwrap();
}
