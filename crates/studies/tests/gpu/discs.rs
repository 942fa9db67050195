//! The paper's routes to the discs, in place of ours, are bounds that lead to the same answers.

use continuum_studies::gpu::Discs;
use continuum_testing::{Random, answered, gpu};
use parry_continuum::Chain;
use parry_continuum::gpu::GpuExhaustive;
use parry_continuum::parry::math::Pose;
use parry_continuum::parry::shape::{Ball, TriMesh};
use parry_continuum::proximity::{Exhaustive, LinkProximity, Proximity};

fn distances(answers: &[LinkProximity]) -> Vec<f64> {
    answers.iter().map(|answer| answer.distance).collect()
}

/// Cylinders in a ball and through its wall: their discs decide.
fn robots() -> Vec<(Chain, Pose)> {
    let mut random = Random::new(5);
    (0..6)
        .map(|number| {
            let mut points = vec![random.point() * 4.0];
            let mut heading = random.direction();
            for k in 0..30 {
                heading = (heading + random.direction() * 0.3).normalize();
                points.push(points[k] + heading * if number % 3 == 0 { 0.15 } else { 0.5 });
            }
            (Chain::cylinders(&points, &[0.4; 30]).unwrap(), random.pose(1.0))
        })
        .collect()
}

#[test]
fn every_route_to_the_discs_gives_the_same_answers() {
    let (vertices, indices) = Ball::new(10.0).to_trimesh(32, 16);
    let mesh = TriMesh::new(vertices, indices).unwrap();
    let robots = robots();
    let robots: Vec<_> = robots.iter().map(|(robot, pose)| (robot, *pose)).collect();
    let mut expected = Vec::new();
    Exhaustive::<f64>::new(&mesh).unwrap().per_link_batch(&robots, &mut expected).unwrap();
    let expected = answered(&expected);
    let touching = expected.iter().flatten().filter(|answer| answer.distance == 0.0).count();
    assert!(touching > 5 && touching < 90, "{touching} of 180 touch");
    for (name, precision) in gpu::PRECISIONS {
        let Some(gpu) = gpu::open(precision) else { continue };
        let mut engine = GpuExhaustive::on(gpu, &mesh).unwrap();
        for discs in [Discs::Convex, Discs::ClosedForm, Discs::Companion] {
            engine.compute_every_pair(&discs.route(precision)).unwrap();
            let mut answers = Vec::new();
            engine.per_link_batch(&robots, &mut answers).unwrap();
            for (answers, expected) in answered(&answers).iter().zip(&expected) {
                assert_eq!(distances(answers), distances(expected), "{name} {discs:?}");
            }
        }
        assert_eq!(engine.answered_on_cpu(), 0, "{name}");
    }
}
