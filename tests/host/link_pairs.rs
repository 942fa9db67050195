//! Links against links, and against the shapes of parry's that are links: every query takes a ball,
//! a capsule or a cylinder for the link that it is, in either order and in every unit of length.

use crate::draw::{CAPS, Draw, U, scaled};
use continuum_testing::Random;
use continuum_testing::placements::Wall;
use parry_continuum::parry::math::{Pose, Real, Vector};
use parry_continuum::parry::query::*;
use parry_continuum::parry::shape::{Ball, Capsule, Shape};
use parry_continuum::{ContinuumDispatcher, ModifiedCylinder};

/// All that is said of a pair, in words: numbers are written so that they are read back as they
/// were.
fn said(pos12: &Pose, g1: &dyn Shape, g2: &dyn Shape, unit: Real) -> Vec<String> {
    let dispatcher = ContinuumDispatcher::default();
    let mut manifold = ContactManifold::<(), ()>::new();
    dispatcher
        .contact_manifold_convex_convex(pos12, g1, g2, None, None, 0.3 * unit, &mut manifold)
        .unwrap();
    let points = manifold.points.iter();
    let points: Vec<_> = points
        .map(|point| {
            let places = [point.local_p1 / unit, point.local_p2 / unit];
            (places, point.dist / unit, point.fid1, point.fid2)
        })
        .collect();
    let way = Vector::new(0.3, -0.7, 0.2) * unit;
    let hit = dispatcher.cast_shapes(pos12, way, g1, g2, ShapeCastOptions::default()).unwrap();
    let closest = match dispatcher.closest_points(pos12, g1, g2, Real::MAX).unwrap() {
        ClosestPoints::WithinMargin(point1, point2) => Some([point1 / unit, point2 / unit]),
        _ => None,
    };
    let contact = dispatcher.contact(pos12, g1, g2, Real::MAX).unwrap().unwrap();
    let comes = NonlinearRigidMotion {
        linvel: way,
        angvel: Vector::new(0.5, 0.1, -0.3),
        ..NonlinearRigidMotion::constant_position(*pos12)
    };
    let rests = NonlinearRigidMotion::constant_position(Pose::IDENTITY);
    let turning = dispatcher.cast_shapes_nonlinear(&rests, g1, &comes, g2, 0.0, 1.0, true).unwrap();
    let of_hit = |hit: ShapeCastHit| {
        (hit.time_of_impact, hit.witness1 / unit, hit.witness2 / unit, hit.normal1, hit.normal2)
    };
    vec![
        format!("{:?}", dispatcher.distance(pos12, g1, g2).unwrap().distance / unit),
        format!("{:?}", dispatcher.intersection_test(pos12, g1, g2).unwrap().intersecting),
        format!("{closest:?}"),
        format!(
            "{:?} {:?} {:?}",
            (contact.point1 / unit, contact.point2 / unit),
            (contact.normal1, contact.normal2),
            contact.dist / unit
        ),
        format!("{points:?} {:?} {:?}", manifold.local_n1, manifold.local_n2),
        format!("{:?}", hit.map(of_hit)),
        format!("{:?}", turning.map(of_hit)),
    ]
}

/// The allowed difference between two computations of a number of size 1: 64 units in the last
/// place of the largest coordinate.
const ROUNDING: Real = 64.0 * U * 4.0;

const KINDS: [Wall; 4] = [Wall::Ball, Wall::Capsule, Wall::Cylinder, Wall::Link];

/// The link that a shape of parry's is, written down anew.
fn as_link(shape: &dyn Shape) -> ModifiedCylinder {
    if let Some(ball) = shape.as_ball() {
        return ModifiedCylinder::capsule(Vector::ZERO, Vector::ZERO, ball.radius).unwrap();
    }
    if let Some(capsule) = shape.as_capsule() {
        return ModifiedCylinder::capsule(capsule.segment.a, capsule.segment.b, capsule.radius)
            .unwrap();
    }
    if let Some(cylinder) = shape.as_cylinder() {
        let half = Vector::Y * cylinder.half_height;
        return ModifiedCylinder::cylinder(-half, half, cylinder.radius).unwrap();
    }
    *shape.as_shape().unwrap()
}

#[test]
fn a_ball_a_capsule_and_a_cylinder_are_links() {
    let mut random = Random::new(451);
    let mut overlapping = 0;
    for kind in KINDS {
        for _ in 0..300 {
            let (link, wall, pose) = random.aligned(kind);
            let other = as_link(&*wall);
            for (pos12, is_first) in [(pose, true), (pose.inverse(), false)] {
                let said = |wall: &dyn Shape| {
                    if is_first {
                        said(&pos12, &link, wall, 1.0)
                    } else {
                        said(&pos12, wall, &link, 1.0)
                    }
                };
                // While they turn the link of this crate is the one that is measured from, in both
                // orders.
                let count = if is_first { 7 } else { 6 };
                let taken = said(&other);
                assert_eq!(said(&*wall)[..count], taken[..count], "{link:?} {other:?} {pos12:?}");
                overlapping += usize::from(taken[1] == "true");
            }
        }
    }
    assert!(overlapping > 300, "{overlapping}");
}

