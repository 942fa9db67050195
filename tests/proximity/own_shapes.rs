//! A robot and itself does not depend on frame, order, unit and cuts of straight links.

use continuum_testing::Random;
use parry_continuum::parry::math::{Pose, Vector};
use parry_continuum::proximity::{Decision, SelfQuery};
use parry_continuum::{Chain, Tube};
use std::f64::consts::PI;

type Make = fn(&[Vector], &[f64]) -> Chain;

const KINDS: [Make; 2] = [
    |points, radii| Chain::from_centreline(points, radii).unwrap(),
    |points, radii| Chain::capsules(points, radii).unwrap(),
];

/// Two legs from `y = 0` to `y = leg`, `width` apart at `y = 0`, that open by an angle, and the
/// base of the U between them.
fn hairpin(leg: f64, width: f64, opening: f64) -> [Vector; 4] {
    let (sin, cos) = (0.5 * opening).sin_cos();
    let half = 0.5 * width;
    [
        Vector::new(-half - leg * sin, leg * cos, 0.0),
        Vector::new(-half, 0.0, 0.0),
        Vector::new(half, 0.0, 0.0),
        Vector::new(half + leg * sin, leg * cos, 0.0),
    ]
}

/// The distance of a robot and itself, which the decisions about it and about its tube confirm.
fn distance(query: &mut SelfQuery, chain: &Chain, unit: f64) -> Option<f64> {
    let found = query.minimum(chain).unwrap().map(|found| found.distance);
    let margin = found.map_or(5.0 * unit, |distance| distance + 0.01 * unit);
    assert_eq!(query.clears(chain, margin).unwrap(), found.is_none(), "{chain:?}");
    let decision = query.clears_tube(&Tube::from(chain), margin, 1e-3 * unit).unwrap();
    let expected = if found.is_none() { Decision::Clear } else { Decision::Contact };
    assert_eq!(decision, expected, "{found:?} {margin} {chain:?}");
    if let Some(distance) = found
        && distance > 0.01 * unit
    {
        let margin = distance - 0.01 * unit;
        assert!(query.clears(chain, margin).unwrap());
        let decision = query.clears_tube(&Tube::from(chain), margin, 1e-3 * unit).unwrap();
        assert_eq!(decision, Decision::Clear, "{found:?} {margin} {chain:?}");
    }
    found
}

/// Legs of radius 4 that are 10 apart: a gap of 2, in every frame.
#[test]
fn parallel_legs_keep_their_gap_where_the_radius_steps() {
    let mut query = SelfQuery::new();
    let points = [
        [-0.6980962574913405, 0.0, 39.99390780625565],
        [0.0, 0.0, 0.0],
        [9.998476951563912, 0.0, 0.17452406437283513],
        [9.300380694072572, 0.0, 40.16843187062848],
    ]
    .map(Vector::from_array);
    let turned = |degrees: i32| {
        let (sin, cos) = (PI * f64::from(degrees) / 180.0).sin_cos();
        points.map(|p| Vector::new(p.x * cos + p.z * sin, p.y, p.z * cos - p.x * sin))
    };
    for degrees in 0..360 {
        let legs = turned(degrees);
        let chain = Chain::from_centreline(&legs, &[4.0, 1.0, 4.0]).unwrap();
        let found = query.minimum(&chain).unwrap().unwrap_or_else(|| panic!("{degrees}"));
        assert!((found.distance - 2.0).abs() < 1e-12, "{degrees}: {found:?}");
        assert!(!query.clears(&chain, 5.0).unwrap(), "{degrees}");
        if degrees % 20 == 0 {
            assert!(distance(&mut query, &chain, 1.0).is_some());
        }
    }
}

