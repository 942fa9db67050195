//! Fast links do not pass through a wall.

use crate::drop::{Drop, attitudes, links, mesh, world};
use parry_continuum::parry::math::{Pose, Real, Vector};
use rapier3d_f64::prelude::*;

/// Thrown at a floor without thickness, a hundred times its radius in a step. Returns whether it got through.
fn thrown(link: usize, attitude: usize, substeps: usize) -> bool {
    let mut world = world(1.0);
    world.integration_parameters.max_ccd_substeps = substeps;
    let pose = Pose::from_parts(Vector::new(0.3, 20.0, 0.1), attitudes()[attitude].1);
    let mut drop = Drop::new(world, mesh(1.0, |_, _| 0.0), SharedShape::new(links()[link]), pose);
    let body = &mut drop.world.bodies[drop.body];
    body.enable_ccd(substeps > 0);
    body.set_linvel(Vector::Y * -6000.0, true);
    for _ in 0..60 {
        drop.world.step();
    }
    drop.pose().translation.y < -1.0
}

#[test]
fn with_continuous_collision_detection_nothing_passes() {
    for link in 0..4 {
        for (attitude, named) in attitudes().iter().enumerate() {
            assert!(!thrown(link, attitude, 1), "{:?} {}", links()[link].caps(), named.0);
            assert!(thrown(link, attitude, 0), "too slow to need it: {:?}", links()[link].caps());
        }
    }
}

/// A link that is spun into a wall, too: its end moves 30 radii in a step.
#[test]
fn a_spinning_link_stays_above() {
    for link in links() {
        let pose = Pose::from_parts(Vector::new(0.3, 1.6, 0.1), attitudes()[0].1);
        let mut drop = Drop::new(world(1.0), mesh(1.0, |_, _| 0.0), SharedShape::new(link), pose);
        let body = &mut drop.world.bodies[drop.body];
        body.enable_ccd(true);
        body.set_angvel(Vector::new(0.3, 0.0, 1.0) * 200.0, true);
        let mut lowest = Real::INFINITY;
        for _ in 0..240 {
            drop.world.step();
            lowest = lowest.min(drop.pose().translation.y);
        }
        assert!(lowest > 0.3, "{:?} {lowest}", link.caps());
    }
}
