//! The search on the GPU: its refit, its failures and its limits.

use super::{ball, gpu, robot};
use crate::answer::{LinkProximity, PlacementFault, ProximityError};
use crate::engine::{BvhSearch, Proximity};
use crate::gpu::opened::Gpu;
use crate::gpu::search::SearchKernels;
use crate::gpu::search::kernels::{Question, passes};
use crate::gpu::{GpuError, GpuSearch, Precision};
use crate::robot::BendingSection;
use crate::robot::Chain;
use continuum_testing::Random;
use gpu_batch::{DeviceError, DeviceFailure, Shader, wgpu};
use parry3d_f64::math::{Pose, Real, Vector};
use parry3d_f64::shape::TriMesh;

/// The engine, all of whose queries go to the device.
fn search(gpu: &Gpu, mesh: &TriMesh) -> GpuSearch {
    let mut search = GpuSearch::on(gpu, mesh).unwrap();
    search.set_min_links(Some(0));
    search
}

/// Robots of each model in the ball and through its wall, some with more links than a link group.
fn robots(count: u32) -> Vec<(Chain, Pose)> {
    let mut random = Random::new(61);
    (0..count)
        .map(|number| {
            let links = [30, 1, 5, 32, 33, 70][number as usize % 6];
            let mut points = vec![random.point() * 4.0];
            let mut heading = random.direction();
            let step = if number % 4 == 3 { 0.5 } else { 0.15 };
            for k in 0..links {
                heading = (heading + random.direction() * 0.3).normalize();
                points.push(points[k] + heading * step);
            }
            let thick = random.between(0.2, 0.6);
            let radii: Vec<_> = (0..links).map(|k| thick / (1 + k / 10) as Real).collect();
            let build =
                [Chain::from_centreline, Chain::capsules, Chain::cylinders][number as usize % 3];
            (build(&points, &radii).unwrap(), random.pose(1.0))
        })
        .collect()
}

fn refs(robots: &[(Chain, Pose)]) -> Vec<(&Chain, Pose)> {
    robots.iter().map(|(robot, pose)| (robot, *pose)).collect()
}

/// All batches of two engines are the same, to the last bit.
fn check(engine: &mut GpuSearch, mesh: &TriMesh, robots: &[(&Chain, Pose)]) {
    let mut reference = BvhSearch::new(mesh).unwrap();
    let (mut minima, mut expected) = (Vec::new(), Vec::new());
    engine.minimum_batch(robots, &mut minima).unwrap();
    reference.minimum_batch(robots, &mut expected).unwrap();
    assert_eq!(minima, expected);
    let least: Vec<_> = expected.iter().flatten().collect();
    let (mut links, mut expected) = (Vec::new(), Vec::new());
    engine.per_link_batch(robots, &mut links).unwrap();
    reference.per_link_batch(robots, &mut expected).unwrap();
    assert_eq!(links, expected);
    let (mut clear, mut expected) = (Vec::new(), Vec::new());
    let middle = least[least.len() / 2].distance;
    for margin in [0.0, 1e-9, 0.3, middle, middle.next_down().max(0.0), 1e9, Real::INFINITY] {
        engine.clears_batch(robots, margin, &mut clear).unwrap();
        reference.clears_batch(robots, margin, &mut expected).unwrap();
        assert_eq!(clear, expected, "{margin}");
    }
}

#[test]
fn batches_are_those_of_the_cpu_bit_for_bit() {
    let Some(gpu) = gpu() else { return };
    let (mesh, robots) = (ball(), robots(200));
    let mut engine = search(gpu, &mesh);
    check(&mut engine, &mesh, &refs(&robots));
    assert_eq!(engine.answered_on_cpu(), 0);
    // One by one.
    let mut reference = BvhSearch::new(&mesh).unwrap();
    let (mut out, mut expected): (Vec<LinkProximity>, _) = (Vec::new(), Vec::new());
    for (robot, pose) in &robots[..20] {
        assert_eq!(engine.minimum(robot, pose), reference.minimum(robot, pose));
        engine.per_link(robot, pose, &mut out).unwrap();
        reference.per_link(robot, pose, &mut expected).unwrap();
        assert_eq!(out, expected);
        for bound in [0.0, 0.3, 5.0] {
            let found = engine.minimum_within(robot, pose, bound);
            assert_eq!(found, reference.minimum_within(robot, pose, bound));
        }
    }
}

