//! Point and ray queries on a link are exact: certified by separating planes, checked against each other and
//! against parry, and unchanged by the unit of length.

mod common;
mod host_common;

use common::Random;
use host_common::{CAPS, Draw, U, extent, largest, scaled, surface_point, violation};
use parry_continuum::parry::math::{Real, Vector};
use parry_continuum::parry::query::{PointQuery, Ray, RayCast};
use parry_continuum::parry::shape::{Capsule, Cylinder, FeatureId, Shape, SupportMap};
use parry_continuum::{Cap, ModifiedCylinder};

/// A point around, inside or on a link, at times on its axis line or very far away.
fn point_near(random: &mut Random, link: &ModifiedCylinder) -> Vector {
    let surface = surface_point(random, link);
    let t = random.between(-0.5, 1.5);
    let on_axis = link.start() * (1.0 - t) + link.end() * t;
    match random.index(6) {
        0 => on_axis,
        1 => surface + random.direction() * random.log_between(1e-9, 1e-3),
        2 => surface + random.direction() * random.log_between(1e2, 1e6),
        3 => surface,
        4 => on_axis * 0.5 + surface * 0.5,
        _ => surface + random.vector(2.0),
    }
}

/// How far `link` reaches along `direction`, by the support map that `tests/host_shape.rs` checks.
fn reach(link: &ModifiedCylinder, direction: Vector, from: Vector) -> Real {
    (link.local_support_point(direction) - from).dot(direction)
}

#[test]
fn distances_are_certified_by_a_separating_plane_outside_and_by_a_ball_inside() {
    let mut random = Random::new(11);
    let (mut outside, mut certified, mut inside, mut inner_pieces) = (0, 0, 0, [0; 3]);
    let count = 20_000;
    for _ in 0..count {
        let link = random.link();
        let p = point_near(&mut random, &link);
        let (size, coordinates) = (extent(&link, p), largest(&link, p));
        let distance = link.distance_to_local_point(p, false);
        let (projection, feature) = link.project_local_point_and_get_feature(p);
        let context = || format!("{link:?} from {p}: {projection:?} {feature:?} at {distance}");
        assert_eq!(projection.is_inside, distance <= 0.0, "{}", context());

        // The witness lies on the link and realises the distance.
        let apart = (projection.point - p).length();
        assert!((apart - distance.abs()).abs() <= 8.0 * U * (coordinates + size), "{}", context());
        assert!(violation(&link, projection.point).abs() <= 8.0 * U * (coordinates + size), "{}", context());

        if distance > 0.0 {
            outside += 1;
            // No support point along the outward normal comes closer to `p`: a lower bound, whatever the
            // normal is. On a rim the normal is the difference of the witnesses, which is only as good as
            // they are apart.
            let (normal, tolerance) = match feature {
                FeatureId::Face(_) => (link.feature_normal_at_point(0, feature, p), 16.0),
                _ if apart < 1e-9 * coordinates => (None, 0.0),
                _ => (Some((p - projection.point) / apart), 16.0 * (1.0 + size / distance)),
            };
            if let Some(normal) = normal {
                certified += 1;
                let lower = -reach(&link, normal, p);
                let error = (lower - distance).abs() / (U * (coordinates + size));
                assert!(error <= tolerance, "off by {error}: {}", context());
            }
        } else {
            inside += 1;
            if let FeatureId::Face(piece) = feature {
                inner_pieces[piece as usize] += 1;
            }
            // No direction leads out sooner.
            for _ in 0..20 {
                let direction = random.direction();
                assert!(
                    reach(&link, direction, p) >= -distance - 8.0 * U * (coordinates + size),
                    "{}",
                    context()
                );
            }
            let axis = (link.end() - link.start()).normalize_or_zero();
            for direction in [axis, -axis] {
                let leaves = direction == Vector::ZERO
                    || reach(&link, direction, p) >= -distance - 8.0 * U * coordinates;
                assert!(leaves, "{}", context());
            }
        }
    }
    assert!(certified > outside * 9 / 10, "{certified} of {outside} certified");
    assert!(outside > count / 3 && inside > count / 4, "{outside} outside, {inside} inside");
    assert!(inner_pieces.iter().all(|&visits| visits > inside / 20), "{inner_pieces:?} of {inside}");
}

