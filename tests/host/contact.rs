//! Contacts: exact while apart, and otherwise the least translation that separates.

use crate::draw::{Draw, U, extent};
use continuum_testing::narrow_phase::segment_triangle;
use continuum_testing::{Random, rounds};
use parry_continuum::distance::Vec3;
use parry_continuum::parry::math::{Pose, Real, Vector};
use parry_continuum::parry::query::{Contact, PointQuery, QueryDispatcher};
use parry_continuum::parry::shape::{Shape, SupportMap, Triangle};
use parry_continuum::{Cap, ContinuumDispatcher, ModifiedCylinder};

fn contact(g1: &dyn Shape, g2: &dyn Shape) -> Contact {
    ContinuumDispatcher::default().contact(&Pose::IDENTITY, g1, g2, Real::MAX).unwrap().unwrap()
}

/// How far the triangle begins beyond the end of the link in a direction.
fn gap(link: &ModifiedCylinder, triangle: &Triangle, direction: Vector) -> Real {
    let reach = link.local_support_point(direction);
    triangle
        .vertices()
        .iter()
        .map(|vertex| (vertex - reach).dot(direction))
        .fold(Real::INFINITY, Real::min)
}

/// A link and a triangle through its inside, at times only just; half of them aligned.
fn crossing(random: &mut Random) -> Option<(ModifiedCylinder, Triangle)> {
    if random.chance(0.5) {
        let (link, triangle, pose) = random.meeting();
        let triangle = triangle.transformed(&pose);
        return (contact(&link, &triangle).dist < 0.0).then_some((link, triangle));
    }
    let link = random.link();
    let inside = link.start().lerp(link.end(), random.unit()) + random.vector(link.radius());
    let (a, b) = (inside + random.vector(1.5), inside + random.vector(1.5));
    let c = if random.chance(0.5) { inside } else { inside * 3.0 - a - b };
    link.contains_local_point(inside).then(|| (link, Triangle::new(a, b, c)))
}

#[test]
fn the_translation_separates_whatever_the_link() {
    let mut random = Random::new(61);
    let mut checked = [0; 2];
    for _ in 0..20_000 {
        let Some((link, triangle)) = crossing(&mut random) else { continue };
        let size = U * (extent(&link, triangle.a).max(extent(&link, triangle.b)) + 4.0);
        let found = contact(&link, &triangle);
        assert!(
            found.dist <= 32.0 * size && (found.normal1.length() - 1.0).abs() < 4.0 * U,
            "{found:?}"
        );
        assert_eq!(found.normal2, -found.normal1);
        if found.dist >= 0.0 {
            continue;
        }
        let apart = triangle.transformed(&Pose::from_translation(-found.normal1 * found.dist));
        assert!(
            gap(&link, &apart, found.normal1) >= -32.0 * size,
            "{link:?} {triangle:?} {found:?}"
        );
        let swapped = contact(&triangle, &link);
        assert_eq!((swapped.dist, swapped.normal2), (found.dist, found.normal1));
        checked[usize::from(link.caps() == [Cap::Round; 2])] += 1;
    }
    assert!(checked.iter().all(|&n| n > 1500), "{checked:?}");
}

/// r - F, and no direction leads out sooner.
#[test]
fn a_capsule_is_pushed_out_by_the_shortest_way_while_its_axis_is_outside() {
    let mut random = Random::new(62);
    let mut checked = 0;
    for _ in 0..20_000 {
        let Some((link, triangle)) = crossing(&mut random) else { continue };
        let link = ModifiedCylinder::capsule(link.start(), link.end(), link.radius()).unwrap();
        let vec3 = |v: Vector| Vec3::from(v.to_array());
        let axis = [vec3(link.start()), vec3(link.end())];
        let outside = segment_triangle(axis, triangle.vertices().map(vec3)).distance;
        if outside == 0.0 {
            continue;
        }
        checked += 1;
        let found = contact(&link, &triangle);
        let tolerance = 32.0 * U * (extent(&link, triangle.a).max(extent(&link, triangle.b)) + 4.0);
        assert!(
            (found.dist - (outside - link.radius())).abs() <= tolerance,
            "{found:?} for {outside}"
        );
        let between = found.point2 - found.point1;
        let context = || format!("{link:?} {triangle:?} {found:?} {outside:e}");
        assert!((between.dot(found.normal1) - found.dist).abs() <= tolerance, "{}", context());
        // Where an edge all but lies along the axis, the closest points are known to the root of
        // the rounding.
        assert!(
            (between - found.normal1 * found.dist).length() <= tolerance.sqrt(),
            "{}",
            context()
        );
        for _ in 0..50 {
            assert!(gap(&link, &triangle, random.direction()) <= found.dist + tolerance);
        }
    }
    assert!(checked > 2000, "{checked}");
}

