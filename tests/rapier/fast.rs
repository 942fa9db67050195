//! Fast links do not pass through a wall without thickness, in any attitude.
//!
//! Thrown at it with continuous collision detection, they touch it with one end, and the blow
//! swings the other end through the wall within the next step. rapier takes a hit at the very start
//! of a step for none: only a cast that answers for what touches already (see
//! `src/host/link_cast.rs`) holds them there.

use crate::drop::{Drop, attitudes, links, mesh, world};
use continuum_testing::{Random, rounds};
use parry_continuum::parry::math::{Pose, Real, Vector};
use parry_continuum::{Cap, Chain, ModifiedCylinder};
use rapier3d_f64::prelude::*;

/// Thrown at a floor without thickness, a hundred times its radius in a step. Returns whether it
/// got through.
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

/// What is thrown: links 2 long, a chain of two of them, and parry's own.
fn thin(kind: &str, radius: Real) -> SharedShape {
    let link = |caps| ModifiedCylinder::new(-Vector::Y, Vector::Y, radius, caps).unwrap();
    match kind {
        "flat" => SharedShape::new(link([Cap::Flat; 2])),
        "round" => SharedShape::new(link([Cap::Round; 2])),
        "mixed" => SharedShape::new(link([Cap::Flat, Cap::Round])),
        "chain" => {
            let points = [-Vector::Y, Vector::ZERO, Vector::new(0.3, 0.9, 0.0)];
            SharedShape::new(Chain::from_centreline(&points, &[radius; 2]).unwrap())
        }
        "parry's capsule" => SharedShape::capsule_y(1.0, radius),
        "parry's cylinder" => SharedShape::cylinder(1.0, radius),
        _ => panic!("{kind}"),
    }
}

/// Counts the throws that get through, in random attitudes and with some spin.
fn through(kind: &str, radius: Real, speed: Real, throws: usize) -> usize {
    let mut random = Random::new(141);
    let passes = |_: &usize| {
        let turn = random.direction() * random.between(0.0, 3.1);
        let place = Vector::new(random.between(-1.0, 1.0), 3.0, random.between(-1.0, 1.0));
        let spin = random.direction() * random.between(0.0, 5.0);
        let mut drop = Drop::new(
            world(1.0),
            mesh(1.0, |_, _| 0.0),
            thin(kind, radius),
            Pose::new(place, turn),
        );
        drop.world.integration_parameters.dt = 1.0 / 60.0;
        let body = &mut drop.world.bodies[drop.body];
        body.enable_ccd(true);
        body.set_linvel(Vector::new(0.1, -1.0, 0.05) * speed, true);
        body.set_angvel(spin, true);
        for _ in 0..60 {
            drop.world.step();
            let at = drop.pose().translation;
            // Off the edge it may fall.
            if at.x.abs().max(at.z.abs()) > 5.0 {
                return false;
            }
            if at.y < -1.5 {
                return true;
            }
        }
        false
    };
    (0..throws).filter(passes).count()
}

const THIN: [(Real, Real); 4] = [(0.1, 100.0), (0.1, 300.0), (0.02, 100.0), (0.02, 300.0)];

fn none_gets_through(throws: usize) {
    for (radius, speed) in THIN {
        for kind in ["flat", "round", "mixed", "chain"] {
            let passed = through(kind, radius, speed, throws);
            assert_eq!(passed, 0, "{kind} of radius {radius} at {speed}, of {throws}");
        }
    }
}

#[test]
fn thin_links_do_not_get_through_in_any_attitude() {
    none_gets_through(rounds(50));
    // The scene is one in which things do get through.
    assert!(through("parry's cylinder", 0.02, 300.0, 50) > 0);
}

#[test]
#[ignore = "takes minutes"]
fn thin_links_do_not_get_through_in_a_thousand_attitudes() {
    for (radius, speed) in THIN {
        let [capsule, cylinder] =
            ["parry's capsule", "parry's cylinder"].map(|kind| through(kind, radius, speed, 1000));
        println!(
            "radius {radius} at {speed}: {capsule} of parry's capsules, {cylinder} of its cylinders"
        );
    }
    none_gets_through(1000);
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
