//! What no caller can bring about: small buffers, failing devices and drivers. Without a GPU these tests pass without
//! doing anything, unless PARRY_CONTINUUM_REQUIRE_GPU is set.

use super::batch::{Batch, BatchKernel};
use super::device::{Adapter, Device};
use super::link::LinkRecord;
use super::opened::{Gpu, Opened};
use super::plan::{Plan, Round, Tuning};
use super::record::Record;
use super::self_test::{self, OPERANDS};
use super::wgsl::{CONVEX, FACE_VECTORS, Shader};
use super::{GpuError, GpuExhaustive, Precision};
use crate::Chain;
use crate::proximity::{DeviceFailure, Exhaustive, LinkProximity, Proximity, ProximityError};
use parry3d_f64::math::{Pose, Real, Vector};
use parry3d_f64::shape::{Ball, TriMesh};
use std::sync::OnceLock;
use wgpu::naga;

/// The GPU of this machine in single precision, if there is one.
fn gpu() -> Option<&'static Gpu> {
    static GPU: OnceLock<Option<Gpu>> = OnceLock::new();
    let open = || match Gpu::open(Precision::F32) {
        Ok(gpu) => Some(gpu),
        Err(error) => {
            assert!(std::env::var_os("PARRY_CONTINUUM_REQUIRE_GPU").is_none(), "{error}");
            None
        }
    };
    GPU.get_or_init(open).as_ref()
}

/// As many parts as that takes, few threads with several pairs each, and little that is kept or comes back at once.
fn in_parts(part: usize) -> Tuning {
    Tuning { part, threads: 1 << 12, round: 1 << 10, answer: 100 << 10, ..Tuning::default() }
}

fn ball() -> TriMesh {
    let (vertices, indices) = Ball::new(10.0).to_trimesh(40, 20);
    TriMesh::new(vertices, indices).unwrap()
}

/// A bent robot, turned and moved differently for every number.
fn robot(number: usize) -> (Chain, Pose) {
    let points: Vec<_> = (0..8)
        .map(|k| Vector::new((Real::from(k) * 0.3).sin(), Real::from(k) * 0.4, Real::from(k) * 0.7))
        .collect();
    let robot = Chain::from_centreline(&points, &[1.0, 1.0, 0.7, 0.7, 0.7, 0.3, 0.3]).unwrap();
    let number = number as Real;
    (robot, Pose::new(Vector::new(number.sin(), number.cos(), -1.0), Vector::new(number, 1.0, 0.2)))
}

fn distances(answers: &[LinkProximity]) -> Vec<Real> {
    answers.iter().map(|answer| answer.distance).collect()
}

#[test]
fn a_mesh_in_many_parts_is_the_same_mesh() {
    let Some(gpu) = gpu() else { return };
    let mesh = ball();
    let moved: Vec<_> = mesh.vertices().iter().map(|&v| v * 0.9 + Vector::new(0.1, 0.2, 0.3)).collect();
    let (robot, pose) = robot(3);
    let mut exhaustive = Exhaustive::<f64>::new(&mesh).unwrap();
    for most in [1, 7, 300, 1599] {
        // A part a triangle is slow; a few suffice.
        let mesh = if most == 1 {
            TriMesh::new(mesh.vertices().to_vec(), mesh.indices()[..20].to_vec()).unwrap()
        } else {
            mesh.clone()
        };
        let mut expected = if most == 1 { Exhaustive::<f64>::new(&mesh).unwrap() } else { exhaustive };
        let mut engine = GpuExhaustive::tuned(gpu, &mesh, in_parts(most)).unwrap();
        let (mut one, mut other) = (Vec::new(), Vec::new());
        for vertices in [mesh.vertices(), &moved] {
            engine.set_vertices(vertices).unwrap();
            expected.set_vertices(vertices).unwrap();
            engine.per_link(&robot, &pose, &mut one).unwrap();
            expected.per_link(&robot, &pose, &mut other).unwrap();
            assert_eq!(distances(&one), distances(&other), "{most} triangles in a part");
        }
        exhaustive = Exhaustive::<f64>::new(&ball()).unwrap();
    }
}