/// Margins that hold no triangle, some and all; and robots that are left to the CPU.
#[test]
fn contacts_are_those_of_the_cpu_bit_for_bit() {
    let Some(gpu) = gpu() else { return };
    let (mesh, mut robots) = (ball(), robots(60));
    robots[8].1.translation.x = 1e9;
    let mut engine = search(gpu, &mesh);
    let mut reference = BvhSearch::new(&mesh).unwrap();
    let (mut out, mut expected) = (Vec::new(), Vec::new());
    let (mut none, mut several) = (0, 0);
    for margin in [0.0, 0.5, 3.0, 1e12] {
        for (robot, pose) in &robots {
            for prominence in [0.0, 0.1] {
                engine.contacts_within(robot, pose, margin, prominence, &mut out).unwrap();
                reference.contacts_within(robot, pose, margin, prominence, &mut expected).unwrap();
                assert_eq!(out, expected, "{margin}, {prominence}");
                none += u32::from(out.is_empty());
                several += u32::from(out.len() > robot.links().len());
            }
        }
    }
    assert!(none > 50 && several > 50, "{none} {several}");
    // One robot is too far out, for four margins and two prominences.
    assert_eq!(engine.answered_on_cpu(), 8);
    robots[8].1.translation.x = Real::NAN;
    let (robot, pose) = &robots[8];
    let error = engine.contacts_within(robot, pose, 1.0, 0.0, &mut out);
    assert_eq!(error, Err(ProximityError::Pose(PlacementFault::PoseNotFinite)));
}

/// Robots that are refused, too far out or left to the CPU do not disturb their neighbours.
#[test]
fn a_bad_robot_costs_the_others_nothing() {
    let Some(gpu) = gpu() else { return };
    let (mesh, mut robots) = (ball(), robots(60));
    robots[0].1.translation.x = Real::NAN;
    robots[7].1.translation.x = 1e200;
    robots[8].1.translation.x = 1e9;
    robots[30].1.translation.x = Real::INFINITY;
    robots[31].1.translation.y = 1e5;
    robots[59].1.translation.x = Real::NAN;
    let mut engine = search(gpu, &mesh);
    check(&mut engine, &mesh, &refs(&robots));
    // Two robots in each of nine batches.
    assert_eq!(engine.answered_on_cpu(), 18);
    let mut none = vec![Ok(false)];
    engine.clears_batch(&[], 0.0, &mut none).unwrap();
    assert!(none.is_empty());
    let mut answers = Vec::new();
    engine.minimum_batch(&refs(&robots[..1]), &mut answers).unwrap();
    assert_eq!(answers, [Err(ProximityError::Pose(PlacementFault::PoseNotFinite))]);
}

/// After a move the device refits, and so does the CPU where it is needed.
#[test]
fn a_moved_mesh_is_the_same_as_a_new_one() {
    let Some(gpu) = gpu() else { return };
    let (mesh, robots) = (ball(), robots(40));
    let mut engine = search(gpu, &mesh);
    for turn in [0.4, 3.0] {
        let moved: Vec<_> = mesh
            .vertices()
            .iter()
            .map(|&v| Vector::new(turn * v.x + 0.3 * v.y, v.y * 1.1, v.z + 0.2 * turn))
            .collect();
        let moved = TriMesh::new(moved, mesh.indices().to_vec()).unwrap();
        engine.set_vertices(moved.vertices()).unwrap();
        check(&mut engine, &moved, &refs(&robots));
        engine.set_min_links(Some(usize::MAX));
        check(&mut engine, &moved, &refs(&robots));
        engine.set_min_links(Some(0));
        let found = engine.cpu().minimum(&robots[0].0, &robots[0].1);
        assert_eq!(found, engine.minimum(&robots[0].0, &robots[0].1));
    }
}

/// After a move the device decides about robots of sections, and the CPU refits nothing for them.
#[test]
fn a_batch_of_sections_refits_no_cpu_without_need() {
    let Some(gpu) = gpu() else { return };
    let mesh = ball();
    let mut engine = search(gpu, &mesh);
    let section = |bend: Real| BendingSection { length: 5.0, radius: 0.2, bend: [bend, 0.1] };
    let robots: Vec<_> = (0..50).map(|k| [section(0.006 * Real::from(k)), section(-0.2)]).collect();
    let (mut out, mut expected) = (Vec::new(), Vec::new());
    for stretch in [1.1, 0.5] {
        let moved: Vec<_> = mesh.vertices().iter().map(|&corner| corner * stretch).collect();
        engine.set_vertices(&moved).unwrap();
        engine.clears_sections_batch(&robots, 8, &Pose::IDENTITY, 0.2, &mut out).unwrap();
        assert_eq!(engine.answered_on_cpu(), 0);
        assert!(engine.is_cpu_stale(), "nothing was left for the CPU");
        let mut moved = BvhSearch::from_triangles(&moved, mesh.indices()).unwrap();
        moved.clears_sections_batch(&robots, 8, &Pose::IDENTITY, 0.2, &mut expected).unwrap();
        assert_eq!(out, expected);
    }
}

