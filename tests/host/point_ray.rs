//! Point and ray queries on a link are exact: certified by separating planes, checked against each
//! other and against parry, and unchanged by the unit of length.

use crate::draw::{CAPS, Draw, scaled, surface_point};
use crate::rays::assert_hit;
use continuum_testing::Random;
use parry_continuum::ModifiedCylinder;
use parry_continuum::parry::math::{Real, Vector};
use parry_continuum::parry::query::{PointQuery, Ray, RayCast};
use parry_continuum::parry::shape::SupportMap;

/// A point around, inside or on a link, at times on its axis line or very far away, and as often
/// where pieces of its surface meet: on a rim, in the plane of a cap, above a seam between barrel
/// and round cap, a little off or not.
pub fn point_near(random: &mut Random, link: &ModifiedCylinder) -> Vector {
    let surface = surface_point(random, link);
    let t = random.between(-0.5, 1.5);
    let on_axis = link.start() * (1.0 - t) + link.end() * t;
    match random.index(12) {
        6.. => on_a_seam(random, link),
        0 => on_axis,
        1 => surface + random.direction() * random.log_between(1e-9, 1e-3),
        2 => surface + random.direction() * random.log_between(1e2, 1e6),
        3 => surface,
        4 => on_axis * 0.5 + surface * 0.5,
        _ => surface + random.vector(2.0),
    }
}

/// A point in the plane through an end of a link: on its axis, its rim, inside or outside of it, or
/// a little off.
fn on_a_seam(random: &mut Random, link: &ModifiedCylinder) -> Vector {
    let axis = (link.end() - link.start()).normalize_or(Vector::X);
    let side =
        if random.chance(0.5) { axis.any_orthonormal_vector() } else { across(random, axis) };
    let end = if random.chance(0.5) { link.start() } else { link.end() };
    let point = end + side * (link.radius() * [0.0, 0.5, 1.0, 1.0, 2.0][random.index(5)]);
    match random.index(3) {
        0 => point + axis * random.log_between(1e-16, 1e-3) * [1.0, -1.0][random.index(2)],
        1 => point + side * random.log_between(1e-16, 1e-3) * [1.0, -1.0][random.index(2)],
        _ => point,
    }
}

/// A unit vector across another.
fn across(random: &mut Random, axis: Vector) -> Vector {
    axis.cross(random.direction()).normalize_or(axis.any_orthonormal_vector())
}

/// How far `link` reaches along `direction`, by the support map that `tests/host/shape.rs` checks.
pub fn reach(link: &ModifiedCylinder, direction: Vector, from: Vector) -> Real {
    (link.local_support_point(direction) - from).dot(direction)
}

/// A ray from around the link: aimed at it or past it, along its axis or across, from inside or
/// from far away, its direction of any length.
pub fn ray_near(random: &mut Random, link: &ModifiedCylinder) -> Ray {
    let origin = point_near(random, link);
    let target = surface_point(random, link);
    let axis = link.end() - link.start();
    // Along the barrel, grazing it or its rims, or in the plane of a cap.
    if random.chance(0.5) && axis != Vector::ZERO {
        let side = across(random, axis.normalize());
        let seam = on_a_seam(random, link);
        let way = [axis.normalize(), side, axis.normalize().cross(side)][random.index(3)];
        let back = [0.0, 1.0, 3.0][random.index(3)];
        return Ray::new(seam - way * back, way * [1.0, 0.5, 3.0][random.index(3)]);
    }
    let direction = match random.index(5) {
        0 if axis != Vector::ZERO => axis * if random.chance(0.5) { 1.0 } else { -1.0 },
        1 => axis.cross(random.direction()) + random.direction() * 1e-9,
        2 => target - origin,
        3 => target + random.vector(0.3) - origin,
        _ => random.direction(),
    };
    Ray::new(origin, direction * random.log_between(1e-3, 1e3))
}

