//! How well each pair of convex shapes is answered: the table in the dispatcher's documentation.
//!
//! The reference is alternating projection: from a point of the one shape to the closest of the other and back. Both
//! projections are exact for the shapes here, and the lengths fall towards the distance of the two. An overlap is
//! recognised by a point that is in both.

use crate::draw::Draw;
use continuum_testing::Random;
use parry_continuum::parry::math::{Pose, Real};
use parry_continuum::parry::query::{ClosestPoints, PointQuery, QueryDispatcher, ShapeCastOptions};
use parry_continuum::parry::shape::{Shape, SharedShape, Triangle};
use parry_continuum::{ContinuumDispatcher, ModifiedCylinder};
use std::collections::BTreeMap;

const ROUNDING: Real = 1e-11;
/// At which distance a cast takes a link and a triangle for touching: 1e-9 of the link's size.
const EARLY: Real = 1e-8;
/// What parry's GJK leaves open for shapes of size 1.
const GJK: Real = 1e-5;
/// By what a translation may fall short of separating: what GJK, which is asked, leaves open. (How much longer than the least
/// it is: see [`depths`](super::depths).)
const SEPARATED: Real = 1e-5;

/// A convex shape of about size 1 and its name.
fn walls(random: &mut Random) -> Vec<(&'static str, SharedShape)> {
    let mut size = || random.between(0.2, 0.8);
    let (a, b, c) = (size(), size(), size());
    let points = [0; 3].map(|_| random.vector(0.8));
    vec![
        ("ball", SharedShape::ball(a)),
        ("cuboid", SharedShape::cuboid(a, b, c)),
        ("capsule", SharedShape::capsule_y(a, b)),
        ("cylinder", SharedShape::cylinder(a, b)),
        ("cone", SharedShape::cone(a, b)),
        ("box that is a line", SharedShape::cuboid(0.0, a, 0.0)),
        ("segment", SharedShape::segment(points[0], points[1])),
        ("triangle", SharedShape::new(Triangle::new(points[0], points[1], points[2]))),
        (
            "link",
            SharedShape::new(ModifiedCylinder::new(points[0], points[1], 0.5 * c, random.caps()).unwrap()),
        ),
        ("half-space", SharedShape::halfspace(random.direction())),
    ]
}

/// The distance from above.
pub fn projected(link: &ModifiedCylinder, wall: &dyn Shape, pose: &Pose) -> Real {
    let mut p = link.start();
    let mut distance = Real::INFINITY;
    for _ in 0..40000 {
        let q = wall.project_point(pose, p, true).point;
        let next = link.project_local_point(q, true).point;
        let now = (next - q).length();
        // Falls until rounding.
        if now >= distance {
            break;
        }
        (p, distance) = (next, now);
    }
    distance
}

#[test]
fn answers_are_off_by_no_more_than_the_table_says() {
    let (mut random, dispatcher) = (Random::new(131), ContinuumDispatcher::default());
    let mut worst = BTreeMap::<&str, [Real; 4]>::new();
    let (mut apart, mut across) = (0, 0);
    for _ in 0..600 {
        let link = random.link();
        for (name, wall) in walls(&mut random) {
            let pose = random.pose(1.8);
            let expected = projected(&link, &*wall, &pose);
            for (pos12, g1, g2) in
                [(pose, &link as &dyn Shape, &*wall), (pose.inverse(), &*wall, &link as &dyn Shape)]
            {
                let worst = worst.entry(name).or_default();
                let mut note = |query: usize, off: Real| worst[query] = worst[query].max(off);
                let distance = dispatcher.distance(&pos12, g1, g2).unwrap().distance;
                note(0, distance - expected);
                if expected > 1e-3 {
                    apart += 1;
                    note(0, expected - distance);
                    assert!(!dispatcher.intersection_test(&pos12, g1, g2).unwrap().intersecting);
                    let ClosestPoints::WithinMargin(p1, p2) =
                        dispatcher.closest_points(&pos12, g1, g2, 99.0).unwrap()
                    else {
                        panic!("{name} {expected}")
                    };
                    note(1, ((p1 - pos12 * p2).length() - expected).abs());
                    note(1, g1.distance_to_local_point(p1, true).max(g2.distance_to_local_point(p2, true)));
                    let contact = dispatcher.contact(&pos12, g1, g2, 99.0).unwrap().unwrap();
                    note(1, (contact.dist - expected).abs());
                    // Towards each other until they meet.
                    let (p1, p2) = (p1, pos12 * p2);
                    let options = ShapeCastOptions::with_max_time_of_impact(9.0);
                    let hit = dispatcher.cast_shapes(&pos12, p1 - p2, g1, g2, options).unwrap();
                    note(2, hit.map_or(Real::INFINITY, |hit| (hit.time_of_impact - 1.0).abs() * expected));
                } else if expected == 0.0 {
                    across += 1;
                    assert!(dispatcher.intersection_test(&pos12, g1, g2).unwrap().intersecting, "{name}");
                    // What it says separates the two, but for what the iterations leave.
                    let contact = dispatcher.contact(&pos12, g1, g2, 0.0).unwrap().unwrap();
                    let separates = |more: Real| {
                        let way = -contact.normal1 * (contact.dist - more);
                        let moved = Pose::from_translation(way) * pos12;
                        !dispatcher.intersection_test(&moved, g1, g2).unwrap().intersecting
                    };
                    let short = (-40..0).map(|k| Real::powi(2.0, k)).find(|&more| separates(more));
                    note(3, short.unwrap_or(Real::INFINITY));
                }
            }
        }
    }
    for (name, [distance, points, cast, separation]) in worst {
        let is_iterated = ["cuboid", "cone"].contains(&name);
        let off = if is_iterated { GJK } else { ROUNDING };
        println!("{name}: {distance} {points} {cast} {separation}");
        assert!(distance <= off && points <= off, "{name}: {distance} {points}");
        let early = if is_iterated { GJK } else { EARLY };
        assert!(cast <= early, "{name}: {cast}");
        let short = if is_iterated { SEPARATED } else { ROUNDING };
        assert!(separation <= short, "{name}: {separation}");
    }
    assert!(apart > 5000 && across > 500, "{apart} apart, {across} across");
}