/// A fan of triangles whose tips meet below robots: more are equally near than a thread has slots
/// for.
fn fan(count: usize) -> (TriMesh, Vec<(Chain, Pose)>) {
    let angle = |k: usize| (k as Real * 0.001, k as Real / 16.0);
    let mut vertices = vec![Vector::ZERO];
    for k in 0..count {
        let (rise, turn) = angle(k);
        vertices.push(Vector::new(turn.cos(), turn.sin(), 1.0 + rise));
        vertices.push(Vector::new((turn + 0.1).cos(), (turn + 0.1).sin(), 1.0 + rise));
    }
    let indices = (0..count as u32).map(|k| [0, 2 * k + 1, 2 * k + 2]).collect();
    let mesh = TriMesh::new(vertices, indices).unwrap();
    let points: Vec<_> = (0..6).map(|k| Vector::new(Real::from(k) - 2.5, 0.0, -1.0)).collect();
    let robots = (0..4).map(|k| {
        let robot = Chain::capsules(&points, &[0.1; 5]).unwrap();
        (robot, Pose::from_translation(Vector::Z * (0.05 * Real::from(k))))
    });
    (mesh, robots.collect())
}

/// More triangles are equally near than a thread has slots for, or a chunk has entries for.
#[test]
fn many_equals_take_the_second_pass_and_then_the_cpu() {
    let Some(gpu) = gpu() else { return };
    // A fan of triangles, and another of far more.
    for (count, is_left) in [(600, false), (4200, true)] {
        let (mesh, robots) = fan(count);
        let mut engine = search(gpu, &mesh);
        check(&mut engine, &mesh, &refs(&robots));
        // The candidates do not fit at first; the chunk is then searched once more.
        assert_eq!(engine.answered_on_cpu() > 0, is_left, "{count}");
    }
}

/// A compiler that fuses the visit which counts and the visit which writes differently: the second
/// finds more candidates than the first, or fewer. Such robots are left to the CPU.
#[test]
fn a_group_whose_two_counts_differ_is_left_to_the_cpu() {
    let Some(gpu) = gpu() else { return };
    let (mesh, robots) = fan(600);
    let test = "is_wanted(bounds.lower, triangle.number, bound, highest, link.error)";
    for shift in ["0.05", "-0.05"] {
        let other = test.replace("bound,", &format!("bound + select(0.0, {shift}, slots > 0u),"));
        let mut edited = 0;
        let kernels = SearchKernels::with_passes(&gpu.0.device, |kind| {
            let edit = |mut pass: Shader| {
                pass.text = pass.text.replace(test, &other);
                pass
            };
            passes(kind, false).into_iter().map(edit).collect()
        });
        for kind in 0..Question::KINDS {
            let texts = passes(kind, false);
            edited += texts.iter().filter(|pass| pass.text.contains(test)).count();
        }
        assert_eq!(edited, Question::KINDS, "each kind gathers once");
        let mut engine = search(gpu, &mesh);
        engine.set_kernels(kernels.unwrap());
        check(&mut engine, &mesh, &refs(&robots));
        assert!(engine.answered_on_cpu() > 0, "{shift}");
    }
}

#[test]
fn a_lost_device_is_an_error_of_every_query_but_those_on_the_cpu() {
    if gpu().is_none() {
        return;
    }
    let gpu = Gpu::open_another(Precision::F32).unwrap();
    let mesh = ball();
    let mut engine = search(&gpu, &mesh);
    let (robot, pose) = robot(1);
    let expected = engine.minimum(&robot, &pose);
    gpu.0.device.raw().destroy();
    let lost = ProximityError::Device(DeviceFailure::Lost);
    for _ in 0..2 {
        assert_eq!(engine.minimum(&robot, &pose), Err(lost));
        let mut out = vec![Ok(false)];
        assert_eq!(engine.clears_batch(&[(&robot, pose)], 0.1, &mut out), Err(lost));
        assert!(out.is_empty());
        assert_eq!(engine.set_vertices(mesh.vertices()), Ok(()));
    }
    engine.set_min_links(None);
    assert_eq!(engine.minimum(&robot, &pose), expected);
    let error = GpuSearch::on(&gpu, &mesh).expect_err("an error");
    assert_eq!(error, GpuError::Device(DeviceError::Failed(DeviceFailure::Lost)));
}

#[test]
fn a_refused_command_is_an_error_once() {
    if gpu().is_none() {
        return;
    }
    let gpu = Gpu::open_another(Precision::F32).unwrap();
    let mesh = ball();
    let (robot, pose) = robot(1);
    let expected = BvhSearch::new(&mesh).unwrap().minimum(&robot, &pose);
    let mut engine = search(&gpu, &mesh);
    assert_eq!(engine.minimum(&robot, &pose), expected);
    gpu.0.device.buffer(u64::MAX / 4, wgpu::BufferUsages::STORAGE);
    let Err(ProximityError::Device(failure)) = engine.minimum(&robot, &pose) else {
        panic!("the engine does not know of the failure")
    };
    assert!(matches!(failure, DeviceFailure::Refused | DeviceFailure::OutOfMemory), "{failure}");
    assert_eq!(engine.minimum(&robot, &pose), expected);
}
