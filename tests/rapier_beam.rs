//! The elastic robot of the example bends as beam theory says.

#[path = "../examples/rapier_ventricle/rod.rs"]
#[allow(dead_code)]
mod rod;

use parry_continuum::parry::math::{Pose, Real, Vector};
use rod::{RestShape, Rod};

#[test]
fn explore() {
    const EI: Real = 5e5;
    for iterations in [1, 4] {
        let length = 40.0;
        let mut world = rod::world(2.0).unwrap();
        world.integration_parameters.num_solver_iterations = iterations;
        let mut robot = Rod::new(&mut world, Pose::IDENTITY);
        let points: Vec<_> = (0..=30).map(|k| Vector::Z * (length * k as Real / 30.0)).collect();
        let rest = RestShape { points, radii: vec![1.0; 30], stiffness: vec![EI; 30] };
        robot.set_rest_shape(&mut world, &rest).unwrap();
        let force = 10.0;
        println!("expected {}", force * length.powi(3) / 3.0 / EI);
        let t = std::time::Instant::now();
        for i in 0..501 {
            robot.pull_tip(&mut world, Vector::X * force);
            world.step();
            if i % 50 == 0 {
                println!("{iterations} {i} {:.5} {:?}", robot.points(&world)[30], t.elapsed());
            }
        }
        let p = robot.points(&world);
        let gap = p.windows(2).map(|w| (w[1] - w[0]).length()).fold(0.0, Real::max);
        println!("longest {gap}");
    }
}
