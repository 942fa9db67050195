//! Ray queries.

use crate::draw::{Draw, U, extent, largest, surface_point};
use crate::point_ray::ray_near;
use continuum_testing::Random;
use parry_continuum::parry::math::{Real, Vector};
use parry_continuum::parry::query::{PointQuery, Ray, RayCast};
use parry_continuum::parry::shape::{Capsule, Cylinder, FeatureId, Shape, SupportMap};
use parry_continuum::{Cap, Chain, ModifiedCylinder};

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
        let (mut time, mut gap, mut steps) =
            (0.0, link.distance_to_local_point(ray.origin, true), 0);
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
                assert!(
                    time * speed <= hit.time_of_impact * speed + 2.0 * tolerance,
                    "{time} {}",
                    context()
                );
            }
            None => {
                misses += 1;
                // A ray that comes within rounding of the link goes no deeper.
                let ahead = (0..100).map(|i| {
                    ray.point_at(time + extent(&link, ray.origin) / speed * 0.02 * Real::from(i))
                });
                let deepest =
                    ahead.map(|p| link.distance_to_local_point(p, false)).fold(gap, Real::min);
                assert!(deepest >= -tolerance, "{deepest} {time} {}", context());
            }
        }
        marched += usize::from(steps < 300);
    }
    assert!(hits > count * 3 / 10 && misses > count / 10, "{hits} hits, {misses} misses");
    assert!(marched > count * 8 / 10, "{marched} conclusive of {count}");
}

/// The far side, cast back from beyond it, is where the hollow ray from inside comes out; entry and
/// exit normals both point against the ray and are the surface's.
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
        assert!(
            link.distance_to_local_point(exit, false).abs() <= tolerance,
            "{link:?} {ray:?} {out:?}"
        );
        let beyond = ray.point_at(out.time_of_impact + 1.0);
        assert!(!link.contains_local_point(beyond), "a convex body is left once: {link:?} {ray:?}");
        let back =
            link.cast_local_ray_and_get_normal(&Ray::new(beyond, -ray.dir), 2.0, false).unwrap();
        // Where the ray leaves at a grazing angle its time is as uncertain as the angle is small.
        let (gap, slope) =
            ((1.0 - back.time_of_impact).abs() * 3.0, back.normal.dot(ray.dir) / 3.0);
        let certain = gap * slope <= tolerance || gap * gap <= tolerance;
        assert!(certain, "{gap} {slope} {out:?} {back:?} for {link:?} {ray:?}");
        assert!(out.normal.dot(ray.dir) <= 1e-9 && back.normal.dot(ray.dir) >= -1e-9);
        assert!(
            (out.normal.length() - 1.0).abs() < 4.0 * U
                && (back.normal.length() - 1.0).abs() < 4.0 * U
        );
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
pub fn assert_hit(
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
    // Beside the axis, parallel to it: onto the disc, onto the half ball at 30 degrees from its
    // pole.
    assert_hit(&link, [0.25, 0.0, -1.0], [0.0, 0.0, 1.0], true, 1.0, [0.0, 0.0, -1.0]);
    let up = 0.75_f64.sqrt();
    assert_hit(&link, [0.25, 0.0, 3.0], [0.0, 0.0, -1.0], true, 1.0 - 0.5 * up, [0.5, 0.0, up]);
    // Across it: the barrel, and the exit on the other side.
    assert_hit(&link, [-2.0, 0.0, 1.0], [0.5, 0.0, 0.0], true, 3.0, [-1.0, 0.0, 0.0]);
    assert_hit(&link, [0.0, 0.0, 1.0], [0.5, 0.0, 0.0], false, 1.0, [-1.0, 0.0, 0.0]);
    // Grazing the barrel, in the plane of the disc, and just past either.
    assert_hit(&link, [0.5, -2.0, 1.0], [0.0, 1.0, 0.0], true, 2.0, [1.0, 0.0, 0.0]);
    assert!(
        link.cast_local_ray(&Ray::new(Vector::new(0.0, -2.0, 0.0), Vector::Y), 9.0, true).is_some()
    );
    assert!(
        link.cast_local_ray(&Ray::new(Vector::new(0.0, -2.0, -1e-15), Vector::Y), 9.0, true)
            .is_none()
    );
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

/// Rounding puts half of the surface's points outside. A ray that starts there hits at once on its
/// way in, and not at all on its way out.
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
        assert_eq!(
            link.cast_local_ray(&Ray::new(p, tilted), Real::MAX, true),
            None,
            "{link:?} {p} {tilted}"
        );
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

/// A hit at the end of the time counts, for a chain as for its link: far away, and along an axis or
/// in the face of a link's box.
#[test]
fn a_chain_is_hit_at_the_end_of_the_time() {
    let mut random = Random::new(49);
    let mut far = 0;
    for _ in 0..4000 {
        let axis =
            if random.chance(0.5) { Vector::AXES[random.index(3)] } else { random.direction() };
        let start = random.vector(1.0) * random.log_between(1.0, 1e6);
        let points = [start, start + axis * random.between(0.1, 2.0)];
        let chain = Chain::cylinders(&points, &[random.between(0.01, 1.0)]).unwrap();
        let (inside, away) = if random.chance(0.5) {
            let face = Vector::AXES[random.index(3)];
            let away = random.direction();
            (chain.links()[0].local_support_point_toward(face), away - face * away.dot(face))
        } else {
            let away = if random.chance(0.5) { axis } else { random.direction() };
            (points[0].lerp(points[1], random.unit()), away)
        };
        let origin = inside + away * random.log_between(1.0, 1e6);
        let ray = Ray::new(origin, (inside - origin) * random.log_between(1e-3, 1e3));
        let link = &chain.links()[0];
        let Some(time) = link.cast_local_ray(&ray, Real::MAX, true) else { continue };
        far += usize::from((origin - inside).length() > 1e3);
        // The link and the chain agree for every end of the time.
        for most in [time, time.next_down(), time.next_up()] {
            let expected = link.cast_local_ray(&ray, most, true);
            assert_eq!(chain.cast_local_ray(&ray, most, true), expected, "{chain:?} {ray:?}");
        }
    }
    assert!(far > 1000, "{far}");
}
