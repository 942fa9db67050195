//! Tubes fitted to measured points: within the deviation of every point, smooth, and right in their
//! bounds.

use super::{Discs, Seen, discs, judge};
use continuum_testing::{Arcs, Random, rounds};
use parry_continuum::parry::math::{Pose, Vector};
use parry_continuum::proximity::{Decision, ProximityError, RobotPair, SelfQuery};
use parry_continuum::{RobotError, Tube};
use std::f64::consts::{PI, TAU};

/// How many fits are compared with and without a turn.
const TUBES: usize = 120;

/// Evenly spread in a ball.
fn in_ball(random: &mut Random) -> Vector {
    loop {
        let point = random.point();
        if point.length() <= 1.0 {
            return point;
        }
    }
}

/// Robots of 80 mm as in a planner: up to four arcs, two radii.
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

/// Samples of a robot, some taken twice, each off by up to the noise.
fn measured(random: &mut Random, arcs: &Arcs, count: usize, noise: f64) -> (Vec<Vector>, Vec<f64>) {
    let (mut points, mut radii, mut from) =
        (vec![arcs.at(0.0).0 + in_ball(random) * noise], Vec::new(), 0.0);
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
    let (mut random, mut seen, mut roughest, mut refused) =
        (Random::new(91), Seen::default(), 0, 0);
    while seen.asked < rounds(10_000) {
        let arcs = robot(&mut random);
        let deviation = [0.02, 0.05, 0.25, 1.0][random.below(4) as usize];
        let count = [50, 100, 200, 400][random.below(4) as usize];
        let noise = deviation * [0.0, 0.3, 0.5, 1.0][random.below(4) as usize];
        let (points, radii) = measured(&mut random, &arcs, count, noise);
        let tube = Tube::fit(&points, &radii, deviation);
        if noise == deviation {
            // Points that were measured twice may be so far apart that only a kink is near enough
            // to both.
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
    assert!(roughest > rounds(200) && 20 * refused < roughest, "{refused} of {roughest}");
    assert!(seen.touching > rounds(500) && seen.at_faces > rounds(2_000), "{seen:?}");
    assert!(seen.resolved > rounds(9_900), "{seen:?}");
}

/// A robot that wriggles about the fitted line, or arc, in place by as much as is stated, and in
/// direction too.
#[test]
fn whatever_wriggles_within_what_is_stated_is_within_the_bounds() {
    let (mut random, mut seen) = (Random::new(92), Seen::default());
    for round in 0..rounds(600) {
        let (length, radius) = (random.between(5.0, 40.0), random.between(0.3, 2.0));
        let mut arcs = Arcs::from_frame(random.pose(5.0));
        let bend = Vector::X
            * if round % 2 == 0 { 0.0 } else { random.between(0.0, 0.3 / radius).min(PI / length) };
        arcs.push(radius, &[(length, bend)]);
        let points: Vec<_> = (0..=200).map(|k| arcs.at(length * f64::from(k) / 200.0).0).collect();
        let size = radius * [0.02, 0.2, 0.6][random.below(3) as usize];
        let (turns, phase) =
            ((random.between(0.1, 2.0) / radius).min(30.0 / length), TAU * random.unit());
        // What the fit is off the arc counts too.
        let (deviation, turn) = (size + 2e-3, (size * turns).atan() + 1e-2);
        let tube = Tube::fit(&points, &vec![radius; 200], deviation).unwrap();
        assert!(tube.residual() < 1e-3, "{}", tube.residual());
        let up = arcs
            .at(0.0)
            .1
            .cross(arcs.at(0.5 * length).0 - arcs.at(0.0).0 + Vector::splat(1e-3))
            .normalize();
        let curve = |s: f64| {
            let ((point, along), angle) = (arcs.at(s), turns * s + phase);
            // Across the curve, and across the plane in which it lies.
            let (across, here) =
                if bend == Vector::ZERO { (up, along) } else { (normal(&arcs), along) };
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
    assert!(
        seen.touching > rounds(500)
            && seen.at_faces > rounds(2_000)
            && seen.resolved > seen.asked * 9 / 10,
        "{seen:?}"
    );
}

/// Across the plane of an arc.
fn normal(arcs: &Arcs) -> Vector {
    let [start, end] = [0.0, 0.1 * arcs.length()].map(|s| arcs.at(s).1);
    start.cross(end).normalize()
}

/// A stated turn at a face tightens the bounds.
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

/// Points that were measured twice cost the spline no digits, however many there are.
#[test]
fn many_points_measured_twice_are_fitted() {
    let (count, rise, radius) = (10_000, 5.0, 10.0);
    for apart in [0.0, 1e-12, 1e-6] {
        let mut points = Vec::new();
        for k in 0..count {
            let (sin, cos) = (40.0 * f64::from(k) / f64::from(count)).sin_cos();
            let height = rise * 40.0 * f64::from(k) / f64::from(count);
            let point = Vector::new(radius * cos, radius * sin, height);
            points.extend([point, point + Vector::X * apart]);
        }
        let tube = Tube::fit(&points, &vec![1.0; points.len() - 1], 0.05).unwrap();
        let length = 40.0 * f64::hypot(rise, radius);
        assert!((tube.length() - length).abs() < 0.1, "{apart}: {}", tube.length());
        assert!(tube.residual() < 0.01, "{apart}: {}", tube.residual());
    }
}

/// A short segment that is wider than both neighbours is not merged away.
#[test]
fn a_short_wide_segment_is_kept() {
    let heights = [0.0, 1.0, 2.0, 3.0, 4.0, 4.0 + 1e-4, 5.0, 6.0, 7.0, 8.0];
    let mut radii = [1.0; 9];
    radii[4] = 3.0;
    let tube = Tube::fit(&heights.map(|z| Vector::Z * z), &radii, 0.05).unwrap();
    let mut beside = super::speck(Vector::new(3.5, 0.0, 4.0));
    let found = beside.clearance(&tube, &Pose::IDENTITY, 1e-3).unwrap();
    assert!(found.lower <= 0.5, "{found:?}");
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

/// Whether an answer is at least as good as another one: it decides the same, or it decides at all.
fn is_no_worse(
    known: &Result<Decision, ProximityError>,
    before: &Result<Decision, ProximityError>,
) -> bool {
    match before {
        Ok(Decision::Undecided) => known.is_ok(),
        Ok(decided) => known.as_ref().ok() == Some(decided),
        Err(_) => true,
    }
}

/// A stated turn never loosens a bound or an answer: beside a mesh, another tube and itself, near
/// faces and far from them.
#[test]
fn a_stated_turn_never_makes_an_answer_worse() {
    let (mut random, mut seen) = (Random::new(93), Seen::default());
    let (mut better, mut decided, mut beside) = (0, 0, 0);
    for round in 0..TUBES {
        let arcs = if round % 2 == 0 {
            let mut arcs = Arcs::from_frame(random.pose(5.0));
            arcs.push(random.between(0.3, 2.0), &[(random.between(2.0, 20.0), Vector::ZERO)]);
            arcs
        } else {
            robot(&mut random)
        };
        let unit = [1.0, 1e-3, 1e-6][random.below(3) as usize];
        let deviation = [0.02, 0.25, 0.25, 1.0][random.below(4) as usize];
        let (points, radii) = measured(&mut random, &arcs, 60, 0.0);
        let points: Vec<_> = points.iter().map(|point| *point * unit).collect();
        let radii: Vec<_> = radii.iter().map(|radius| radius * unit).collect();
        let tube = Tube::fit(&points, &radii, deviation * unit).unwrap();
        let turned =
            tube.clone().with_turn([0.0, 0.02, 0.02, 0.3, 2.0][random.below(5) as usize]).unwrap();
        let curve = |s: f64| arcs.at(s);
        for _ in 0..6 {
            let point = super::near(&mut random, &discs(&arcs), &curve, 4.0);
            let truth = super::distance(&discs(&arcs), &curve, point);
            let tolerance = [0.0, 0.01, 0.1][random.below(3) as usize] * unit;
            let ask = |tube: &Tube| {
                super::speck(point * unit).clearance(tube, &Pose::IDENTITY, tolerance)
            };
            let [before, known] = [ask(&tube).unwrap(), ask(&turned).unwrap()];
            assert!(
                before.lower <= known.lower && known.upper <= before.upper,
                "{before:?} {known:?}"
            );
            assert!(known.resolved || !before.resolved, "{before:?} {known:?}");
            // The pieces explain the lower bound, whichever of the two queries it is from.
            let mut pieces = Vec::new();
            let mut speck = super::speck(point * unit);
            let again = speck.clearance_pieces(&turned, &Pose::IDENTITY, tolerance, &mut pieces);
            assert_eq!(again, Ok(known));
            let least = pieces.iter().map(|piece| piece.lower).fold(known.upper, f64::min);
            assert_eq!(least, known.lower, "{known:?}");
            assert!(
                known.lower <= truth * unit * (1.0 + 1e-9)
                    && truth * unit <= known.upper + 1e-9 * unit
            );
            let margin = (truth + random.between(-1.0, 1.0) * (deviation + 1.0)).max(0.0) * unit;
            let decide = |tube: &Tube| {
                super::speck(point * unit).clears_tube(tube, &Pose::IDENTITY, margin, 1e-3 * unit)
            };
            let [before, known] = [decide(&tube), decide(&turned)];
            assert!(is_no_worse(&known, &before), "{before:?} {known:?}");
            seen.asked += 1;
            better += usize::from(known.is_ok() && before.is_err());
            decided += usize::from(matches!(before, Ok(Decision::Clear)));
        }
        if round % 8 == 0 {
            let pose =
                Pose::from_parts(random.direction() * (5.0 * unit), random.pose(1.0).rotation);
            let other = [&tube, &turned][random.below(2) as usize];
            let ask = |tube: &Tube| {
                RobotPair::new().clearance(tube, &Pose::IDENTITY, other, &pose, 0.1 * unit).unwrap()
            };
            let [before, known] = [ask(&tube), ask(&turned)];
            assert!(
                before.lower <= known.lower && known.upper <= before.upper,
                "{before:?} {known:?}"
            );
            let margin = before.upper * random.between(0.2, 1.2);
            let decide = |tube: &Tube| {
                RobotPair::new().clears_tubes(
                    tube,
                    &Pose::IDENTITY,
                    other,
                    &pose,
                    margin,
                    0.1 * unit,
                )
            };
            let [before, known] = [decide(&tube), decide(&turned)];
            assert!(is_no_worse(&known, &before), "{before:?} {known:?}");
            let decide = |tube: &Tube| SelfQuery::new().clears_tube(tube, 0.1 * unit, 0.05 * unit);
            assert!(is_no_worse(&decide(&turned), &decide(&tube)));
            beside += usize::from(before.is_ok());
        }
    }
    assert!(seen.asked == 6 * TUBES && decided > TUBES / 2, "{seen:?} {better} {decided} {beside}");
}

/// Errors use the words of the function that was called.
#[test]
fn what_is_refused_names_the_deviation() {
    let zigzag: Vec<_> =
        (0..40).map(|k| Vector::new(f64::from(k % 2), 0.0, 0.1 * f64::from(k))).collect();
    let error = Tube::fit(&zigzag, &[0.1; 39], 1e-3).unwrap_err();
    assert!(matches!(error, RobotError::TurnsTooSharply { .. }), "{error}");
    assert!(error.to_string().contains("a `deviation` as large as their noise"), "{error}");
    let arc: Vec<_> =
        (0..40).map(|k| 0.1 * f64::from(k)).map(|a| Vector::new(a.cos(), a.sin(), 0.0)).collect();
    let error = Tube::from_samples(&arc, &[1.01; 39], None).unwrap_err();
    assert!(matches!(error, RobotError::BendsWithinRadius { .. }), "{error}");
    assert!(error.to_string().contains("`Tube::fit`"), "{error}");
}