#[test]
fn solid_points_stay_and_distances_carry_parrys_sign() {
    let mut random = Random::new(12);
    for _ in 0..2000 {
        let link = random.link();
        let p = point_near(&mut random, &link);
        let signed = link.distance_to_local_point(p, false);
        let solid = link.project_local_point(p, true);
        assert_eq!(link.contains_local_point(p), solid.is_inside);
        assert_eq!(link.distance_to_local_point(p, true), signed.max(0.0));
        if solid.is_inside {
            assert_eq!(solid.point, p);
        } else {
            assert_eq!(solid.point, link.project_local_point(p, false).point);
        }
    }
}

#[test]
fn points_agree_with_parrys_capsule_and_cylinder() {
    let mut random = Random::new(13);
    for _ in 0..5000 {
        let (half, radius) = (random.log_between(0.1, 2.0), random.log_between(0.1, 2.0));
        let (start, end) = (Vector::new(0.0, -half, 0.0), Vector::new(0.0, half, 0.0));
        let p = random.vector(3.0);
        let capsule = ModifiedCylinder::capsule(start, end, radius).unwrap();
        let cylinder = ModifiedCylinder::cylinder(start, end, radius).unwrap();
        let pairs: [(&dyn Shape, &dyn Shape); 2] =
            [(&capsule, &Capsule::new(start, end, radius)), (&cylinder, &Cylinder::new(half, radius))];
        for (ours, theirs) in pairs {
            for solid in [false, true] {
                let (a, b) =
                    (ours.distance_to_local_point(p, solid), theirs.distance_to_local_point(p, solid));
                assert!((a - b).abs() < 1e-14, "{a} for {b} at {p}, half {half}, radius {radius}");
            }
            assert_eq!(ours.contains_local_point(p), theirs.contains_local_point(p));
        }
    }
}

/// A flat end is nearer than the round one, though the round end's half ball holds the point: 0.15 to the
/// disc, 0.95 to the half ball.
#[test]
fn inside_a_short_link_the_far_flat_end_can_be_the_nearest() {
    let link = ModifiedCylinder::new(Vector::ZERO, 0.1 * Vector::Z, 1.0, [Cap::Flat, Cap::Round]).unwrap();
    let (projection, feature) = link.project_local_point_and_get_feature(0.15 * Vector::Z);
    assert!((projection.point - Vector::ZERO).length() < 1e-16 && projection.is_inside);
    assert_eq!(feature, FeatureId::Face(1));
}

/// A ray from around the link: aimed at it or past it, along its axis or across, from inside or from far
/// away, its direction of any length.
fn ray_near(random: &mut Random, link: &ModifiedCylinder) -> Ray {
    let origin = point_near(random, link);
    let target = surface_point(random, link);
    let axis = link.end() - link.start();
    let direction = match random.index(5) {
        0 if axis != Vector::ZERO => axis * if random.chance(0.5) { 1.0 } else { -1.0 },
        1 => axis.cross(random.direction()) + random.direction() * 1e-9,
        2 => target - origin,
        3 => target + random.vector(0.3) - origin,
        _ => random.direction(),
    };
    Ray::new(origin, direction * random.log_between(1e-3, 1e3))
}