/// A triangle that dips 0.01 into a flat cap, half a radius from the axis: out by the cap, not by
/// the barrel.
#[test]
fn a_flat_cap_is_left_along_the_axis() {
    let link = ModifiedCylinder::cylinder(Vector::ZERO, 2.0 * Vector::Z, 1.0).unwrap();
    let triangle = Triangle::new(
        Vector::new(0.5, -0.2, 1.99),
        Vector::new(0.5, 0.2, 1.99),
        Vector::new(0.9, 0.0, 2.5),
    );
    let found = contact(&link, &triangle);
    assert!((-0.0128..=-0.009).contains(&found.dist), "{found:?}");
    assert!(found.normal1.z > 0.99);
}

/// Rounding of the witnesses would turn their difference by 1e-4 here.
#[test]
fn close_contacts_have_the_normal_of_the_feature() {
    let mut random = Random::new(63);
    for _ in 0..500 {
        let pose = random.pose(1.0);
        let (caps, gap) = (random.caps(), random.log_between(1e-13, 1e-11));
        let link = ModifiedCylinder::new(-Vector::X, Vector::X, 0.25, caps).unwrap();
        let floor = -0.25 - gap;
        let triangle = Triangle::new(
            Vector::new(-3.0, floor, -2.0),
            Vector::new(3.0, floor, -2.5),
            Vector::new(0.2, floor, 3.0),
        );
        let (link, triangle) = (link.transformed(&pose), triangle.transformed(&pose));
        let found = contact(&link, &triangle);
        assert!((found.dist - gap).abs() < 32.0 * U, "{found:?} for {gap}");
        assert!((found.normal1 + pose.rotation * Vector::Y).length() < 1e-14, "{found:?}");
    }
}

#[test]
fn a_ball_on_a_sliver_and_other_poor_triangles_still_come_apart() {
    let ball = ModifiedCylinder::capsule(Vector::ZERO, Vector::ZERO, 1.0).unwrap();
    let wire = ModifiedCylinder::cylinder(-Vector::X, Vector::X, 0.0).unwrap();
    let rod = ModifiedCylinder::cylinder(-Vector::X, Vector::X, 0.5).unwrap();
    let needle = Triangle::new(-Vector::Y, Vector::ZERO, 2.0 * Vector::Y);
    let dot = Triangle::new(Vector::ZERO, Vector::ZERO, Vector::ZERO);
    let point = ModifiedCylinder::capsule(Vector::ZERO, Vector::ZERO, 0.0).unwrap();
    for link in [ball, wire, rod, point] {
        for triangle in [needle, dot] {
            let found = contact(&link, &triangle);
            let apart = triangle.transformed(&Pose::from_translation(-found.normal1 * found.dist));
            assert!(
                gap(&link, &apart, found.normal1) >= -8.0 * U,
                "{link:?} {triangle:?}: {found:?}"
            );
            assert!(found.dist >= -3.0 && found.dist <= 0.0);
        }
    }
}

/// No sampled direction, and no descent from the best one, separates by a shorter translation: for
/// all caps, with the axis outside the triangle or through it, for thick links and wires.
#[test]
fn no_sampled_direction_separates_sooner() {
    let mut random = Random::new(64);
    // By whether the link has a flat cap, and whether its axis crosses the triangle.
    let mut checked = [[0; 2]; 2];
    for _ in 0..rounds(4000) {
        let Some((link, triangle)) = crossing(&mut random) else { continue };
        let found = contact(&link, &triangle);
        let vec3 = |v: Vector| Vec3::from(v.to_array());
        let axis = [vec3(link.start()), vec3(link.end())];
        let pierced = segment_triangle(axis, triangle.vertices().map(vec3)).distance == 0.0;
        checked[usize::from(link.caps() != [Cap::Round; 2])][usize::from(pierced)] += 1;
        let try_all = |directions: &mut dyn Iterator<Item = Vector>, best: (Real, Vector)| {
            directions
                .map(|n| (gap(&link, &triangle, n), n))
                .fold(best, |a, b| if b.0 > a.0 { b } else { a })
        };
        let worst = (Real::NEG_INFINITY, Vector::X);
        let mut best = try_all(&mut (0..200).map(|_| random.direction()), worst);
        let mut step = 0.3;
        while step > 1e-8 {
            let around = best.1;
            let mut near = (0..12).map(|_| (around + random.direction() * step).normalize());
            let next = try_all(&mut near, best);
            step *= if next.0 > best.0 { 1.0 } else { 0.5 };
            best = next;
        }
        let rounding = 32.0 * U * (extent(&link, triangle.a).max(extent(&link, triangle.b)) + 4.0);
        assert!(best.0 <= found.dist + rounding, "{link:?} {triangle:?}: {found:?}, but {best:?}");
    }
    assert!(checked.iter().flatten().all(|&n| n > rounds(100)), "{checked:?}");
}
