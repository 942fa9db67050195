//! A robot and itself: where its parts come near one another, and that neighbours never do.

use continuum_testing::Random;
use continuum_testing::narrow_phase::point_modified_cylinder;
use parry_continuum::distance::{Vec3, segment_segment};
use parry_continuum::parry::math::{Pose, Vector};
use parry_continuum::proximity::{Decision, SelfQuery};
use parry_continuum::{Cap, Chain, LinearMotion, ModifiedCylinder, Tube};
use std::f64::consts::PI;

/// A robot of one radius along a curve over `[0, 1]`.
fn along(curve: impl Fn(f64) -> Vector, count: u32, radius: f64) -> Chain {
    let points: Vec<_> = (0..=count).map(|k| curve(f64::from(k) / f64::from(count))).collect();
    Chain::from_centreline(&points, &vec![radius; count as usize]).unwrap()
}

/// Half a turn of a circle in the plane of x and z, from one straight leg to another.
fn hairpin(radius: f64, leg: f64, thickness: f64) -> Chain {
    let arc = (0..=40).map(|k| PI * f64::from(k) / 40.0);
    let points: Vec<_> = std::iter::once(Vector::ZERO)
        .chain(arc.map(|a| Vector::new(radius * (1.0 - a.cos()), 0.0, leg + radius * a.sin())))
        .chain([Vector::X * (2.0 * radius)])
        .collect();
    Chain::from_centreline(&points, &vec![thickness; points.len() - 1]).unwrap()
}

#[test]
fn a_straight_robot_never_meets_itself() {
    for radii in [[0.5, 0.5, 0.5], [1.5, 1.0, 0.5]] {
        let points: Vec<_> = (0..4).map(|k| Vector::Z * f64::from(k)).collect();
        let robot = Chain::from_centreline(&points, &radii).unwrap();
        assert_eq!(SelfQuery::new().minimum(&robot).unwrap(), None);
        assert!(SelfQuery::new().clears(&robot, 1e9).unwrap());
    }
    let one = Chain::from_centreline(&[Vector::ZERO, Vector::Z], &[3.0]).unwrap();
    assert_eq!(SelfQuery::new().minimum(&one).unwrap(), None);
}

#[test]
fn a_hairpin_is_as_wide_as_its_waist() {
    for (radius, thickness) in [(10.0, 1.5), (2.0, 0.9), (1.0, 0.99)] {
        let robot = hairpin(radius, 5.0, thickness);
        let found = SelfQuery::new().minimum(&robot).unwrap().unwrap();
        assert!((found.distance - 2.0 * (radius - thickness)).abs() < 1e-12, "{found:?}");
        assert!(SelfQuery::new().clears(&robot, 2.0 * (radius - thickness) - 1e-9).unwrap());
        assert!(!SelfQuery::new().clears(&robot, 2.0 * (radius - thickness) + 1e-9).unwrap());
    }
}

/// An arc of curvature 0.5 and radius 0.9: at a turn of 52 degrees its surfaces are nearer than at
/// the waist of any hairpin.
#[test]
fn a_bend_does_not_meet_its_own_neighbourhood() {
    let arc = |turn: f64| {
        move |s: f64| Vector::new(2.0 * (1.0 - (turn * s).cos()), 0.0, 2.0 * (turn * s).sin())
    };
    let robot = along(arc(0.48 * PI), 40, 0.9);
    assert_eq!(SelfQuery::new().minimum(&robot).unwrap(), None);
    // Beyond a quarter of a turn base and tip are faces that something may stand on, but nothing
    // does.
    for turn in [0.55 * PI, 0.8 * PI, 0.99 * PI] {
        let robot = along(arc(turn), 60, 0.9);
        assert_eq!(SelfQuery::new().minimum(&robot).unwrap(), None, "{turn}");
        assert!(SelfQuery::new().clears(&robot, 1e9).unwrap());
    }
}