/// Along the ray no point before the time of impact is on the link, and the point at that time is.
#[test]
fn rays_hit_where_the_distance_first_vanishes() {
    let mut random = Random::new(14);
    let (mut hits, mut misses, mut marched) = (0, 0, 0);
    let count = 20_000;
    for _ in 0..count {
        let link = random.link();
        let ray = ray_near(&mut random, &link);
        let speed = ray.dir.length();
        let tolerance = 16.0 * U * (largest(&link, ray.origin) + extent(&link, ray.origin));
        let hit = link.cast_local_ray_and_get_normal(&ray, Real::MAX, true);
        let context = || format!("{link:?} by {ray:?}: {hit:?}");

        // Sphere tracing: a step as long as the distance can't pass the link.
        let (mut time, mut gap, mut steps) = (0.0, link.distance_to_local_point(ray.origin, true), 0);
        let far = 4.0 * extent(&link, ray.origin) / speed;
        while gap > tolerance && time < far && steps < 300 {
            time += gap / speed;
            gap = link.distance_to_local_point(ray.point_at(time), true);
            steps += 1;
        }
        match &hit {
            Some(hit) => {
                hits += 1;
                let at_hit = link.distance_to_local_point(ray.point_at(hit.time_of_impact), false);
                let inside = hit.time_of_impact == 0.0 && at_hit < 0.0;
                assert!(inside || at_hit.abs() <= tolerance, "{at_hit} {}", context());
                assert!(time * speed <= hit.time_of_impact * speed + 2.0 * tolerance, "{time} {}", context());
            }
            None => {
                misses += 1;
                // A ray that comes within rounding of the link goes no deeper.
                let ahead = (0..100)
                    .map(|i| ray.point_at(time + extent(&link, ray.origin) / speed * 0.02 * Real::from(i)));
                let deepest = ahead.map(|p| link.distance_to_local_point(p, false)).fold(gap, Real::min);
                assert!(deepest >= -tolerance, "{deepest} {time} {}", context());
            }
        }
        marched += usize::from(steps < 300);
    }
    assert!(hits > count * 3 / 10 && misses > count / 10, "{hits} hits, {misses} misses");
    assert!(marched > count * 8 / 10, "{marched} conclusive of {count}");
}

/// The far side, cast back from beyond it, is where the hollow ray from inside comes out; entry and exit
/// normals both point against the ray and are the surface's.
#[test]
fn hollow_rays_leave_where_the_reversed_ray_enters() {
    let mut random = Random::new(15);
    let mut pieces = [0; 3];
    for _ in 0..10_000 {
        let link = random.link();
        if link.radius() == 0.0 {
            continue;
        }
        let (t, axis) = (random.unit(), link.end() - link.start());
        let origin = link.start() + axis * t + random.vector(0.5 * link.radius());
        if !link.contains_local_point(origin) {
            continue;
        }
        let ray = Ray::new(origin, random.direction() * 3.0);
        let tolerance = 64.0 * U * (largest(&link, origin) + extent(&link, origin));
        let out = link.cast_local_ray_and_get_normal(&ray, Real::MAX, false).unwrap();
        let exit = ray.point_at(out.time_of_impact);
        assert!(link.distance_to_local_point(exit, false).abs() <= tolerance, "{link:?} {ray:?} {out:?}");
        let beyond = ray.point_at(out.time_of_impact + 1.0);
        assert!(!link.contains_local_point(beyond), "a convex body is left once: {link:?} {ray:?}");
        let back = link.cast_local_ray_and_get_normal(&Ray::new(beyond, -ray.dir), 2.0, false).unwrap();
        // Where the ray leaves at a grazing angle its time is as uncertain as the angle is small.
        let (gap, slope) = ((1.0 - back.time_of_impact).abs() * 3.0, back.normal.dot(ray.dir) / 3.0);
        let certain = gap * slope <= tolerance || gap * gap <= tolerance;
        assert!(certain, "{gap} {slope} {out:?} {back:?} for {link:?} {ray:?}");
        assert!(out.normal.dot(ray.dir) <= 1e-9 && back.normal.dot(ray.dir) >= -1e-9);
        assert!((out.normal.length() - 1.0).abs() < 4.0 * U && (back.normal.length() - 1.0).abs() < 4.0 * U);
        if slope > 1e-3 && out.feature == back.feature {
            assert!((out.normal + back.normal).length() < 1e-6, "{out:?} {back:?}");
            let surface = link.feature_normal_at_point(0, out.feature, exit).unwrap();
            assert!((out.normal + surface).length() < 1e-6, "{out:?} {surface}");
        }
        if let FeatureId::Face(piece) = out.feature {
            pieces[piece as usize] += 1;
        }
    }
    assert!(pieces.iter().all(|&visits| visits > 500), "{pieces:?}");
}

