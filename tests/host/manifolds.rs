//! Contact manifolds are found through every composite in both orders, and refused where a pair is.

use crate::draw::Draw;
use crate::scene::{floor_field, floor_mesh, heap, tube};
use continuum_testing::Random;
use continuum_testing::placements::{Placement, Wall};
use parry_continuum::parry::math::{Pose, Real, Vector};
use parry_continuum::parry::query::details::NormalConstraints;
use parry_continuum::parry::query::*;
use parry_continuum::parry::shape::{Compound, Cuboid, Shape, SharedShape, TriMesh, Triangle};
use parry_continuum::{Cap, Chain, ContinuumDispatcher, ModifiedCylinder};
use std::collections::BTreeSet;

type Manifold = ContactManifold<(), ()>;

fn manifolds(
    dispatcher: &impl PersistentQueryDispatcher<(), ()>,
    pos12: &Pose,
    g1: &dyn Shape,
    g2: &dyn Shape,
    prediction: Real,
) -> Result<Vec<Manifold>, Unsupported> {
    let (mut manifolds, mut workspace) = (vec![], None);
    // Twice, because parry updates the previous manifold.
    dispatcher.contact_manifolds(pos12, g1, g2, prediction, &mut manifolds, &mut workspace)?;
    dispatcher.contact_manifolds(pos12, g1, g2, prediction, &mut manifolds, &mut workspace)?;
    Ok(manifolds)
}

#[test]
fn what_is_near_touches_in_a_manifold() {
    let dispatcher = ContinuumDispatcher::default();
    let mut random = Random::new(71);
    let (mut near, mut far) = (0, 0);
    for _ in 0..30 {
        let chain = tube(&mut random);
        let link = chain.links()[2];
        let others: [SharedShape; 4] = [
            SharedShape::new(floor_mesh()),
            SharedShape::new(floor_field()),
            SharedShape::new(heap(&mut random)),
            SharedShape::new(tube(&mut random)),
        ];
        let robots: [&dyn Shape; 2] = [&chain, &link];
        let mut pairs = vec![];
        for (robot, other) in
            robots.into_iter().flat_map(|robot| others.iter().map(move |other| (robot, other)))
        {
            let pose =
                Pose::new(Vector::new(0.0, random.between(-0.3, 0.5), 0.0), random.direction());
            pairs.push((SharedShape(robot.clone_dyn().into()), other.clone(), pose.inverse()));
        }
        for kind in [Wall::BoxMesh, Wall::Plate, Wall::HeightField, Wall::Compound, Wall::Chain] {
            let Placement { robot, wall, pose, .. } = random.placement(kind);
            pairs.push((robot, wall, pose));
        }
        for (robot, other, pose) in &pairs {
            for (g1, g2, pos12) in
                [(&**robot, &**other, *pose), (&**other, &**robot, pose.inverse())]
            {
                let apart = dispatcher.distance(&pos12, g1, g2).unwrap().distance;
                let found = manifolds(&dispatcher, &pos12, g1, g2, 0.02).unwrap();
                let points: Vec<_> =
                    found.iter().flat_map(|m| m.points.iter().map(move |p| (m, p))).collect();
                if apart < 0.015 {
                    near += 1;
                    assert!(
                        !points.is_empty(),
                        "{:?} and {:?} at {apart}",
                        g1.shape_type(),
                        g2.shape_type()
                    );
                } else if apart > 0.025 {
                    far += 1;
                    assert!(points.iter().all(|(_, p)| p.dist > 0.0), "{points:?} at {apart}");
                }
                for (manifold, point) in points {
                    let place = |pose: Option<&Pose>, p| pose.map_or(p, |pose| pose * p);
                    let p1 = place(manifold.subshape_pos1(), point.local_p1);
                    let p2 = place(manifold.subshape_pos2(), point.local_p2);
                    assert!(p1.is_finite() && p2.is_finite() && point.dist.is_finite());
                }
            }
        }
    }
    assert!(near > 60 && far > 60, "{near} near, {far} far");
}

