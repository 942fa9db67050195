//! A world with links and chains is saved and loaded: what rapier refuses, and the way round that its documentation
//! names.

use crate::drop::{mesh, world};
use continuum_worlds as worlds;
use parry_continuum::parry::math::{Pose, Real, Vector};
use parry_continuum::{Cap, Chain, ContinuumDispatcher, ModifiedCylinder};
use rapier3d_f64::prelude::*;
use serde_json::{from_str, to_string};

/// A robot's shape as data of its own.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
enum Robot {
    Link(ModifiedCylinder),
    Chain(Chain),
}

impl Robot {
    fn of(shape: &dyn Shape) -> Option<Self> {
        let link = shape.as_shape::<ModifiedCylinder>().map(|link| Self::Link(*link));
        link.or_else(|| shape.as_shape::<Chain>().map(|chain| Self::Chain(chain.clone())))
    }

    fn shape(self) -> SharedShape {
        match self {
            Self::Link(link) => SharedShape::new(link),
            Self::Chain(chain) => SharedShape::new(chain),
        }
    }
}

/// A link and a chain that are falling onto a mesh.
fn falling() -> (PhysicsWorld, [RigidBodyHandle; 2]) {
    let mut world = world(1.0);
    world.insert(RigidBodyBuilder::fixed(), mesh(1.0, |_, _| 0.0));
    let link = ModifiedCylinder::new(-Vector::X, Vector::X, 0.5, [Cap::Flat, Cap::Round]).unwrap();
    let chain = Chain::from_centreline(&[-Vector::X, Vector::ZERO, Vector::new(1.0, 0.0, 0.3)], &[0.25; 2]);
    let shapes = [SharedShape::new(link), SharedShape::new(chain.unwrap())];
    let mut z = -3.0;
    let bodies = shapes.map(|shape| {
        z += 2.0;
        let body = RigidBodyBuilder::dynamic().translation(Vector::new(0.1, 0.6, z)).angular_damping(5.0);
        world.insert(body, ColliderBuilder::new(shape)).0
    });
    for _ in 0..30 {
        world.step();
    }
    (world, bodies)
}

/// How high the two bodies are after two seconds.
fn heights_later(mut world: PhysicsWorld, bodies: [RigidBodyHandle; 2]) -> [Real; 2] {
    for _ in 0..240 {
        world.step();
    }
    bodies.map(|body| world.bodies[body].translation().y)
}

#[test]
fn a_world_with_links_is_refused_and_one_without_is_not() {
    let (mut world, bodies) = falling();
    let refused = worlds::write(&world).map(drop).expect_err("a custom shape was written");
    assert!(refused.to_string().contains("Custom cannot be serialized"), "{refused}");
    for body in bodies {
        world.remove_body(body);
    }
    let read = worlds::read(&worlds::write(&world).unwrap()).unwrap();
    assert_eq!(read.colliders.len(), 1);
}

/// The way round: robots are saved on their own, balls hold their places in the world, and after loading each
/// collider gets its shape back and the narrow phase its dispatcher.
#[test]
fn a_world_is_saved_with_its_robots_beside_it() {
    let (world, bodies) = falling();
    let expected = heights_later(falling().0, bodies);
    assert!((expected[0] - 0.5).abs() < 1e-3 && (expected[1] - 0.25).abs() < 1e-3, "{expected:?}");

    let (mut saved, mut robots) = (world, Vec::new());
    for (handle, collider) in saved.colliders.iter_mut() {
        if let Some(robot) = Robot::of(collider.shape()) {
            robots.push((handle, robot));
            collider.set_shape(SharedShape::ball(1.0));
        }
    }
    assert_eq!(robots.len(), 2);
    let text = (worlds::write(&saved).unwrap(), to_string(&robots).unwrap());

    let load = || {
        let mut world = worlds::read(&text.0).unwrap();
        let read: Vec<(ColliderHandle, Robot)> = from_str(&text.1).unwrap();
        assert_eq!(read, robots);
        for (handle, robot) in read {
            world.colliders[handle].set_shape(robot.shape());
        }
        world
    };
    let mut world = load();
    world.narrow_phase.set_query_dispatcher(ContinuumDispatcher::default());
    let heights = heights_later(world, bodies);
    let as_high = |k: usize| (heights[k] - expected[k]).abs() < 1e-3;
    assert!(as_high(0) && as_high(1), "{heights:?} {expected:?}");

    // Without it, parry clips the polygons that stand for links: as high to the eye, and not to the digit.
    let without = heights_later(load(), bodies);
    assert!(without != heights, "{without:?}");
}

/// What `install` sets is saved but for the dispatcher.
#[test]
fn the_parameters_are_saved_and_the_dispatcher_is_not() {
    let mut world = world(1e-3);
    let link = ModifiedCylinder::capsule(Vector::ZERO, Vector::X, 0.5).unwrap();
    let wall = [(-1.0, -1.0), (1.0, -1.0), (0.0, 1.0)].map(|(x, z)| Vector::new(x, 2.0, z));
    let wall = Triangle::from(wall);
    let apart = |world: &PhysicsWorld| {
        let dispatcher = world.narrow_phase.query_dispatcher();
        dispatcher.distance(&Pose::IDENTITY, &link, &wall).map(|apart| apart.distance)
    };
    assert_eq!(apart(&world).unwrap(), 1.5);
    let mut read = worlds::read(&worlds::write(&world).unwrap()).unwrap();
    assert_eq!(read.integration_parameters, world.integration_parameters);
    assert_ne!(apart(&read).ok(), Some(1.5));
    parry_continuum::rapier::install(&mut read.narrow_phase, &mut read.integration_parameters, 1e-3).unwrap();
    assert_eq!(apart(&read).unwrap(), 1.5);
    world.step();
}