#[test]
fn rays_agree_with_parrys_capsule_and_cylinder() {
    let mut random = Random::new(16);
    let (mut hits, mut misses, count) = (0, 0, 5000);
    for _ in 0..count {
        let (half, radius) = (random.log_between(0.1, 2.0), random.log_between(0.1, 2.0));
        let (start, end) = (Vector::new(0.0, -half, 0.0), Vector::new(0.0, half, 0.0));
        let origin = random.vector(4.0);
        let ray = Ray::new(origin, random.vector(1.5) - origin);
        let capsule = ModifiedCylinder::capsule(start, end, radius).unwrap();
        let theirs = Capsule::new(start, end, radius);
        for solid in [true, false] {
            let a = capsule.cast_local_ray_and_get_normal(&ray, 100.0, solid);
            let b = theirs.cast_local_ray_and_get_normal(&ray, 100.0, solid);
            match (a, b) {
                (Some(a), Some(b)) => {
                    hits += 1;
                    // Both solve a square root that loses half the digits where the ray grazes.
                    assert!((a.time_of_impact - b.time_of_impact).abs() < 1e-6, "{a:?} for {b:?}");
                    assert!((a.normal - b.normal).length() < 1e-6, "{a:?} for {b:?}");
                }
                (None, None) => misses += 1,
                (a, b) => panic!("{a:?} for {b:?} by {ray:?}, half {half}, radius {radius}"),
            }
        }
        // parry's cylinder marches by GJK, so only roughly.
        let cylinder = ModifiedCylinder::cylinder(start, end, radius).unwrap();
        let theirs = Cylinder::new(half, radius).cast_local_ray(&ray, 100.0, true);
        if let (Some(a), Some(b)) = (cylinder.cast_local_ray(&ray, 100.0, true), theirs) {
            assert!((a - b).abs() < 1e-2, "{a} for {b} by {ray:?}, half {half}, radius {radius}");
        }
    }
    assert!(hits > count / 2 && misses > count / 4, "{hits} hits, {misses} misses");
}

/// Half flat, half round, along z from 0 to 2 with radius 1/2.
fn bullet() -> ModifiedCylinder {
    ModifiedCylinder::new(Vector::ZERO, 2.0 * Vector::Z, 0.5, [Cap::Flat, Cap::Round]).unwrap()
}

#[track_caller]
fn assert_hit(
    link: &ModifiedCylinder,
    origin: [Real; 3],
    dir: [Real; 3],
    solid: bool,
    time: Real,
    normal: [Real; 3],
) {
    let ray = Ray::new(origin.into(), dir.into());
    let hit = link.cast_local_ray_and_get_normal(&ray, Real::MAX, solid).unwrap();
    assert!((hit.time_of_impact - time).abs() < 1e-15 * (1.0 + time), "{hit:?}");
    assert!((hit.normal - Vector::from(normal)).length() < 1e-15, "{hit:?}");
}

