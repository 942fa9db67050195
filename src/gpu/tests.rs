//! What no caller can bring about: small buffers, failing devices and drivers. Without a GPU these tests pass without
//! doing anything, unless PARRY_CONTINUUM_REQUIRE_GPU is set.

use super::device::{Adapter, Device};
use super::opened::Gpu;
use super::self_test::{self, OPERANDS};
use super::shaders::Kernel;
use super::{DeviceFailure, GpuError, GpuExhaustive, Precision};
use crate::Chain;
use crate::proximity::{Exhaustive, LinkProximity, MeshError, Proximity, ProximityError};
use parry3d_f64::math::{Pose, Real, Vector};
use parry3d_f64::shape::{Ball, TriMesh};
use std::sync::OnceLock;

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
        let mut engine = GpuExhaustive::in_parts(gpu, &mesh, most).unwrap();
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
    let mut engine = GpuExhaustive::in_parts(gpu, &mesh, 900).unwrap();
    let robots: Vec<_> = (0..40).map(robot).collect();
    let plan = super::plan::Plan::new(&gpu.0, engine.mesh(), 7 * robots.len());
    assert!(plan.links_per_submission < 7 * robots.len(), "{plan:?}");
    assert!((plan.links_per_round as usize) < plan.links_per_submission, "{plan:?}");
    assert!(plan.links_at_once > 1 && plan.triangles_at_once > 1, "{plan:?}");
    let (mut one, mut other) = (Vec::new(), Vec::new());
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
fn a_lost_device_is_an_error() {
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
        assert_eq!(engine.set_vertices(mesh.vertices()), Err(MeshError::Device(DeviceFailure::Lost)));
    }
    let error = GpuExhaustive::on(&gpu, &mesh).err().expect("an error");
    assert_eq!(error, GpuError::Device(DeviceFailure::Lost));
    assert!(error.to_string().contains("build a new engine"), "{error}");
}

#[test]
fn a_refused_command_is_an_error_once() {
    let Some(gpu) = gpu() else { return };
    let device = &Gpu::open(Precision::F32).unwrap().0.device;
    device.buffer(u64::MAX / 4, wgpu::BufferUsages::STORAGE);
    let failure = device.failures.check().unwrap_err();
    assert!(matches!(failure, DeviceFailure::Refused | DeviceFailure::OutOfMemory), "{failure}");
    assert_eq!(device.failures.check(), Ok(()));
    assert_eq!(gpu.0.device.failures.check(), Ok(()));
}

#[test]
fn a_shader_that_does_not_compile_is_an_error() {
    let Some(gpu) = gpu() else { return };
    let device = &gpu.0.device;
    let layout = device.layout(&[Some(false), Some(true)]);
    let kernel = Kernel { name: "nonsense", text: "@compute fn nonsense() { return 1; }" };
    match device.compile(kernel, 5, &layout, &[]) {
        Err(GpuError::Shader { kernel: "nonsense", .. }) => {}
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
