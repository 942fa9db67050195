//! Robots on robots: rods that cross, rings of a coil on one another, a hundred chains. What comes
//! to rest lies where the shapes say, as with parry's own.

use crate::drop::{grid, world};
use parry_continuum::parry::math::{Pose, Real, Vector};
use parry_continuum::parry::shape::Compound;
use parry_continuum::{Cap, Chain, ModifiedCylinder};
use rapier3d_f64::prelude::*;
use std::f64::consts::TAU;

const CAPS: [[Cap; 2]; 4] =
    [[Cap::Flat; 2], [Cap::Round; 2], [Cap::Flat, Cap::Round], [Cap::Round, Cap::Flat]];

/// A rod falls across another, which is held and thicker, so that it balances there. Returns its
/// places, in units of `size`.
fn crossed(size: Real, [below, above]: [SharedShape; 2], turn: Real) -> Vec<Pose> {
    let mut world = world(size);
    world.insert(RigidBodyBuilder::fixed(), ColliderBuilder::new(below));
    let from = Pose::new(Vector::Y * 0.9 * size, Vector::Y * turn);
    // rapier has no rolling friction.
    let body = RigidBodyBuilder::dynamic().pose(from).linear_damping(1.0).angular_damping(3.0);
    let (body, collider) = world.insert(body, ColliderBuilder::new(above));
    // The unit of mass is the same in all scenes.
    let shape = world.colliders[collider].shape();
    let steel = shape.mass_properties(1.0 / (size * size * size));
    world.colliders[collider].set_mass_properties(steel);
    let place = |_| {
        world.step();
        let pose = world.bodies[body].position();
        Pose::from_parts(pose.translation / size, pose.rotation)
    };
    (0..900).map(place).collect()
}

#[test]
fn a_rod_rests_across_another_in_every_unit() {
    let link = |size: Real, half: Real, radius: Real, caps| {
        let half = Vector::X * half * size;
        SharedShape::new(ModifiedCylinder::new(-half, half, radius * size, caps).unwrap())
    };
    for below in CAPS {
        // Others have their weight beside the middle, and fall.
        for above in [CAPS[0], CAPS[1]] {
            for turn in [0.3, 0.25 * TAU] {
                let at = |size: Real| {
                    crossed(size, [link(size, 1.5, 0.5, below), link(size, 1.0, 0.25, above)], turn)
                };
                let millimetres = at(1.0);
                let last = millimetres[millimetres.len() - 1];
                let context = format!("{above:?} on {below:?} {turn} {last:?}");
                assert!((last.translation.y - 0.75).abs() < 0.005 * 0.25, "{context}");
                assert!((last.rotation * Vector::X).y.abs() < 0.02, "{context}");
                // Bit for bit.
                assert_eq!(at(1.0 / 1024.0), millimetres, "{context}");
            }
        }
    }
}

/// The centreline of a ring around y, open by a little.
fn ring(turn: Real) -> Vec<Vector> {
    let at = |k: u32| turn + 0.97 * TAU * Real::from(k) / 16.0;
    (0..17).map(at).map(|at| Vector::new(at.cos(), 0.0, at.sin()) * 2.0).collect()
}

const RADIUS: Real = 0.2;

fn ring_of_links(turn: Real) -> SharedShape {
    SharedShape::new(Chain::from_centreline(&ring(turn), &[RADIUS; 16]).unwrap())
}

fn ring_of_capsules(turn: Real) -> SharedShape {
    let capsule =
        |ends: &[Vector]| (Pose::IDENTITY, SharedShape::capsule(ends[0], ends[1], RADIUS));
    SharedShape::new(Compound::new(ring(turn).windows(2).map(capsule).collect()))
}

/// Rings of a coil, one on the other, on a floor: the error of each height in radii, and how many
/// are awake after this many steps.
fn coil(ring: fn(Real) -> SharedShape) -> (Real, usize) {
    let mut world = world(2.0 * RADIUS);
    world.insert(
        RigidBodyBuilder::fixed(),
        ColliderBuilder::new(SharedShape::new(grid(1.0, |_, _| 0.0))),
    );
    let bodies: Vec<_> = (0..4)
        .map(|k| {
            let height = RADIUS * (1.0 + 2.3 * Real::from(k));
            let body = RigidBodyBuilder::dynamic().translation(Vector::Y * height);
            world.insert(body, ColliderBuilder::new(ring(0.7 * Real::from(k)))).0
        })
        .collect();
    for _ in 0..600 {
        world.step();
    }
    let off = bodies.iter().enumerate().map(|(k, &body)| {
        // The centre of an open ring lies beside its middle, at the same height.
        let height = world.bodies[body].center_of_mass().y;
        (height / RADIUS - (1.0 + 2.0 * k as Real)).abs()
    });
    let off = off.fold(0.0, Real::max);
    (off, bodies.iter().filter(|&&body| !world.bodies[body].is_sleeping()).count())
}

#[test]
fn a_coil_keeps_its_thickness() {
    let [(ours, awake), (parrys, _)] = [coil(ring_of_links), coil(ring_of_capsules)];
    // A hundredth of the radius for each ring below, or what parry's own shapes sink in.
    assert!(ours < (1.5 * parrys).max(0.04), "{ours} {parrys}");
    assert_eq!(awake, 0);
}
