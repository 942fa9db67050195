//! Straight casts that begin where the two touch, to rounding: what comes nearer is met at once,
//! what parts may go.

use crate::draw::Draw;
use continuum_testing::Random;
use parry_continuum::parry::math::{Pose, Real, Rotation, Vector};
use parry_continuum::parry::query::{PointQuery, QueryDispatcher, ShapeCastHit, ShapeCastOptions};
use parry_continuum::parry::shape::{Ball, Cuboid, Cylinder, Shape, TriMesh, Triangle};
use parry_continuum::{Cap, ContinuumDispatcher, ModifiedCylinder};

/// The hit of a link at rest and a wall that moves, in both orders.
fn casts(
    link: &ModifiedCylinder,
    wall: &dyn Shape,
    place: Vector,
    velocity: Vector,
    stop_at_penetration: bool,
) -> [Option<ShapeCastHit>; 2] {
    let options = ShapeCastOptions { stop_at_penetration, ..Default::default() };
    let pose = Pose::from_translation(place);
    let cast = |pose: &Pose, velocity, g1: &dyn Shape, g2: &dyn Shape| {
        ContinuumDispatcher::default().cast_shapes(pose, velocity, g1, g2, options).unwrap()
    };
    [
        cast(&pose, velocity, link, wall),
        cast(&pose.inverse(), -velocity, wall, link).map(ShapeCastHit::swapped),
    ]
}

#[test]
fn a_ball_that_touches_a_link_is_met_or_let_go() {
    let (mut apart, mut overlapping) = (0, 0);
    for (y, z) in [(0.0, 1.0), (0.6, 0.8), (-0.8, 0.6), (0.28, 0.96), (0.8, -0.6)] {
        let out = Vector::new(0.0, y, z);
        for r in (1..=20).map(|k| 0.05 * Real::from(k)) {
            let link = ModifiedCylinder::capsule(-Vector::X, Vector::X, r).unwrap();
            for radius in (1..=36).map(|k| 0.05 * Real::from(k)) {
                let (ball, place) = (Ball::new(radius), out * (r + radius));
                let distance = place.length() - radius - r;
                apart += usize::from(distance > 0.0);
                overlapping += usize::from(distance < 0.0);
                let cast = |velocity, stop| casts(&link, &ball, place, velocity, stop);
                for hit in [true, false].into_iter().flat_map(|stop| cast(-out, stop)) {
                    let hit = hit.unwrap_or_else(|| panic!("no hit: {r} {radius} {out}"));
                    assert!(hit.time_of_impact <= 1e-12, "{r} {radius} {out}: {hit:?}");
                    assert!((hit.normal1 - out).length() < 1e-6, "{r} {radius} {out}: {hit:?}");
                }
                for hit in cast(out, false) {
                    assert!(hit.is_none(), "{r} {radius} {out}");
                }
            }
        }
    }
    assert!(apart > 300 && overlapping > 300, "{apart} {overlapping}");
}

/// With a box GJK tells the contacts. What is apart by more than its tolerance may go.
#[test]
fn a_box_that_touches_a_link_is_met_and_one_beside_it_let_go() {
    let wall = Cuboid::new(Vector::new(1.5, 1.25, 0.75));
    for r in (1..=20).map(|k| 0.05 * Real::from(k)) {
        for caps in [[Cap::Round; 2], [Cap::Flat; 2], [Cap::Flat, Cap::Round]] {
            let link = ModifiedCylinder::new(-Vector::X, Vector::X, r, caps).unwrap();
            for place in
                [Vector::Z * (r + 0.75), Vector::new(0.3, 0.1, -r - 0.75), Vector::Y * (r + 1.25)]
            {
                let into = -place.normalize();
                for stop in [true, false] {
                    for hit in casts(&link, &wall, place, into, stop) {
                        let hit = hit.unwrap_or_else(|| panic!("no hit: {link:?} {place} {stop}"));
                        assert!(hit.time_of_impact <= 1e-5, "{link:?} {place}: {hit:?}");
                    }
                    for beside in [1e-7, 1e-5, 1e-3].map(|gap| place - into * gap) {
                        for hit in casts(&link, &wall, beside, -into, stop) {
                            assert!(hit.is_none(), "{link:?} {beside}: {hit:?}");
                        }
                    }
                }
            }
        }
    }
}

