//! Nonlinear casts of links against triangles and half-spaces: never late, and where they say.

use crate::draw::Draw;
use crate::scene::tube;
use continuum_testing::{Random, rounds};
use parry_continuum::parry::math::{Pose, Real, Vector};
use parry_continuum::parry::query::{NonlinearRigidMotion, QueryDispatcher, ShapeCastStatus};
use parry_continuum::parry::shape::{HalfSpace, Shape, SharedShape, Triangle};
use parry_continuum::{Cap, Chain, ContinuumDispatcher, ModifiedCylinder};

/// A motion from a place to near another, sometimes straight, sometimes still, sometimes spinning
/// fast.
fn motion(random: &mut Random, from: Pose, way: Vector) -> NonlinearRigidMotion {
    let spin = [0.0, 0.5, 6.0][random.index(3)];
    NonlinearRigidMotion::new(from, random.vector(0.5), way, random.direction() * spin)
}

fn distance(
    g1: &dyn Shape,
    m1: &NonlinearRigidMotion,
    g2: &dyn Shape,
    m2: &NonlinearRigidMotion,
    time: Real,
) -> Real {
    let pos12 = m1.position_at_time(time).inv_mul(&m2.position_at_time(time));
    ContinuumDispatcher::default().distance(&pos12, g1, g2).unwrap().distance
}

#[test]
fn casts_are_never_late_and_end_where_the_shapes_touch() {
    let (mut random, dispatcher) = (Random::new(121), ContinuumDispatcher::default());
    let (mut hits, mut misses, mut unfinished) = ([0; 3], [0; 3], 0);
    for _ in 0..rounds(1500) {
        let chain = tube(&mut random);
        let link = random.link();
        let triangle = Triangle::new(random.vector(2.0), random.vector(2.0), random.vector(2.0));
        let half_space = HalfSpace::new(random.direction());
        let cases: [(usize, &dyn Shape, &dyn Shape); 3] =
            [(0, &link, &triangle), (1, &link, &half_space), (2, &chain, &half_space)];
        for (kind, robot, wall) in cases {
            let place = random.pose(4.0);
            let way = if kind == 0 {
                -place.translation + random.vector(1.5)
            } else {
                random.vector(4.0)
            };
            let robot_motion = motion(&mut random, place, way);
            let wall_way = random.vector(0.5);
            let wall_motion = if random.chance(0.5) {
                motion(&mut random, Pose::IDENTITY, wall_way)
            } else {
                NonlinearRigidMotion::identity()
            };
            if distance(robot, &robot_motion, wall, &wall_motion, 0.0) < 1e-6 {
                continue;
            }
            for (g1, m1, g2, m2) in [
                (robot, &robot_motion, wall, &wall_motion),
                (wall, &wall_motion, robot, &robot_motion),
            ] {
                let hit = dispatcher.cast_shapes_nonlinear(m1, g1, m2, g2, 0.0, 1.0, true).unwrap();
                let at = |time| distance(g1, m1, g2, m2, time);
                let met = (0..=500).map(|i| Real::from(i) / 500.0).find(|&time| at(time) == 0.0);
                match hit {
                    Some(hit) => {
                        hits[kind] += 1;
                        unfinished += usize::from(hit.status == ShapeCastStatus::OutOfIterations);
                        let apart = at(hit.time_of_impact);
                        assert!(apart < 1e-7, "{hit:?} at {apart}");
                        assert!(met.is_none_or(|met| hit.time_of_impact <= met), "{hit:?} {met:?}");
                        let [p1, p2] = [
                            m1.position_at_time(hit.time_of_impact),
                            m2.position_at_time(hit.time_of_impact),
                        ];
                        assert!((p1 * hit.witness1 - p2 * hit.witness2).length() < 1e-7, "{hit:?}");
                        assert!(
                            (p1.rotation * hit.normal1 + p2.rotation * hit.normal2).length() < 1e-9
                        );
                    }
                    None => {
                        misses[kind] += 1;
                        assert_eq!(met, None);
                    }
                }
            }
        }
    }
    assert!(
        hits.iter().chain(&misses).all(|&n| n > rounds(200)),
        "{hits:?} hits, {misses:?} misses"
    );
    assert_eq!(unfinished, 0);
}

/// A link that touches a wall with one end and swings is stopped before its axis is through.
#[test]
fn what_touches_at_the_start_does_not_get_through() {
    let (mut random, dispatcher) = (Random::new(122), ContinuumDispatcher::default());
    let (mut held, mut free) = (0, 0);
    let wall = Triangle::new(
        Vector::new(-90.0, 0.0, -90.0),
        Vector::new(90.0, 0.0, -90.0),
        Vector::new(0.0, 0.0, 90.0),
    );
    let still = NonlinearRigidMotion::identity();
    for _ in 0..rounds(2000) {
        let radius = random.log_between(0.02, 0.4);
        let link = ModifiedCylinder::new(-Vector::X, Vector::X, radius, random.caps()).unwrap();
        let turn = random.direction() * random.between(0.0, 3.0);
        let raised = Pose::new(Vector::ZERO, turn);
        // Resting on the wall, or a little inside it.
        let lowest = distance_below(&link, &raised);
        let pose = Pose::from_parts(
            Vector::Y * (lowest - random.between(0.0, 0.4) * radius),
            raised.rotation,
        );
        let moving = NonlinearRigidMotion::new(
            pose,
            Vector::ZERO,
            random.vector(3.0) + Vector::Y * random.between(-20.0, 2.0),
            random.direction() * random.between(0.0, 2.0),
        );
        let is_through = |time: Real| {
            let pose = moving.position_at_time(time);
            let inset = link.caps().map(|cap| if cap == Cap::Flat { radius } else { 0.0 });
            let ends = [link.start() + Vector::X * inset[0], link.end() - Vector::X * inset[1]];
            ends.iter().any(|end| (pose * end).y < 0.0)
        };
        let hit = dispatcher
            .cast_shapes_nonlinear(&moving, &link, &still, &wall, 0.0, 0.5, false)
            .unwrap();
        let through = (0..=500).map(|i| Real::from(i) / 1000.0).find(|&time| is_through(time));
        match hit {
            Some(hit) => {
                held += 1;
                assert!(
                    hit.time_of_impact > 0.0 && !is_through(hit.time_of_impact),
                    "{link:?} {moving:?} {hit:?}"
                );
                assert!(through.is_none_or(|through| hit.time_of_impact < through));
            }
            None => {
                free += 1;
                assert_eq!(through, None, "{link:?} {moving:?}");
            }
        }
    }
    assert!(held > rounds(500) && free > rounds(100), "{held} held, {free} free");
}

