//! A link is a complete parry shape: its bounds, support points, features and scaled copies fit the
//! true shape.

use crate::draw::{CAPS, Draw, U, surface_point, violation};
use continuum_testing::Random;
use parry_continuum::parry::math::{Pose, Real, Vector};
use parry_continuum::parry::query::{self, PointQuery};
use parry_continuum::parry::shape::{
    Cuboid, FeatureId, PolygonalFeature, PolygonalFeatureMap, Shape, ShapeType, SupportMap,
    TypedShape,
};
use parry_continuum::{Cap, ModifiedCylinder};

#[test]
fn support_points_are_on_the_link_and_no_surface_point_goes_further() {
    let mut random = Random::new(21);
    for _ in 0..3000 {
        let link = random.link();
        let axis = (link.end() - link.start()).normalize_or(Vector::X);
        let direction = match random.index(4) {
            0 => axis * if random.chance(0.5) { 1.0 } else { -1.0 },
            1 => axis.cross(random.direction()).normalize_or(Vector::Y),
            _ => random.direction(),
        };
        let support = link.local_support_point(direction * random.log_between(1e-200, 1e200));
        assert!(violation(&link, support) < 8.0 * U * 8.0, "{link:?} {direction}: {support}");
        for _ in 0..20 {
            let other = surface_point(&mut random, &link);
            assert!(
                (other - support).dot(direction) < 32.0 * U,
                "{link:?} {direction}: {support} for {other}"
            );
        }
    }
}

#[test]
fn a_support_point_of_no_direction_is_on_the_link() {
    for caps in CAPS {
        let link = ModifiedCylinder::new(Vector::ZERO, Vector::X, 0.5, caps).unwrap();
        for direction in [Vector::ZERO, Vector::splat(Real::NAN)] {
            assert!(link.contains_local_point(link.local_support_point(direction)));
        }
    }
}

#[test]
fn boxes_touch_the_link_on_all_six_sides() {
    let mut random = Random::new(22);
    for _ in 0..1000 {
        let (link, pose) = (random.link(), random.pose(2.0));
        let moved = link.transformed(&pose);
        for (link, aabb) in [(link, link.compute_local_aabb()), (moved, link.compute_aabb(&pose))] {
            for axis in Vector::AXES {
                let high = link.local_support_point(axis).dot(axis);
                let low = link.local_support_point(-axis).dot(axis);
                assert!((aabb.maxs.dot(axis) - high).abs() < 64.0 * U, "{link:?} {aabb:?}");
                assert!((aabb.mins.dot(axis) - low).abs() < 64.0 * U, "{link:?} {aabb:?}");
            }
        }
    }
}

/// Holds every surface point; and no smaller ball does, because wherever its centre moved, a
/// surface point on the far side would be further than the radius.
#[test]
fn bounding_spheres_are_the_smallest() {
    let mut random = Random::new(23);
    for _ in 0..500 {
        let link = random.link();
        let sphere = link.compute_local_bounding_sphere();
        let points: Vec<_> = (0..2000).map(|_| surface_point(&mut random, &link)).collect();
        let farthest =
            |centre: Vector| points.iter().map(|p| (p - centre).length()).fold(0.0, Real::max);
        assert!(farthest(sphere.center) <= sphere.radius + 32.0 * U, "{link:?} {sphere:?}");

        // The touching points, a pole by support and a rim by construction, hold the centre between
        // them.
        let axis = (link.end() - link.start()).normalize_or(Vector::X);
        let side = axis.any_orthonormal_vector() * link.radius();
        let mut touching = vec![];
        for (end, centre, outward) in [(0, link.start(), -axis), (1, link.end(), axis)] {
            match link.caps()[end] {
                Cap::Round => touching.push(centre + outward * link.radius()),
                Cap::Flat => touching.extend([centre + side, centre - side]),
            }
        }
        let off = |p: &Vector| ((p - sphere.center).length() - sphere.radius).abs();
        assert!(touching.iter().all(|p| off(p) < 32.0 * U), "{link:?} {sphere:?}");
        let along = |p: &Vector| (p - sphere.center).dot(axis);
        assert!(
            touching.iter().any(|p| along(p) <= 32.0 * U)
                && touching.iter().any(|p| along(p) >= -32.0 * U)
        );
    }
}