/// The distance of neighbouring turns of a helix: at the angle near 2 pi where R^2 sin(phi) + (p /
/// 2 pi)^2 phi = 0.
#[test]
fn a_helix_meets_itself_at_one_pitch() {
    let (radius, thickness) = (3.0, 0.4);
    for pitch in [0.5, 0.79, 0.81, 2.0] {
        let rise = pitch / (2.0 * PI);
        let slope = |phi: f64| radius * radius * phi.sin() + rise * rise * phi;
        let (mut low, mut high) = (1.5 * PI, 2.5 * PI);
        for _ in 0..100 {
            let middle = 0.5 * (low + high);
            if slope(middle) < 0.0 { low = middle } else { high = middle }
        }
        let chord = (2.0 * radius * radius * (1.0 - low.cos()) + (rise * low).powi(2)).sqrt();
        let turn = |s: f64| 6.0 * PI * s;
        let helix =
            |s: f64| Vector::new(radius * turn(s).cos(), radius * turn(s).sin(), rise * turn(s));
        let robot = along(helix, 600, thickness);
        let found = SelfQuery::new().minimum(&robot).unwrap().unwrap();
        // A chord of 1.8 degrees leaves the circle by 4e-4, equally on both turns up to its tilt.
        let expected = (chord - 2.0 * thickness).max(0.0);
        assert!(
            (found.distance - expected).abs() < 1e-3,
            "{pitch}: {} for {expected}",
            found.distance
        );
        assert_eq!(SelfQuery::new().clears(&robot, 0.0).unwrap(), pitch > 0.8);
    }
}

/// A thick tube, a thin one out of its face, which bends by `turn` and goes on straight.
fn bent_back(turn: f64, reach: f64) -> Chain {
    let arc = (0..=30).map(|k| turn * f64::from(k) / 30.0);
    let mut points = vec![Vector::Z * -10.0, Vector::ZERO];
    points.extend(arc.map(|a| Vector::new(1.0 - a.cos(), 0.0, 1.0 + a.sin())));
    let way = Vector::new(turn.sin(), 0.0, turn.cos());
    points.push(points[points.len() - 1] + way * reach);
    let radii: Vec<_> = (0..points.len() - 1).map(|k| if k == 0 { 3.0 } else { 0.2 }).collect();
    Chain::from_centreline(&points, &radii).unwrap()
}

#[test]
fn a_thin_tube_that_bends_back_stands_on_the_face_of_its_step() {
    // All the way round, its tip stands on the face.
    let robot = bent_back(PI, 0.75);
    let found = SelfQuery::new().minimum(&robot).unwrap().unwrap();
    assert!((found.distance - 0.25).abs() < 1e-9, "{found:?}");
    assert_eq!(found.links, [0, robot.links().len() as u32 - 1]);

    // By less than half a turn, its side comes near the rim: beside a face that is sampled densely.
    for turn in [0.6 * PI, 0.7 * PI, 0.8 * PI] {
        let robot = bent_back(turn, 2.5);
        let found = SelfQuery::new().minimum(&robot).unwrap().unwrap();
        let last = robot.links()[robot.links().len() - 1];
        let mut least = f64::INFINITY;
        for ring in 0..=300 {
            for spoke in 0..720 {
                let (sin, cos) = (PI * f64::from(spoke) / 360.0).sin_cos();
                let point = Vector::new(cos, sin, 0.0) * (3.0 * f64::from(ring) / 300.0);
                least = least.min(distance_to(&last, point));
            }
        }
        assert!(
            found.distance <= least + 1e-12 && least < found.distance + 0.03,
            "{} {least}",
            found.distance
        );
        assert!(!SelfQuery::new().clears(&robot, least).unwrap());
    }
}

fn distance_to(link: &ModifiedCylinder, point: Vector) -> f64 {
    let v = |point: Vector| Vec3::from(point.to_array());
    let flat = link.caps().map(|cap| cap == Cap::Flat);
    point_modified_cylinder(v(point), v(link.start()), v(link.end()), link.radius(), flat).distance
}

#[test]
fn two_steps_face_one_another() {
    let points: Vec<_> = [0.0, 3.0, 5.0, 8.0].map(|z| Vector::Z * z).to_vec();
    let robot = Chain::from_centreline(&points, &[2.0, 0.5, 2.0]).unwrap();
    assert_eq!(SelfQuery::new().minimum(&robot).unwrap().unwrap().distance, 2.0);
}

