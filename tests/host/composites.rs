//! Queries on composites are the best of those on their parts.

use crate::dispatcher::ROUNDING;
use crate::scene::{floor_field, floor_mesh, heap, parts, tube, zigzag};
use continuum_testing::placements::{Placement, Wall};
use continuum_testing::{Random, rounds};
use parry_continuum::parry::math::{IVector, Pose, Real, Vector};
use parry_continuum::parry::query::{
    ClosestPoints, ContactManifold, NonlinearRigidMotion, PersistentQueryDispatcher,
    QueryDispatcher, ShapeCastOptions,
};
use parry_continuum::parry::shape::{
    Ball, Compound, Cuboid, HeightField, Shape, SharedShape, Voxels,
};
use parry_continuum::parry::utils::Array2;
use parry_continuum::{Chain, ContinuumDispatcher};

/// Every pair of a robot and a composite, with the poses that bring them near each other; half of
/// them aligned.
pub fn composites(random: &mut Random) -> Vec<(&'static str, SharedShape, SharedShape, Pose)> {
    let mut pairs: Vec<(&'static str, SharedShape, SharedShape, Pose)> = vec![];
    let chain = tube(random);
    let link = SharedShape::new(chain.links()[1]);
    let chain = SharedShape::new(chain);
    for robot in [link, chain] {
        for (name, other) in [
            ("compound", SharedShape::new(heap(random))),
            ("mesh", SharedShape::new(floor_mesh())),
            ("field", SharedShape::new(floor_field())),
            ("polyline", SharedShape::new(zigzag(random))),
            ("chain", SharedShape::new(tube(random))),
        ] {
            let place =
                Pose::new(Vector::new(0.0, random.between(-0.2, 0.7), 0.0), random.direction());
            pairs.push((name, robot.clone(), other, place.inverse()));
        }
    }
    for (name, kind) in [
        ("compound", Wall::Compound),
        ("mesh", Wall::BoxMesh),
        ("field", Wall::HeightField),
        ("polyline", Wall::Polyline),
        ("chain", Wall::Chain),
    ] {
        for _ in 0..2 {
            let Placement { robot, wall, pose, .. } = random.placement(kind);
            pairs.push((name, robot, wall, pose));
        }
    }
    pairs
}

/// A query on a composite is the best of the dispatcher's queries on its parts, one by one.
#[test]
fn composites_get_the_best_of_their_parts() {
    let dispatcher = ContinuumDispatcher::default();
    let mut random = Random::new(42);
    let mut visits = std::collections::BTreeMap::new();
    for _ in 0..rounds(40) {
        for (name, robot, other, pos12) in composites(&mut random) {
            for (first, second, pos12) in
                [(&robot, &other, pos12), (&other, &robot, pos12.inverse())]
            {
                let (g1, g2): (&dyn Shape, &dyn Shape) = (&**first, &**second);
                let pair = |id1: u32, id2: u32| {
                    let (parts1, parts2) = (parts(g1), parts(g2));
                    let part1 = parts1.into_iter().find(|part| part.0 == id1).unwrap();
                    let part2 = parts2.into_iter().find(|part| part.0 == id2).unwrap();
                    (part1.1.inv_mul(&(pos12 * part2.1)), part1.2, part2.2)
                };
                let mut least = Real::INFINITY;
                for (_, pose1, part1) in parts(g1) {
                    for (_, pose2, part2) in parts(g2) {
                        let pose = pose1.inv_mul(&(pos12 * pose2));
                        least = least
                            .min(dispatcher.distance(&pose, &*part1, &*part2).unwrap().distance);
                    }
                }
                // GJK answers for the pairs that are not ours, at its own accuracy.
                let tolerance = if matches!(name, "mesh" | "field") { ROUNDING } else { 1e-5 };

                let answer = dispatcher.distance(&pos12, g1, g2).unwrap();
                assert!(
                    (answer.distance - least).abs() <= tolerance,
                    "{name}: {answer:?} for {least}"
                );
                let (pose, part1, part2) = pair(answer.subshape1, answer.subshape2);
                let again = dispatcher.distance(&pose, &*part1, &*part2).unwrap().distance;
                assert!(
                    (again - least).abs() <= tolerance,
                    "{name}: ids of {answer:?}, but {again} for {least}"
                );

                let meets = dispatcher.intersection_test(&pos12, g1, g2).unwrap();
                // Where they touch, the rounding of a part's pose decides.
                let depth = dispatcher.contact(&pos12, g1, g2, Real::MAX).unwrap().unwrap().dist;
                let touches = least <= tolerance && depth.abs() <= tolerance;
                assert!(
                    touches || meets.intersecting == (least == 0.0),
                    "{name}: {meets:?} for {least}, {depth}"
                );
                if meets.intersecting {
                    let (pose, part1, part2) = pair(meets.subshape1, meets.subshape2);
                    // The part's pose is rounded once more here.
                    let again = dispatcher.distance(&pose, &*part1, &*part2).unwrap().distance;
                    assert!(
                        again <= tolerance,
                        "{name}: {meets:?}, but {again} {:?} {:?}",
                        part1.shape_type(),
                        part2.shape_type()
                    );
                }

                let contact = dispatcher.contact(&pos12, g1, g2, least + 0.01).unwrap();
                let contact = contact.unwrap_or_else(|| panic!("{name}: no contact at {least}"));
                assert!(
                    (contact.dist.max(0.0) - least).abs() <= tolerance.max(1e-5),
                    "{name}: {contact:?} {least}"
                );
                let (pose, part1, part2) = pair(contact.subshape1, contact.subshape2);
                let again = dispatcher.distance(&pose, &*part1, &*part2).unwrap().distance;
                assert!(
                    (again - least).abs() <= tolerance.max(1e-5),
                    "{name}: {contact:?}, but {again}"
                );

                if touches {
                    let near = dispatcher.closest_points(&pos12, g1, g2, 1.0).unwrap();
                    let meets = match near {
                        ClosestPoints::Intersecting => true,
                        ClosestPoints::WithinMargin(p1, p2) => {
                            (p1 - pos12 * p2).length() <= tolerance
                        }
                        ClosestPoints::Disjoint => false,
                    };
                    assert!(meets, "{name}: {near:?} at {least}");
                } else if least > 0.0 {
                    let near = dispatcher.closest_points(&pos12, g1, g2, least + 1e-4).unwrap();
                    let ClosestPoints::WithinMargin(p1, p2) = near else {
                        panic!("{name}: {near:?} at {least}")
                    };
                    assert!(((p1 - pos12 * p2).length() - least).abs() <= tolerance, "{name}");
                    let far = dispatcher.closest_points(&pos12, g1, g2, 0.9 * least).unwrap();
                    assert_eq!(far, ClosestPoints::Disjoint, "{name}");
                    assert_eq!(
                        dispatcher.contact(&pos12, g1, g2, 0.9 * least).unwrap(),
                        None,
                        "{name}"
                    );
                } else {
                    let near = dispatcher.closest_points(&pos12, g1, g2, 1.0).unwrap();
                    assert_eq!(near, ClosestPoints::Intersecting, "{name}");
                }
                let tally = visits.entry(name).or_insert([0; 2]);
                tally[usize::from(least == 0.0)] += 1;
            }
        }
    }
    assert!(visits.len() == 5 && visits.values().flatten().all(|&n| n >= rounds(5)), "{visits:?}");
}

/// parry's routines for voxels have absolute tolerances, so links refuse them in every query.
#[test]
fn voxels_are_refused_by_robots_and_left_to_parry_by_others() {
    let voxels = Voxels::new(Vector::ONE, &[IVector::new(0, 0, 0), IVector::new(1, 0, 0)]);
    let chain = Chain::cylinders(&[-Vector::Y, Vector::ZERO, Vector::Y], &[0.25, 0.25]).unwrap();
    let link = chain.links()[0];
    let compound = Compound::new(vec![
        (Pose::IDENTITY, SharedShape::ball(0.25)),
        (Pose::IDENTITY, SharedShape::new(link)),
    ]);
    let (cuboid, dispatcher) = (Cuboid::new(Vector::splat(0.25)), ContinuumDispatcher::default());
    let place = Pose::from_translation(Vector::splat(0.5));
    let shapes: [(&dyn Shape, bool); 4] =
        [(&chain, false), (&link, false), (&compound, false), (&cuboid, true)];
    for (shape, is_answered) in shapes {
        let still = NonlinearRigidMotion::identity();
        let comes = NonlinearRigidMotion { linvel: Vector::X, ..still };
        for (g1, g2, pos12) in
            [(&voxels as &dyn Shape, shape, place), (shape, &voxels, place.inverse())]
        {
            let options = ShapeCastOptions::default();
            let mut found = Vec::<ContactManifold<(), ()>>::new();
            let answers = [
                dispatcher.intersection_test(&pos12, g1, g2).is_ok(),
                dispatcher.cast_shapes(&pos12, Vector::X, g1, g2, options).is_ok(),
                dispatcher.cast_shapes_nonlinear(&still, g1, &comes, g2, 0.0, 1.0, true).is_ok(),
                dispatcher.contact_manifolds(&pos12, g1, g2, 0.1, &mut found, &mut None).is_ok(),
            ];
            assert_eq!(answers, [is_answered; 4], "{:?}", shape.shape_type());
            assert!(is_answered || found.is_empty());
            assert!(dispatcher.distance(&pos12, g1, g2).is_err());
            assert!(dispatcher.contact(&pos12, g1, g2, 0.1).is_err());
            assert!(dispatcher.closest_points(&pos12, g1, g2, 0.1).is_err());
        }
    }
}

/// parry finds no cell of what a negative scale mirrors.
#[test]
fn mirrored_height_fields_are_refused() {
    let field = HeightField::new(Array2::new(3, 3, vec![1.0; 9]), Vector::new(2.0, 1.0, 2.0));
    let robot =
        Chain::capsules(&[Vector::new(-0.9, 0.9, 0.3), Vector::new(0.9, 1.1, 0.4)], &[0.25])
            .unwrap();
    let dispatcher = ContinuumDispatcher::default();
    let mirrors = [Vector::new(-1.0, 1.0, 1.0), Vector::new(1.0, -1.0, 1.0)];
    for scale in mirrors.into_iter().chain([Vector::ONE]) {
        let wall = SharedShape::new(field.clone().scaled(scale));
        let ball = Ball::new(0.1);
        let far = Pose::from_translation(Vector::splat(1e3));
        let meets =
            dispatcher.intersection_test(&far, &*wall, &ball).map(|found| found.intersecting);
        assert_eq!(meets.ok(), (scale == Vector::ONE).then_some(false));
        let pairs: [[&dyn Shape; 2]; 2] = [[&robot, &*wall], [&*wall, &robot]];
        for [g1, g2] in pairs {
            let found = dispatcher.intersection_test(&Pose::IDENTITY, g1, g2);
            let hit = dispatcher.cast_shapes(
                &Pose::IDENTITY,
                Vector::Y,
                g1,
                g2,
                ShapeCastOptions::default(),
            );
            let still = NonlinearRigidMotion::identity();
            let turned = dispatcher.cast_shapes_nonlinear(&still, g1, &still, g2, 0.0, 1.0, true);
            let (mut manifolds, mut workspace) = (Vec::<ContactManifold<(), ()>>::new(), None);
            let manifold = dispatcher.contact_manifolds(
                &Pose::IDENTITY,
                g1,
                g2,
                0.1,
                &mut manifolds,
                &mut workspace,
            );
            if scale == Vector::ONE {
                assert!(found.unwrap().intersecting);
                assert!(hit.unwrap().is_some() && turned.unwrap().is_some() && manifold.is_ok());
            } else {
                assert!(found.is_err() && hit.is_err() && turned.is_err() && manifold.is_err());
                assert!(dispatcher.distance(&Pose::IDENTITY, g1, g2).is_err());
                assert!(dispatcher.contact(&Pose::IDENTITY, g1, g2, 0.1).is_err());
                assert!(dispatcher.closest_points(&Pose::IDENTITY, g1, g2, 0.1).is_err());
            }
        }
    }
}
