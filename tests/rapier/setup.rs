//! What the helper sets, and what rapier cannot do with custom shapes.

use parry_continuum::parry::math::{Pose, Real, Vector};
use parry_continuum::parry::shape::{Cuboid, Triangle};
use parry_continuum::{ModifiedCylinder, rapier};
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