/// Legs that open by less than rounding in their directions are parallel, with and without steps,
/// cut in one link a leg or in several.
#[test]
fn legs_keep_their_gap_in_every_frame_order_and_unit() {
    let (mut random, mut query) = (Random::new(71), SelfQuery::new());
    let mut tilted = 0;
    for round in 0..600 {
        let unit = [1.0, 1e-3, 1e-6, 1e4][random.below(4) as usize];
        let opening = [0.0, 1e-15, 1e-12, 1e-9, -1e-9][random.below(5) as usize];
        let (leg, width) = (random.between(5.0, 60.0), random.between(3.0, 12.0));
        let wide = random.between(0.1, 0.48) * width;
        let thin = [wide, 0.3 * wide][random.below(2) as usize].min(0.4 * width);
        let pose = match random.below(3) {
            0 => Pose::IDENTITY,
            1 => random.pose(0.0),
            _ => random.pose(100.0),
        };
        let corners = hairpin(leg, width, opening);
        let cuts = 1 + random.below(3);
        let mut points = Vec::new();
        let mut radii = Vec::new();
        for (number, pair) in corners.windows(2).enumerate() {
            let parts = if number == 1 { 1 } else { cuts };
            for k in 0..parts {
                points.push(pair[0].lerp(pair[1], f64::from(k) / f64::from(parts)));
                radii.push(if number == 1 { thin } else { wide } * unit);
            }
        }
        points.push(corners[3]);
        let mut points: Vec<_> = points.iter().map(|point| pose * *point * unit).collect();
        if random.below(2) == 0 {
            points.reverse();
            radii.reverse();
        }
        let chain = KINDS[round % 2](&points, &radii);
        // A square corner of links of one radius that are short is too sharp.
        let Ok(found) = query.minimum(&chain) else { continue };
        let found = found.unwrap_or_else(|| panic!("{round}, {opening}: {points:?} {radii:?}"));
        let expected = width - 2.0 * wide;
        assert!((found.distance / unit - expected).abs() < 1e-6, "{found:?} {expected}");
        if round % 4 == 0 {
            assert!(distance(&mut query, &chain, unit).is_some());
        }
        tilted += usize::from(opening != 0.0);
    }
    assert!(tilted > 200, "{tilted}");
}

/// Legs that open come nearest at the bend, and belong to it.
#[test]
fn legs_that_open_do_not_meet_however_they_are_cut() {
    let mut query = SelfQuery::new();
    for (cuts, opening) in [(1, 1e-3), (2, 1e-3), (7, 1e-3), (1, 0.1), (7, 0.1)] {
        let corners = hairpin(30.0, 10.0, opening);
        let mut points = Vec::new();
        for (number, pair) in corners.windows(2).enumerate() {
            let parts = if number == 1 { 1 } else { cuts };
            points
                .extend((0..parts).map(|k| pair[0].lerp(pair[1], f64::from(k) / f64::from(parts))));
        }
        points.push(corners[3]);
        for make in KINDS {
            let chain = make(&points, &vec![1.0; points.len() - 1]);
            assert_eq!(distance(&mut query, &chain, 1.0), None, "{cuts} {opening}");
        }
    }
}

/// The frames of a robot whose coordinates are rounded up to 2^20 from the origin.
fn far_frames(random: &mut Random) -> [Pose; 4] {
    let frame = |away: f64| {
        let turned = random.pose(0.0).rotation;
        Pose::from_parts(random.direction() * away, turned)
    };
    [0.0, 1024.0, 1_048_576.0, 1_048_576.0].map(frame)
}

/// Legs that are skew about the bend between them, which is perpendicular to both, are nearest at
/// the bend. Rounding puts the closest places inside of both or not. Below 35 degrees they count
/// as parallel legs do, in every frame; beyond they do not.
#[test]
fn skew_legs_are_as_near_as_their_bend_in_every_frame() {
    let (mut random, mut query) = (Random::new(74), SelfQuery::new());
    for skew in [0.0, 1e-4, 1e-3, 0.01, 0.1, 0.5, 0.6, 0.7, 1.0, 0.5 * PI, 2.0, 3.0] {
        for opening in [0.0, 1e-12, -1e-12, 1e-9, 1e-8] {
            if opening != 0.0 && skew > 0.6 {
                continue;
            }
            let (sin, cos) = f64::sin_cos(skew);
            let leg = Vector::new(opening, sin, cos) * 12.0;
            let points = [Vector::Z * 10.0, Vector::ZERO, Vector::X * 4.0, Vector::X * 4.0 + leg];
            for frame in far_frames(&mut random) {
                let mut placed = points.map(|point| frame * point);
                if random.below(2) == 0 {
                    placed.reverse();
                }
                for make in KINDS {
                    let chain = make(&placed, &[0.5; 3]);
                    let found = distance(&mut query, &chain, 1.0);
                    let expected = (skew < 0.61).then_some(3.0);
                    assert_eq!(found.is_some(), expected.is_some(), "{skew} {opening} {frame:?}");
                    let off = found.zip(expected).map_or(0.0, |(one, two)| one - two);
                    assert!(off.abs() < 1e-6, "{skew} {opening} {off}");
                }
            }
        }
    }
}

