//! Worlds for the tests in rapier: grounds, a link that is dropped on one, and what is observed of
//! it.
#![allow(dead_code)]

use parry_continuum::parry::math::{Pose, Real, Rot3, Vector};
use parry_continuum::parry::query::QueryDispatcher;
use parry_continuum::parry::shape::TriMesh;
use parry_continuum::parry::utils::Array2;
use parry_continuum::{Cap, ContinuumDispatcher, ModifiedCylinder, rapier};
use rapier3d_f64::prelude::*;

/// The links that are dropped, with every combination of caps: 2 long, of radius 0.5, around the
/// origin along y.
pub fn links() -> [ModifiedCylinder; 4] {
    [[Cap::Flat; 2], [Cap::Round; 2], [Cap::Flat, Cap::Round], [Cap::Round, Cap::Flat]]
        .map(|caps| ModifiedCylinder::new(-Vector::Y, Vector::Y, 0.5, caps).unwrap())
}

/// How the links are held before they fall: upright, lying, tilted.
pub fn attitudes() -> [(&'static str, Rot3); 3] {
    [
        ("upright", Rot3::IDENTITY),
        ("lying", Rot3::from_rotation_z(std::f64::consts::FRAC_PI_2)),
        ("tilted", Rot3::from_axis_angle(Vector::new(0.8, 0.0, 0.6), 0.6)),
    ]
}

/// Gravity downwards, in lengths of the scene per second squared, and the parameters for links of
/// this size.
pub fn world(size: Real) -> PhysicsWorld {
    let mut world = PhysicsWorld { gravity: Vector::Y * -9.81 * size, ..Default::default() };
    rapier::install(&mut world.narrow_phase, &mut world.integration_parameters, size).unwrap();
    world.integration_parameters.dt = 1.0 / 120.0;
    world
}

/// A grid of triangles over the square of half width 6 with the heights given.
pub fn grid(size: Real, height: impl Fn(Real, Real) -> Real) -> TriMesh {
    const CELLS: u32 = 15;
    let place = |i: u32| 12.0 * (i as Real / CELLS as Real - 0.5);
    let vertex = |k: u32| {
        let (x, z) = (place(k / (CELLS + 1)), place(k % (CELLS + 1)));
        Vector::new(x, height(x, z), z) * size
    };
    let cell = |k: u32| {
        let a = (CELLS + 1) * (k / CELLS) + k % CELLS;
        [[a, a + 1, a + CELLS + 1], [a + 1, a + CELLS + 2, a + CELLS + 1]]
    };
    let vertices = (0..(CELLS + 1) * (CELLS + 1)).map(vertex).collect();
    let triangles = (0..CELLS * CELLS).flat_map(cell).collect();
    TriMesh::with_flags(vertices, triangles, TriMeshFlags::FIX_INTERNAL_EDGES).unwrap()
}

pub fn mesh(size: Real, height: impl Fn(Real, Real) -> Real) -> ColliderBuilder {
    ColliderBuilder::new(SharedShape::new(grid(size, height)))
}

/// Gentle bumps.
pub fn bump(x: Real, z: Real) -> Real {
    0.15 * (1.3 * x).sin() * (1.1 * z).cos()
}

pub fn box_ground(size: Real) -> ColliderBuilder {
    ColliderBuilder::cuboid(6.0 * size, size, 6.0 * size).translation(Vector::Y * -size)
}

pub fn field(size: Real, height: impl Fn(Real, Real) -> Real) -> ColliderBuilder {
    const CELLS: usize = 15;
    let place = |i: usize| 12.0 * (i as Real / CELLS as Real - 0.5);
    // Rows along z, columns along x.
    let heights = Array2::new(CELLS + 1, CELLS + 1, {
        let points = (0..(CELLS + 1) * (CELLS + 1)).map(|k| (k / (CELLS + 1), k % (CELLS + 1)));
        points.map(|(column, row)| height(place(column), place(row))).collect()
    });
    let flags = HeightFieldFlags::FIX_INTERNAL_EDGES;
    ColliderBuilder::heightfield_with_flags(heights, Vector::new(12.0, 1.0, 12.0) * size, flags)
}

/// A body above a ground.
pub struct Drop {
    pub world: PhysicsWorld,
    pub body: RigidBodyHandle,
    pub collider: ColliderHandle,
    pub ground: ColliderHandle,
}

impl Drop {
    pub fn new(
        mut world: PhysicsWorld,
        ground: ColliderBuilder,
        shape: SharedShape,
        pose: Pose,
    ) -> Self {
        let (_, ground) = world.insert(RigidBodyBuilder::fixed(), ground);
        let (body, collider) =
            world.insert(RigidBodyBuilder::dynamic().pose(pose), ColliderBuilder::new(shape));
        Self { world, body, collider, ground }
    }

    pub fn pose(&self) -> Pose {
        *self.world.bodies[self.body].position()
    }

    /// Kinetic and potential energy.
    pub fn energy(&self) -> Real {
        let body = &self.world.bodies[self.body];
        body.kinetic_energy() + body.gravitational_potential_energy(0.0, self.world.gravity)
    }

    pub fn is_asleep(&self) -> bool {
        self.world.bodies[self.body].is_sleeping()
    }

    /// Minus the depth of the overlap with the ground, or the distance from it, by the crate's own
    /// query; at most `reach`.
    pub fn gap(&self, reach: Real) -> Real {
        let (shape, ground) =
            (&self.world.colliders[self.collider], &self.world.colliders[self.ground]);
        let pos12 = ground.position().inv_mul(shape.position());
        let found =
            ContinuumDispatcher::default().contact(&pos12, ground.shape(), shape.shape(), reach);
        found.unwrap().map_or(reach, |contact| contact.dist)
    }

    /// The points that the solver holds the body with, in the world.
    pub fn supports(&self) -> Vec<Vector> {
        let mut points = Vec::new();
        for pair in self.world.contact_pairs_with(self.collider) {
            let Some(contacts) = pair.rigid() else { continue };
            let clusters = &contacts.solver_clusters;
            let manifolds = if clusters.is_empty() { &contacts.manifolds } else { clusters };
            let first = *self.world.colliders[pair.collider1].position();
            for manifold in manifolds {
                for contact in &manifold.data.solver_contacts {
                    let point = &manifold.points[contact.contact_id[0] as usize & 0x7f];
                    let place = manifold
                        .subshape_pos1()
                        .map_or(point.local_p1, |pose| pose * point.local_p1);
                    points.push(first * place);
                }
            }
        }
        points
    }
}

/// The link with every length multiplied by `factor`.
pub fn scaled(link: &ModifiedCylinder, factor: Real) -> ModifiedCylinder {
    ModifiedCylinder::new(
        link.start() * factor,
        link.end() * factor,
        link.radius() * factor,
        link.caps(),
    )
    .unwrap()
}