/// A thick tube, and a thin one that comes back between a quarter and half a turn later and runs
/// into its end: points of both in one place, which rounding leaves some units in the last place
/// apart, in any direction.
#[test]
fn a_tip_that_runs_into_a_face_is_never_lost() {
    let points = [
        [0.0, 0.0, 0.0],
        [8.609375037926096, 2.1540864029459943, -4.608532654216331],
        [15.496875068266972, 3.87735552530279, -8.295358777589396],
        [16.610797475342583, 2.330033529409117, -7.691230056174417],
        [14.309283972373123, 0.6608991322890376, -5.740535266297684],
    ]
    .map(Vector::from_array);
    let radii = [5.0, 1.0, 1.0, 1.0];
    let mut random = Random::new(41);
    let mut apart = 0;
    for turned in 0..2000 {
        let pose = if turned == 0 { Pose::IDENTITY } else { random.pose(0.0) };
        let points = points.map(|point| pose * point);
        let robot = Chain::capsules(&points, &radii).unwrap();
        let found =
            SelfQuery::new().minimum(&robot).unwrap().expect("the last link meets the first");
        assert_eq!(found.links, [0, 3]);
        assert!(found.distance < 1e-13, "{found:?}");
        apart += usize::from(found.distance > 0.0);
        assert!(
            !SelfQuery::new().clears(&robot, 0.5).unwrap()
                && !SelfQuery::new().clears(&robot, 1e-13).unwrap()
        );
    }
    assert!(apart > 100, "rounding parted only {apart}");
}

/// Two axes that are nearest at places within both are a local minimum, for all joints between
/// them.
#[test]
fn no_local_minimum_is_left_out() {
    let mut random = Random::new(1);
    let (mut query, mut minima, mut none) = (SelfQuery::new(), 0, 0);
    for _ in 0..2000 {
        let count = 3 + random.below(10);
        let (mut at, mut way) = (Vector::ZERO, random.direction());
        let mut points = vec![at];
        for _ in 0..count {
            at += way;
            points.push(at);
            let sharp = [0.3, 1.2][random.below(2) as usize];
            way = (way + random.direction() * sharp).normalize_or(Vector::Z);
        }
        let radius = 1e-3;
        let Ok(robot) = Chain::from_centreline(&points, &vec![radius; count as usize]) else {
            continue;
        };
        let Ok(found) = query.minimum(&robot) else { continue };
        for i in 0..count as usize {
            for j in i + 2..count as usize {
                let v = |point: Vector| Vec3::from(point.to_array());
                let axes = segment_segment(
                    [v(points[i]), v(points[i + 1])],
                    [v(points[j]), v(points[j + 1])],
                );
                let inside = |k: usize, point: Vec3<f64>| {
                    let point = Vector::from(<[f64; 3]>::from(point));
                    let share = (point - points[k]).dot(points[k + 1] - points[k]);
                    let whole = (points[k + 1] - points[k]).length_squared();
                    // Not an end that rounding has moved.
                    1e-9 * whole < share && share < (1.0 - 1e-9) * whole
                };
                if inside(i, axes.point1) && inside(j, axes.point2) {
                    let expected = (axes.distance - 2.0 * radius).max(0.0);
                    let least = found.expect("a local minimum").distance;
                    assert!(least <= expected + 1e-12, "{least} {expected}");
                    minima += 1;
                }
            }
        }
        none += usize::from(found.is_none());
        // What is remembered changes no answer.
        assert_eq!(SelfQuery::new().minimum(&robot).unwrap(), found);
        if let Some(found) = found {
            assert!(
                SelfQuery::new().clears(&robot, found.distance.next_down()).unwrap()
                    || found.distance == 0.0
            );
            assert!(!SelfQuery::new().clears(&robot, found.distance).unwrap());
        }
    }
    assert!(minima > 80 && none > 100, "{minima} {none}");
}

#[test]
fn a_joint_that_is_too_sharp_is_named() {
    let points = [Vector::ZERO, Vector::Z, Vector::new(0.2, 0.0, 0.1)];
    let robot = Chain::from_centreline(&points, &[0.2, 0.2]).unwrap();
    let error = SelfQuery::new().minimum(&robot).unwrap_err();
    assert_eq!(error.kind(), "joint_too_sharp");
    assert!(error.to_string().contains("joint 1"), "{error}");
}

