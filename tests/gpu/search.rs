//! The search on the GPU over many robots: the answers of the search on the CPU, to the last bit.

use continuum_demo::steer::Random;
use continuum_demo::{ctr, ventricle};
use continuum_testing::{Random as Seeded, gpu, rounds};
use parry_continuum::Chain;
use parry_continuum::parry::math::{Pose, Vector};
use parry_continuum::parry::shape::{Ball, TriMesh};
use parry_continuum::proximity::{BvhSearch, Proximity};

/// Random shapes of three tubes in a ventricle, with the caps that fit, as capsules and as
/// cylinders; most of them touch the wall. PARRY_CONTINUUM_EFFORT=25 asks about 100,000.
#[test]
fn random_robots_are_answered_as_on_the_cpu() {
    let (vertices, indices) = ventricle::mesh(20_000);
    let mesh = TriMesh::new(vertices, indices).unwrap();
    let Some(mut engine) = gpu::search(&mesh) else { return };
    let mut reference = BvhSearch::new(&mesh).unwrap();
    let (tubes, mut random) = (ctr::three_tubes(), Random(17));
    let (mut touching, mut apart, count) = (0, 0, rounds(4000_usize));
    let mut left = count;
    while left > 0 {
        let now = left.min(5000);
        left -= now;
        let shapes: Vec<_> = (0..now)
            .map(|shape| {
                let line = tubes.centreline(&tubes.any_joints(&mut random), 30);
                let build = [Chain::from_centreline, Chain::capsules, Chain::cylinders][shape % 3];
                build(&line.points, &line.radii).unwrap()
            })
            .collect();
        let robots: Vec<_> = shapes.iter().map(|shape| (shape, ventricle::entry())).collect();
        let (mut found, mut expected) = (Vec::new(), Vec::new());
        engine.minimum_batch(&robots, &mut found).unwrap();
        reference.minimum_batch(&robots, &mut expected).unwrap();
        assert_eq!(found, expected);
        for answer in &expected {
            if answer.as_ref().unwrap().distance > 0.0 { apart += 1 } else { touching += 1 }
        }
        let (mut found, mut expected) = (Vec::new(), Vec::new());
        engine.per_link_batch(&robots, &mut found).unwrap();
        reference.per_link_batch(&robots, &mut expected).unwrap();
        assert_eq!(found, expected);
        for margin in [0.0, 0.5] {
            let (mut found, mut expected) = (Vec::new(), Vec::new());
            engine.clears_batch(&robots, margin, &mut found).unwrap();
            reference.clears_batch(&robots, margin, &mut expected).unwrap();
            assert_eq!(found, expected, "{margin}");
        }
    }
    assert!(apart > count / 20 && touching > count / 20, "{apart} apart, {touching} touching");
    // Of all four questions.
    assert!(engine.answered_on_cpu() < count as u64 / 4, "{}", engine.answered_on_cpu());
}

/// The search goes on while the mesh moves, and batches of every size reuse its buffers.
#[test]
#[cfg(target_os = "linux")]
#[ignore = "reads the memory of the whole process, so it runs alone"]
fn ten_thousand_batches_keep_the_memory_they_have() {
    let resident = || {
        let text = std::fs::read_to_string("/proc/self/statm").unwrap();
        text.split(' ').nth(1).and_then(|pages| pages.parse::<usize>().ok()).unwrap() * 4096
    };
    let (vertices, indices) = Ball::new(10.0).to_trimesh(8, 4);
    let mesh = TriMesh::new(vertices, indices).unwrap();
    let Some(mut engine) = gpu::search(&mesh) else { return };
    let mut random = Seeded::new(3);
    let robot = Chain::from_centreline(&[Vector::ZERO, Vector::Z, Vector::Z * 2.0], &[0.5, 0.3]);
    let robot = robot.unwrap();
    let (mut minima, mut links, mut before) = (Vec::new(), Vec::new(), 0);
    for batch in 0..10_000 {
        let robots: Vec<_> = (0..1 + batch % 7).map(|_| (&robot, random.pose(1.0))).collect();
        if batch % 2 == 0 {
            engine.minimum_batch(&robots, &mut minima).unwrap();
        } else {
            engine.per_link_batch(&robots, &mut links).unwrap();
        }
        if batch % 100 == 0 {
            engine.set_vertices(mesh.vertices()).unwrap();
        }
        if batch == 2000 {
            before = resident();
        }
    }
    let grown = resident().saturating_sub(before);
    assert!(grown < 4 << 20, "{grown} bytes more after 8,000 batches");
    assert_eq!(minima[0].as_ref().map(|answer| answer.distance > 0.0), Ok(true));
    assert!(engine.clears(&robot, &Pose::IDENTITY, 1.0).unwrap());
}