#[test]
fn scaling_gives_the_true_image_or_nothing() {
    let mut random = Random::new(24);
    let mut given = 0;
    let count = 4000;
    for _ in 0..count {
        let link = random.link();
        let s = random.log_between(1e-2, 1e2);
        let mut scale = Vector::splat(s);
        if random.chance(0.3) {
            scale[random.index(3)] = random.log_between(1e-2, 1e2);
        }
        for i in 0..3 {
            scale[i] *= if random.chance(0.3) { -1.0 } else { 1.0 };
        }
        let Some(image) = link.scale_dyn(scale, 8) else { continue };
        given += 1;
        // Rounding the scaled end points turns a short link by u over its length.
        let slant = if link.length() > 0.0 { 1.0 + link.radius() / link.length() } else { 1.0 };
        let size = scale.abs().max_element() * slant;
        for _ in 0..20 {
            // The image of the surface is the surface of the image, and so are the pre-images.
            let p = surface_point(&mut random, &link) * scale;
            assert!(
                image.distance_to_local_point(p, false).abs() < 64.0 * U * size,
                "{link:?} {scale}"
            );
        }
        let image = image.as_shape::<ModifiedCylinder>().unwrap();
        for _ in 0..20 {
            let p = surface_point(&mut random, image) / scale;
            let size = size / scale.abs().min_element();
            assert!(
                link.distance_to_local_point(p, false).abs() < 64.0 * U * size,
                "{link:?} {scale}"
            );
        }
    }
    assert!(given > count * 6 / 10 && given < count * 9 / 10, "{given} of {count}");
}

#[test]
fn scaling_refuses_what_would_have_elliptic_sections() {
    let stretch = Vector::new(1.0, 1.0, 2.0);
    let along = |axis: Vector, caps| ModifiedCylinder::new(Vector::ZERO, axis, 0.5, caps).unwrap();
    assert!(along(Vector::Z, [Cap::Flat; 2]).scale_dyn(stretch, 8).is_some());
    assert!(along(Vector::X, [Cap::Flat; 2]).scale_dyn(stretch, 8).is_none());
    assert!(along(Vector::new(1.0, 1.0, 0.0), [Cap::Flat; 2]).scale_dyn(stretch, 8).is_none());
    for caps in &CAPS[1..] {
        assert!(along(Vector::Z, *caps).scale_dyn(stretch, 8).is_none());
        assert!(along(Vector::Z, *caps).scale_dyn(Vector::new(2.0, -2.0, 2.0), 8).is_some());
    }
    // To nothing: a point has no direction for a flat cap. And to infinity and beyond.
    assert!(along(Vector::Z, [Cap::Flat; 2]).scale_dyn(Vector::ZERO, 8).is_none());
    assert!(along(Vector::Z, [Cap::Round; 2]).scale_dyn(Vector::ZERO, 8).is_some());
    for bad in [Real::INFINITY, Real::NAN, 1e301] {
        assert!(along(Vector::Z, [Cap::Round; 2]).scale_dyn(Vector::splat(bad), 8).is_none());
    }
}

#[test]
fn the_thickness_is_that_of_the_largest_ball_inside() {
    let mut random = Random::new(25);
    for _ in 0..500 {
        let link = random.link();
        // The deepest point is on the axis, or past its end within a half ball.
        let span = link.end() - link.start();
        let reach = if span == Vector::ZERO { 0.0 } else { link.radius() / span.length() };
        let point =
            |i| link.start() + span * (Real::from(i) / 2000.0 * (1.0 + 2.0 * reach) - reach);
        let depth = |p| -link.distance_to_local_point(p, false);
        let deepest = (0..=2000).map(point).map(depth).fold(0.0, Real::max);
        let step = (span.length() + 2.0 * link.radius()) / 2000.0;
        let thickness = link.ccd_thickness();
        assert!(
            (deepest - 64.0 * U..=deepest + step + 64.0 * U).contains(&thickness),
            "{link:?}: {thickness}, {deepest}"
        );
    }
}

