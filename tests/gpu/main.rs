//! The engine on the GPU. tests/proximity also tests it with the questions of all engines.
#![cfg(feature = "gpu")]

mod bending;
mod hostile;
mod search;

use continuum_testing::{Random, answered, gpu};
use parry_continuum::Chain;
use parry_continuum::gpu::GpuExhaustive;
use parry_continuum::parry::math::{Pose, Vector};
use parry_continuum::parry::shape::{Ball, TriMesh};
use parry_continuum::proximity::{Exhaustive, LinkProximity, Proximity};

/// A lumpy ball of about a thousand triangles.
fn cave() -> TriMesh {
    let (mut vertices, indices) = Ball::new(10.0).to_trimesh(32, 16);
    for v in &mut vertices {
        *v *= 1.0 + 0.1 * (v.x * 1.3).sin() * (v.y * 0.9).cos() + 0.05 * (v.z * 2.1).sin();
    }
    TriMesh::new(vertices, indices).unwrap()
}

/// Robots of 30 links, each model in turn, in the cave or through its wall.
fn robots(count: u32) -> Vec<(Chain, Pose)> {
    let mut random = Random::new(5);
    (0..count)
        .map(|number| {
            let mut points = vec![random.point() * 4.0];
            let mut heading = random.direction();
            let step = if number % 4 == 3 { 0.5 } else { 0.15 };
            for k in 0..30 {
                heading = (heading + random.direction() * 0.3).normalize();
                points.push(points[k] + heading * step);
            }
            let radii: Vec<_> = (0..30).map(|k| [0.6, 0.4, 0.2][k / 10]).collect();
            let robot = match number % 3 {
                0 => Chain::from_centreline(&points, &radii),
                1 => Chain::capsules(&points, &radii),
                _ => Chain::cylinders(&points, &radii),
            };
            (robot.unwrap(), random.pose(1.0))
        })
        .collect()
}

fn refs(robots: &[(Chain, Pose)]) -> Vec<(&Chain, Pose)> {
    robots.iter().map(|(robot, pose)| (robot, *pose)).collect()
}

fn distances(answers: &[LinkProximity]) -> Vec<f64> {
    answers.iter().map(|answer| answer.distance).collect()
}

/// The GPU's candidates contain the double-precision minimum: the distances equal the CPU's bit for
/// bit, with and without culling, one by one and in a batch, and no link needed the CPU.
#[test]
fn the_distances_are_those_of_the_cpu() {
    let (mesh, robots) = (cave(), robots(12));
    let mut exhaustive = Exhaustive::<f64>::new(&mesh).unwrap();
    let mut expected = Vec::new();
    exhaustive.per_link_batch(&refs(&robots), &mut expected).unwrap();
    let expected = answered(&expected);
    let all: Vec<_> = expected.iter().flatten().collect();
    let touching = all.iter().filter(|answer| answer.distance == 0.0).count();
    assert!(touching > 10 && touching < all.len() / 2, "{touching} of {} touch", all.len());
    for (name, precision) in gpu::PRECISIONS {
        let Some(gpu) = gpu::open(precision) else { continue };
        let mut engine = GpuExhaustive::on(gpu, &mesh).unwrap();
        for culling in [true, false] {
            #[cfg(feature = "laboratory")]
            engine.set_culling(culling).unwrap();
            let (mut answers, mut batch) = (Vec::new(), Vec::new());
            for ((robot, pose), expected) in robots.iter().zip(&expected) {
                engine.per_link(robot, pose, &mut answers).unwrap();
                assert_eq!(distances(&answers), distances(expected), "{name}, culling {culling}");
                let minimum = distances(expected).into_iter().fold(f64::INFINITY, f64::min);
                assert_eq!(engine.minimum(robot, pose).unwrap().distance, minimum);
                for margin in [0.5 * minimum, minimum, minimum.next_up(), minimum + 0.1] {
                    assert_eq!(engine.clears(robot, pose, margin).unwrap(), minimum > margin);
                }
            }
            engine.per_link_batch(&refs(&robots), &mut batch).unwrap();
            let (mut minima, mut clear) = (Vec::new(), Vec::new());
            engine.minimum_batch(&refs(&robots), &mut minima).unwrap();
            engine.clears_batch(&refs(&robots), 0.2, &mut clear).unwrap();
            for (((answers, expected), minimum), clear) in
                answered(&batch).iter().zip(&expected).zip(answered(&minima)).zip(answered(&clear))
            {
                assert_eq!(
                    distances(answers),
                    distances(expected),
                    "{name}, culling {culling}, in a batch"
                );
                let least = distances(expected).into_iter().fold(f64::INFINITY, f64::min);
                assert_eq!((minimum.distance, clear), (least, least > 0.2));
            }
        }
        assert_eq!(engine.answered_on_cpu(), 0, "{name}");
    }
}