/// A thin part bends back to the round shoulder that it leaves. The shoulder's point is in the thin
/// part, or outside of it, by 1e-5: in every frame.
#[test]
fn a_shoulder_is_covered_in_every_frame() {
    let (mut random, mut query) = (Random::new(75), SelfQuery::new());
    for (by, expected) in [(-2e-5, None), (2e-5, Some(3.5))] {
        // The point is `thick * sine` from the thin axis.
        let (thick, thin, away) = (2.0, 0.5, 6.0);
        let sine: f64 = thin / thick * (1.0 + by);
        let tip = Vector::new(sine, 0.0, (1.0 - sine * sine).sqrt()) * away;
        let bend = Vector::new(tip.x - 0.3, 0.0, 10.3);
        let points = [Vector::Z * -9.0, Vector::ZERO, Vector::Z * 10.0, bend, tip];
        for frame in far_frames(&mut random) {
            let placed = points.map(|point| frame * point);
            let chain = Chain::capsules(&placed, &[thick, thin, thin, thin]).unwrap();
            let found = distance(&mut query, &chain, 1.0);
            assert_eq!(found.is_some(), expected.is_some(), "{by} {frame:?} {found:?}");
            let off = found.zip(expected).map_or(0.0, |(one, two)| one - two);
            assert!(off.abs() < 1e-6, "{off}");
        }
    }
}

/// Two thick links in a plane and two thin ones between them. The inner points of the rims that
/// look at one another are nearest, below and beyond a turn of pi, for the chain and its tube.
#[test]
fn rims_meet_beyond_half_a_turn_too() {
    let mut query = SelfQuery::new();
    let towards = |angle: f64| Vector::new(angle.sin(), 0.0, angle.cos());
    for turn in [2.9_f64, 3.0, 3.1, 3.13, 3.15, 3.2, 3.3, 3.4, 3.42] {
        // The last joint bends back.
        let angles = [-0.417, 0.797, 1.697, 3.811 - turn];
        let mut points = vec![Vector::ZERO];
        for angle in angles {
            points.push(points[points.len() - 1] + towards(angle) * 4.0);
        }
        let inner = |joint: usize, angle: f64| points[joint] + towards(angle + 0.5 * PI);
        let expected = inner(1, angles[0]).distance(inner(3, angles[3] - PI));
        let chain = Chain::cylinders(&points, &[1.0, 0.3, 0.3, 1.0]).unwrap();
        let found = distance(&mut query, &chain, 1.0);
        assert!(found.is_some_and(|found| (found - expected).abs() < 1e-9), "{turn} {found:?}");
    }
}

/// The noise of measured points turns a straight robot by more than pi.
#[test]
fn a_noisy_straight_robot_never_meets_itself() {
    let (mut random, mut query) = (Random::new(72), SelfQuery::new());
    let mut turned = 0;
    for round in 0..150 {
        let count = 50 + random.below(100);
        let noise = [0.0, 0.02, 0.1, 0.2][random.below(4) as usize];
        let pose = random.pose(3.0);
        let points: Vec<_> = (0..=count)
            .map(|k| pose * (Vector::Z * f64::from(k) + random.point() * noise))
            .collect();
        let ways: Vec<_> = points.windows(2).map(|pair| (pair[1] - pair[0]).normalize()).collect();
        let turn: f64 = ways
            .windows(2)
            .map(|pair| pair[0].cross(pair[1]).length().atan2(pair[0].dot(pair[1])))
            .sum();
        let taper = if random.below(2) == 0 { 1.0 } else { 1.0 - 1e-3 };
        let radii: Vec<_> = (0..count).map(|k| 0.5 * f64::powi(taper, k as i32)).collect();
        let chain = KINDS[round % 2](&points, &radii);
        assert_eq!(query.minimum(&chain).unwrap(), None, "{noise}");
        assert!(query.clears(&chain, 1e3).unwrap());
        if round % 10 == 0 {
            let tube = Tube::from(&chain);
            assert_eq!(query.clears_tube(&tube, 0.1, 1e-3).unwrap(), Decision::Clear);
        }
        turned += usize::from(turn > PI);
    }
    assert!(turned > 60, "{turned}");
}

