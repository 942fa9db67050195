//! A triangle that goes through the inside of a link is at distance 0, not at a rounding of it, and
//! every query says so.

use crate::draw::Draw;
use continuum_testing::Random;
use parry_continuum::parry::math::Pose;
use parry_continuum::parry::query::{ClosestPoints, PointQuery, QueryDispatcher};
use parry_continuum::parry::shape::{Shape, TriMesh, Triangle};
use parry_continuum::{ContinuumDispatcher, ModifiedCylinder};

#[test]
fn an_overlap_is_an_overlap_to_every_query() {
    let dispatcher = ContinuumDispatcher::default();
    let mut random = Random::new(51);
    let mut flat_caps = 0;
    for _ in 0..20_000 {
        let link = random.link();
        let inside = link.start().lerp(link.end(), random.unit()) + random.vector(link.radius());
        if link.distance_to_local_point(inside, false) > -1e-9 {
            continue;
        }
        flat_caps += usize::from(link.caps() != crate::draw::CAPS[1]);
        // The point is a convex combination of the corners.
        let (a, b) = (inside + random.vector(2.0), inside + random.vector(2.0));
        let mut weight = || random.between(0.05, 1.0);
        let c = inside - ((a - inside) * weight() + (b - inside) * weight()) / weight();
        let (triangle, pose) = (Triangle::new(a, b, c), Pose::IDENTITY);
        let mesh = TriMesh::new(vec![a, b, c], vec![[0, 1, 2]]).unwrap();
        let context = || format!("{link:?} {triangle:?}");

        assert_eq!(
            dispatcher.distance(&pose, &link, &triangle).unwrap().distance,
            0.0,
            "{}",
            context()
        );
        assert_eq!(
            dispatcher.distance(&pose, &mesh, &link).unwrap().distance,
            0.0,
            "{}",
            context()
        );
        assert!(
            dispatcher.intersection_test(&pose, &link, &mesh).unwrap().intersecting,
            "{}",
            context()
        );
        let points = dispatcher.closest_points(&pose, &triangle, &link, 0.0).unwrap();
        assert_eq!(points, ClosestPoints::Intersecting, "{}", context());
        let contact = dispatcher.contact(&pose, &link, &mesh, 0.0).unwrap();
        assert!(contact.is_some_and(|contact| contact.dist < 0.0), "{contact:?} {}", context());
    }
    assert!(flat_caps > 5000, "{flat_caps}");
}

#[test]
fn a_wire_through_a_triangle_meets_it() {
    let dispatcher = ContinuumDispatcher::default();
    let mut random = Random::new(52);
    for _ in 0..5000 {
        let inside = random.vector(1.0);
        let way = random.vector(1.0);
        let (start, end) =
            (inside - way * random.between(0.1, 1.0), inside + way * random.between(0.1, 1.0));
        let wire = ModifiedCylinder::new(start, end, 0.0, random.caps()).unwrap();
        let (a, b) = (inside + random.vector(2.0), inside + random.vector(2.0));
        let triangle = Triangle::new(a, b, inside * 3.0 - a - b);
        let mesh = TriMesh::new(triangle.vertices().to_vec(), vec![[0, 1, 2]]).unwrap();
        for surface in [&triangle as &dyn Shape, &mesh] {
            let distance = dispatcher.distance(&Pose::IDENTITY, &wire, surface).unwrap().distance;
            assert_eq!(distance, 0.0, "{wire:?} {triangle:?}");
            assert!(
                dispatcher.intersection_test(&Pose::IDENTITY, surface, &wire).unwrap().intersecting
            );
        }
    }
}
