//! A step of a rapier world with a robot in a ventricle: one body per link, or one collider for the
//! chain.
//!
//! The robot sways into the wall and back while its tubes turn, so its shape changes at every
//! step. Everything is kinematic, so the time is that of the broad and the narrow phase.

use continuum_demo::{ctr, ventricle};
use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use parry_continuum::parry::math::{Pose, Real, Rot3, Vector};
use parry_continuum::parry::shape::TriMesh;
use parry_continuum::proximity::{BvhSearch, Proximity};
use parry_continuum::{Chain, ModifiedCylinder, rapier};
use rapier3d_f64::prelude::*;
use std::hint::black_box;

const LINKS: usize = 30;

/// The robot's shape and place at a step.
fn robot(step: usize) -> (Chain, Pose) {
    let phase = step as Real / 200.0 * std::f64::consts::TAU;
    let mut joints = ventricle::goal();
    joints.angles[1] += 0.05 * phase.sin();
    let line = ctr::three_tubes().centreline(&joints, LINKS);
    let aside =
        Pose::from_translation(Vector::new(0.9, 0.5, -0.3) * (1.6 * (0.5 - 0.5 * phase.cos())));
    (
        Chain::from_centreline(&line.points, &line.radii).expect("a robot"),
        aside * ventricle::entry(),
    )
}

fn place(link: &ModifiedCylinder, base: &Pose) -> Pose {
    *base * Pose::from_parts(link.start(), Rot3::from_rotation_arc(Vector::Z, link.axis()))
}

fn world(wall: &TriMesh) -> PhysicsWorld {
    let mut world = PhysicsWorld { gravity: Vector::ZERO, ..Default::default() };
    rapier::install(&mut world.narrow_phase, &mut world.integration_parameters, 2.0)
        .expect("a size");
    world.integration_parameters.dt = 1e-3;
    world.insert(RigidBodyBuilder::fixed(), ColliderBuilder::new(SharedShape::new(wall.clone())));
    world
}

fn kinematic(
    world: &mut PhysicsWorld,
    shape: SharedShape,
    pose: Pose,
) -> (RigidBodyHandle, ColliderHandle) {
    let collider = ColliderBuilder::new(shape)
        .active_collision_types(ActiveCollisionTypes::KINEMATIC_FIXED)
        .collision_groups(InteractionGroups::new(
            Group::GROUP_1,
            !Group::GROUP_1,
            InteractionTestMode::And,
        ));
    world.insert(RigidBodyBuilder::kinematic_position_based().pose(pose), collider)
}

fn step(criterion: &mut Criterion) {
    let robots: Vec<_> = (0..200).map(robot).collect();
    let flags = TriMeshFlags::FIX_INTERNAL_EDGES_TWO_SIDED;
    for triangles in [6_000, 96_000] {
        let (vertices, indices) = ventricle::mesh(triangles);
        let wall = TriMesh::with_flags(vertices, indices, flags).expect("a mesh");
        let mut group = criterion.benchmark_group("step");
        let id = |name: &str| BenchmarkId::new(name, triangles);

        let mut empty = world(&wall);
        group.bench_function(id("no robot"), |bencher| bencher.iter(|| empty.step()));

        let mut per_link = world(&wall);
        let (chain, pose) = &robots[0];
        let along = |link: &ModifiedCylinder| {
            ModifiedCylinder::new(
                Vector::ZERO,
                Vector::Z * link.length(),
                link.radius(),
                link.caps(),
            )
        };
        let bodies: Vec<_> = chain
            .links()
            .iter()
            .map(|link| {
                let shape = SharedShape::new(along(link).expect("a link"));
                kinematic(&mut per_link, shape, place(link, pose)).0
            })
            .collect();
        let mut turns = robots.iter().cycle();
        group.bench_function(id("link per body"), |bencher| {
            bencher.iter(|| {
                let (chain, pose) = turns.next().expect("it goes round");
                for (body, link) in bodies.iter().zip(chain.links()) {
                    per_link.bodies[*body].set_next_kinematic_position(place(link, pose));
                }
                per_link.step();
            });
        });

        let mut whole = world(&wall);
        let (body, collider) = kinematic(&mut whole, SharedShape::new(chain.clone()), *pose);
        let mut turns = robots.iter().cycle();
        group.bench_function(id("chain per collider, new shape"), |bencher| {
            bencher.iter(|| {
                let (chain, pose) = turns.next().expect("it goes round");
                whole.colliders[collider].set_shape(SharedShape::new(chain.clone()));
                whole.bodies[body].set_next_kinematic_position(*pose);
                whole.step();
            });
        });
        let mut turns = robots.iter().cycle();
        group.bench_function(id("chain per collider, moved only"), |bencher| {
            bencher.iter(|| {
                let (_, pose) = turns.next().expect("it goes round");
                whole.bodies[body].set_next_kinematic_position(*pose);
                whole.step();
            });
        });

        let mut search = BvhSearch::new(&wall).expect("a mesh");
        let (mut turns, mut found) = (robots.iter().cycle(), Vec::new());
        group.bench_function(id("clearance of all links"), |bencher| {
            bencher.iter(|| {
                let (chain, pose) = turns.next().expect("it goes round");
                search.per_link(chain, pose, &mut found).expect("distances");
                black_box(&found);
            });
        });
        group.finish();
    }
}

criterion_group!(benches, step);
criterion_main!(benches);
