//! A chain is to parry the union of its links where that is what counts, and a compound of them
//! elsewhere.

use crate::draw::{Draw, U, surface_point};
use continuum_testing::Random;
use parry_continuum::parry::mass_properties::MassProperties;
use parry_continuum::parry::math::{Pose, Real, Vector};
use parry_continuum::parry::query::{PointQuery, Ray, RayCast};
use parry_continuum::parry::shape::{Compound, FeatureId, Shape, SharedShape, TypedShape};
use parry_continuum::{Chain, ModifiedCylinder};

/// A bent tube with a step in its radius.
fn chain(random: &mut Random) -> Chain {
    let mut points = vec![random.vector(1.0)];
    let mut heading = random.direction();
    for _ in 0..8 {
        heading = (heading + random.vector(0.5)).normalize();
        points.push(points[points.len() - 1] + heading * random.between(0.1, 0.5));
    }
    let radius = random.between(0.05, 0.3);
    let radii: Vec<_> = (0..8).map(|i| if i < 4 { radius } else { 0.6 * radius }).collect();
    Chain::from_centreline(&points, &radii).unwrap()
}

/// parry's composite of the same links.
fn compound(chain: &Chain) -> Compound {
    Compound::new(
        chain.links().iter().map(|link| (Pose::IDENTITY, SharedShape::new(*link))).collect(),
    )
}

fn point_near(random: &mut Random, chain: &Chain) -> Vector {
    let link = chain.links()[random.index(chain.links().len())];
    let surface = surface_point(random, &link);
    match random.index(3) {
        0 => surface + random.vector(0.1),
        1 => link.start().lerp(surface, random.unit()),
        _ => surface + random.vector(1.0),
    }
}

#[test]
fn points_see_the_union_from_outside_and_the_compound_from_inside() {
    let mut random = Random::new(31);
    let (mut inside, mut outside, mut in_two) = (0, 0, 0);
    for _ in 0..300 {
        let chain = chain(&mut random);
        let compound = compound(&chain);
        for _ in 0..20 {
            let p = point_near(&mut random, &chain);
            let holders = chain.links().iter().filter(|link| link.contains_local_point(p)).count();
            let nearest =
                chain.links().iter().map(|link| link.distance_to_local_point(p, false).abs());
            let nearest = nearest.fold(Real::INFINITY, Real::min);
            let signed = chain.distance_to_local_point(p, false);
            assert_eq!(signed, if holders > 0 { -nearest } else { nearest });
            assert_eq!(chain.distance_to_local_point(p, true), signed.max(0.0));
            assert_eq!(chain.contains_local_point(p), holders > 0);

            for solid in [false, true] {
                let (ours, theirs) =
                    (chain.project_local_point(p, solid), compound.project_local_point(p, solid));
                assert_eq!(ours.is_inside, holders > 0);
                let (a, b) = ((ours.point - p).length(), (theirs.point - p).length());
                assert!((a - b).abs() < 16.0 * U * 8.0, "{ours:?} for {theirs:?}");
                let link = chain.links()[ours.subshape as usize];
                assert!(link.distance_to_local_point(ours.point, true) < 16.0 * U * 8.0);
            }
            let (projection, feature) = chain.project_local_point_and_get_feature(p);
            assert_eq!(projection.point, chain.project_local_point(p, false).point);
            assert_ne!(feature, FeatureId::Unknown);
            let normal =
                chain.feature_normal_at_point(projection.subshape, feature, projection.point);
            assert!(normal.is_some());
            inside += usize::from(holders > 0);
            in_two += usize::from(holders > 1);
            outside += usize::from(holders == 0);
        }
    }
    assert!(
        inside > 1500 && outside > 1500 && in_two > 300,
        "{inside} inside, {in_two} twice, {outside} outside"
    );
}