#[test]
fn a_batch_takes_many_rounds_and_submissions() {
    let Some(gpu) = gpu() else { return };
    let mesh = ball();
    let mut engine = GpuExhaustive::tuned(gpu, &mesh, in_parts(900)).unwrap();
    let robots: Vec<_> = (0..40).map(robot).collect();
    let plan = Plan::new(&gpu.0, engine.on_device().unwrap(), 7 * robots.len(), &in_parts(900));
    assert!(plan.links_per_submission < 7 * robots.len(), "{plan:?}");
    assert!((plan.links_per_round as usize) < plan.links_per_submission, "{plan:?}");
    assert!(plan.links_at_once > 1 && plan.triangles_at_once > 1, "{plan:?}");
    let (mut one, mut other) = (Vec::new(), Vec::new());
    let robots: Vec<_> = robots.iter().map(|(robot, pose)| (robot, *pose)).collect();
    engine.per_link_batch(&robots, &mut one).unwrap();
    Exhaustive::<f64>::new(&mesh).unwrap().per_link_batch(&robots, &mut other).unwrap();
    assert_eq!(one.len(), other.len());
    for (one, other) in one.iter().zip(&other) {
        assert_eq!(distances(one), distances(other));
    }
    assert_eq!(engine.answered_on_cpu(), 0);
}

/// A wall of many triangles along which the robot lies: more are equally near than come back.
#[test]
fn too_many_equals_are_measured_on_the_cpu() {
    let Some(gpu) = gpu() else { return };
    let count = 200;
    let vertices = (0..=count)
        .flat_map(|i| [-1.0, 1.0].map(|side| Vector::new(Real::from(i) * 0.1, side, 0.0)))
        .collect();
    let indices = (0..count).flat_map(|i| [[2 * i, 2 * i + 1, 2 * i + 2], [2 * i + 1, 2 * i + 3, 2 * i + 2]]);
    let mesh = TriMesh::new(vertices, indices.collect()).unwrap();
    let points = [Vector::new(1.0, 0.0, 2.0), Vector::new(19.0, 0.0, 2.0), Vector::new(19.0, 0.0, 5.0)];
    let robot = Chain::cylinders(&points, &[0.5, 0.5]).unwrap();
    let mut engine = GpuExhaustive::on(gpu, &mesh).unwrap();
    let mut answers = Vec::new();
    engine.per_link(&robot, &Pose::IDENTITY, &mut answers).unwrap();
    assert_eq!(distances(&answers), [1.5, 2.0]);
    assert_eq!(engine.answered_on_cpu(), 1);
    assert_eq!(engine.minimum(&robot, &Pose::IDENTITY).unwrap().distance, 1.5);
    assert!(engine.clears(&robot, &Pose::IDENTITY, 1.4).unwrap());
    assert!(!engine.clears(&robot, &Pose::IDENTITY, 1.5).unwrap());
}

#[test]
fn a_lost_device_is_an_error_of_every_query() {
    if gpu().is_none() {
        return;
    }
    let gpu = Gpu::open(Precision::F32).unwrap();
    let mesh = ball();
    let mut engine = GpuExhaustive::on(&gpu, &mesh).unwrap();
    let (robot, pose) = robot(1);
    engine.minimum(&robot, &pose).unwrap();
    gpu.0.device.device.destroy();
    for _ in 0..2 {
        assert_eq!(engine.minimum(&robot, &pose), Err(ProximityError::Device(DeviceFailure::Lost)));
        // The vertices are as good as others.
        assert_eq!(engine.set_vertices(mesh.vertices()), Ok(()));
    }
    let error = GpuExhaustive::on(&gpu, &mesh).expect_err("an error");
    assert_eq!(error, GpuError::Device(DeviceFailure::Lost));
    assert!(error.to_string().contains("build a new engine"), "{error}");
}

/// Asks a device for what it cannot do.
fn provoke(gpu: &Gpu) {
    gpu.0.device.buffer(u64::MAX / 4, wgpu::BufferUsages::STORAGE);
}

/// Whose command it was a driver does not say: every engine on the device hears of it, once, and then answers as before.
#[test]
fn a_refused_command_is_an_error_of_every_engine_once() {
    if gpu().is_none() {
        return;
    }
    let gpu = Gpu::open(Precision::F32).unwrap();
    let mesh = ball();
    let (robot, pose) = robot(1);
    let expected = Exhaustive::<f64>::new(&mesh).unwrap().minimum(&robot, &pose).unwrap();
    let mut engines = [(); 2].map(|()| GpuExhaustive::on(&gpu, &mesh).unwrap());
    let mut batch = Batch::new(&gpu, &BatchKernel::new("echo", ECHO, 1, 1)).unwrap();
    for engine in &mut engines {
        assert_eq!(engine.minimum(&robot, &pose).unwrap().distance, expected.distance);
    }
    provoke(&gpu);
    for engine in &mut engines {
        let Err(ProximityError::Device(failure)) = engine.clears(&robot, &pose, 1.0) else {
            panic!("an engine does not know of the failure")
        };
        assert!(matches!(failure, DeviceFailure::Refused | DeviceFailure::OutOfMemory), "{failure}");
        assert_eq!(engine.minimum(&robot, &pose).unwrap().distance, expected.distance);
    }
    assert!(batch.run([1.0], |_| {}).is_err());
    assert_eq!(batch.run([1.0], |_| {}), Ok(()));
    // What failed before an engine was built is none of its business.
    provoke(&gpu);
    let mut engine = GpuExhaustive::on(&gpu, &mesh).unwrap();
    assert_eq!(engine.minimum(&robot, &pose).unwrap().distance, expected.distance);
}