#[test]
fn rays_along_and_across_the_axis_hit_the_right_piece() {
    let link = bullet();
    // Along the axis, through both caps, inside and out; twice the speed, half the time.
    assert_hit(&link, [0.0, 0.0, -1.0], [0.0, 0.0, 2.0], true, 0.5, [0.0, 0.0, -1.0]);
    assert_hit(&link, [0.0, 0.0, 4.0], [0.0, 0.0, -1.0], true, 1.5, [0.0, 0.0, 1.0]);
    assert_hit(&link, [0.0, 0.0, 1.0], [0.0, 0.0, 1.0], false, 1.5, [0.0, 0.0, -1.0]);
    assert_hit(&link, [0.0, 0.0, 1.0], [0.0, 0.0, -1.0], false, 1.0, [0.0, 0.0, 1.0]);
    // Beside the axis, parallel to it: onto the disc, onto the half ball at 30 degrees from its pole.
    assert_hit(&link, [0.25, 0.0, -1.0], [0.0, 0.0, 1.0], true, 1.0, [0.0, 0.0, -1.0]);
    let up = 0.75_f64.sqrt();
    assert_hit(&link, [0.25, 0.0, 3.0], [0.0, 0.0, -1.0], true, 1.0 - 0.5 * up, [0.5, 0.0, up]);
    // Across it: the barrel, and the exit on the other side.
    assert_hit(&link, [-2.0, 0.0, 1.0], [0.5, 0.0, 0.0], true, 3.0, [-1.0, 0.0, 0.0]);
    assert_hit(&link, [0.0, 0.0, 1.0], [0.5, 0.0, 0.0], false, 1.0, [-1.0, 0.0, 0.0]);
    // Grazing the barrel, in the plane of the disc, and just past either.
    assert_hit(&link, [0.5, -2.0, 1.0], [0.0, 1.0, 0.0], true, 2.0, [1.0, 0.0, 0.0]);
    assert!(link.cast_local_ray(&Ray::new(Vector::new(0.0, -2.0, 0.0), Vector::Y), 9.0, true).is_some());
    assert!(link.cast_local_ray(&Ray::new(Vector::new(0.0, -2.0, -1e-15), Vector::Y), 9.0, true).is_none());
    let past = Vector::new(0.5 + 1e-15, -2.0, 1.0);
    assert!(link.cast_local_ray(&Ray::new(past, Vector::Y), 9.0, true).is_none());
    // Into the infinite cylinder below the disc and out of it again before the disc.
    let steep = Ray::new(Vector::new(-1.0, 0.0, -1.0), Vector::new(1.0, 0.0, 0.5));
    assert!(link.cast_local_ray(&steep, 9.0, true).is_none());
    // Starting inside, starting beyond, stopping short, too slow.
    assert_hit(&link, [0.1, 0.0, 1.0], [1.0, 0.0, 0.0], true, 0.0, [0.0, 0.0, 0.0]);
    let (above, down) = (4.0 * Vector::Z, -Vector::Z);
    assert!(link.cast_local_ray(&Ray::new(above, Vector::Z), 9.0, true).is_none());
    assert!(link.cast_local_ray(&Ray::new(above, down), 1.49, true).is_none());
    assert!(link.cast_local_ray(&Ray::new(above, down), 1.5, true).is_some());
}

#[test]
fn a_ray_without_direction_hits_the_solid_it_starts_in() {
    let link = bullet();
    for (origin, hits) in [(Vector::Z, true), (Vector::X, false)] {
        let ray = Ray::new(origin, Vector::ZERO);
        assert_eq!(link.cast_local_ray(&ray, 9.0, true).is_some(), hits);
        assert_eq!(link.cast_local_ray(&ray, 9.0, false), None);
    }
}

/// Rounding puts half of the surface's points outside. A ray that starts there hits at once on its way in,
/// and not at all on its way out.
#[test]
fn rays_from_the_surface_hit_inwards_only() {
    let mut random = Random::new(27);
    let mut outside = 0;
    for _ in 0..2000 {
        let link = random.link();
        let p = surface_point(&mut random, &link);
        let (_, feature) = link.project_local_point_and_get_feature(p);
        let Some(normal) = link.feature_normal_at_point(0, feature, p) else { continue };
        let tilted = normal + random.direction() * 0.3;
        // On a rim the way in for one face can be the way out for the other.
        let leads_in = link.contains_local_point(p - tilted * 1e-2 * link.ccd_thickness());
        if !leads_in || link.contains_local_point(p) {
            continue;
        }
        outside += 1;
        assert_eq!(link.cast_local_ray(&Ray::new(p, tilted), Real::MAX, true), None, "{link:?} {p} {tilted}");
        let hit = link.cast_local_ray(&Ray::new(p, -tilted), Real::MAX, true);
        let error = hit.map(|time| link.distance_to_local_point(p - tilted * time, false).abs());
        assert!(error.is_some_and(|error| error < 32.0 * U), "{link:?} {p} {tilted}: {hit:?}");
    }
    assert!(outside > 500, "{outside}");
}

