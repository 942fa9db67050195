//! The search on the GPU over many robots: the answers of the search on the CPU, to the last bit.

use continuum_demo::steer::Random;
use continuum_demo::{ctr, ventricle};
use continuum_testing::{Random as Seeded, gpu, rounds};
use parry_continuum::gpu::GpuSearch;
use parry_continuum::parry::math::{Pose, Vector};
use parry_continuum::parry::shape::{Ball, TriMesh};
use parry_continuum::proximity::{BvhSearch, LinkProximity, Proximity, ProximityError};
use parry_continuum::{BendingSection, Chain};

/// Asserts that both engines have the same minima. Returns them.
pub fn same_minima(
    engine: &mut GpuSearch,
    reference: &mut BvhSearch,
    robots: &[(&Chain, Pose)],
) -> Vec<Result<LinkProximity, ProximityError>> {
    let (mut found, mut expected) = (Vec::new(), Vec::new());
    engine.minimum_batch(robots, &mut found).unwrap();
    reference.minimum_batch(robots, &mut expected).unwrap();
    assert_eq!(found, expected);
    expected
}

/// Asserts that both engines have the same answers for each link.
pub fn same_links(engine: &mut GpuSearch, reference: &mut BvhSearch, robots: &[(&Chain, Pose)]) {
    let (mut found, mut expected) = (Vec::new(), Vec::new());
    engine.per_link_batch(robots, &mut found).unwrap();
    reference.per_link_batch(robots, &mut expected).unwrap();
    assert_eq!(found, expected);
}

/// Asserts that both engines decide alike about a margin.
pub fn same_decisions(
    engine: &mut GpuSearch,
    reference: &mut BvhSearch,
    robots: &[(&Chain, Pose)],
    margin: f64,
) {
    let (mut found, mut expected) = (Vec::new(), Vec::new());
    engine.clears_batch(robots, margin, &mut found).unwrap();
    reference.clears_batch(robots, margin, &mut expected).unwrap();
    assert_eq!(found, expected, "{margin}");
}

/// Asserts that both engines have the same contacts. Returns their number.
pub fn same_contacts(
    engine: &mut GpuSearch,
    reference: &mut BvhSearch,
    (robot, pose): (&Chain, Pose),
    margin: f64,
) -> usize {
    let (mut found, mut expected) = (Vec::new(), Vec::new());
    for prominence in [0.0, 0.2] {
        engine.contacts_within(robot, &pose, margin, prominence, &mut found).unwrap();
        reference.contacts_within(robot, &pose, margin, prominence, &mut expected).unwrap();
        assert_eq!(found, expected, "{margin}, {prominence}");
    }
    found.len()
}

/// Random shapes of three tubes in a ventricle, with the caps that fit, as capsules and as
/// cylinders; most of them touch the wall. PARRY_CONTINUUM_EFFORT=25 asks about 100,000.
#[test]
fn random_robots_are_answered_as_on_the_cpu() {
    let (vertices, indices) = ventricle::mesh(20_000);
    let mesh = TriMesh::new(vertices, indices).unwrap();
    let Some(mut engine) = gpu::search(&mesh) else { return };
    let mut reference = BvhSearch::new(&mesh).unwrap();
    let (tubes, mut random) = (ctr::three_tubes(), Random(17));
    let (mut touching, mut apart, mut contacts, count) = (0, 0, 0, rounds(4000_usize));
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
        for answer in same_minima(&mut engine, &mut reference, &robots) {
            if answer.unwrap().distance > 0.0 { apart += 1 } else { touching += 1 }
        }
        same_links(&mut engine, &mut reference, &robots);
        for margin in [0.0, 0.5] {
            same_decisions(&mut engine, &mut reference, &robots, margin);
        }
        for &robot in robots.iter().step_by(50) {
            contacts += same_contacts(&mut engine, &mut reference, robot, 1.0);
        }
    }
    assert!(contacts > count / 50, "{contacts} contacts");
    assert!(apart > count / 20 && touching > count / 20, "{apart} apart, {touching} touching");
    // Of all four questions.
    assert!(engine.answered_on_cpu() < count as u64 / 4, "{}", engine.answered_on_cpu());
}

/// From the centre of a ball nearly all triangles are equally near. Mesa's GPU in software stops
/// the loops of such a search, and the robot is left to the CPU.
#[test]
fn loops_that_a_driver_stops_lose_no_answer() {
    let (vertices, indices) = Ball::new(10.0).to_trimesh(60, 60);
    let mesh = TriMesh::new(vertices, indices).unwrap();
    let Some(mut engine) = gpu::search(&mesh) else { return };
    let mut random = Seeded::new(31);
    let shapes: Vec<_> = (0..200)
        .map(|shape| {
            let mut points = vec![random.point() * 0.2];
            for k in 0..8 {
                points.push(points[k] + random.direction() * 0.1);
            }
            let build = [Chain::from_centreline, Chain::capsules, Chain::cylinders][shape % 3];
            build(&points, &[random.between(0.05, 0.6); 8]).unwrap()
        })
        .collect();
    let robots: Vec<_> = shapes.iter().map(|shape| (shape, Pose::IDENTITY)).collect();
    let mut reference = BvhSearch::new(&mesh).unwrap();
    for _ in 0..3 {
        same_links(&mut engine, &mut reference, &robots);
        same_minima(&mut engine, &mut reference, &robots);
    }
}

