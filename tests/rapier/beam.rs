//! The elastic robot of the example `rapier_ventricle` bends as beam theory says, pulled or pressed
//! against a wall.

use continuum_demo::rod::{self, RestShape, Rod};
use parry_continuum::parry::math::{Pose, Real, Vector};
use rapier3d_f64::prelude::*;

/// Bending stiffness in mN mm^2, length in mm.
const EI: Real = 5e5;
const LENGTH: Real = 40.0;
const LINKS: usize = 10;

fn straight(length: Real) -> RestShape {
    let points = (0..=LINKS).map(|k| Vector::Z * (length * k as Real / LINKS as Real)).collect();
    RestShape { points, radii: vec![1.0; LINKS], stiffness: vec![EI; LINKS] }
}

/// The moments of a clamped beam under a force at its end fall linearly along it. Joints stand for
/// the stretches around them, so they add up by the trapezoidal rule: F L^3 / 3 EI times 1 + 1 / 2
/// n^2.
#[test]
fn a_pulled_tip_moves_as_far_as_that_of_a_beam() {
    let mut world = rod::world(2.0).unwrap();
    let mut robot = Rod::new(&mut world, Pose::IDENTITY);
    robot.set_rest_shape(&mut world, &straight(LENGTH)).unwrap();
    let force = 10.0;
    for _ in 0..400 {
        let (body, tip) = robot.tip(&world).unwrap();
        world.bodies[body].reset_forces(true);
        world.bodies[body].reset_torques(true);
        world.bodies[body].add_force_at_point(Vector::X * force, tip, true);
        world.step();
    }
    let tip = robot.points(&world)[LINKS];
    let beam = force * LENGTH.powi(3) / (3.0 * EI) * (1.0 + 0.5 / (LINKS * LINKS) as Real);
    assert!((tip.x - beam).abs() < 1e-3 * beam && tip.y.abs() < 1e-9, "{tip} for {beam}");
    // It does not stretch.
    let points = robot.points(&world);
    let longest = points.windows(2).map(|ends| (ends[1] - ends[0]).length()).fold(0.0, Real::max);
    assert!((longest - LENGTH / LINKS as Real).abs() < 1e-9);
}

/// The contact forces on a robot that is moved sideways by its base against the edge of a wall.
fn pressed(edge: Real, aside: Real) -> Vec<Real> {
    let mut world = rod::world(2.0).unwrap();
    let wall =
        [(-9.0, edge), (9.0, edge), (9.0, 60.0), (-9.0, 60.0)].map(|(y, z)| Vector::new(1.0, y, z));
    let wall = ColliderBuilder::trimesh(wall.to_vec(), vec![[0, 1, 2], [0, 2, 3]]).unwrap();
    world.insert(RigidBodyBuilder::fixed(), wall.friction(0.0));
    let mut robot = Rod::new(&mut world, Pose::IDENTITY);
    robot.set_rest_shape(&mut world, &straight(LENGTH)).unwrap();
    for step in 0..900 {
        let way = aside * (step as Real / 400.0).min(1.0);
        robot.push(&mut world, Pose::from_translation(Vector::X * way));
        world.step();
    }
    robot.forces(&world)
}

/// It is held there by 3 EI d / L^3, and in a second run by the same, bit for bit.
#[test]
fn a_wall_holds_it_with_the_force_of_a_bent_beam() {
    let (edge, aside) = (39.0, 0.5);
    let forces = pressed(edge, aside);
    let held: Real = forces.iter().sum();
    let beam = 3.0 * EI * aside / edge.powi(3);
    assert!((held - beam).abs() < 0.02 * beam, "{held} mN for {beam} mN: {forces:?}");
    assert_eq!(forces.iter().filter(|force| **force > 0.0).count(), 1);
    assert_eq!(pressed(edge, aside), forces);
}

/// A rest shape that grows and bends is followed; without forces nothing else happens.
#[test]
fn it_follows_its_rest_shape() {
    let mut world = rod::world(2.0).unwrap();
    let mut robot = Rod::new(&mut world, Pose::IDENTITY);
    for step in 1..=200 {
        let (count, bend) = (2 + step / 25, 0.001 * step as Real);
        let mut points = vec![Vector::ZERO];
        for k in 0..count {
            let turn = bend * k as Real;
            points.push(points[k] + Vector::new(turn.sin(), 0.0, turn.cos()) * 2.0);
        }
        let rest = RestShape { points, radii: vec![1.0; count], stiffness: vec![EI; count] };
        robot.set_rest_shape(&mut world, &rest).unwrap();
        world.step();
        let is = robot.points(&world);
        let apart = is.iter().zip(&rest.points).map(|(is, rest)| (*is - *rest).length());
        assert!(apart.fold(0.0, Real::max) < 1e-6, "step {step}");
        assert_eq!(is.len(), count + 1);
    }
}