#[test]
fn a_direction_of_subnormal_length_is_a_direction() {
    let ray = Ray::new(1e-5 * Vector::X, Vector::new(-1e-310, 0.0, 0.0));
    let ball = ModifiedCylinder::capsule(Vector::ZERO, Vector::ZERO, 0.5e-5).unwrap();
    let time = ball.cast_local_ray(&ray, Real::MAX, true).unwrap();
    assert!((time * 1e-310 / 0.5e-5 - 1.0).abs() < 1e-12, "{time}");
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
fn on_the_axis_any_way_out_is_taken_but_a_whole_radius_long() {
    let mut random = Random::new(17);
    for _ in 0..2000 {
        let (start, axis, radius) = (random.vector(1.0), random.direction(), random.log_between(1e-3, 1.0));
        let link = ModifiedCylinder::new(start, start + axis, radius, random.caps()).unwrap();
        let p = start + axis * random.between(0.4, 0.6);
        let depth = -link.distance_to_local_point(p, false);
        let way = link.project_local_point(p, false).point - p;
        let heights = [(p - start).length(), (start + axis - p).length()];
        let flat = link.caps().into_iter().zip(heights).filter(|(cap, _)| *cap == Cap::Flat);
        let expected = flat.map(|(_, height)| height).fold(radius, Real::min);
        assert!((depth - expected).abs() < 1e-14, "{depth} for {expected}");
        assert!((way.length() - depth).abs() < 1e-14, "{way} for {depth}");
    }
}

/// From a million radii away the hit is still on the surface to the rounding of that distance.
#[test]
fn a_far_origin_loses_no_more_than_its_own_rounding() {
    let mut random = Random::new(18);
    let mut hits = 0;
    for _ in 0..5000 {
        let link = random.link();
        if link.radius() == 0.0 {
            continue;
        }
        let target = surface_point(&mut random, &link);
        let origin = target + random.direction() * 1e6 * link.radius();
        let ray = Ray::new(origin, target - origin);
        if let Some(time) = link.cast_local_ray(&ray, 2.0, true) {
            hits += 1;
            let error = link.distance_to_local_point(ray.point_at(time), false).abs();
            assert!(error <= 8.0 * U * extent(&link, origin), "{error} from {origin} for {link:?}");
        }
    }
    assert!(hits > 2500, "{hits}");
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
            links.extend(ModifiedCylinder::new(-reach * Vector::X, reach * Vector::ONE, radius, caps));
        }
    }
    assert_eq!(links.len(), 20);
    for _ in 0..20_000 {
        let mut any = || Vector::from([0; 3].map(|_| sizes[random.index(8)] * [1.0, -1.0][random.index(2)]));
        let (origin, dir) = (any(), any());
        let link = &links[random.index(20)];
        let (point, distance) =
            (link.project_local_point(origin, false).point, link.distance_to_local_point(origin, false));
        let hit = link.cast_local_ray_and_get_normal(&Ray::new(origin, dir), Real::MAX, random.chance(0.5));
        if origin.is_finite() {
            assert!(!distance.is_nan() && point.is_finite(), "{link:?} {origin}: {distance} {point}");
            assert!(
                hit.is_none_or(|h| h.time_of_impact >= 0.0 && h.normal.is_finite()),
                "{link:?} {origin} {dir} {hit:?}"
            );
        } else {
            // Never a number that could be taken for a clearance.
            assert!(!distance.is_finite() && hit.is_none(), "{link:?} {origin}: {distance} {hit:?}");
        }
        assert!(dir.is_finite() || hit.is_none(), "{link:?} {origin} {dir} {hit:?}");
    }
}