/// A cylinder lying 0.01 deep in a floor touches it along its barrel, standing on it along its cap.
#[test]
fn a_cylinder_lies_on_a_line_and_stands_on_a_square() {
    let dispatcher = ContinuumDispatcher::default();
    let corners = [(-9.0, -9.0), (9.0, -9.0), (9.0, 9.0), (-9.0, 9.0)];
    let vertices = corners.map(|(x, z)| Vector::new(x, 0.0, z)).to_vec();
    let floor = TriMesh::new(vertices, vec![[0, 2, 1], [0, 3, 2]]).unwrap();
    let deep = |manifolds: &[Manifold]| -> Vec<Real> {
        manifolds
            .iter()
            .flat_map(|m| m.points.iter().map(|p| p.dist))
            .filter(|dist| *dist < 0.0)
            .collect()
    };
    let lying = ModifiedCylinder::cylinder(-Vector::X, Vector::X, 0.5).unwrap();
    let place = Pose::from_translation(Vector::new(2.0, 0.49, -3.0));
    let found = deep(&manifolds(&dispatcher, &place, &floor, &lying, 0.02).unwrap());
    assert!(found.len() >= 2 && found.iter().all(|dist| (dist + 0.01).abs() < 1e-6), "{found:?}");

    let standing =
        ModifiedCylinder::new(Vector::ZERO, Vector::Y, 0.5, [Cap::Flat, Cap::Round]).unwrap();
    let place = Pose::from_translation(Vector::new(2.0, -0.01, -3.0));
    let found = deep(&manifolds(&dispatcher, &place, &floor, &standing, 0.02).unwrap());
    assert!(found.len() >= 3 && found.iter().all(|dist| (dist + 0.01).abs() < 1e-6), "{found:?}");
}

/// What this crate leaves to parry is answered or refused: an overlap never reads as no contact.
#[test]
fn every_other_shape_answers_or_is_refused() {
    let dispatcher = ContinuumDispatcher::default();
    let tip = [Vector::ZERO, Vector::X, Vector::Y, Vector::Z];
    let shapes = [
        SharedShape::ball(0.5),
        SharedShape::capsule_y(0.5, 0.3),
        SharedShape::cuboid(0.5, 0.5, 0.5),
        SharedShape::cylinder(0.5, 0.4),
        SharedShape::cone(0.5, 0.4),
        SharedShape::halfspace(Vector::Y),
        SharedShape::segment(-Vector::X, Vector::X),
        SharedShape::convex_hull(&tip).unwrap(),
        SharedShape::round_cuboid(0.4, 0.4, 0.4, 0.1),
        SharedShape::round_cylinder(0.4, 0.3, 0.1),
        SharedShape::polyline(vec![-Vector::X, Vector::ZERO, Vector::Z], None),
        SharedShape::new(ModifiedCylinder::cylinder(-Vector::X, Vector::X, 0.3).unwrap()),
    ];
    let mut answered = BTreeSet::new();
    let mut random = Random::new(73);
    for caps in crate::draw::CAPS {
        let link =
            ModifiedCylinder::new(Vector::new(0.0, -0.5, 0.0), Vector::Y, 0.25, caps).unwrap();
        let chain =
            Chain::from_centreline(&[-Vector::Y, 0.1 * Vector::Y, Vector::Y], &[0.25; 2]).unwrap();
        for robot in [&link as &dyn Shape, &chain] {
            for (kind, shape) in shapes.iter().enumerate() {
                let pose = Pose::new(random.vector(0.05), random.direction() * 0.2);
                for (g1, g2, pos12) in [(robot, &**shape, pose), (&**shape, robot, pose.inverse())]
                {
                    let Ok(found) = manifolds(&dispatcher, &pos12, g1, g2, 0.02) else { continue };
                    answered.insert(kind);
                    let deepest = found.iter().flat_map(|m| &m.points).map(|point| point.dist);
                    let deepest = deepest.fold(Real::INFINITY, Real::min);
                    assert!(
                        deepest < 0.0,
                        "{:?} against {:?}: {deepest}",
                        caps,
                        shape.shape_type()
                    );
                }
            }
        }
    }
    // parry has no contacts for segments in three dimensions... and says so.
    assert!(answered.len() >= 10, "{answered:?}");
}

