//! Walls that give way: a robot keeps its contacts on them, and they do not feed it energy.

use crate::drop::{Drop, attitudes, grid, links, world};
use parry_continuum::Chain;
use parry_continuum::parry::math::{Pose, Real, Vector};
use rapier3d_f64::dynamics::SoftBodyBuilder;
use rapier3d_f64::prelude::*;
use std::f64::consts::PI;

/// A floor whose waves are `height` high.
fn waves(height: Real) -> SharedShape {
    SharedShape::new(grid(1.0, |x, z| height * (1.3 * x).sin() * (1.1 * z).cos()))
}

fn robots() -> Vec<(String, SharedShape)> {
    let mut robots: Vec<_> = links()
        .map(|link| (format!("{:?}", link.caps()), SharedShape::new(link)))
        .into_iter()
        .collect();
    let points = [-Vector::Y, 0.2 * Vector::Y, Vector::new(0.2, 1.3, 0.0)];
    robots.push((
        "chain".into(),
        SharedShape::new(Chain::from_centreline(&points, &[0.5; 2]).unwrap()),
    ));
    robots
}

/// parry's capsule and cylinder, for comparison.
fn parrys() -> [(String, SharedShape); 2] {
    [
        ("parry's cylinder".into(), SharedShape::cylinder(1.0, 0.5)),
        ("parry's capsule".into(), SharedShape::capsule_y(1.0, 0.5)),
    ]
}

/// On a mesh that is another one at each step, for ten seconds, and then stays as it is: how deep
/// the body gets, for how many steps it is loose, and by what height its energy grows once the mesh
/// is still.
fn on_moving_mesh(robot: SharedShape) -> (Real, usize, Real) {
    let ground = ColliderBuilder::new(waves(0.0));
    let pose = Pose::from_parts(Vector::new(0.2, 0.51, -0.1), attitudes()[1].1);
    let mut drop = Drop::new(world(1.0), ground, robot, pose);
    let body = &mut drop.world.bodies[drop.body];
    body.set_linear_damping(0.2);
    body.set_angular_damping(0.2);
    let (mut loose, mut deepest) = (0, 0.0_f64);
    for step in 0..1200 {
        let height = 0.1 * (2.0 * PI * Real::from(step) / 480.0).sin();
        drop.world.colliders[drop.ground].set_shape(waves(height));
        drop.world.step();
        let gap = drop.gap(0.1);
        loose += usize::from(step > 60 && gap > 0.01);
        deepest = deepest.min(gap);
    }
    let (before, mut most) = (drop.energy(), Real::NEG_INFINITY);
    for _ in 0..600 {
        drop.world.step();
        most = most.max(drop.energy());
    }
    let weight = drop.world.bodies[drop.body].mass() * drop.world.gravity.length();
    (deepest, loose, (most - before) / weight)
}

#[test]
fn a_robot_rests_on_a_mesh_that_moves() {
    let parrys = parrys().map(|(_, shape)| on_moving_mesh(shape).0);
    let deepest_of_parrys = parrys[0].min(parrys[1]);
    for (name, robot) in robots() {
        let (deepest, loose, gain) = on_moving_mesh(robot);
        println!("{name}: {deepest} deep, {loose} loose, {gain} gained; parry's {parrys:?}");
        assert_eq!(loose, 0, "{name}");
        assert!(deepest > 1.1 * deepest_of_parrys, "{name}: {deepest} against {parrys:?}");
        // Gains at most what leaving the overlap takes.
        assert!(gain < -deepest, "{name}: {gain}");
    }
}

/// rapier's own soft body gives way under the robot as under parry's shapes.
#[test]
fn a_robot_rests_on_a_soft_body() {
    let [cylinder, capsule] = parrys().map(|(_, shape)| on_soft_body(shape).0);
    for (name, robot) in robots() {
        let (lowest, touching, speed) = on_soft_body(robot);
        println!(
            "{name}: {lowest} low, {touching} touching, {speed} fast; parry's {cylinder}, {capsule}"
        );
        assert_eq!(touching, 600, "{name}");
        assert!(lowest > 0.98 * capsule.min(cylinder), "{name}: {lowest} against {capsule}");
        assert!(name == "chain" || speed < 1e-3, "{name}: {speed}");
        assert!(speed < 0.5, "{name}: {speed}");
    }
}

/// On a slab of tetrahedra held at its bottom: how low the body gets, at how many of the last 600
/// steps it touches, and its speed at the end.
fn on_soft_body(robot: SharedShape) -> (Real, usize, Real) {
    let mut world = world(1.0);
    let slab = SoftBodyBuilder::cuboid(-0.5 * Vector::Y, Vector::new(2.0, 0.5, 2.0), 9, 3, 9);
    let low = |(k, p): (usize, &Vector)| (p.y < -0.9).then_some(k as u32);
    let pinned: Vec<_> = slab.particle_positions().iter().enumerate().filter_map(low).collect();
    assert!(pinned.len() > 50);
    let slab = world.insert_soft_body(slab.mass(20.0).pinned_particles(pinned));
    let pose = Pose::from_parts(Vector::new(0.1, 0.6, 0.05), attitudes()[1].1);
    let body = RigidBodyBuilder::dynamic().pose(pose).linear_damping(0.5).angular_damping(0.5);
    let (body, collider) = world.insert(body, ColliderBuilder::new(robot).density(0.5));
    let (mut touching, mut lowest) = (0, Real::INFINITY);
    for step in 0..900 {
        world.step();
        lowest = lowest.min(world.bodies[body].translation().y);
        let touches = world.contact_pairs_with(collider).any(|pair| pair.has_any_active_contact());
        touching += usize::from(step >= 300 && touches);
    }
    assert!(
        world.soft_bodies[slab].particles().iter().all(|particle| particle.position().is_finite())
    );
    (lowest, touching, world.bodies[body].linvel().length())
}