/// A capsule's round end where the robot gets thinner is in the way like a face.
#[test]
fn a_thin_tube_that_bends_back_meets_the_round_end_of_its_step() {
    let points = [[0.0, 0.0, -10.0], [0.0, 0.0, 0.0], [0.0, 0.0, 3.0], [3.0, 0.0, -2.196_152]]
        .map(Vector::from);
    let robot = Chain::capsules(&points, &[2.0, 0.1, 0.1]).unwrap();
    let met = SelfQuery::new().minimum(&robot).unwrap().unwrap();
    assert!(met.distance == 0.0 && met.links == [0, 2], "{met:?}");
    assert!(!SelfQuery::new().clears(&robot, 0.0).unwrap());
    // Thin enough to stay away at the point of the axis that is nearest to the step.
    let robot = Chain::capsules(&points, &[0.5, 0.1, 0.1]).unwrap();
    let apart = SelfQuery::new().minimum(&robot).unwrap().unwrap();
    let [tip, joint] = [points[3], points[2]];
    let way = (tip - joint).normalize();
    let nearest = (joint + way * (points[1] - joint).dot(way) - points[1]).length();
    assert!(
        (apart.distance - (nearest - 0.6)).abs() < 1e-12 && apart.links == [0, 2],
        "{apart:?} {nearest}"
    );
    assert!(
        SelfQuery::new().clears(&robot, 0.99 * apart.distance).unwrap()
            && !SelfQuery::new().clears(&robot, apart.distance).unwrap()
    );
}

/// A link that comes back along the one before, whichever way rounding turns its axis.
#[test]
fn a_robot_that_is_folded_is_refused() {
    let mut random = Random::new(7);
    for _ in 0..200 {
        let (start, joint) = (random.point() * 50.0, random.point() * 50.0);
        for radius in [0.0, 0.1, 5.0] {
            let robot = Chain::capsules(&[start, joint, start], &[radius; 2]).unwrap();
            assert_eq!(SelfQuery::new().minimum(&robot).unwrap_err().kind(), "joint_too_sharp");
        }
    }
}

/// An arc in the plane of x and z, of links of length 1, that turns by this much at each joint.
fn arc(turn: f64, count: usize) -> Vec<Vector> {
    let mut points = vec![Vector::ZERO];
    for k in 0..count {
        let (sin, cos) = (turn * k as f64).sin_cos();
        points.push(points[k] + Vector::new(sin, 0.0, cos));
    }
    points
}

#[test]
fn radii_that_are_equal_up_to_rounding_are_no_steps() {
    let mut query = SelfQuery::new();
    let points: Vec<_> = (0..7).map(|k| Vector::Z * (0.1 * f64::from(k))).collect();
    let radii = [0.1 + 0.2, 0.3, 0.1 + 0.2, 0.3, 0.3, 0.3];
    assert!(radii[0] != radii[1]);
    for chain in [Chain::from_centreline(&points, &radii), Chain::capsules(&points, &radii)] {
        assert_eq!(query.minimum(&chain.unwrap()).unwrap(), None);
    }
    let mut random = Random::new(8);
    for round in 0..200 {
        let count = 3 + random.below(20) as usize;
        let (turn, noise) =
            (random.between(0.0, 1.5) / count as f64, [2e-16, 1e-12, 1e-10][round % 3]);
        let unit = [1.0, 1e-3, 1e-6][random.below(3) as usize];
        let radius = random.between(0.1, 5.0).min(0.4 / turn) * unit;
        let mut points = arc(turn, count);
        points.iter_mut().for_each(|point| *point *= unit);
        let noisy = |_| radius * (1.0 + noise * random.between(-1.0, 1.0));
        let radii: Vec<_> = (0..=count).map(noisy).collect();
        let links = &radii[1..];
        let chains = [
            Chain::from_centreline(&points, links),
            Chain::capsules(&points, links),
            Chain::from_vertex_radii(&points, &radii),
        ];
        for chain in chains.map(Result::unwrap) {
            assert_eq!(query.minimum(&chain).unwrap(), None, "{round}");
            assert!(query.clears(&chain, 9.0).unwrap(), "{round}");
            let tube = Tube::from(&chain);
            let decision = query.clears_tube(&tube, 0.0, 1e-3 * unit).unwrap();
            assert_eq!(decision, Decision::Clear, "{round}");
        }
        if round % 10 == 0 {
            let motion = LinearMotion::chain(&points, &points, links).unwrap();
            assert!(query.clears_motion(&motion, 0.0, 1e-3 * unit).unwrap().is_clear(), "{round}");
        }
    }
}

