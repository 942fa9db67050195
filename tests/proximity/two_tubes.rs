//! Two tubes against the truth: all their discs, sampled closer and closer where they are near.

use super::robots::{beside, robot};
use super::tube::{all_ways, fine};
use continuum_testing::narrow_phase::disc_disc;
use continuum_testing::{Arcs, Random, rounds};
use parry_continuum::distance::Vec3;
use parry_continuum::parry::math::{Pose, Rotation, Vector};
use parry_continuum::proximity::{
    Decision, PairWitness, ProximityError, RobotClearance, RobotPair,
};
use parry_continuum::{Chain, Tube};
use std::f64::consts::PI;
use std::sync::Arc;

/// How far apart the discs of two places are.
fn discs_apart(places: [(Vector, Vector); 2], radii: [f64; 2]) -> f64 {
    let [(c1, n1), (c2, n2)] =
        places.map(|(c, n)| (Vec3::from(c.to_array()), Vec3::from(n.to_array())));
    disc_disc(c1, n1, radii[0], c2, n2, radii[1]).distance
}

/// The least distance of two tubes' discs on a grid, which the tubes' cannot be above.
fn sampled(arcs: [&Arcs; 2], pose: &Pose) -> f64 {
    const GRID: u32 = 150;
    let discs = arcs.map(|arcs| {
        let (mut all, mut from) = (Vec::new(), 0.0);
        for part in &arcs.stretches {
            let at = |k: u32| arcs.at(from + part.length * f64::from(k) / f64::from(GRID));
            all.extend((0..=GRID).map(|k| (at(k), part.radius)));
            from += part.length;
        }
        all
    });
    let placed =
        |&((c, n), radius): &((Vector, Vector), f64)| ((pose * c, pose.rotation * n), radius);
    let second: Vec<_> = discs[1].iter().map(placed).collect();
    let mut least = f64::INFINITY;
    for &(first, radius) in &discs[0] {
        for &(other, other_radius) in &second {
            // The balls around both discs prune most pairs.
            if (first.0 - other.0).length() - radius - other_radius < least {
                least = least.min(discs_apart([first, other], [radius, other_radius]));
            }
        }
    }
    least
}

/// A pose that brings a place of the second tube near one of the first: any way, alongside, or end
/// to end.
fn placed(random: &mut Random, arcs: [&Arcs; 2], kind: u32) -> Pose {
    let [(c, n), (d, m)] = match kind {
        3 => [(arcs[0].at(arcs[0].length())), arcs[1].at(0.0)],
        _ => arcs.map(|arcs| arcs.at(arcs.length() * random.unit())),
    };
    let radii =
        arcs.map(|arcs| arcs.stretches.iter().fold(0.0, |most: f64, part| most.max(part.radius)));
    let off = (radii[0] + radii[1]) * [0.0, 0.5, 1.1, 3.0][random.below(4) as usize];
    let turn = match kind {
        0 | 1 => random.pose(0.0).rotation,
        // Its direction there becomes that of the first, or the opposite one.
        2 => Rotation::from_rotation_arc(m, n),
        _ => Rotation::from_rotation_arc(m, if random.below(2) == 0 { n } else { -n }),
    };
    let aside = if kind == 3 { n } else { n.cross(random.direction()).normalize() };
    Pose::from_parts(c + aside * off - turn * d, turn)
}

/// Chains so fine that they are within 1e-5 of their tubes.
fn contains(found: &RobotClearance, truth: f64) -> bool {
    found.lower <= truth + 2e-5 && truth <= found.upper + 2e-5
}