/// Knows nothing.
struct Ignorant;

impl QueryDispatcher for Ignorant {
    fn intersection_test(
        &self,
        _: &Pose,
        _: &dyn Shape,
        _: &dyn Shape,
    ) -> Result<ShapeIntersection, Unsupported> {
        Err(Unsupported)
    }
    fn distance(
        &self,
        _: &Pose,
        _: &dyn Shape,
        _: &dyn Shape,
    ) -> Result<ShapeDistance, Unsupported> {
        Err(Unsupported)
    }
    fn contact(
        &self,
        _: &Pose,
        _: &dyn Shape,
        _: &dyn Shape,
        _: Real,
    ) -> Result<Option<Contact>, Unsupported> {
        Err(Unsupported)
    }
    fn closest_points(
        &self,
        _: &Pose,
        _: &dyn Shape,
        _: &dyn Shape,
        _: Real,
    ) -> Result<ClosestPoints, Unsupported> {
        Err(Unsupported)
    }
    fn cast_shapes(
        &self,
        _: &Pose,
        _: Vector,
        _: &dyn Shape,
        _: &dyn Shape,
        _: ShapeCastOptions,
    ) -> Result<Option<ShapeCastHit>, Unsupported> {
        Err(Unsupported)
    }
    fn cast_shapes_nonlinear(
        &self,
        _: &NonlinearRigidMotion,
        _: &dyn Shape,
        _: &NonlinearRigidMotion,
        _: &dyn Shape,
        _: Real,
        _: Real,
        _: bool,
    ) -> Result<Option<ShapeCastHit>, Unsupported> {
        Err(Unsupported)
    }
}

impl PersistentQueryDispatcher<(), ()> for Ignorant {
    fn contact_manifolds(
        &self,
        _: &Pose,
        _: &dyn Shape,
        _: &dyn Shape,
        _: Real,
        _: &mut Vec<Manifold>,
        _: &mut Option<ContactManifoldsWorkspace>,
    ) -> Result<(), Unsupported> {
        Err(Unsupported)
    }
    fn contact_manifold_convex_convex(
        &self,
        _: &Pose,
        _: &dyn Shape,
        _: &dyn Shape,
        _: Option<&dyn NormalConstraints>,
        _: Option<&dyn NormalConstraints>,
        _: Real,
        _: &mut Manifold,
    ) -> Result<(), Unsupported> {
        Err(Unsupported)
    }
}

#[test]
fn a_pair_that_is_refused_has_no_manifold() {
    let mut random = Random::new(72);
    let (chain, cuboid) = (tube(&mut random), SharedShape::new(Cuboid::new(Vector::ONE)));
    let cuboids = Compound::new(vec![(Pose::IDENTITY, cuboid)]);
    let pose = Pose::IDENTITY;
    let ignorant = ContinuumDispatcher(Ignorant);
    assert!(manifolds(&ignorant, &pose, &chain, &cuboids, 0.1).is_err());
    assert!(manifolds(&ignorant, &pose, &cuboids, &chain.links()[0], 0.1).is_err());

    let dispatcher = ContinuumDispatcher::default();
    let broken = Triangle::new(Vector::ZERO, Vector::X, Vector::new(0.0, Real::NAN, 0.0));
    assert!(manifolds(&dispatcher, &pose, &chain.links()[0], &broken, 0.1).is_err());
    assert!(manifolds(&dispatcher, &pose, &chain, &cuboids, Real::NAN).is_err());
    let nowhere = Pose::from_translation(Vector::NAN);
    assert!(manifolds(&dispatcher, &nowhere, &chain, &cuboids, 0.1).is_err());
    // parry insists on a prediction that is not negative.
    assert!(manifolds(&dispatcher, &pose, &chain, &cuboids, -1.0).is_ok());
}