/// A square corner of links twice as long as their radius is as sharp as a joint may be: links
/// overlap there over half of their length. It is accepted in every frame.
#[test]
fn a_joint_at_the_limit_is_accepted_in_every_frame() {
    let (mut query, mut random) = (SelfQuery::new(), Random::new(65));
    let up = (0..=4).map(|k| Vector::new(0.0, 0.0, f64::from(k)));
    let over = (1..=2).map(|k| Vector::new(f64::from(k), 0.0, 4.0));
    let down = (0..4).rev().map(|k| Vector::new(2.0, 0.0, f64::from(k)));
    let points: Vec<_> = up.chain(over).chain(down).collect();
    for _ in 0..50 {
        let away = [0.0, 10.0, 1e3][random.below(3) as usize];
        let frame = random.pose(away);
        let placed: Vec<_> = points.iter().map(|point| frame * *point).collect();
        for make in KINDS {
            let found = distance(&mut query, &make(&placed, &[0.5; 10]), 1.0).unwrap();
            assert!((found - 1.0).abs() < 1e-9, "{found}");
        }
    }
}

/// Two disks on an arc of a thin backbone, `4 / theta` from its centre: the inner points of their
/// rims are `2 (4 / theta - 5) sin(theta / 2)` apart.
#[test]
fn spacer_disks_on_a_thin_backbone_meet_at_their_rims() {
    let mut query = SelfQuery::new();
    for theta in [0.5, 0.7, 0.75] {
        for (chords, thickness) in [(1, 1.0), (2, 0.5), (4, 1.0), (8, 0.1)] {
            let radius = 4.0 / theta;
            let on_arc = |angle: f64| {
                Vector::new(radius * (1.0 - f64::cos(angle)), 0.0, radius * f64::sin(angle))
            };
            let mut points = vec![Vector::Z * -thickness];
            points.extend((0..=chords).map(|k| on_arc(theta * f64::from(k) / f64::from(chords))));
            let along = Vector::new(f64::sin(theta), 0.0, f64::cos(theta));
            points.push(on_arc(theta) + along * thickness);
            let mut radii = vec![0.5; points.len() - 1];
            (radii[0], radii[chords as usize + 1]) = (5.0, 5.0);
            let chain = Chain::from_centreline(&points, &radii).unwrap();
            let gap = 2.0 * (radius - 5.0) * f64::sin(0.5 * theta);
            let found = distance(&mut query, &chain, 1.0).unwrap();
            assert!((found - gap).abs() < 1e-12, "{theta} {chords}: {found} {gap}");
        }
    }
    // A sharp joint of the thin part itself is still refused, and the message names its radius.
    let points = [[0.0, 0.0, -1.0], [0.0; 3], [0.0, 0.0, 2.0], [0.1, 0.0, 1.0]].map(Vector::from);
    let error = query.minimum(&Chain::from_centreline(&points, &[5.0, 0.5, 0.5]).unwrap());
    let error = error.unwrap_err();
    assert!(error.kind() == "joint_too_sharp" && error.to_string().contains("0.5"), "{error}");
}

/// The thin part between two round shoulders is one body, however it is cut.
#[test]
fn a_thin_part_between_round_shoulders_may_be_cut() {
    let mut query = SelfQuery::new();
    for thin in [0.2, 0.46, 0.63, 1.2] {
        let mut answers = Vec::new();
        for parts in [1, 2, 3, 8, 50] {
            let mut points = vec![Vector::ZERO];
            points.extend(
                (0..=parts).map(|k| Vector::Z * (1.0 + thin * f64::from(k) / f64::from(parts))),
            );
            points.push(Vector::Z * (2.0 + thin));
            let mut radii = vec![0.06; points.len() - 1];
            (radii[0], radii[parts as usize + 1]) = (0.45, 0.45);
            let mut random = Random::new(73);
            for round in 0..10 {
                let pose = if round == 0 { Pose::IDENTITY } else { random.pose(2.0) };
                let placed: Vec<_> = points.iter().map(|point| pose * *point).collect();
                answers.push(distance(&mut query, &KINDS[1](&placed, &radii), 1.0));
            }
        }
        // The shoulders are nearest inside of the thin part, if it is longer than their radius.
        let expected = if thin > 0.45 { None } else { Some(0.0) };
        assert!(answers.iter().all(|answer| *answer == expected), "{thin}: {answers:?}");
    }
}