/// Two shoulders of a taper look the same way, and what they overlap is the robot itself.
#[test]
fn a_tapered_robot_does_not_meet_its_own_neighbourhood() {
    let mut query = SelfQuery::new();
    let points: Vec<_> = (0..5).map(|k| Vector::Z * (0.5 * f64::from(k))).collect();
    let straight = Chain::capsules(&points, &[1.0, 0.99, 0.98, 0.97]).unwrap();
    assert_eq!(query.minimum(&straight).unwrap(), None);
    let mut random = Random::new(9);
    let (mut overlapping, mut bent) = (0, 0);
    for round in 0..600 {
        let count = 4 + random.below(30) as usize;
        // Up to half a turn, as tight as the joints allow.
        let turn = random.between(0.1, PI) / count as f64;
        let tight = [0.5, 0.7, 0.8, 0.99][random.below(4) as usize];
        let radius = tight * 0.5 / (0.5 * turn).tan();
        let ratio: f64 = 1.0 - [1e-8, 1e-3, 0.01, 0.1][random.below(4) as usize];
        let mut radii: Vec<_> = (0..count).map(|k| radius * ratio.powi(k as i32)).collect();
        if round % 2 == 0 {
            radii.reverse();
        }
        let points = arc(turn, count);
        let is_flat = round % 4 < 2;
        let chain = if is_flat {
            Chain::from_centreline(&points, &radii)
        } else {
            Chain::capsules(&points, &radii)
        };
        let chain = chain.unwrap();
        assert!(query.clears(&chain, 0.0).unwrap(), "{round}: {:?}", query.minimum(&chain));
        let decision = query.clears_tube(&Tube::from(&chain), 0.0, 1e-3).unwrap();
        assert_eq!(decision, Decision::Clear, "{round}");
        if round % 20 < 4 {
            let motion = if is_flat {
                LinearMotion::chain(&points, &points, &radii)
            } else {
                LinearMotion::capsules(&points, &points, &radii)
            };
            let found = query.clears_motion(&motion.unwrap(), 0.0, 1e-3).unwrap();
            // In the tightest bends the rims of flat faces overlap what lies a quarter of a turn
            // on, inside of the adjoining link: a motion need not tell that.
            let may_doubt = is_flat && tight > 0.9 && found.decision == Decision::Undecided;
            assert!(found.is_clear() || may_doubt, "{round}: {found:?}");
        }
        overlapping += usize::from(radius > 1.0);
        bent += usize::from(turn * count as f64 > 0.5 * PI);
    }
    assert!(overlapping > 100 && bent > 200, "{overlapping} {bent}");
}

/// A thick link, and a thin part that leaves it, turns round and comes back to its wide end.
#[test]
fn a_thin_part_that_bends_back_to_a_thick_end_meets_it() {
    let (mut random, mut query) = (Random::new(10), SelfQuery::new());
    let (mut round_ends, mut corners) = (0, 0);
    for round in 0..400 {
        let (wide, thin) = (random.between(2.0, 6.0), random.between(0.05, 1.0));
        let is_flat = random.below(2) == 0;
        // The tip ends at this place of the end, or a little ahead of it.
        let beside = random.between(thin, 0.9 * wide - thin);
        let depth = if is_flat { 0.0 } else { (wide * wide - beside * beside).sqrt() };
        let gap = [0.0, 1e-3, 0.5][random.below(3) as usize];
        let out = depth + 4.0 * wide;
        let angle = random.between(0.0, 6.0);
        let side = Vector::new(angle.cos(), angle.sin(), 0.0);
        let aside = random.direction() * 0.2 * thin;
        let points = [
            Vector::Z * -10.0,
            Vector::ZERO,
            Vector::Z * out,
            side * beside + Vector::Z * (out + 0.5 * thin) + aside,
            // Towards the ball's centre, or down to the face.
            if is_flat {
                side * beside + Vector::Z * (gap + 1e-9)
            } else {
                (side * beside + Vector::Z * depth) * ((wide + gap + 1e-9) / wide)
            },
        ];
        let pose = random.pose(3.0);
        let points = points.map(|point| pose * point);
        let radii = [wide, thin, thin, thin];
        let chain = if is_flat {
            Chain::from_centreline(&points, &radii)
        } else {
            Chain::capsules(&points, &radii)
        };
        let Ok(found) = query.minimum(&chain.unwrap()) else { continue };
        let found = found.unwrap_or_else(|| panic!("{round}: the tip meets the end"));
        assert!(found.distance <= gap + 2e-9, "{round}: {found:?} {gap}");
        if beside > 2.0 * thin + gap + 1e-3 {
            assert_eq!(found.links, [0, 3], "{round}");
        }
        round_ends += usize::from(!is_flat);
        corners += usize::from(gap == 0.0);
    }
    assert!(round_ends > 50 && corners > 30, "{round_ends} {corners}");
}
