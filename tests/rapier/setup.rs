//! What the helper sets, and what rapier cannot do with custom shapes.

use parry_continuum::parry::math::{Pose, Real, Vector};
use parry_continuum::parry::shape::{Compound, Cuboid, Triangle};
use parry_continuum::{Chain, ModifiedCylinder, rapier};
use rapier3d_f64::prelude::*;

#[test]
fn the_world_is_made_for_links_of_a_size() {
    let mut world = PhysicsWorld::default();
    rapier::install(&mut world.narrow_phase, &mut world.integration_parameters, 1e-3).unwrap();
    let parameters = &world.integration_parameters;
    assert_eq!(parameters.prediction_distance(), 2e-5);
    assert!(!parameters.contact_recycling && parameters.max_linear_velocity() == Real::MAX);
    // The dispatcher answers the pair that parry's own refuses or gets wrong by a thousandth.
    let link = ModifiedCylinder::cylinder(Vector::ZERO, Vector::X * 1e-3, 5e-4).unwrap();
    let wall = [(-1.0, -1.0), (1.0, -1.0), (0.0, 1.0)].map(|(x, z)| Vector::new(x, 2e-3, z));
    let installed = world.narrow_phase.query_dispatcher();
    let apart = installed.distance(&Pose::IDENTITY, &link, &Triangle::from(wall)).unwrap();
    assert!((apart.distance - 1.5e-3).abs() < 1e-18);
    assert!(installed.contact(&Pose::IDENTITY, &link, &Cuboid::new(Vector::ONE), 0.1).is_ok());
}

#[test]
fn a_size_that_is_none_changes_nothing() {
    let (mut world, before) = (PhysicsWorld::default(), IntegrationParameters::default());
    for size in [0.0, -1.0, Real::NAN, Real::INFINITY] {
        let refused =
            rapier::install(&mut world.narrow_phase, &mut world.integration_parameters, size);
        assert!(refused.unwrap_err().to_string().contains("above 0"), "{size}");
        assert_eq!(world.integration_parameters, before);
    }
}

/// A chain on a chain, beside a compound: saved as the book says, loaded, and continued as if it
/// had never been saved. JSON has no keys for rapier's pairs of parts.
#[test]
fn a_world_with_composites_near_each_other_is_saved_and_continued() {
    let mut world = PhysicsWorld { gravity: -9.81 * Vector::Y, ..Default::default() };
    rapier::install(&mut world.narrow_phase, &mut world.integration_parameters, 0.5).unwrap();
    world
        .insert(RigidBodyBuilder::fixed(), ColliderBuilder::new(SharedShape::halfspace(Vector::Y)));
    let chain = |length: Real| {
        let points = [0.0, 0.5, 1.0].map(|share| Vector::X * (length * (share - 0.5)));
        SharedShape::new(Chain::capsules(&points, &[0.25; 2]).unwrap())
    };
    let parts = [-0.4, 0.4].map(|z| (Pose::translation(0.0, 0.0, z), SharedShape::ball(0.2)));
    let bodies = [
        (chain(2.0), Vector::new(0.0, 0.26, 0.0)),
        (chain(1.5), Vector::new(0.1, 0.78, 0.05)),
        (SharedShape::new(Compound::new(parts.to_vec())), Vector::new(0.1, 1.25, 0.0)),
    ];
    let bodies = bodies.map(|(shape, place)| {
        world.insert(RigidBodyBuilder::dynamic().translation(place), ColliderBuilder::new(shape)).0
    });
    for _ in 0..20 {
        world.step();
    }
    let mut robots = Vec::new();
    for (handle, collider) in world.colliders.iter_mut() {
        let robot = collider.shape().as_shape::<Chain>().cloned();
        if let Some(robot) = robot {
            robots.push((handle, robot));
            collider.set_shape(SharedShape::ball(1.0));
        }
    }
    let refused = serde_json::to_string(&world).unwrap_err().to_string();
    assert!(refused.contains("key must be a string"), "{refused}");
    let mut saved = Vec::new();
    ciborium::into_writer(&world, &mut saved).unwrap();
    let mut loaded: PhysicsWorld = ciborium::from_reader(&saved[..]).unwrap();
    rapier::install(&mut loaded.narrow_phase, &mut loaded.integration_parameters, 0.5).unwrap();
    let mut worlds = [world, loaded];
    for (handle, robot) in &robots {
        for world in &mut worlds {
            world.colliders[*handle].set_shape(SharedShape::new(robot.clone()));
        }
    }
    for _ in 0..60 {
        worlds.iter_mut().for_each(PhysicsWorld::step);
    }
    let [places, loaded] = worlds.map(|world| bodies.map(|body| *world.bodies[body].position()));
    for (place, loaded) in places.iter().zip(loaded) {
        assert!((place.translation - loaded.translation).length() < 1e-6, "{place:?} {loaded:?}");
    }
}