#[test]
fn answers_are_the_same_every_time() {
    let (mesh, robots) = (cave(), robots(6));
    for (name, precision) in gpu::PRECISIONS {
        let Some(gpu) = gpu::open(precision) else { continue };
        let (mut first, mut again) = (Vec::new(), Vec::new());
        GpuExhaustive::on(gpu, &mesh).unwrap().per_link_batch(&refs(&robots), &mut first).unwrap();
        let mut engine = GpuExhaustive::on(gpu, &mesh).unwrap();
        for _ in 0..5 {
            engine.per_link_batch(&refs(&robots), &mut again).unwrap();
            assert_eq!(first, again, "{name}");
        }
    }
}

/// More blocks than a workgroup has threads, and more triangles than the first limits are sampled
/// from.
#[test]
fn a_large_mesh() {
    let (vertices, indices) = Ball::new(10.0).to_trimesh(260, 130);
    let mesh = TriMesh::new(vertices, indices).unwrap();
    assert!(mesh.num_triangles() > 256 * 256);
    let mut random = Random::new(23);
    let robots: Vec<_> = (0..4)
        .map(|_| {
            let robot = Chain::cylinders(&[random.point() * 4.0, random.point() * 4.0], &[0.5]);
            (robot.unwrap(), random.pose(1.0))
        })
        .collect();
    let (mut expected, mut answers) = (Vec::new(), Vec::new());
    Exhaustive::<f64>::new(&mesh).unwrap().per_link_batch(&refs(&robots), &mut expected).unwrap();
    let expected = answered(&expected);
    for (name, precision) in gpu::PRECISIONS {
        let Some(gpu) = gpu::open(precision) else { continue };
        let mut engine = GpuExhaustive::on(gpu, &mesh).unwrap();
        engine.per_link_batch(&refs(&robots), &mut answers).unwrap();
        for (answers, expected) in answered(&answers).iter().zip(&expected) {
            assert_eq!(distances(answers), distances(expected), "{name}");
        }
        assert_eq!(engine.answered_on_cpu(), 0, "{name}");
    }
}

/// A link so far out that single precision would overflow is measured on the CPU, and counted.
#[test]
fn far_links_are_answered_too() {
    let mesh = cave();
    let robot = Chain::capsules(&[Vector::ZERO, Vector::Z], &[0.5]).unwrap();
    let pose = Pose::from_translation(Vector::X * 1e9);
    let expected = Exhaustive::<f64>::new(&mesh).unwrap().minimum(&robot, &pose).unwrap();
    for (_, precision) in gpu::PRECISIONS {
        let Some(gpu) = gpu::open(precision) else { continue };
        let mut engine = GpuExhaustive::on(gpu, &mesh).unwrap();
        assert_eq!(engine.minimum(&robot, &pose).unwrap().distance, expected.distance);
        assert_eq!(engine.answered_on_cpu(), 1);
    }
}

/// The adapter reports its name and kind, and its clock runs if it has one.
#[test]
fn the_adapter_is_named() {
    for (_, precision) in gpu::PRECISIONS {
        let Some(gpu) = gpu::open(precision) else { continue };
        let adapter = gpu.adapter();
        assert!(!adapter.name.is_empty());
        assert_eq!(adapter.to_string().contains("in software"), adapter.is_software);
        assert_eq!(
            adapter.is_software,
            adapter.name.contains("llvmpipe") || adapter.name.contains("SwiftShader")
        );
        let mut engine = GpuExhaustive::on(gpu, &cave()).unwrap();
        let (robot, pose) = &robots(1)[0];
        engine.minimum(robot, pose).unwrap();
        assert!(engine.device_time().is_none_or(|time| time.as_nanos() > 0));
    }
}

/// Where a triangle lies just before a flat cap and another overlaps the link, the gap does not
/// hide the overlap.
#[test]
fn a_gap_before_a_flat_cap_hides_no_overlap() {
    let mut random = Random::new(11);
    for (name, precision) in gpu::PRECISIONS {
        let Some(gpu) = gpu::open(precision) else { continue };
        for round in 0..100 {
            let (start, direction) = (random.point() * 3.0, random.direction());
            let (side, length) = (direction.any_orthonormal_vector(), random.between(0.5, 2.0));
            let (end, radius) = (start + direction * length, random.between(0.1, 0.5));
            let other = direction.cross(side);
            let across = |ahead: f64, aside: f64| {
                [0.0, 2.0, 4.0].map(|turn: f64| {
                    let (sin, cos) = turn.sin_cos();
                    end + direction * ahead
                        + side * (aside * radius)
                        + (side * cos + other * sin) * (0.1 * radius)
                })
            };
            let far =
                [Vector::splat(20.0), Vector::new(20.0, 20.0, 19.0), Vector::new(20.0, 19.0, 20.0)];
            let gap = 10.0_f64.powf(random.between(-12.0, -7.0));
            let corners = [across(gap, 0.1), across(-0.4 * length, 0.6), far].concat();
            let mesh = TriMesh::new(corners, vec![[0, 1, 2], [3, 4, 5], [6, 7, 8]]).unwrap();
            let robot = Chain::cylinders(&[start, end], &[radius]).unwrap();
            let answer =
                GpuExhaustive::on(gpu, &mesh).unwrap().minimum(&robot, &Pose::IDENTITY).unwrap();
            assert_eq!(
                (answer.distance, answer.witness.triangle),
                (0.0, 1),
                "{name}, {round}: a gap of {gap}"
            );
        }
    }
}
