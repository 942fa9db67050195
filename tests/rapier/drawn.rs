//! What rapier's debug renderer shows of links and chains, and how to show the rest through the
//! same backend.

use crate::drop::{mesh, world};
use parry_continuum::parry::math::{Real, Vector};
use parry_continuum::{Cap, Chain, ModifiedCylinder};
use rapier3d_f64::pipeline::{
    DebugColor, DebugRenderBackend, DebugRenderMode, DebugRenderObject, DebugRenderPipeline,
    DebugRenderStyle,
};
use rapier3d_f64::prelude::*;
use std::collections::HashMap;

/// Stores the lines by collider, and the lines of contacts under `None`.
#[derive(Default)]
struct Lines(HashMap<Option<ColliderHandle>, Vec<[Vector; 2]>>);

impl Lines {
    fn of(&self, collider: impl Into<Option<ColliderHandle>>) -> &[[Vector; 2]] {
        self.0.get(&collider.into()).map_or(&[], Vec::as_slice)
    }
}

impl DebugRenderBackend for Lines {
    fn draw_line(&mut self, object: DebugRenderObject, a: Vector, b: Vector, _: DebugColor) {
        let collider = match object {
            DebugRenderObject::Collider(handle, _)
            | DebugRenderObject::ColliderAabb(handle, ..) => Some(handle),
            _ => None,
        };
        self.0.entry(collider).or_default().push([a, b]);
    }
}

fn drawn(world: &PhysicsWorld, mode: DebugRenderMode) -> Lines {
    let mut lines = Lines::default();
    DebugRenderPipeline::new(DebugRenderStyle::default(), mode).render(
        &mut lines,
        &world.bodies,
        &world.colliders,
        &world.impulse_joints,
        &world.multibody_joints,
        &world.narrow_phase,
        &world.soft_bodies,
    );
    lines
}

/// The links of a shape, for every kind of robot.
fn links_of(shape: &dyn Shape) -> Vec<ModifiedCylinder> {
    let link = shape.as_shape::<ModifiedCylinder>().map(|link| vec![*link]);
    link.or_else(|| shape.as_shape::<Chain>().map(|chain| chain.links().to_vec()))
        .unwrap_or_default()
}

/// The way round: the edges of each link's mesh, handed to the backend as the collider's own.
fn draw_robots(world: &PhysicsWorld, backend: &mut impl DebugRenderBackend) {
    for (handle, collider) in world.colliders.iter() {
        for link in links_of(collider.shape()) {
            let (vertices, triangles) = link.to_trimesh(16);
            let edges: Vec<_> =
                triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]).collect();
            backend.draw_polyline(
                DebugRenderObject::Collider(handle, collider),
                &vertices,
                &edges,
                collider.position(),
                Vector::ONE,
                [0.0, 1.0, 0.5, 1.0],
            );
        }
    }
}

#[test]
fn boxes_and_contacts_are_drawn_and_shapes_are_not() {
    let mut world = world(1.0);
    let (_, ground) = world.insert(RigidBodyBuilder::fixed(), mesh(1.0, |_, _| 0.0));
    let link = ModifiedCylinder::new(-Vector::X, Vector::X, 0.5, [Cap::Flat, Cap::Round]).unwrap();
    let body = RigidBodyBuilder::dynamic().translation(Vector::Y * 0.51);
    let (_, robot) = world.insert(body, ColliderBuilder::new(SharedShape::new(link)));
    let chain = Chain::from_centreline(
        &[Vector::ZERO, Vector::Z, 2.0 * Vector::Z + 0.1 * Vector::X],
        &[0.2; 2],
    );
    let body = RigidBodyBuilder::dynamic().translation(Vector::new(3.0, 0.21, 0.0));
    let (_, chain) = world.insert(body, ColliderBuilder::new(SharedShape::new(chain.unwrap())));
    for _ in 0..60 {
        world.step();
    }

    let shapes = drawn(&world, DebugRenderMode::COLLIDER_SHAPES);
    assert!(!shapes.of(ground).is_empty());
    assert!(shapes.of(robot).is_empty() && shapes.of(chain).is_empty());

    let boxes = drawn(&world, DebugRenderMode::COLLIDER_AABBS);
    for handle in [robot, chain] {
        let bounds = world.colliders[handle].compute_aabb();
        let corners = boxes.of(handle).iter().flatten();
        let far =
            corners.clone().fold(Vector::splat(Real::NEG_INFINITY), |far, &corner| far.max(corner));
        let is_far = (far - bounds.maxs).length() < 1e-12;
        assert!(boxes.of(handle).len() == 12 && is_far, "{bounds:?} {far}");
    }

    // A line of each contact, from where it lies on the one to where it lies on the other.
    let contacts = drawn(&world, DebugRenderMode::CONTACTS);
    let on_ground = contacts.of(None).iter().flatten().filter(|point| point.y.abs() < 0.02);
    assert!(on_ground.count() >= 4, "{:?}", contacts.of(None));

    let mut lines = Lines::default();
    draw_robots(&world, &mut lines);
    for handle in [robot, chain] {
        let collider = &world.colliders[handle];
        assert!(lines.of(handle).len() > 100);
        for &point in lines.of(handle).iter().flatten() {
            let off = collider.shape().distance_to_point(collider.position(), point, false);
            assert!(off.abs() < 1e-12, "{off}");
        }
    }
}