/// The only plane between a rim and an edge that passes it aslant belongs to neither shape.
#[test]
fn an_edge_that_touches_a_rim_aslant_is_met_or_let_go() {
    let mut random = Random::new(171);
    let (mut apart, mut met, mut gone) = (0, 0, 0);
    for _ in 0..4000 {
        let (radius, length) = (random.between(0.3, 2.0), random.between(0.5, 3.0));
        let (frame, place) = (random.pose(1.0), random.vector(3.0));
        let turned = |v: Vector| frame.rotation * v;
        let link =
            ModifiedCylinder::cylinder(place, place + turned(Vector::Z) * length, radius).unwrap();
        let (sin, cos) = random.between(0.0, std::f64::consts::TAU).sin_cos();
        let tangent = turned(Vector::new(-sin, cos, 0.0));
        let tilt = random.between(0.1, 1.4);
        let normal =
            turned(Vector::new(cos, sin, 0.0)) * tilt.cos() + turned(Vector::Z) * tilt.sin();
        // Along an edge that is perpendicular to the normal, and not to the rim's tangent.
        let edge = (tangent + tangent.cross(normal) * random.between(-3.0, 3.0)).normalize();
        let on_rim = place + turned(Vector::new(cos * radius, sin * radius, length));
        let beyond = on_rim
            + normal * random.between(0.5, 2.0)
            + edge.cross(normal) * random.between(-1.0, 1.0);
        let ends =
            [on_rim - edge * random.between(0.5, 2.0), on_rim + edge * random.between(0.5, 2.0)];
        let triangle = Triangle::new(ends[0], ends[1], beyond);
        let distance = ContinuumDispatcher::default()
            .distance(&Pose::IDENTITY, &link, &triangle)
            .unwrap()
            .distance;
        apart += usize::from(distance > 0.0);
        let across = random.direction();
        let velocity = if across.dot(normal) > 0.0 { -across } else { across };
        if velocity.dot(normal) > -0.05 {
            continue;
        }
        for hit in [true, false]
            .into_iter()
            .flat_map(|stop| casts(&link, &triangle, Vector::ZERO, velocity, stop))
        {
            let hit = hit.unwrap_or_else(|| {
                panic!("no hit, {distance:e}: {link:?} {triangle:?} {velocity}")
            });
            assert!(hit.time_of_impact <= 1e-12, "{hit:?}");
            met += 1;
        }
        for hit in casts(&link, &triangle, Vector::ZERO, -velocity, false) {
            assert!(hit.is_none(), "{distance:e}: {link:?} {triangle:?}");
            gone += 1;
        }
    }
    // Rounding alone would part more than one in ten.
    assert_eq!(apart, 0);
    assert!(met > 3000 && gone > 1500, "{met} {gone}");
}

/// A hit at the very end of the time counts, whether the wall is a triangle or a mesh.
#[test]
fn the_last_moment_belongs_to_a_cast() {
    let link = ModifiedCylinder::capsule(Vector::ZERO, Vector::ZERO, 0.5).unwrap();
    let corners = [[-9.0, -9.0], [9.0, -9.0], [0.0, 9.0]].map(|[y, z]| Vector::new(2.0, y, z));
    let triangle = Triangle::from(corners);
    let mesh = TriMesh::new(corners.to_vec(), vec![[0, 1, 2]]).unwrap();
    let walls: [&dyn Shape; 2] = [&triangle, &mesh];
    for wall in walls {
        for (place, velocity, latest) in [
            (Vector::ZERO, Vector::X * -1.5, 1.0),
            (Vector::ZERO, Vector::X * -3.0, 0.5),
            (Vector::X * -1.75, Vector::X, 0.0),
            (Vector::X * -1.75, Vector::X, Real::MAX),
        ] {
            let cast = |latest| {
                let options = ShapeCastOptions::with_max_time_of_impact(latest);
                let place = Pose::from_translation(place);
                let hit = ContinuumDispatcher::default()
                    .cast_shapes(&place, velocity, &link, wall, options);
                hit.unwrap().map(|hit| hit.time_of_impact)
            };
            let expected = if latest == Real::MAX { 0.0 } else { latest };
            assert_eq!(cast(latest), Some(expected), "{velocity}");
            if expected > 0.0 {
                assert_eq!(cast(latest.next_down()), None, "{velocity}");
            }
        }
    }
}

