//! Devices that fail, and drivers that do not do as they are told.

use super::{ball, gpu, robot};
use crate::answer::ProximityError;
use crate::engine::{Exhaustive, Proximity};
use crate::gpu::opened::{Gpu, Opened};
use crate::gpu::{GpuError, GpuExhaustive, Precision};
use crate::robot::Chain;
use gpu_batch::{DeviceError, DeviceFailure, Shader, wgpu};
use parry3d_f64::math::{Pose, Real, Vector};
use std::sync::Arc;

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
    gpu.0.device.raw().destroy();
    for _ in 0..2 {
        assert_eq!(engine.minimum(&robot, &pose), Err(ProximityError::Device(DeviceFailure::Lost)));
        // The vertices are as good as others.
        assert_eq!(engine.set_vertices(mesh.vertices()), Ok(()));
    }
    let error = GpuExhaustive::on(&gpu, &mesh).expect_err("an error");
    assert_eq!(error, GpuError::Device(DeviceError::Failed(DeviceFailure::Lost)));
    assert!(error.to_string().contains("open it anew"), "{error}");
}

/// Asks a device for what it cannot do.
fn provoke(gpu: &Gpu) {
    gpu.0.device.buffer(u64::MAX / 4, wgpu::BufferUsages::STORAGE);
}

/// Whose command it was a driver does not say: every engine on the device hears of it, once, and
/// then answers as before.
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
    for engine in &mut engines {
        assert_eq!(engine.minimum(&robot, &pose).unwrap().distance, expected.distance);
    }
    provoke(&gpu);
    for engine in &mut engines {
        let Err(ProximityError::Device(failure)) = engine.clears(&robot, &pose, 1.0) else {
            panic!("an engine does not know of the failure")
        };
        assert!(
            matches!(failure, DeviceFailure::Refused | DeviceFailure::OutOfMemory),
            "{failure}"
        );
        assert_eq!(engine.minimum(&robot, &pose).unwrap().distance, expected.distance);
    }
    // What failed before an engine was built is none of its business.
    provoke(&gpu);
    let mut engine = GpuExhaustive::on(&gpu, &mesh).unwrap();
    assert_eq!(engine.minimum(&robot, &pose).unwrap().distance, expected.distance);
}

/// New vertices hold from the moment that they are accepted. If they do not arrive, the next query
/// says so, and the one after it sends them again, into memory of its own.
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
    let mut out = vec![Ok(Vec::new())];
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
    let idle = Shader::new("idle", "@compute @workgroup_size(1) fn idle() {}");
    let layout = gpu.0.query_layout.clone();
    let idle = gpu.0.device.compile("idle", &idle, &layout, &[]).unwrap();
    let opened: &mut Opened = Arc::get_mut(&mut gpu.0).unwrap();
    let collect = std::mem::replace(&mut opened.collect, idle);
    let mut engine = GpuExhaustive::on(&gpu, &mesh).unwrap();
    for _ in 0..2 {
        let answer = engine.clears(&robot, &Pose::IDENTITY, 0.1);
        assert_eq!(answer, Err(ProximityError::Device(DeviceFailure::Unanswered)));
    }
    drop(engine);
    Arc::get_mut(&mut gpu.0).unwrap().collect = collect;
    let mut engine = GpuExhaustive::on(&gpu, &mesh).unwrap();
    assert_eq!(engine.clears(&robot, &Pose::IDENTITY, 0.1), Ok(false));
}