/// New vertices hold from the moment that they are accepted. If they do not arrive, the next query says so, and the one
/// after it sends them again, into memory of its own.
#[test]
fn an_upload_that_is_refused_is_an_error_of_the_query_and_done_again() {
    if gpu().is_none() {
        return;
    }
    let gpu = Gpu::open(Precision::F32).unwrap();
    let mesh = ball();
    let moved: Vec<_> = mesh.vertices().iter().map(|&v| Vector::new(0.4 * v.x, v.y, v.z)).collect();
    let (robot, pose) = robot(2);
    let mut exhaustive = Exhaustive::<f64>::new(&mesh).unwrap();
    let rest = exhaustive.minimum(&robot, &pose).unwrap();
    exhaustive.set_vertices(&moved).unwrap();
    let expected = exhaustive.minimum(&robot, &pose).unwrap();
    assert_ne!(rest.triangle, expected.triangle);
    let (rest, expected) = (rest.distance, expected.distance);

    let mut engine = GpuExhaustive::on(&gpu, &mesh).unwrap();
    assert_eq!(engine.minimum(&robot, &pose).unwrap().distance, rest);
    engine.on_device().unwrap().parts[0].vertex_buffer.destroy();
    engine.set_vertices(&moved).unwrap();
    let mut out = vec![Vec::new()];
    let failed = engine.per_link_batch(&[(&robot, pose)], &mut out);
    assert_eq!(failed, Err(ProximityError::Device(DeviceFailure::Refused)));
    assert!(out.is_empty());
    assert_eq!(engine.minimum(&robot, &pose).unwrap().distance, expected);
    // What no engine accepts changes nothing.
    let mut bad = mesh.vertices().to_vec();
    bad[3].y = Real::NAN;
    engine.set_vertices(&bad).unwrap_err();
    assert_eq!(engine.minimum(&robot, &pose).unwrap().distance, expected);
}

/// Kernels that run and write nothing: no candidate would be the same as a clear way.
#[test]
fn what_was_not_written_is_no_answer() {
    if gpu().is_none() {
        return;
    }
    let mesh = ball();
    // Through the wall.
    let robot = Chain::capsules(&[Vector::ZERO, Vector::X * 20.0], &[0.5]).unwrap();
    let mut gpu = Gpu::open(Precision::F32).unwrap();
    let idle = Shader { entry_point: "idle", text: "@compute @workgroup_size(1) fn idle() {}".into() };
    let layout = gpu.0.query_layout.clone();
    let idle = gpu.0.device.compile("idle", &idle, &layout, &[]).unwrap();
    let opened: &mut Opened = std::sync::Arc::get_mut(&mut gpu.0).unwrap();
    let collect = std::mem::replace(&mut opened.collect, idle);
    let mut engine = GpuExhaustive::on(&gpu, &mesh).unwrap();
    for _ in 0..2 {
        let answer = engine.clears(&robot, &Pose::IDENTITY, 0.1);
        assert_eq!(answer, Err(ProximityError::Device(DeviceFailure::Unanswered)));
    }
    drop(engine);
    std::sync::Arc::get_mut(&mut gpu.0).unwrap().collect = collect;
    let mut engine = GpuExhaustive::on(&gpu, &mesh).unwrap();
    assert_eq!(engine.clears(&robot, &Pose::IDENTITY, 0.1), Ok(false));
}

/// A kernel that answers a number with itself.
const ECHO: &str = "fn solve(problem: u32, answer: u32) { answers[answer] = problems[problem]; }";

