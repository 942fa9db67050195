//! Lengths that are small beside the unit of length: gaps, balls, overlaps below the prediction,
//! and boxes that touch within rounding.

use continuum_testing::{Random, rounds};
use parry_continuum::parry::math::{Pose, Real, Vector};
use parry_continuum::parry::query::{ClosestPoints, Contact, QueryDispatcher, ShapeCastOptions};
use parry_continuum::parry::shape::{Ball, Capsule, Compound, Cuboid, Shape, SharedShape};
use parry_continuum::{Chain, ContinuumDispatcher, ModifiedCylinder};

fn contact(pos12: &Pose, g1: &dyn Shape, g2: &dyn Shape, prediction: Real) -> Option<Contact> {
    ContinuumDispatcher::default().contact(pos12, g1, g2, prediction).unwrap()
}

#[test]
fn an_overlap_less_deep_than_asked_for_is_no_contact() {
    let link = ModifiedCylinder::capsule(-Vector::X, Vector::X, 0.5).unwrap();
    let walls = [
        SharedShape::cuboid(1.0, 1.0, 1.0),
        SharedShape::capsule_x(1.0, 1.0),
        SharedShape::new(Compound::new(vec![(Pose::IDENTITY, SharedShape::cuboid(1.0, 1.0, 1.0))])),
        SharedShape::new(ModifiedCylinder::cylinder(-Vector::X, Vector::X, 1.0).unwrap()),
    ];
    for wall in &walls {
        let place = Pose::from_translation(Vector::new(0.1, -1.477, 0.0));
        for (pos12, g1, g2) in
            [(place, &link as &dyn Shape, &**wall), (place.inverse(), &**wall, &link)]
        {
            for prediction in [-0.024, -0.05, -0.5] {
                assert!(
                    contact(&pos12, g1, g2, prediction).is_none(),
                    "{:?} {prediction}",
                    wall.shape_type()
                );
            }
            for prediction in [-0.022, -1e-9, 0.0, 1.0, Real::MAX] {
                let dist = contact(&pos12, g1, g2, prediction).unwrap().dist;
                assert!(
                    (dist + 0.023).abs() < 1e-5,
                    "{:?} {prediction}: {dist}",
                    wall.shape_type()
                );
            }
        }
    }
}

/// All lengths are powers of two times small numbers: every answer is exact.
#[test]
fn a_tiny_ball_beside_a_tiny_link_does_not_touch_it() {
    for unit in [1.0, -40.0, -54.0, -60.0, -200.0].map(Real::exp2) {
        let link = ModifiedCylinder::cylinder(Vector::ZERO, Vector::X * 4.0 * unit, unit).unwrap();
        let ball = Ball::new(unit);
        for (place, expected) in [
            (Vector::new(2.0, 2.5, 0.0), 0.5),
            (Vector::new(2.0, 1.25, 0.0), -0.75),
            (Vector::new(2.0, 1.0, 0.0), -1.0),
            (Vector::new(2.0, 0.75, 0.0), -1.25),
            (Vector::new(-1.5, 0.0, 0.5), 0.5),
            (Vector::new(7.0, 5.0, 0.0), 4.0),
        ] {
            let (place, expected) = (Pose::from_translation(place * unit), expected * unit);
            for (pos12, g1, g2) in
                [(place, &link as &dyn Shape, &ball as &dyn Shape), (place.inverse(), &ball, &link)]
            {
                let dispatcher = ContinuumDispatcher::default();
                let found = contact(&pos12, g1, g2, Real::MAX).unwrap();
                assert_eq!(found.dist, expected, "{unit:e} {place:?}");
                let between = pos12 * found.point2 - found.point1;
                assert!(
                    (between - found.normal1 * found.dist).length() <= 1e-15 * unit,
                    "{unit:e} {found:?}"
                );
                assert_eq!(
                    dispatcher.distance(&pos12, g1, g2).unwrap().distance,
                    expected.max(0.0)
                );
                let meets = dispatcher.intersection_test(&pos12, g1, g2).unwrap().intersecting;
                let closest = dispatcher.closest_points(&pos12, g1, g2, Real::MAX).unwrap();
                assert_eq!(meets, expected <= 0.0, "{unit:e} {place:?}");
                assert_eq!(closest == ClosestPoints::Intersecting, meets, "{unit:e} {place:?}");
            }
        }
    }
}

/// A shape that grazes a part grazes the whole: the boxes of the two touch, up to rounding.
#[test]
fn a_cast_that_grazes_a_part_is_not_rounded_past_the_whole() {
    let (mut random, mut met) = (Random::new(311), 0);
    for _ in 0..rounds(4000) {
        let [r, half, beside, long] = [0; 4].map(|_| random.between(0.1, 3.0));
        let link = ModifiedCylinder::capsule(Vector::ZERO, Vector::Z * long, r).unwrap();
        let part = Cuboid::new(Vector::splat(half));
        let place = Pose::from_translation(Vector::Y * beside);
        let whole = Compound::new(vec![
            (place, SharedShape::new(part)),
            (Pose::from_translation(Vector::Y * 90.0), SharedShape::ball(1.0)),
        ]);
        let chain = Chain::capsules(&[Vector::ZERO, Vector::Z * long], &[r]).unwrap();
        // Beside the box, at exactly the sum of the sizes, up to rounding.
        let pos12 = Pose::from_translation(Vector::new(-9.0, beside + half + r, 0.1));
        let velocity = Vector::X * random.between(0.5, 2.0);
        let options = ShapeCastOptions { stop_at_penetration: false, ..Default::default() };
        let dispatcher = ContinuumDispatcher::default();
        let cast = |pos12: &Pose, g1: &dyn Shape, g2: &dyn Shape| {
            dispatcher.cast_shapes(pos12, velocity, g1, g2, options).unwrap().is_some()
        };
        if cast(&place.inv_mul(&pos12), &part, &link) {
            met += 1;
            assert!(cast(&pos12, &whole, &link), "{r} {half} {beside}");
            assert!(cast(&pos12, &whole, &chain), "{r} {half} {beside}");
        }
    }
    assert!(met > rounds(1000), "{met}");
}

/// The same at rest: what touches a part touches the whole.
#[test]
fn what_touches_a_part_touches_the_whole() {
    let (mut random, mut met) = (Random::new(312), 0);
    for _ in 0..4000 {
        let [r, half, beside] = [0; 3].map(|_| random.between(0.1, 3.0));
        let link = ModifiedCylinder::capsule(Vector::ZERO, Vector::Z, r).unwrap();
        let part = Capsule::new(-Vector::X, Vector::X, half);
        let place = Pose::from_translation(Vector::Y * beside);
        let whole = Compound::new(vec![(place, SharedShape::new(part))]);
        let pos12 = Pose::from_translation(Vector::new(0.1, beside + half + r, 0.0));
        let dispatcher = ContinuumDispatcher::default();
        let of_part = contact(&place.inv_mul(&pos12), &part, &link, 0.0);
        if let Some(of_part) = of_part {
            met += 1;
            let of_whole = contact(&pos12, &whole, &link, 0.0).map(|contact| contact.dist);
            assert_eq!(of_whole, Some(of_part.dist), "{r} {half} {beside}");
        }
        let meets = |pos12: &Pose, g1: &dyn Shape| {
            dispatcher.intersection_test(pos12, g1, &link).unwrap().intersecting
        };
        assert_eq!(
            meets(&place.inv_mul(&pos12), &part),
            meets(&pos12, &whole),
            "{r} {half} {beside}"
        );
    }
    assert!(met > 100, "{met}");
}