/// Hosts identify a point by its feature ids, and warm-start its force.
#[test]
fn no_two_points_of_a_manifold_have_the_same_names() {
    let dispatcher = ContinuumDispatcher::default();
    let names = |pos12: &Pose, g1: &ModifiedCylinder, g2: &ModifiedCylinder| {
        let mut manifold = ContactManifold::<(), ()>::new();
        dispatcher
            .contact_manifold_convex_convex(pos12, g1, g2, None, None, 0.3, &mut manifold)
            .unwrap();
        let names: Vec<_> = manifold.points.iter().map(|point| (point.fid1, point.fid2)).collect();
        let are_all_new = names.iter().enumerate().all(|(k, name)| !names[..k].contains(name));
        assert!(are_all_new, "{names:?}: {g1:?} {g2:?} {pos12:?}");
        names.len()
    };
    // A rod that lies on a cap; both its ends are over the cap.
    let table = ModifiedCylinder::cylinder(Vector::ZERO, Vector::Z, 1.0).unwrap();
    let rod = ModifiedCylinder::capsule(Vector::X * -0.5, Vector::X * 0.5, 0.1).unwrap();
    let above = Pose::translation(0.0, 0.0, 1.1);
    assert_eq!([names(&above, &table, &rod), names(&above.inverse(), &rod, &table)], [2, 2]);
    let mut random = Random::new(456);
    let mut several = 0;
    for _ in 0..2000 {
        let (link, wall, pose) = random.aligned(Wall::Link);
        several += usize::from(names(&pose, &link, &as_link(&*wall)) > 1);
    }
    assert!(several > 200, "{several}");
}

/// A large ball on the way of a small link, which comes at it more and more aslant: it stops by the
/// small one's measure, whichever of them is named first.
#[test]
fn a_cast_stops_by_the_measure_of_the_smaller_link() {
    let large = Ball::new(1000.0);
    let small = ModifiedCylinder::capsule(Vector::ZERO, Vector::ZERO, 1e-3).unwrap();
    let dispatcher = ContinuumDispatcher::default();
    let options = ShapeCastOptions::default();
    for aside in (0..50).map(|k| 20.0 * Real::from(k)) {
        let reach = large.radius + small.radius();
        let met = ((reach - aside) * (reach + aside)).sqrt();
        let place = Pose::translation(met + 0.5, aside, 0.0);
        let towards =
            dispatcher.cast_shapes(&place, -Vector::X, &large, &small, options).unwrap().unwrap();
        let back = dispatcher
            .cast_shapes(&place.inverse(), Vector::X, &small, &large, options)
            .unwrap()
            .unwrap();
        for hit in [towards, back] {
            let late = hit.time_of_impact - 0.5;
            assert!((-1e-9..=1e-10).contains(&late), "{aside}: {late:e}");
        }
    }
    // Nothing is met in a time that has passed, be it met already.
    let passed = ShapeCastOptions { max_time_of_impact: -1.0, ..options };
    let inside = Pose::translation(999.0, 0.0, 0.0);
    assert!(dispatcher.cast_shapes(&inside, -Vector::X, &large, &small, passed).unwrap().is_none());
    assert!(
        dispatcher.cast_shapes(&inside, -Vector::X, &large, &small, options).unwrap().is_some()
    );
}

/// Multiplied by a power of two, everything is as many times as large, bit for bit.
#[test]
fn the_unit_of_length_does_not_matter_to_links() {
    let mut random = Random::new(452);
    let mut flat = 0;
    for kind in KINDS {
        for _ in 0..200 {
            let (link, wall, pose) = random.aligned(kind);
            let other = as_link(&*wall);
            flat += usize::from(link.caps() == CAPS[0] && other.caps() == CAPS[0]);
            let plain = said(&pose, &link, &other, 1.0);
            for exponent in [-480, -300, -200, -51, -10, 1, 51, 300, 480] {
                let unit = Real::powi(2.0, exponent);
                let larger = Pose::from_parts(pose.translation * unit, pose.rotation);
                let said = said(&larger, &scaled(&link, unit), &scaled(&other, unit), unit);
                assert_eq!(said, plain, "times 2^{exponent}: {link:?} {other:?} {pose:?}");
            }
        }
    }
    assert!(flat > 50, "{flat}");
}