#[test]
fn balls_and_wires_answer_rays_and_points() {
    let ball = ModifiedCylinder::capsule(Vector::X, Vector::X, 0.5).unwrap();
    assert_hit(&ball, [1.0, 3.0, 0.0], [0.0, -1.0, 0.0], true, 2.5, [0.0, 1.0, 0.0]);
    assert_hit(&ball, [1.0, 0.0, 0.0], [0.0, 0.0, 2.0], false, 0.25, [0.0, 0.0, -1.0]);
    assert_eq!(ball.distance_to_local_point(Vector::X, false), -0.5);
    assert_eq!(ball.distance_to_local_point(3.0 * Vector::X, false), 1.5);

    for caps in CAPS {
        let wire = ModifiedCylinder::new(Vector::ZERO, Vector::X, 0.0, caps).unwrap();
        assert_hit(&wire, [0.5, 2.0, 0.0], [0.0, -1.0, 0.0], true, 2.0, [0.0, 1.0, 0.0]);
        assert_eq!(wire.distance_to_local_point(Vector::new(0.5, 3.0, 4.0), false), 5.0);
        assert_eq!(wire.distance_to_local_point(Vector::new(4.0, 4.0, 0.0), false), 5.0);
        assert!(wire.contains_local_point(Vector::new(0.5, 0.0, 0.0)));
        assert!(!wire.contains_local_point(Vector::new(0.5, 1e-100, 0.0)));
    }
}

#[test]
fn a_change_of_unit_changes_no_bit() {
    let mut random = Random::new(19);
    for _ in 0..2000 {
        let link = random.link();
        let ray = ray_near(&mut random, &link);
        let distance = link.distance_to_local_point(ray.origin, false);
        let projection = link.project_local_point(ray.origin, false);
        let hit = link.cast_local_ray_and_get_normal(&ray, Real::MAX, false);
        for k in [-300, -41, 7, 300] {
            let unit = Real::powi(2.0, k);
            let (link, ray) = (scaled(&link, unit), Ray::new(ray.origin * unit, ray.dir * unit));
            assert_eq!(link.distance_to_local_point(ray.origin, false), distance * unit);
            assert_eq!(link.project_local_point(ray.origin, false).point, projection.point * unit);
            let scaled_hit = link.cast_local_ray_and_get_normal(&ray, Real::MAX, false);
            assert_eq!(
                scaled_hit.map(|h| (h.time_of_impact, h.normal)),
                hit.map(|h| (h.time_of_impact, h.normal))
            );
        }
    }
}

#[test]
fn nothing_finite_gives_a_nan_and_nothing_panics() {
    let sizes = [0.0, 5e-324, 1e-300, 1.0, 1e300, Real::MAX, Real::INFINITY, Real::NAN];
    let mut random = Random::new(20);
    let mut links = vec![];
    for caps in CAPS {
        for (reach, radius) in
            [(1e150, 1e150), (1e150, 1e-300), (1e30, 1e150), (1e-300, 0.0), (5e-324, 5e-324)]
        {
            links.extend(ModifiedCylinder::new(
                -reach * Vector::X,
                reach * Vector::ONE,
                radius,
                caps,
            ));
        }
    }
    assert_eq!(links.len(), 20);
    for _ in 0..20_000 {
        let mut any =
            || Vector::from([0; 3].map(|_| sizes[random.index(8)] * [1.0, -1.0][random.index(2)]));
        let (origin, dir) = (any(), any());
        let link = &links[random.index(20)];
        let (point, distance) = (
            link.project_local_point(origin, false).point,
            link.distance_to_local_point(origin, false),
        );
        let hit = link.cast_local_ray_and_get_normal(
            &Ray::new(origin, dir),
            Real::MAX,
            random.chance(0.5),
        );
        if origin.is_finite() {
            assert!(
                !distance.is_nan() && point.is_finite(),
                "{link:?} {origin}: {distance} {point}"
            );
            assert!(
                hit.is_none_or(|h| h.time_of_impact >= 0.0 && h.normal.is_finite()),
                "{link:?} {origin} {dir} {hit:?}"
            );
        } else {
            // Never a number that could be taken for a clearance.
            assert!(
                !distance.is_finite() && hit.is_none(),
                "{link:?} {origin}: {distance} {hit:?}"
            );
        }
        assert!(dir.is_finite() || hit.is_none(), "{link:?} {origin} {dir} {hit:?}");
    }
}