/// Neither is what an earlier submission wrote.
#[test]
fn an_earlier_answer_is_no_answer() {
    let Some(gpu) = gpu() else { return };
    let mut batch = Batch::new(gpu, &BatchKernel::new("echo", ECHO, 1, 1)).unwrap();
    let mut answers = Vec::<Real>::new();
    batch.run([1.0, 2.0, 3.0], |answer| answers.extend(answer)).unwrap();
    batch.run([4.0, 5.0, 6.0], |answer| answers.extend(answer)).unwrap();
    assert_eq!(answers, [1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
    let idle = Shader { entry_point: "idle", text: "@compute @workgroup_size(1) fn idle() {}".into() };
    batch.kernel = gpu.0.device.compile("idle", &idle, &batch.layout, &[]).unwrap();
    assert_eq!(batch.run([7.0, 8.0, 9.0], |_| panic!("an answer")), Err(DeviceFailure::Unanswered));
}

#[test]
fn a_batch_answers_whole_problems_in_any_number() {
    let Some(gpu) = gpu() else { return };
    let text = "fn solve(problem: u32, answer: u32) { answers[answer] = problems[problem] + problems[problem + 1u]; }";
    let mut batch = Batch::new(gpu, &BatchKernel::new("sum", text, 2, 1)).unwrap();
    for count in [0, 1, 2, 5, 1000, 100_001] {
        let mut answers = Vec::<Real>::new();
        batch.run((0..count).map(f64::from), |answer| answers.extend(answer)).unwrap();
        let expected: Vec<_> = (0..count / 2).map(|k| f64::from(4 * k + 1)).collect();
        assert_eq!(answers, expected);
    }
}

#[test]
fn a_shader_that_does_not_compile_is_an_error() {
    let Some(gpu) = gpu() else { return };
    let device = &gpu.0.device;
    let layout = device.layout(&[Some(false), Some(true)]);
    let kernel = Shader { entry_point: "nonsense", text: "@compute fn nonsense() { return 1; }".into() };
    match device.compile("nonsense", &kernel, &layout, &[]) {
        Err(GpuError::Shader { kernel, .. }) if kernel == "nonsense" => {}
        other => panic!("{other:?}"),
    }
}

#[test]
fn a_machine_without_a_gpu_is_an_error() {
    let mut descriptor = wgpu::InstanceDescriptor::new_without_display_handle();
    descriptor.backends = wgpu::Backends::empty();
    match Device::open_of(descriptor, Precision::F32).err() {
        Some(error @ GpuError::NoAdapter { .. }) => {
            assert!(error.to_string().contains("install a driver"), "{error}");
        }
        other => panic!("{other:?}"),
    }
}

/// Quotients and roots as a device in single precision gives them.
#[test]
fn single_precision_does_not_pass_for_double() {
    let adapter = Adapter { name: "a".into(), interface: "b".into(), is_software: true };
    let results = OPERANDS.iter().flat_map(|&[x, y]| [x / y, x.sqrt()]);
    let exact: Vec<_> = results.collect();
    let rounded: Vec<_> = exact.iter().map(|&value| f64::from(value as f32)).collect();
    let nothing = vec![f64::NAN; exact.len()];
    assert_eq!(self_test::compare(&exact, Precision::F64, &adapter), Ok(()));
    assert_eq!(self_test::compare(&rounded, Precision::F32, &adapter), Ok(()));
    for wrong in [rounded, nothing] {
        let error = self_test::compare(&wrong, Precision::F64, &adapter).unwrap_err();
        assert!(error.to_string().contains("use Precision::F32"), "{error}");
    }
    assert_eq!(adapter.to_string(), "a (b, in software)");
}

/// What Rust says of a record's size, WGSL says too.
#[test]
fn records_are_as_large_as_shaders_see_them() {
    for precision in [Precision::F32, Precision::F64] {
        let kernel = Shader::nearest(precision, CONVEX);
        let module = naga::front::wgsl::parse_str(&kernel.text).unwrap();
        let mut layouter = naga::proc::Layouter::default();
        layouter.update(module.to_ctx()).unwrap();
        for (name, size) in [
            (Round::NAME, Round::size(precision)),
            (LinkRecord::NAME, LinkRecord::size(precision)),
            ("FaceRecord", u64::from(FACE_VECTORS) * 4 * precision.size()),
        ] {
            let is_it = |ty: &naga::Type| ty.name.as_deref() == Some(name);
            let (handle, _) = module.types.iter().find(|(_, ty)| is_it(ty)).expect(name);
            assert_eq!(u64::from(layouter[handle].size), size, "{name} {precision:?}");
        }
    }
}