#[test]
fn tubes_are_as_near_as_their_discs() {
    let mut random = Random::new(1);
    let (mut pair, mut touching, mut free, mut coarse, mut undecided) =
        (RobotPair::new(), 0, 0, 0, 0);
    for round in 0..rounds(100) {
        let arcs = [0, 1].map(|_| {
            let frame = random.pose(1.0);
            Arc::new(Arcs::random(&mut random, frame, 0.6))
        });
        let both = [&*arcs[0], &*arcs[1]];
        let pose = placed(&mut random, both, round % 4);
        let [a, b] = both.map(|arcs| fine(arcs, Chain::cylinders));
        let truth = RobotPair::new().minimum(&a, &Pose::IDENTITY, &b, &pose).unwrap().distance;
        let discs = sampled(both, &pose);
        let [ways, others] = [all_ways(&arcs[0]), all_ways(&arcs[1])];
        for (way, (a, b)) in ways.iter().zip(&others).enumerate() {
            let here = Pose::IDENTITY;
            for tolerance in [0.3, 0.01] {
                let found = pair.clearance(a, &here, b, &pose, tolerance).unwrap();
                assert!(contains(&found, truth), "{round}, way {way}: {truth} in {found:?}");
                assert!(found.lower <= discs + 1e-9, "{round}, way {way}: {discs} below {found:?}");
                assert!(found.resolved || way > 0, "{round}, way {way}: {found:?}");
                assert_eq!(found.resolved, found.upper - found.lower <= tolerance);
                coarse += u32::from(!found.resolved);
                let RobotClearance { upper, witness, .. } = found;
                let PairWitness { on_first, on_second, arc_lengths, .. } = witness;
                assert!((on_first - on_second).length() <= upper + 1e-9, "{found:?}");
                assert!((0.0..=a.length() + 1e-9).contains(&arc_lengths[0]));
                assert!((0.0..=b.length() + 1e-9).contains(&arc_lengths[1]));
                let turned = pair.clearance(b, &pose, a, &here, tolerance).unwrap();
                assert!(contains(&turned, truth), "{truth} in {turned:?}");
            }
            for off in [-0.1, -0.004, 0.004, 0.1] {
                let margin = truth + off;
                if margin < 0.0 {
                    continue;
                }
                match pair.clears_tubes(a, &here, b, &pose, margin, 0.003) {
                    Ok(decision) => {
                        let right = if off < 0.0 { Decision::Clear } else { Decision::Contact };
                        assert_eq!(decision, right, "{round}, way {way}: {margin} of {truth}");
                    }
                    Err(ProximityError::ToleranceTooFine { .. }) if way > 0 => undecided += 1,
                    Err(error) => panic!("{error}"),
                }
            }
        }
        if truth > 0.0 { free += 1 } else { touching += 1 }
    }
    println!("{touching} {free} {coarse} {undecided}");
    assert!(
        touching > rounds(15)
            && free > rounds(30)
            && coarse < rounds(100)
            && undecided < rounds(200),
        "{touching} {free} {coarse} {undecided}"
    );
}

/// A chain is a tube whose pieces are straight: the bounds differ by rounding, for all caps.
#[test]
fn chains_are_tubes_of_straight_pieces() {
    let mut random = Random::new(2);
    let (mut pair, mut apart, mut touching) = (RobotPair::new(), 0, 0);
    for round in 0..800 {
        let (a, b) = (robot(&mut random, 12), robot(&mut random, 12));
        let pose_a = random.pose(1.0);
        let pose_b = beside(&mut random, &a, &pose_a, &b, [0.0, 1.0, 6.0][round % 3]);
        let truth = RobotPair::new().minimum(&a, &pose_a, &b, &pose_b).unwrap().distance;
        let found =
            pair.clearance(&Tube::from(&a), &pose_a, &Tube::from(&b), &pose_b, 0.0).unwrap();
        assert!(found.lower <= truth && truth <= found.upper, "{round}: {truth} in {found:?}");
        assert!(found.upper - found.lower <= 1e-9, "{round}: {truth} in {found:?}");
        if truth > 0.0 { apart += 1 } else { touching += 1 }
    }
    assert!(apart > 150 && touching > 150, "{apart} {touching}");
}

/// An arc of 90 degrees with the radius of curvature 20, sampled.
fn quarter(scale: f64) -> Tube {
    let angles = (0..=90).map(|k| PI * f64::from(k) / 180.0);
    let points: Vec<_> =
        angles.map(|a| Vector::new(1.0 - a.cos(), 0.0, a.sin()) * (20.0 * scale)).collect();
    Tube::from_samples(&points, &[scale; 90], Some([Vector::Z, Vector::X])).unwrap()
}