/// The swapped query is computed in the other frame, so the two differ by rounding alone.
#[test]
fn the_order_of_two_links_does_not_matter() {
    let mut random = Random::new(453);
    let dispatcher = ContinuumDispatcher::default();
    let (mut apart, mut overlapping) = (0, 0);
    let mut worst = [0.0_f64; 4];
    for kind in KINDS {
        for _ in 0..1000 {
            let (link, wall, pose) = random.aligned(kind);
            let (a, b) = (&link as &dyn Shape, &*wall);
            let back = pose.inverse();
            let [there, again] = [(&pose, a, b), (&back, b, a)].map(|(pos12, g1, g2)| {
                let distance = dispatcher.distance(pos12, g1, g2).unwrap().distance;
                (distance, dispatcher.contact(pos12, g1, g2, Real::MAX).unwrap().unwrap())
            });
            let off = [(there.0 - again.0).abs(), (there.1.dist - again.1.dist).abs()];
            if there.0 > 0.0 && again.0 > 0.0 {
                apart += 1;
                worst[0] = worst[0].max(off[0]);
                worst[1] = worst[1].max(off[1]);
            } else {
                overlapping += 1;
                worst[2] = worst[2].max(off[0]);
                worst[3] = worst[3].max(off[1]);
            }
        }
    }
    assert!(worst[..3].iter().all(|&worst| worst < ROUNDING), "{worst:?}");
    assert!(worst[3] < 1e-11, "{worst:?}");
    assert!(apart > 1000 && overlapping > 1000, "{apart} {overlapping}");
}

/// In metres as in millimetres, up to rounding: a thousand is not a power of two.
#[test]
fn metres_and_millimetres_say_the_same() {
    let mut random = Random::new(454);
    let dispatcher = ContinuumDispatcher::default();
    let (mut apart, mut overlapping, mut hits) = (0, 0, 0);
    for _ in 0..1000 {
        let (link, wall, pose) = random.aligned(Wall::Link);
        let other = as_link(&*wall);
        let way = random.vector(1.0);
        let of_unit = |unit: Real| {
            let (link, other) = (scaled(&link, unit), scaled(&other, unit));
            let pose = Pose::from_parts(pose.translation * unit, pose.rotation);
            let distance = dispatcher.distance(&pose, &link, &other).unwrap().distance / unit;
            let contact = dispatcher.contact(&pose, &link, &other, Real::MAX).unwrap().unwrap();
            let options = ShapeCastOptions::default();
            let hit = dispatcher.cast_shapes(&pose, way * unit, &link, &other, options).unwrap();
            (distance, contact.dist / unit, hit.map(|hit| hit.time_of_impact))
        };
        let [millimetres, metres] = [1.0, 1e-3].map(of_unit);
        let context = || format!("{link:?} {other:?} {pose:?} {way} {millimetres:?} {metres:?}");
        assert!((millimetres.0 - metres.0).abs() < ROUNDING, "{}", context());
        if millimetres.0.min(metres.0) > 0.0 {
            apart += 1;
            assert!((millimetres.1 - metres.1).abs() < ROUNDING, "{}", context());
        } else {
            overlapping += 1;
            assert!((millimetres.1 - metres.1).abs() < 1e-11, "{}", context());
        }
        // What grazes is hit or not.
        if let (Some(millimetres), Some(metres)) = (millimetres.2, metres.2) {
            hits += 1;
            assert!((millimetres - metres).abs() < 1e-6, "{}", context());
        }
    }
    assert!(apart > 250 && overlapping > 250 && hits > 250, "{apart} {overlapping} {hits}");
}

/// Two capsules that are well apart and not parallel: there parry's iterations are right to 1e-5.
#[test]
fn capsules_are_as_far_apart_as_parry_says() {
    let mut random = Random::new(455);
    let dispatcher = ContinuumDispatcher::default();
    let (mut compared, mut hits) = (0, 0);
    for _ in 0..3000 {
        let [first, second] = [0; 2].map(|_| {
            let (from, radius) = (random.vector(1.0), random.between(0.1, 0.4));
            Capsule::new(from, from + random.direction() * random.between(0.5, 2.0), radius)
        });
        let pose = random.pose(2.0);
        let link = ModifiedCylinder::try_from(&first).unwrap();
        let across = (first.segment.b - first.segment.a)
            .cross(pose.rotation * (second.segment.b - second.segment.a));
        let theirs = DefaultQueryDispatcher.distance(&pose, &first, &second).unwrap().distance;
        if theirs < 0.1 || across.length() < 0.1 {
            continue;
        }
        compared += 1;
        let ours = dispatcher.distance(&pose, &link, &second).unwrap().distance;
        assert!((ours - theirs).abs() < 1e-5, "{ours} {theirs} {first:?} {second:?} {pose:?}");
        let contact = dispatcher.contact(&pose, &link, &second, 9.0).unwrap().unwrap();
        let parrys = DefaultQueryDispatcher.contact(&pose, &first, &second, 9.0).unwrap().unwrap();
        assert!((contact.normal1 - parrys.normal1).length() < 0.02, "{contact:?} {parrys:?}");
        let (way, options) = (-pose.translation + random.vector(0.5), ShapeCastOptions::default());
        let ours = dispatcher.cast_shapes(&pose, way, &link, &second, options).unwrap();
        let theirs =
            DefaultQueryDispatcher.cast_shapes(&pose, way, &first, &second, options).unwrap();
        if let (Some(ours), Some(theirs)) = (ours, theirs)
            && ours.normal1.dot(way).abs() > 0.1
        {
            hits += 1;
            assert!(
                (ours.time_of_impact - theirs.time_of_impact).abs() < 1e-4,
                "{ours:?} {theirs:?}"
            );
        }
    }
    assert!(compared > 1000 && hits > 300, "{compared} {hits}");
}