#[test]
fn rays_hit_the_first_link() {
    let mut random = Random::new(32);
    let (mut hits, mut misses) = (0, 0);
    for _ in 0..300 {
        let chain = chain(&mut random);
        for _ in 0..20 {
            let (origin, target) =
                (point_near(&mut random, &chain), point_near(&mut random, &chain));
            let ray = Ray::new(origin, target - origin);
            for solid in [true, false] {
                let each =
                    chain.links().iter().filter_map(|link| link.cast_local_ray(&ray, 3.0, solid));
                let first = each.reduce(Real::min);
                let hit = chain.cast_local_ray_and_get_normal(&ray, 3.0, solid);
                assert_eq!(hit.map(|hit| hit.time_of_impact), first);
                if let Some(hit) = hit {
                    hits += 1;
                    let link = chain.links()[hit.subshape as usize];
                    let own = link.cast_local_ray_and_get_normal(&ray, 3.0, solid).unwrap();
                    assert_eq!((hit.time_of_impact, hit.normal), (own.time_of_impact, own.normal));
                    // The bound counts as reached.
                    assert!(chain.cast_local_ray(&ray, hit.time_of_impact, solid).is_some());
                } else {
                    misses += 1;
                }
            }
        }
    }
    assert!(hits > 4000 && misses > 1000, "{hits} hits, {misses} misses");
}

#[test]
fn nothing_is_near_a_point_that_is_not_finite() {
    let chain = chain(&mut Random::new(33));
    for bad in [Real::NAN, Real::INFINITY] {
        let p = Vector::new(bad, 0.0, 0.0);
        assert!(
            !chain.distance_to_local_point(p, true).is_finite() && !chain.contains_local_point(p)
        );
        assert!(!chain.project_local_point(p, true).is_inside);
        assert_eq!(chain.project_local_point_and_get_feature(p).1, FeatureId::Unknown);
        assert!(chain.cast_local_ray(&Ray::new(p, Vector::X), 9.0, true).is_none());
    }
    // Far away is a place all the same.
    let far = Vector::splat(1e200);
    assert!(chain.distance_to_local_point(far, true) > 1e200);
    assert!(chain.project_local_point(far, true).point.length() < 1e3);
}

#[test]
fn bounds_hold_the_links_and_boxes_touch_them() {
    let mut random = Random::new(34);
    for _ in 0..200 {
        let (chain, pose) = (chain(&mut random), random.pose(2.0));
        let ball = chain.compute_local_bounding_sphere();
        for k in [-900, 300] {
            let unit = Real::powi(2.0, k);
            let scaled =
                chain.scale_dyn(Vector::splat(unit), 4).unwrap().compute_local_bounding_sphere();
            assert!(
                (scaled.radius / unit - ball.radius).abs() < 32.0 * U,
                "2^{k}: {scaled:?} {ball:?}"
            );
        }
        for (aabb, pose) in
            [(chain.compute_local_aabb(), Pose::IDENTITY), (chain.compute_aabb(&pose), pose)]
        {
            let moved: Vec<_> = chain.links().iter().map(|link| link.transformed(&pose)).collect();
            for axis in Vector::AXES {
                let reach = |direction| {
                    let each = moved
                        .iter()
                        .map(|link| link.as_support_map().unwrap().local_support_point(direction));
                    each.map(|p| p.dot(direction)).fold(Real::NEG_INFINITY, Real::max)
                };
                assert!((aabb.maxs.dot(axis) - reach(axis)).abs() < 64.0 * U);
                assert!((aabb.mins.dot(axis) + reach(-axis)).abs() < 64.0 * U);
            }
        }
        for link in chain.links() {
            for _ in 0..20 {
                let p = surface_point(&mut random, link);
                assert!((p - ball.center).length() <= ball.radius + 32.0 * U);
            }
        }
    }
}