/// A ball whose centre is nearly on a wall has no depth left within rounding. If there is some,
/// half of it is left.
#[test]
fn a_ball_whose_centre_is_on_a_wall_is_not_refused() {
    let dispatcher = ContinuumDispatcher::default();
    let walls = [
        SharedShape::cuboid(0.75, 0.5, 0.5),
        SharedShape::cylinder(0.875, 0.75),
        SharedShape::cone(0.5, 0.75),
    ];
    for (wall, at) in walls.iter().zip([Vector::X * 0.75, Vector::X * 0.75, Vector::Y * -0.5]) {
        let (out, still) =
            (at.normalize(), NonlinearRigidMotion::constant_position(Pose::IDENTITY));
        for room in [0.0, 1e-15, 1.5e-13, 1e-12, 1e-10, 1e-7, 1e-3, 0.1] {
            let centre = at + out * room;
            let ball = ModifiedCylinder::capsule(centre, centre, 0.25).unwrap();
            let comes = NonlinearRigidMotion { linvel: -out, ..still };
            for stop in [true, false] {
                let hits = [
                    dispatcher
                        .cast_shapes_nonlinear(&comes, &ball, &still, &**wall, 0.0, 1.0, stop),
                    dispatcher
                        .cast_shapes_nonlinear(&still, &**wall, &comes, &ball, 0.0, 1.0, stop),
                ];
                for hit in hits {
                    let time = hit.unwrap().map(|hit| hit.time_of_impact);
                    if stop {
                        assert_eq!(time, Some(0.0), "{out} {room}");
                    } else if room >= 1e-3 {
                        let off = time.map_or(1.0, |time| (time - 0.5 * room).abs());
                        assert!(off < 1e-4, "{out} {room} {time:?}");
                    }
                }
            }
        }
    }
}

/// The first hit of two chains is the first of all pairs of their links, at any speeds.
#[test]
fn chains_meet_where_the_first_of_their_links_do() {
    let (mut random, dispatcher) = (Random::new(123), ContinuumDispatcher::default());
    let (mut hits, mut misses) = (0, 0);
    for round in 0..60 {
        let winding = |random: &mut Random| {
            let bend = random.vector(0.3);
            let point = |k: u32| {
                let t = Real::from(k) / 8.0;
                Vector::new(2.0 * t, (3.0 * t).sin() * bend.x, t * t * bend.y)
            };
            let points: Vec<_> = (0..=16).map(point).collect();
            Chain::from_centreline(&points, &[0.03; 16]).unwrap()
        };
        let chains = [winding(&mut random), winding(&mut random)];
        let first = random.pose(1.0);
        let second = Pose::from_parts(random.vector(2.5), random.pose(1.0).rotation);
        // Slow, fast and spinning, or both alike.
        let speed = [0.05, 1.0, 8.0][round % 3];
        let common = random.vector(20.0);
        let ways = [common, common + random.vector(speed)];
        let motions = [motion(&mut random, first, ways[0]), motion(&mut random, second, ways[1])];
        let [m1, m2] = &motions;
        let pairs =
            chains[0].links().iter().flat_map(|a| chains[1].links().iter().map(move |b| (a, b)));
        let each = pairs.filter_map(|(a, b)| {
            let hit = dispatcher.cast_shapes_nonlinear(m1, a, m2, b, 0.0, 1.0, true).unwrap();
            hit.map(|hit| hit.time_of_impact)
        });
        let expected = each.fold(Real::INFINITY, Real::min);
        let hit = dispatcher
            .cast_shapes_nonlinear(m1, &chains[0], m2, &chains[1], 0.0, 1.0, true)
            .unwrap();
        let time = hit.map_or(Real::INFINITY, |hit| hit.time_of_impact);
        if expected.is_finite() {
            hits += 1
        } else {
            misses += 1
        }
        assert!(time == expected || (time - expected).abs() < 1e-9, "{round}: {time} {expected}");
    }
    assert!(hits > 8 && misses > 15, "{hits} hits, {misses} misses");
}

/// How far the link reaches below the origin, by its definition.
fn distance_below(link: &ModifiedCylinder, pose: &Pose) -> Real {
    let axis = pose.rotation * Vector::X;
    let lean = axis.cross(Vector::Y).length();
    let ends = [link.start(), link.end()].into_iter().zip(link.caps());
    let below = ends.map(|(end, cap)| {
        let reach = if cap == Cap::Flat { link.radius() * lean } else { link.radius() };
        reach - (pose * end).y
    });
    below.fold(Real::NEG_INFINITY, Real::max)
}
