//! A half-space is answered exactly in every query and both orders. The reference is the lowest of
//! many points of the surface, and of the points that the links' own definition makes lowest.

use crate::draw::{Draw, surface_point};
use crate::scene::tube;
use continuum_testing::Random;
use parry_continuum::parry::math::{Pose, Real, Vector};
use parry_continuum::parry::query::{
    ClosestPoints, ContactManifold, PersistentQueryDispatcher, QueryDispatcher, ShapeCastOptions,
};
use parry_continuum::parry::shape::{HalfSpace, Shape};
use parry_continuum::{Cap, ContinuumDispatcher, ModifiedCylinder};

const ROUNDING: Real = 1e-13;

/// Height of the lowest point: a round cap that points down reaches a radius below its centre, any
/// other cap reaches its rim.
fn lowest(link: &ModifiedCylinder, pose: &Pose, normal: Vector) -> Real {
    let axis = (link.end() - link.start()).normalize_or_zero();
    let axis = pose.rotation * axis;
    let lean = axis.cross(normal).length();
    let ends = [(link.start(), -axis), (link.end(), axis)].into_iter().zip(link.caps());
    let heights = ends.map(|((end, outward), cap)| {
        let is_down = outward.dot(normal) <= 0.0;
        let reach = if cap == Cap::Round && is_down { link.radius() } else { link.radius() * lean };
        (pose * end).dot(normal) - reach
    });
    heights.fold(Real::INFINITY, Real::min)
}

#[test]
fn every_query_tells_the_height_of_the_lowest_point() {
    let (mut random, dispatcher) = (Random::new(111), ContinuumDispatcher::default());
    let (mut apart, mut across, mut touched_by_samples) = (0, 0, 0);
    for _ in 0..2000 {
        let chain = tube(&mut random);
        let link = random.link();
        let (robot, links): (&dyn Shape, Vec<_>) =
            if random.chance(0.5) { (&chain, chain.links().to_vec()) } else { (&link, vec![link]) };
        let normal = random.direction();
        let half_space = HalfSpace::new(normal);
        let pose = random.pose(1.5);
        let heights: Vec<_> = links.iter().map(|link| lowest(link, &pose, normal)).collect();
        let height = heights.iter().copied().fold(Real::INFINITY, Real::min);
        // No point of the surface is lower, and some are hardly higher.
        let sampled = (0..200).map(|_| {
            let link = &links[random.index(links.len())];
            (pose * surface_point(&mut random, link)).dot(normal)
        });
        let sampled = sampled.fold(Real::INFINITY, Real::min);
        assert!(sampled >= height - ROUNDING);
        touched_by_samples += usize::from(sampled < height + 0.1);
        if height > 0.0 {
            apart += 1
        } else {
            across += 1
        }

        for robot_is_first in [true, false] {
            let (pos12, g1, g2): (_, &dyn Shape, &dyn Shape) = if robot_is_first {
                (pose.inverse(), robot, &half_space)
            } else {
                (pose, &half_space, robot)
            };
            let of_robot =
                |one: u32, other: u32| heights[(if robot_is_first { one } else { other }) as usize];

            let answer = dispatcher.distance(&pos12, g1, g2).unwrap();
            assert!((answer.distance - height.max(0.0)).abs() < ROUNDING);
            assert!(of_robot(answer.subshape1, answer.subshape2) < height + ROUNDING);
            let meets = dispatcher.intersection_test(&pos12, g1, g2).unwrap();
            assert_eq!(meets.intersecting, answer.distance == 0.0);

            match dispatcher.closest_points(&pos12, g1, g2, 9.0).unwrap() {
                ClosestPoints::WithinMargin(p1, p2) => {
                    assert!(((pos12 * p2 - p1).length() - height).abs() < ROUNDING);
                    assert!(g1.distance_to_local_point(p1, true) < ROUNDING);
                    assert!(g2.distance_to_local_point(p2, true) < ROUNDING);
                }
                ClosestPoints::Intersecting => assert!(height <= 0.0),
                ClosestPoints::Disjoint => panic!("everything is near"),
            }
            for margin in [-1.0, 0.0, 0.5 * height] {
                let points = dispatcher.closest_points(&pos12, g1, g2, margin).unwrap();
                assert_eq!(points == ClosestPoints::Intersecting, height <= 0.0);
                assert!(!matches!(points, ClosestPoints::WithinMargin(..)));
            }

            let contact = dispatcher.contact(&pos12, g1, g2, 9.0).unwrap().unwrap();
            assert!((contact.dist - height).abs() < ROUNDING, "{contact:?} for {height}");
            let between = pos12 * contact.point2 - contact.point1;
            assert!((between - contact.normal1 * contact.dist).length() < ROUNDING);
            assert!((contact.normal1 + pos12.rotation * contact.normal2).length() < ROUNDING);
            let out = if robot_is_first { contact.normal2 } else { contact.normal1 };
            assert!((out - normal).length() < ROUNDING);
            assert!(dispatcher.contact(&pos12, g1, g2, height - 1e-9).unwrap().is_none());

            let (mut found, mut workspace): (Vec<ContactManifold<(), ()>>, _) = (vec![], None);
            let prediction = height.max(0.0) + 1e-9;
            dispatcher
                .contact_manifolds(&pos12, g1, g2, prediction, &mut found, &mut workspace)
                .unwrap();
            let points = found
                .iter()
                .flat_map(|manifold| manifold.points.iter().map(move |p| (manifold, p)));
            let mut deepest = Real::INFINITY;
            for (manifold, point) in points {
                deepest = deepest.min(point.dist);
                let between = pos12 * point.local_p2 - point.local_p1;
                assert!((between - manifold.local_n1 * point.dist).length() < ROUNDING);
            }
            assert!((deepest - height).abs() < 1e-9, "{deepest} for {height}");
        }
    }
    assert!(apart > 500 && across > 500, "{apart} apart, {across} across");
    assert!(touched_by_samples > 1200, "{touched_by_samples}");
}