/// What would be met beyond the range of numbers is never met.
#[test]
fn a_wall_that_hardly_comes_nearer_is_never_met() {
    let link = ModifiedCylinder::capsule(Vector::ZERO, Vector::ZERO, 0.5).unwrap();
    let corners = [[-9.0, -9.0], [9.0, -9.0], [0.0, 9.0]].map(|[y, z]| Vector::new(2.0, y, z));
    for slow in [1e-152, 1e-160, 1e-300, 1e-320] {
        for hit in
            casts(&link, &Triangle::from(corners), Vector::ZERO, Vector::new(-slow, 1.0, 0.0), true)
        {
            assert!(hit.is_none(), "{slow}");
        }
    }
}

/// parry's GJK returns a distance of 0.452 for this pair.
#[test]
fn a_cylinder_that_touches_a_link_is_at_no_distance() {
    let link = ModifiedCylinder::cylinder(
        Vector::new(-0.362683682027401, -0.47298806277025496, 0.04843458040430093),
        Vector::new(-0.31261149484969064, -1.4712674581462153, 0.07894728003982576),
        0.39311729705502696,
    );
    let (link, cylinder) = (link.unwrap(), Cylinder::new(0.625, 0.2595046944848895));
    let [x, y, z] = [-0.000870899718993708, -0.4945719644633502, 0.02931797819938096];
    let pose = Pose::from_parts(
        Vector::new(-0.7285175182121935, -0.6327893541345702, -0.4827618196418877),
        Rotation::from_xyzw(x, y, z, 0.8686416232571652),
    );
    // From one to the other and back they come nearer, and are never nearer than the two are.
    let (mut on_link, mut on_cylinder) = (link.start(), Vector::ZERO);
    for _ in 0..1000 {
        on_cylinder = cylinder.project_point(&pose, on_link, true).point;
        on_link = link.project_local_point(on_cylinder, true).point;
    }
    let no_more = (on_link - on_cylinder).length();
    assert!(no_more < 1e-3, "{no_more}");
    let dispatcher = ContinuumDispatcher::default();
    let shapes: [&dyn Shape; 2] = [&link, &cylinder];
    for ([g1, g2], pose) in [(shapes, pose), ([shapes[1], shapes[0]], pose.inverse())] {
        let distance = dispatcher.distance(&pose, g1, g2).unwrap().distance;
        assert!(distance <= no_more + 1e-5, "{distance} {no_more}");
        let contact = dispatcher.contact(&pose, g1, g2, Real::MAX).unwrap().unwrap();
        assert!(contact.dist <= no_more + 1e-5 && contact.dist > -1e-3, "{contact:?}");
    }
}

/// parry's GJK says of the box and the link that they are 2.2e-16 apart.
#[test]
fn a_ball_whose_centre_is_on_a_face_overlaps_by_its_radius() {
    let half_extents = Vector::new(0.4444861098339822, 0.43188743191262113, 0.8714537360499094);
    let (centre, radius) = (Vector::new(half_extents.x, 0.5568854890372149, half_extents.z), 0.125);
    let link = ModifiedCylinder::capsule(centre, centre, radius).unwrap();
    let cuboid = Cuboid::new(half_extents);
    let turned = Rotation::from_xyzw(0.0, 0.0, 0.479425538604203, 0.8775825618903728);
    let pose = Pose::from_parts(turned * (Vector::X * (2.0 * half_extents.x)), turned);
    // Farther than the radius from all other faces.
    let seen = pose.inverse_transform_point(centre).abs();
    let inside = half_extents - seen;
    assert!(inside.z.abs() < 1e-15 && inside.truncate().min_element() > radius, "{seen}");
    let shapes: [&dyn Shape; 2] = [&link, &cuboid];
    for ([g1, g2], pose) in [(shapes, pose), ([shapes[1], shapes[0]], pose.inverse())] {
        let contact =
            ContinuumDispatcher::default().contact(&pose, g1, g2, Real::MAX).unwrap().unwrap();
        assert!((contact.dist + radius).abs() < 1e-12, "{contact:?}");
    }
}
