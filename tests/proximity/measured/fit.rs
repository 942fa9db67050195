//! Tubes fitted to measured points: within the deviation of every point, smooth, and right in their bounds.

use super::{Discs, Seen, discs, judge};
use continuum_testing::{Arcs, Random};
use parry_continuum::parry::math::{Pose, Vector};
use parry_continuum::{RobotError, Tube};
use std::f64::consts::{PI, TAU};

/// Evenly spread in a ball.
fn in_ball(random: &mut Random) -> Vector {
    loop {
        let point = random.point();
        if point.length() <= 1.0 {
            return point;
        }
    }
}

/// Robots of 80 mm like those of a planner: up to four arcs, two radii.
fn robot(random: &mut Random) -> Arcs {
    let mut arcs = Arcs::from_frame(random.pose(20.0));
    let stretches = 1 + random.below(2);
    for _ in 0..stretches {
        let parts: Vec<_> = (0..2)
            .map(|_| {
                let angle = TAU * random.unit();
                let bend = Vector::new(angle.cos(), angle.sin(), 0.0) * random.between(0.0, 0.05);
                (40.0 / f64::from(stretches), bend)
            })
            .collect();
        arcs.push(random.between(0.3, 1.0), &parts);
    }
    arcs
}

/// Samples of a robot, some of which are there twice, each off by up to the noise.
fn measured(random: &mut Random, arcs: &Arcs, count: usize, noise: f64) -> (Vec<Vector>, Vec<f64>) {
    let (mut points, mut radii, mut from) = (vec![arcs.at(0.0).0 + in_ball(random) * noise], Vec::new(), 0.0);
    for part in &arcs.stretches {
        let own = (part.length / arcs.length() * count as f64).round();
        for k in 1..=own as usize {
            let (point, _) = arcs.at(from + part.length * k as f64 / own);
            for _ in 0..=random.below(50) / 49 {
                points.push(point + in_ball(random) * noise);
                radii.push(part.radius);
            }
        }
        from += part.length;
    }
    (points, radii)
}

#[test]
fn noise_within_the_deviation_never_makes_a_bound_wrong() {
    let (mut random, mut seen, mut roughest, mut refused) = (Random::new(91), Seen::default(), 0, 0);
    while seen.asked < 10_000 {
        let arcs = robot(&mut random);
        let deviation = [0.02, 0.05, 0.25, 1.0][random.below(4) as usize];
        let count = [50, 100, 200, 400][random.below(4) as usize];
        let noise = deviation * [0.0, 0.3, 0.5, 1.0][random.below(4) as usize];
        let (points, radii) = measured(&mut random, &arcs, count, noise);
        let tube = Tube::fit(&points, &radii, deviation);
        if noise == deviation {
            // Points that were measured twice may be so far apart that only a kink is near enough to both.
            let found = tube.as_ref().is_ok_and(|tube| tube.residual() <= deviation);
            assert!(found || matches!(tube, Err(RobotError::TurnsTooSharply { .. })), "{tube:?}");
            (roughest, refused) = (roughest + 1, refused + usize::from(!found));
            continue;
        }
        let tube = tube.unwrap();
        assert!(tube.residual() <= deviation);
        let curve = |s: f64| arcs.at(s);
        judge(&mut random, &tube, (&discs(&arcs), &curve), [5.0, 0.1], 10, &mut seen);
    }
    assert!(roughest > 200 && 20 * refused < roughest, "{refused} of {roughest}");
    assert!(seen.touching > 500 && seen.at_faces > 2_000, "{seen:?}");
    assert!(seen.resolved > 9_900, "{seen:?}");
}

/// A robot that wriggles about the fitted line, or arc, in place by as much as is stated, and in direction too.
#[test]
fn whatever_wriggles_within_what_is_stated_is_within_the_bounds() {
    let (mut random, mut seen) = (Random::new(92), Seen::default());
    for round in 0..600 {
        let (length, radius) = (random.between(5.0, 40.0), random.between(0.3, 2.0));
        let mut arcs = Arcs::from_frame(random.pose(5.0));
        let bend =
            Vector::X * if round % 2 == 0 { 0.0 } else { random.between(0.0, 0.3 / radius).min(PI / length) };
        arcs.push(radius, &[(length, bend)]);
        let points: Vec<_> = (0..=200).map(|k| arcs.at(length * f64::from(k) / 200.0).0).collect();
        let size = radius * [0.02, 0.2, 0.6][random.below(3) as usize];
        let (turns, phase) = ((random.between(0.1, 2.0) / radius).min(30.0 / length), TAU * random.unit());
        // What the fit is off the arc counts too.
        let (deviation, turn) = (size + 2e-3, (size * turns).atan() + 1e-2);
        let tube = Tube::fit(&points, &vec![radius; 200], deviation).unwrap();
        assert!(tube.residual() < 1e-3, "{}", tube.residual());
        let up =
            arcs.at(0.0).1.cross(arcs.at(0.5 * length).0 - arcs.at(0.0).0 + Vector::splat(1e-3)).normalize();
        let curve = |s: f64| {
            let ((point, along), angle) = (arcs.at(s), turns * s + phase);
            // Across the curve, and across the plane in which it lies.
            let (across, here) = if bend == Vector::ZERO { (up, along) } else { (normal(&arcs), along) };
            (
                point + across * (size * angle.sin()),
                (here + across * (size * turns * angle.cos())).normalize(),
            )
        };
        let all = [Discs { range: [0.0, length], radius }];
        let stated = tube.clone().with_turn(turn).unwrap();
        for tube in [tube, stated] {
            judge(&mut random, &tube, (&all, &curve), [3.0 * radius, 0.05], 8, &mut seen);
        }
    }
    assert!(seen.touching > 500 && seen.at_faces > 2_000 && seen.resolved > seen.asked * 9 / 10, "{seen:?}");
}

/// Across the plane of an arc.
fn normal(arcs: &Arcs) -> Vector {
    let [start, end] = [0.0, 0.1 * arcs.length()].map(|s| arcs.at(s).1);
    start.cross(end).normalize()
}

/// What is stated of a face makes its bounds closer.
#[test]
fn a_stated_turn_sharpens_a_face() {
    let points: Vec<_> = (0..=100).map(|k| Vector::Z * (f64::from(k) * 0.2)).collect();
    let tube = Tube::fit(&points, &[1.0; 100], 0.01).unwrap();
    let mut ahead = super::speck(Vector::Z * 23.0);
    let mut width = |tube: &Tube| {
        let found = ahead.clearance(tube, &Pose::IDENTITY, 0.01).unwrap();
        assert!(found.resolved && found.lower <= 3.0 && 3.0 <= found.upper, "{found:?}");
        assert!(found.upper - found.lower <= 0.01 + found.uncertainty);
        found.upper - found.lower
    };
    let unknown = width(&tube);
    let known = width(&tube.with_turn(0.02).unwrap());
    // The radius, and twice the radius times the turn, beside twice the deviation.
    assert!((0.9..1.04).contains(&unknown) && known < 0.08, "{unknown} {known}");
}

/// A curve that stands still and turns back has no bound on its curvature.
#[test]
fn points_that_turn_back_are_refused() {
    let points = [0.0, 1.0, 2.0, 0.0].map(|z| Vector::Z * z);
    for scale in [0.25, 0.5, 1.0] {
        let points = points.map(|point| point * scale);
        let found = Tube::fit(&points, &[0.1 * scale; 3], scale);
        assert!(matches!(found, Err(RobotError::TurnsTooSharply { .. })), "{found:?}");
    }
}
