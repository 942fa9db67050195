//! How well each pair of convex shapes is answered: the table in the dispatcher's documentation.
//!
//! The reference is alternating projection: from a point of the one shape to the closest of the
//! other and back. Both projections are exact for the shapes here, and the lengths fall towards the
//! distance of the two. An overlap is recognised by a point that is in both.

use crate::draw::{Draw, scaled};
use continuum_testing::Random;
use parry_continuum::parry::math::{Pose, Real, Vector};
use parry_continuum::parry::query::{
    ClosestPoints, Contact, ContactManifold, PersistentQueryDispatcher, PointQuery,
    QueryDispatcher, ShapeCastHit, ShapeCastOptions,
};
use parry_continuum::parry::shape::{RoundShape, Shape, SharedShape, Triangle, TypedShape};
use parry_continuum::{Chain, ContinuumDispatcher, ModifiedCylinder};
use std::collections::BTreeMap;

const ROUNDING: Real = 1e-11;
/// At which distance a cast takes a link and a triangle for touching: 1e-9 of the link's size.
const EARLY: Real = 1e-8;
/// What parry's GJK leaves open for shapes of size 1.
const GJK: Real = 1e-5;
/// By how much a translation may fail to separate: the tolerance of GJK, which checks it. (For its
/// excess over the least, see [`depths`](super::depths).)
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
            SharedShape::new(
                ModifiedCylinder::new(points[0], points[1], 0.5 * c, random.caps()).unwrap(),
            ),
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
                    note(
                        1,
                        g1.distance_to_local_point(p1, true)
                            .max(g2.distance_to_local_point(p2, true)),
                    );
                    let contact = dispatcher.contact(&pos12, g1, g2, 99.0).unwrap().unwrap();
                    note(1, (contact.dist - expected).abs());
                    // Towards each other until they meet.
                    let (p1, p2) = (p1, pos12 * p2);
                    let options = ShapeCastOptions::with_max_time_of_impact(9.0);
                    let hit = dispatcher.cast_shapes(&pos12, p1 - p2, g1, g2, options).unwrap();
                    note(
                        2,
                        hit.map_or(Real::INFINITY, |hit| {
                            (hit.time_of_impact - 1.0).abs() * expected
                        }),
                    );
                } else if expected == 0.0 {
                    across += 1;
                    assert!(
                        dispatcher.intersection_test(&pos12, g1, g2).unwrap().intersecting,
                        "{name}"
                    );
                    // The translation separates the two, up to the tolerance of the iterations.
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

/// A contact within the pair's own distance is found, and is no farther away.
#[test]
fn a_pair_is_within_its_own_distance() {
    let (mut random, dispatcher) = (Random::new(132), ContinuumDispatcher::default());
    let mut asked = BTreeMap::<&str, usize>::new();
    for round in 0..400 {
        let unit = [1.0, 1e-6, 1e3][round % 3];
        let link = random.link();
        let chain =
            Chain::from_centreline(&[link.start(), link.end(), random.vector(1.5)], &[0.1; 2]);
        let chain =
            chain.unwrap_or_else(|_| Chain::capsules(&[Vector::ZERO, Vector::X], &[0.1]).unwrap());
        let corners = [0; 5].map(|_| random.vector(0.8)).to_vec();
        let mut others = walls(&mut random);
        others.push((
            "mesh",
            SharedShape::trimesh(corners, vec![[0, 1, 2], [1, 2, 3], [2, 3, 4]]).unwrap(),
        ));
        for (name, wall) in others {
            let pose = random.pose(1.8);
            let all = Vector::splat(unit);
            let pose = Pose::from_parts(pose.translation * unit, pose.rotation);
            let wall = if name == "half-space" {
                wall
            } else {
                SharedShape(wall.scale_dyn(all, 0).unwrap().into())
            };
            let robots = [link.scale_dyn(all, 0).unwrap(), chain.scale_dyn(all, 0).unwrap()];
            for robot in &robots {
                for (pos12, g1, g2) in
                    [(pose, &**robot, &*wall), (pose.inverse(), &*wall, &**robot)]
                {
                    let apart = dispatcher.distance(&pos12, g1, g2).unwrap().distance;
                    let contact = dispatcher.contact(&pos12, g1, g2, apart).unwrap();
                    let dist = contact.map(|contact| contact.dist);
                    let context =
                        || format!("{name} {unit} {:?} {:?} {pos12:?}", shown(g1), shown(g2));
                    assert!(
                        dist.is_some_and(|dist| dist <= apart),
                        "{dist:?} for {apart}: {}",
                        context()
                    );
                    *asked.entry(name).or_default() += usize::from(apart > 0.0);
                }
            }
        }
    }
    assert!(asked.len() == 11 && asked.values().all(|&n| n > 500), "{asked:?}");
}

fn shown(shape: &dyn Shape) -> String {
    let robot = (shape.as_shape::<ModifiedCylinder>(), shape.as_shape::<Chain>());
    format!("{robot:?} {:?}", shape.shape_type())
}

/// Shapes that parry iterates on, of size 1.
fn iterated(random: &mut Random) -> Vec<(&'static str, SharedShape)> {
    let mut size = || random.between(0.2, 0.8);
    let (a, b, c, thin) = (size(), size(), size(), 0.2 * size());
    let points: Vec<_> = (0..10).map(|_| random.direction() * a).collect();
    vec![
        ("cuboid", SharedShape::cuboid(a, b, c)),
        ("cone", SharedShape::cone(a, b)),
        ("round cuboid", SharedShape::round_cuboid(a, b, c, thin)),
        ("round cylinder", SharedShape::round_cylinder(a, b, thin)),
        ("round cone", SharedShape::round_cone(a, b, thin)),
        ("disc", SharedShape::cylinder(0.0, b)),
        ("convex polyhedron", SharedShape::convex_hull(&points).unwrap()),
        ("round convex polyhedron", SharedShape::round_convex_hull(&points, thin).unwrap()),
        ("round triangle", SharedShape::round_triangle(points[0], points[1], points[2], thin)),
    ]
}

/// The shape with every length multiplied by a power of two, borders too.
fn image(shape: &SharedShape, factor: Real) -> SharedShape {
    let scaled = SharedShape(shape.scale_dyn(Vector::splat(factor), 0).unwrap().into());
    match scaled.as_typed_shape() {
        TypedShape::RoundCuboid(it) => rounded(it, factor),
        TypedShape::RoundCylinder(it) => rounded(it, factor),
        TypedShape::RoundCone(it) => rounded(it, factor),
        TypedShape::RoundConvexPolyhedron(it) => rounded(it, factor),
        TypedShape::RoundTriangle(it) => rounded(it, factor),
        _ => scaled,
    }
}

fn rounded<S: Clone>(shape: &RoundShape<S>, factor: Real) -> SharedShape
where
    RoundShape<S>: Shape,
{
    let border_radius = shape.border_radius * factor;
    SharedShape::new(RoundShape { inner_shape: shape.inner_shape.clone(), border_radius })
}

/// What parry iterates on is answered in every unit as in the first, bit for bit: distance,
/// contact, manifold and casts.
#[test]
fn iterations_do_not_depend_on_the_unit_of_length() {
    let (mut random, dispatcher) = (Random::new(133), ContinuumDispatcher::default());
    let (mut apart, mut across, mut hits) = (0, 0, 0);
    for round in 0..60 {
        let link = random.link();
        for (name, wall) in iterated(&mut random) {
            let pose = random.pose(1.8);
            let way = random.direction() * 2.0 - pose.translation;
            let unit = Real::powi(2.0, [-20, -10, -60, 10, 60, -300, 300][round % 7]);
            let big = Pose::from_parts(pose.translation * unit, pose.rotation);
            let (big_link, big_wall) = (scaled(&link, unit), image(&wall, unit));
            let context = || format!("{name} {unit:e} {link:?} {pose:?}");
            let distance = dispatcher.distance(&pose, &link, &*wall).unwrap().distance;
            let found = dispatcher.distance(&big, &big_link, &*big_wall).unwrap().distance;
            assert_eq!(found, distance * unit, "{}", context());
            apart += usize::from(distance > 0.0);
            across += usize::from(distance == 0.0);
            let contact = dispatcher.contact(&pose, &link, &*wall, 0.5).unwrap();
            let found = dispatcher.contact(&big, &big_link, &*big_wall, 0.5 * unit).unwrap();
            let shown = |contact: Contact, unit: Real| {
                (contact.dist * unit, contact.point1 * unit, contact.normal1)
            };
            assert_eq!(
                found.map(|it| shown(it, 1.0)),
                contact.map(|it| shown(it, unit)),
                "{}",
                context()
            );
            let options = ShapeCastOptions::with_max_time_of_impact(9.0);
            let hit = dispatcher.cast_shapes(&pose, way, &link, &*wall, options).unwrap();
            let found =
                dispatcher.cast_shapes(&big, way * unit, &big_link, &*big_wall, options).unwrap();
            let time = |hit: Option<ShapeCastHit>| hit.map(|hit| (hit.time_of_impact, hit.normal1));
            assert_eq!(time(found), time(hit), "{}", context());
            hits += usize::from(hit.is_some());
            let least = |pose: &Pose, g1: &dyn Shape, g2: &dyn Shape, prediction: Real| {
                let (mut manifolds, mut workspace): (Vec<ContactManifold<(), ()>>, _) =
                    (vec![], None);
                dispatcher
                    .contact_manifolds(pose, g1, g2, prediction, &mut manifolds, &mut workspace)
                    .unwrap();
                let points = manifolds.into_iter().flat_map(|manifold| manifold.points);
                points.map(|point| (point.dist, point.local_p1)).collect::<Vec<_>>()
            };
            let points = least(&pose, &link, &*wall, 0.1);
            let points: Vec<_> =
                points.into_iter().map(|(dist, p)| (dist * unit, p * unit)).collect();
            assert_eq!(least(&big, &big_link, &*big_wall, 0.1 * unit), points, "{}", context());
        }
    }
    assert!(apart > 400 && across > 25 && hits > 80, "{apart} apart, {across} across, {hits} hits");
}

/// In metres and micrometres clearances are as exact as in the unit of the shapes, and no cast is
/// late or missed.
#[test]
fn clearances_in_small_units_are_no_larger_than_they_are() {
    let (mut random, dispatcher) = (Random::new(134), ContinuumDispatcher::default());
    let mut apart = 0;
    for round in 0..150 {
        let link = random.link();
        let unit = [1e-3, 1e-6, 1e-9, 1e6][round % 4];
        for (name, wall) in
            iterated(&mut random).into_iter().filter(|(name, _)| ["cuboid", "cone"].contains(name))
        {
            let pose = random.pose(1.8);
            let expected = projected(&link, &*wall, &pose);
            if expected <= 1e-3 {
                continue;
            }
            apart += 1;
            let big = Pose::from_parts(pose.translation * unit, pose.rotation);
            let (big_link, big_wall) = (scaled(&link, unit), image(&wall, unit));
            let distance =
                dispatcher.distance(&big, &big_link, &*big_wall).unwrap().distance / unit;
            assert!(
                (distance - expected).abs() < GJK,
                "{name} in {unit}: {distance} for {expected}"
            );
            let points =
                dispatcher.closest_points(&big, &big_link, &*big_wall, 99.0 * unit).unwrap();
            let ClosestPoints::WithinMargin(p1, p2) = points else {
                panic!("{name} in {unit}: {points:?}")
            };
            let options = ShapeCastOptions::with_max_time_of_impact(9.0);
            let way = p1 - big * p2;
            let hit = dispatcher.cast_shapes(&big, way, &big_link, &*big_wall, options).unwrap();
            let time = hit.map_or(Real::INFINITY, |hit| hit.time_of_impact);
            assert!(
                (time - 1.0).abs() * expected < GJK,
                "{name} in {unit}: a hit at {time}, {expected} apart"
            );
        }
    }
    assert!(apart > 150, "{apart}");
}