#[test]
fn masses_add_up() {
    let mut random = Random::new(35);
    for _ in 0..50 {
        let chain = chain(&mut random);
        let parts: Vec<_> =
            chain.links().iter().map(|&link| (Pose::IDENTITY, SharedShape::new(link))).collect();
        let expected = MassProperties::from_compound(7.0, &parts);
        let actual = chain.mass_properties(7.0);
        assert!((actual.mass() - expected.mass()).abs() <= 1e-14 * expected.mass());
        assert!((actual.local_com - expected.local_com).length() < 1e-14);
        // Two capsules in a row share a ball.
        let points = [Vector::ZERO, Vector::X, 2.0 * Vector::X];
        let (one, two) =
            (Chain::capsules(&points[..2], &[0.3]), Chain::capsules(&points, &[0.3, 0.3]));
        let (one, two) = (one.unwrap().mass_properties(1.0), two.unwrap().mass_properties(1.0));
        assert!((two.mass() - 2.0 * one.mass()).abs() < 1e-15);
    }
    let wire = Chain::capsules(&[Vector::ZERO, Vector::X], &[0.0]).unwrap().mass_properties(1.0);
    assert_eq!(wire.mass(), 0.0);
    assert!(wire.local_com.is_finite() && wire.principal_inertia() == Vector::ZERO);
}

#[test]
fn a_chain_scales_when_all_its_links_do() {
    let mut random = Random::new(36);
    let tube = chain(&mut random);
    let image = tube.scale_dyn(Vector::new(2.0, -2.0, 2.0), 8).unwrap();
    let image = image.as_shape::<Chain>().unwrap();
    assert_eq!(image.links().len(), tube.links().len());
    for (link, twice) in tube.links().iter().zip(image.links()) {
        assert_eq!((twice.radius(), twice.caps()), (2.0 * link.radius(), link.caps()));
        assert_eq!(twice.end(), link.end() * Vector::new(2.0, -2.0, 2.0));
    }
    assert_eq!(image.segments_of(3), tube.segments_of(3));
    let p = random.vector(1.0);
    let distance = image.distance_to_local_point(p * Vector::new(2.0, -2.0, 2.0), true);
    assert!((distance - 2.0 * tube.distance_to_local_point(p, true)).abs() < 64.0 * U);
    assert!(tube.scale_dyn(Vector::new(1.0, 2.0, 1.0), 8).is_none());
}

#[test]
fn a_chain_is_a_composite_of_its_links() {
    let chain = chain(&mut Random::new(37));
    assert!(matches!(chain.as_typed_shape(), TypedShape::Custom(_)));
    assert!(chain.as_support_map().is_none() && !chain.is_convex());
    assert_eq!(chain.clone_dyn().as_shape::<Chain>(), Some(&chain));
    let composite = chain.as_composite_shape().unwrap();
    assert_eq!(composite.bvh().leaf_count(), chain.links().len() as u32);
    for (id, link) in chain.links().iter().enumerate() {
        let mut visits = 0;
        composite.map_part_at(id as u32, &mut |pose, part, _| {
            visits += 1;
            assert!(pose.is_none());
            assert_eq!(part.as_shape::<ModifiedCylinder>(), Some(link));
        });
        assert_eq!(visits, 1);
        let leaf = composite.bvh().leaf_node(id as u32).unwrap().aabb();
        assert_eq!(leaf, link.compute_local_aabb());
    }
    composite.map_part_at(99, &mut |_, _, _| panic!("there is no link 99"));
    let thinnest = chain.links().iter().map(ModifiedCylinder::radius).fold(Real::MAX, Real::min);
    assert_eq!(chain.ccd_thickness(), thinnest);
}

/// A joint is no end: how often a chain is divided does not change its thickness.
#[test]
fn a_chain_of_discs_is_as_thick_as_one_of_long_links() {
    for (length, thickness) in [(3.0, 0.25), (0.1, 0.05)] {
        for count in [1, 3, 300] {
            let point = |k: usize| Vector::X * (length * k as Real / count as Real);
            let points: Vec<_> = (0..=count).map(point).collect();
            let chain = Chain::cylinders(&points, &vec![0.25; count]).unwrap();
            assert!((chain.ccd_thickness() - thickness).abs() < 1e-15, "{length} {count}");
        }
    }
}