/// A batch of more links than the device gets at once: chunks take turns in two sets of buffers,
/// the last one smaller, and a robot that is left to the CPU stands in each.
#[test]
fn a_batch_takes_several_chunks() {
    let (vertices, indices) = Ball::new(10.0).to_trimesh(8, 4);
    let mesh = TriMesh::new(vertices, indices).unwrap();
    let Some(mut engine) = gpu::search(&mesh) else { return };
    let mut random = Seeded::new(29);
    let shapes: Vec<_> = (0..64)
        .map(|_| {
            let mut points = vec![random.point() * 4.0];
            for k in 0..64 {
                points.push(points[k] + random.direction() * 0.3);
            }
            Chain::from_centreline(&points, &[0.2; 64]).unwrap()
        })
        .collect();
    // Five chunks: four of 2^13 parts, and a smaller one.
    let mut robots: Vec<_> = (0..20_000).map(|k| (&shapes[k % 64], random.pose(1.0))).collect();
    robots.iter_mut().step_by(4096).for_each(|(_, pose)| pose.translation.x = 1e9);
    robots[17_000].1.translation.x = f64::NAN;
    let mut reference = BvhSearch::new(&mesh).unwrap();
    same_minima(&mut engine, &mut reference, &robots);
    assert_eq!(engine.answered_on_cpu(), 5);
    same_decisions(&mut engine, &mut reference, &robots, 0.5);
}

/// The search computes in single precision on a GPU of either precision.
#[test]
fn a_gpu_of_double_precision_has_the_same_answers() {
    let (vertices, indices) = Ball::new(10.0).to_trimesh(40, 20);
    let mesh = TriMesh::new(vertices, indices).unwrap();
    let mut random = Seeded::new(37);
    let shapes: Vec<_> = (0..100)
        .map(|shape| {
            let mut points = vec![random.point() * 5.0];
            for k in 0..20 {
                points.push(points[k] + random.direction() * 0.4);
            }
            let build = [Chain::from_centreline, Chain::capsules, Chain::cylinders][shape % 3];
            build(&points, &[random.between(0.05, 0.6); 20]).unwrap()
        })
        .collect();
    let robots: Vec<_> = shapes.iter().map(|shape| (shape, Pose::IDENTITY)).collect();
    let section = |bend| BendingSection { length: 6.0, radius: 0.5, bend: [bend, 0.1] };
    let bent: Vec<_> = (0..100).map(|k| [section(0.003 * f64::from(k)); 2]).collect();
    for (_, precision) in gpu::PRECISIONS {
        let Some(gpu) = gpu::open(precision) else { continue };
        let mut engine = GpuSearch::on(gpu, &mesh).unwrap();
        engine.set_min_links(Some(0));
        let mut reference = BvhSearch::new(&mesh).unwrap();
        same_minima(&mut engine, &mut reference, &robots);
        same_links(&mut engine, &mut reference, &robots);
        same_decisions(&mut engine, &mut reference, &robots, 0.5);
        same_contacts(&mut engine, &mut reference, robots[7], 2.0);
        let (mut found, mut expected) = (Vec::new(), Vec::new());
        engine.clears_sections_batch(&bent, 9, &Pose::IDENTITY, 0.3, &mut found).unwrap();
        reference.clears_sections_batch(&bent, 9, &Pose::IDENTITY, 0.3, &mut expected).unwrap();
        assert_eq!(found, expected);
        assert_eq!(engine.answered_on_cpu(), 0);
    }
}

/// After a move of a large mesh the contacts come from the device, until the CPU has refitted.
#[test]
fn contacts_follow_a_large_mesh_that_moves() {
    let (vertices, indices) = Ball::new(10.0).to_trimesh(260, 130);
    let mesh = TriMesh::new(vertices, indices).unwrap();
    assert!(mesh.num_triangles() > 1 << 16);
    let Some(mut engine) = gpu::search(&mesh) else { return };
    engine.set_min_links(None);
    let points = [0.0, 1.0, 2.0].map(|x| Vector::new(4.0 * x, x, 0.0));
    let robot = Chain::from_centreline(&points, &[0.6, 0.4]).unwrap();
    let mut reference = BvhSearch::new(&mesh).unwrap();
    assert!(same_contacts(&mut engine, &mut reference, (&robot, Pose::IDENTITY), 4.0) > 0);
    let at_rest = engine.device_time();
    for turn in [0.9, 0.7] {
        let moved: Vec<_> =
            mesh.vertices().iter().map(|v| Vector::new(v.x * turn, v.y, v.z)).collect();
        engine.set_vertices(&moved).unwrap();
        reference.set_vertices(&moved).unwrap();
        assert!(same_contacts(&mut engine, &mut reference, (&robot, Pose::IDENTITY), 1.0) > 0);
    }
    assert!(at_rest.is_none() && engine.device_time().is_some());
    assert_eq!(engine.answered_on_cpu(), 0);
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