#[test]
fn casts_end_at_the_target_distance() {
    let (mut random, dispatcher) = (Random::new(112), ContinuumDispatcher::default());
    let (mut hits, mut misses, mut starts) = (0, 0, 0);
    for _ in 0..2000 {
        let link = random.link();
        let normal = random.direction();
        let half_space = HalfSpace::new(normal);
        let pose = random.pose(2.5);
        let height = lowest(&link, &pose, normal);
        let velocity = random.vector(2.0);
        let options = ShapeCastOptions {
            max_time_of_impact: random.between(0.5, 3.0),
            target_distance: if random.chance(0.5) { random.between(0.0, 0.5) } else { 0.0 },
            stop_at_penetration: random.chance(0.5),
            ..Default::default()
        };
        let down = -velocity.dot(normal);
        let time = (height - options.target_distance) / down;
        let pos21 = pose.inverse();
        let of_link_first = -(pos21.rotation * velocity);
        for (pos12, vel12, g1, g2) in [
            (pose, velocity, &half_space as &dyn Shape, &link as &dyn Shape),
            (pos21, of_link_first, &link, &half_space),
        ] {
            let hit = dispatcher.cast_shapes(&pos12, vel12, g1, g2, options).unwrap();
            if height <= options.target_distance {
                starts += 1;
                assert_eq!(hit.is_some(), options.stop_at_penetration || down > 0.0);
                assert!(hit.is_none_or(|hit| hit.time_of_impact == 0.0));
            } else if down > 0.0 && time <= options.max_time_of_impact {
                hits += 1;
                let hit = hit.unwrap();
                assert!(
                    (hit.time_of_impact - time).abs() < ROUNDING * (1.0 + 10.0 / down),
                    "{hit:?} for {time}"
                );
                // Both witnesses at the time of impact.
                let moved = Pose::from_parts(
                    pos12.translation + vel12 * hit.time_of_impact,
                    pos12.rotation,
                );
                let between = moved * hit.witness2 - hit.witness1;
                let slack = ROUNDING * (1.0 + 10.0 / down);
                assert!(
                    (between - hit.normal1 * options.target_distance).length() < slack,
                    "{hit:?} {between}"
                );
            } else {
                misses += 1;
                assert!(hit.is_none(), "{hit:?}");
            }
        }
    }
    assert!(
        hits > 300 && misses > 300 && starts > 300,
        "{hits} hits, {misses} misses, {starts} starts"
    );
}

#[test]
fn a_half_space_without_direction_is_refused() {
    let dispatcher = ContinuumDispatcher::default();
    let link = ModifiedCylinder::capsule(Vector::ZERO, Vector::X, 0.2).unwrap();
    for normal in [Vector::ZERO, Vector::NAN, Vector::new(Real::INFINITY, 0.0, 0.0)] {
        let half_space = HalfSpace { normal };
        for (g1, g2) in [(&link as &dyn Shape, &half_space as &dyn Shape), (&half_space, &link)] {
            assert!(
                crate::inner::ask_everything(&dispatcher, &Pose::IDENTITY, g1, g2)
                    .iter()
                    .all(|&answered| !answered)
            );
        }
    }
}