#[test]
fn feature_polygons_lie_on_the_link_around_the_support_point() {
    let mut random = Random::new(26);
    let (mut squares, mut lines) = (0, 0);
    for _ in 0..5000 {
        let link = random.link();
        let (direction, hint) = (random.direction(), surface_point(&mut random, &link));
        let mut polygon = PolygonalFeature::default();
        if random.chance(0.5) {
            link.local_support_feature(direction, &mut polygon);
        } else {
            link.local_support_feature_toward(direction, hint, &mut polygon);
        }
        let corners = &polygon.vertices[..polygon.num_vertices];
        for corner in corners {
            assert!(
                link.distance_to_local_point(*corner, false).abs() < 64.0 * U,
                "{link:?} {polygon:?}"
            );
        }
        match polygon.num_vertices {
            4 => {
                squares += 1;
                let normal =
                    (corners[1] - corners[0]).cross(corners[2] - corners[1]).normalize_or_zero();
                assert!(
                    link.radius() == 0.0 || normal.dot(direction).abs() > 0.5 - 1e-6,
                    "{polygon:?}"
                );
            }
            2 => lines += 1,
            n => panic!("{n} corners"),
        }
        let ids: Vec<_> = polygon.vids[..polygon.num_vertices].to_vec();
        assert!(ids.iter().enumerate().all(|(i, id)| !ids[..i].contains(id)), "{ids:?}");
    }
    assert!(squares > 800 && lines > 2500, "{squares} squares, {lines} lines");
}

#[test]
fn normals_are_known_for_the_features_a_link_has() {
    let link =
        ModifiedCylinder::new(Vector::ZERO, Vector::Z, 0.5, [Cap::Flat, Cap::Round]).unwrap();
    let normal = |feature, p: [Real; 3]| link.feature_normal_at_point(0, feature, p.into());
    assert_eq!(normal(FeatureId::Face(0), [0.5, 0.0, 0.3]), Some(Vector::X));
    assert_eq!(normal(FeatureId::Face(1), [0.1, 0.2, 0.0]), Some(-Vector::Z));
    assert_eq!(normal(FeatureId::Face(2), [0.0, 0.0, 1.5]), Some(Vector::Z));
    let rim = normal(FeatureId::Edge(0), [0.0, 0.5, 0.0]).unwrap();
    assert!((rim - Vector::new(0.0, 0.5_f64.sqrt(), -(0.5_f64.sqrt()))).length() < 4.0 * U);
    // A half ball has no rim; a wire's barrel no normal; and so on.
    assert_eq!(normal(FeatureId::Edge(1), [0.5, 0.0, 1.0]), None);
    assert_eq!(normal(FeatureId::Face(0), [0.0, 0.0, 0.5]), None);
    assert_eq!(normal(FeatureId::Face(3), [0.5, 0.0, 0.5]), None);
    assert_eq!(normal(FeatureId::Face(0), [Real::NAN, 0.0, 0.5]), None);
}

#[test]
fn a_link_is_a_convex_custom_shape_that_parrys_own_algorithms_accept() {
    let link =
        ModifiedCylinder::new(Vector::ZERO, Vector::X, 0.25, [Cap::Round, Cap::Flat]).unwrap();
    assert_eq!(link.shape_type(), ShapeType::Custom);
    assert!(matches!(link.as_typed_shape(), TypedShape::Custom(_)));
    assert!(
        link.is_convex() && link.as_support_map().is_some() && link.as_composite_shape().is_none()
    );
    assert_eq!(link.clone_dyn().as_shape::<ModifiedCylinder>(), Some(&link));

    let cube = Cuboid::new(Vector::splat(0.5));
    for (place, gap) in [(Vector::new(2.5, 0.0, 0.0), 1.0), (Vector::new(0.5, 3.0, 0.0), 2.25)] {
        let distance =
            query::distance(&Pose::IDENTITY, &link, &Pose::from_translation(place), &cube)
                .unwrap()
                .distance;
        assert!((distance - gap).abs() < 1e-6, "{distance} for {gap}");
    }
}
