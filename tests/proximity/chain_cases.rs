//! The reference cases, in every engine.

use crate::agreement::{UNIT, check_agreement, engines};
use crate::scenes::{extent, mesh_of};
use continuum_testing::{Case, distance_cases, read_lines};
use parry_continuum::parry::math::{Pose, Vector};
use parry_continuum::{Cap, Chain};
use serde::Deserialize;

#[derive(Deserialize)]
struct ChainCase {
    id: String,
    points: Vec<[f64; 3]>,
    segment_radius: Vec<f64>,
    tris: Vec<[[f64; 3]; 3]>,
    d_seg: Vec<String>,
}

#[test]
fn chain_cases() {
    let cases: Vec<ChainCase> = read_lines(include_str!("../data/chain_open.jsonl"));
    assert_eq!(cases.len(), 40);
    for case in cases {
        let points: Vec<_> = case.points.iter().map(|&point| Vector::from(point)).collect();
        let robot = Chain::from_centreline(&points, &case.segment_radius).unwrap();
        let mesh = mesh_of(&case.tris);
        let found = check_agreement(&mesh, &robot, &Pose::IDENTITY, 0.0);
        let unit = UNIT * extent(&mesh, &robot);
        for (link, (found, expected)) in found.iter().zip(&case.d_seg).enumerate() {
            let error = (found - expected.parse::<f64>().unwrap()).abs() / unit;
            assert!(error <= 16.0, "{} link {link}: {error} units", case.id);
        }
    }
}

/// The flat caps of single cases as chains of one link: the search must find what the kernel finds.
#[test]
fn one_link_chains_of_the_distance_cases() {
    let flat_and_apart = |case: &&Case| case.kind == "triangle_cylinder" && case.distance() > 0.0;
    let cases = distance_cases();
    let cases: Vec<_> = cases.iter().filter(flat_and_apart).collect();
    assert!(cases.len() > 100);
    for case in cases {
        let (start, end) = (Vector::from(case.p0), Vector::from(case.p1));
        if start == end {
            continue;
        }
        let robot = Chain::cylinders(&[start, end], &[case.r]).unwrap();
        assert_eq!(robot.links()[0].caps(), [Cap::Flat; 2]);
        for (name, mut engine) in engines(&mesh_of(&[case.tri])) {
            let found = engine.minimum(&robot, &Pose::IDENTITY).unwrap();
            let error = (found.distance - case.distance()).abs() / (UNIT * case.scale);
            assert!(error <= 16.0, "{} {} {name}: {error}", case.id, case.cat);
        }
    }
}