#[test]
fn a_scaled_problem_has_the_scaled_answer() {
    let mut random = Random::new(3);
    for round in 0..20 {
        let at = |scale: f64, pose: &Pose| {
            let tube = quarter(scale);
            let pose = Pose::from_parts(pose.translation * scale, pose.rotation);
            RobotPair::new().clearance(&tube, &Pose::IDENTITY, &tube, &pose, 0.01 * scale).unwrap()
        };
        let pose = random.pose(25.0);
        let unit = at(1.0, &pose);
        for power in [-200, -1, 40, 200] {
            let scale = 2.0_f64.powi(power);
            let found = at(scale, &pose);
            assert_eq!(found.lower, unit.lower * scale, "{round}, {power}");
            assert_eq!(found.upper, unit.upper * scale, "{round}, {power}");
            assert_eq!(found.witness.on_second, unit.witness.on_second * scale);
        }
    }
}

/// What both tubes state as their own errors is in both bounds, and no part of the tolerance.
#[test]
fn stated_errors_count() {
    let tube = |error: f64| quarter(1.0).with_error(error).unwrap();
    // Bent away from one another, 8 apart at their bases.
    let pose = Pose::new(Vector::X * -10.0, Vector::Z * PI);
    let found =
        RobotPair::new().clearance(&tube(0.25), &Pose::IDENTITY, &tube(0.5), &pose, 0.01).unwrap();
    assert!(found.resolved && (found.uncertainty - 1.5).abs() < 1e-12, "{found:?}");
    assert!(
        found.lower <= 7.25 && found.lower > 7.2 && 8.75 <= found.upper && found.upper < 8.8,
        "{found:?}"
    );
}

#[test]
fn what_is_wrong_is_named() {
    let tube = Tube::from_samples(&[Vector::ZERO, Vector::Z], &[0.3], None).unwrap();
    let (here, mut pair) = (Pose::IDENTITY, RobotPair::new());
    let mut ask =
        |a: &Pose, b: &Pose, tolerance: f64| pair.clearance(&tube, a, &tube, b, tolerance);
    assert_eq!(
        ask(&here, &here, -1.0),
        Err(ProximityError::Negative { parameter: "tolerance", value: -1.0 })
    );
    let nowhere = Pose::from_translation(Vector::NAN);
    let error = ask(&here, &nowhere, 1.0).unwrap_err();
    assert!(error.kind() == "pose_not_finite" && error.to_string().contains("pose_b"), "{error}");
    let error = ask(&Pose::from_translation(Vector::X * 1e151), &here, 1.0).unwrap_err();
    assert!(error.kind() == "tube_out_of_range" && error.to_string().contains("pose_a"), "{error}");
    let margin = pair.clears_tubes(&tube, &here, &tube, &here, f64::NAN, 0.1).unwrap_err();
    assert!(margin.to_string().contains("margin"), "{margin}");
}

/// Answers are checked when they are read.
#[test]
#[cfg(feature = "serde-serialize")]
fn answers_are_written_and_read() {
    let (tube, there) = (quarter(1.0), Pose::from_translation(Vector::Y * 5.0));
    let found = RobotPair::new().clearance(&tube, &Pose::IDENTITY, &tube, &there, 0.01).unwrap();
    let text = serde_json::to_string(&found).unwrap();
    assert_eq!(serde_json::from_str::<RobotClearance>(&text).unwrap(), found);
    let spoilt = |field: &str, value: serde_json::Value| {
        let mut fields: serde_json::Value = serde_json::from_str(&text).unwrap();
        fields[field] = value;
        serde_json::from_value::<RobotClearance>(fields).unwrap_err().to_string()
    };
    assert!(spoilt("lower", (found.upper + 1.0).into()).contains("in order"));
    assert!(spoilt("uncertainty", (-1.0).into()).contains("at least 0"));
}
