//! A robot of half a millimetre behaves the same in metres, in millimetres and in micrometres.

use crate::drop::{Drop, attitudes, bump, links, mesh, scaled, world};
use parry_continuum::Chain;
use parry_continuum::parry::math::{Pose, Real, Vector};
use rapier3d_f64::prelude::*;

const STEPS: usize = 400;

/// Places after every step, in millimetres. `size` is a millimetre in the scene's unit.
fn fall(size: Real, shape: SharedShape, pose: Pose, height: fn(Real, Real) -> Real) -> Vec<Vector> {
    let mut world = world(size);
    world.gravity = Vector::Y * -9810.0 * size;
    let parameters = &mut world.integration_parameters;
    parameters.dt = 2e-4;
    // rapier's own ratio to the time step. Its 60 Hz would let the weight of a millimetre sink in
    // by a tenth.
    parameters.contact_softness.natural_frequency = 0.5 / parameters.dt;
    parameters.static_contact_softness.natural_frequency = 1.0 / parameters.dt;
    let pose = Pose::from_parts(pose.translation * size, pose.rotation);
    let mut drop = Drop::new(world, mesh(size, height), shape, pose);
    // Steel. The unit of mass is the same in all scenes.
    let steel =
        drop.world.colliders[drop.collider].shape().mass_properties(7.8e-6 / (size * size * size));
    drop.world.colliders[drop.collider].set_mass_properties(steel);
    let step = |_| {
        drop.world.step();
        drop.pose().translation / size
    };
    (0..STEPS).map(step).collect()
}

/// A thousand and twenty-four, so that not even rounding differs.
const THOUSAND: Real = 1024.0;

/// Bit for bit the same, on a plane and on bumps.
#[test]
fn one_scene_at_three_scales() {
    for link in links() {
        for (attitude, turn) in attitudes() {
            let pose = Pose::from_parts(Vector::new(0.1, 1.9, -0.2), turn);
            for height in [|_, _| 0.0, bump as fn(Real, Real) -> Real] {
                let at = |size| fall(size, SharedShape::new(scaled(&link, size)), pose, height);
                let millimetres = at(1.0);
                let context = format!("{:?} {attitude}", link.caps());
                for other in [at(1.0 / THOUSAND), at(THOUSAND)] {
                    let apart = (0..STEPS).find(|&step| millimetres[step] != other[step]);
                    assert_eq!(apart, None, "{context}");
                }
                let last = millimetres[STEPS - 1];
                assert!(last.y < 1.51 && last.y > 0.2, "{context} ends at {last}");
            }
        }
    }
}

/// By a true thousand, rounding decides which of many equally deep points hold the link. It rests
/// at the same height.
#[test]
fn metres_millimetres_and_micrometres() {
    for link in links() {
        for (attitude, turn) in attitudes() {
            let pose = Pose::from_parts(Vector::new(0.1, 1.9, -0.2), turn);
            let heights = [1e-3, 1.0, 1e3].map(|size| {
                let places = fall(size, SharedShape::new(scaled(&link, size)), pose, |_, _| 0.0);
                places[STEPS - 1].y
            });
            let apart = (heights[0] - heights[1]).abs().max((heights[2] - heights[1]).abs());
            assert!(apart < 5e-4, "{:?} {attitude}: {heights:?}", link.caps());
        }
    }
}

#[test]
fn a_chain_at_three_scales() {
    let points = [Vector::ZERO, Vector::X, Vector::new(1.9, 0.0, 0.4), Vector::new(2.6, 0.2, 1.1)];
    let at = |size: Real| {
        let robot =
            Chain::from_centreline(&points.map(|p| p * size), &[0.4, 0.4, 0.3].map(|r| r * size));
        let pose = Pose::new(Vector::new(-1.0, 1.0, 0.0), Vector::new(0.1, 0.2, 0.1));
        fall(size, SharedShape::new(robot.unwrap()), pose, bump)
    };
    let millimetres = at(1.0);
    assert!(at(1.0 / THOUSAND) == millimetres && at(THOUSAND) == millimetres);
    assert!(millimetres[STEPS - 1].y < 0.7);
}
