//! Point queries.

use crate::draw::{Draw, U, extent, largest, violation};
use crate::point_ray::{point_near, reach};
use continuum_testing::Random;
use parry_continuum::parry::math::{Real, Vector};
use parry_continuum::parry::query::PointQuery;
use parry_continuum::parry::shape::{Capsule, Cylinder, FeatureId, Shape};
use parry_continuum::{Cap, ModifiedCylinder};

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
        assert!(
            violation(&link, projection.point).abs() <= 8.0 * U * (coordinates + size),
            "{}",
            context()
        );

        if distance > 0.0 {
            outside += 1;
            // No support point along the outward normal comes closer to `p`: a lower bound for
            // any normal. On a rim the normal is the difference of the witnesses, which is
            // imprecise if they are close.
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
    assert!(
        inner_pieces.iter().all(|&visits| visits > inside / 20),
        "{inner_pieces:?} of {inside}"
    );
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
        let pairs: [(&dyn Shape, &dyn Shape); 2] = [
            (&capsule, &Capsule::new(start, end, radius)),
            (&cylinder, &Cylinder::new(half, radius)),
        ];
        for (ours, theirs) in pairs {
            for solid in [false, true] {
                let (a, b) = (
                    ours.distance_to_local_point(p, solid),
                    theirs.distance_to_local_point(p, solid),
                );
                assert!((a - b).abs() < 1e-14, "{a} for {b} at {p}, half {half}, radius {radius}");
            }
            assert_eq!(ours.contains_local_point(p), theirs.contains_local_point(p));
        }
    }
}

/// A flat end is nearer than the round one, though the round end's half ball holds the point: 0.15
/// to the disc, 0.95 to the half ball.
#[test]
fn inside_a_short_link_the_far_flat_end_can_be_the_nearest() {
    let link =
        ModifiedCylinder::new(Vector::ZERO, 0.1 * Vector::Z, 1.0, [Cap::Flat, Cap::Round]).unwrap();
    let (projection, feature) = link.project_local_point_and_get_feature(0.15 * Vector::Z);
    assert!((projection.point - Vector::ZERO).length() < 1e-16 && projection.is_inside);
    assert_eq!(feature, FeatureId::Face(1));
}

#[test]
fn on_the_axis_any_way_out_is_taken_but_a_whole_radius_long() {
    let mut random = Random::new(17);
    for _ in 0..2000 {
        let (start, axis, radius) =
            (random.vector(1.0), random.direction(), random.log_between(1e-3, 1.0));
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
