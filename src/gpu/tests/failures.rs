//! Devices that fail, and drivers that do not follow their commands.

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
    let gpu = Gpu::open_another(Precision::F32).unwrap();
    let mesh = ball();
    let mut engine = GpuExhaustive::on(&gpu, &mesh).unwrap();
    let (robot, pose) = robot(1);
    engine.minimum(&robot, &pose).unwrap();
    gpu.0.device.raw().destroy();
    for _ in 0..2 {
        assert_eq!(engine.minimum(&robot, &pose), Err(ProximityError::Device(DeviceFailure::Lost)));
        // The engine accepts vertices although the device is lost.
        assert_eq!(engine.set_vertices(mesh.vertices()), Ok(()));
    }
    let error = GpuExhaustive::on(&gpu, &mesh).expect_err("an error");
    assert_eq!(error, GpuError::Device(DeviceError::Failed(DeviceFailure::Lost)));
    assert!(error.to_string().contains("open it anew"), "{error}");
}

/// Requests an impossible buffer from the device.
fn provoke(gpu: &Gpu) {
    gpu.0.device.buffer(u64::MAX / 4, wgpu::BufferUsages::STORAGE);
}

/// A driver does not say whose command failed. So every engine on the device reports the failure
/// once, and then answers as before.
#[test]
fn a_refused_command_is_an_error_of_every_engine_once() {
    if gpu().is_none() {
        return;
    }
    let gpu = Gpu::open_another(Precision::F32).unwrap();
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
    // A failure before an engine was built does not concern the engine.
    provoke(&gpu);
    let mut engine = GpuExhaustive::on(&gpu, &mesh).unwrap();
    assert_eq!(engine.minimum(&robot, &pose).unwrap().distance, expected.distance);
}

/// New vertices count from the moment they are accepted. If an upload fails, the next query reports
/// it, and the query after uploads them again, into new memory.
#[test]
fn an_upload_that_is_refused_is_an_error_of_the_query_and_done_again() {
    if gpu().is_none() {
        return;
    }
    let gpu = Gpu::open_another(Precision::F32).unwrap();
    let mesh = ball();
    let moved: Vec<_> = mesh.vertices().iter().map(|&v| Vector::new(0.4 * v.x, v.y, v.z)).collect();
    let (robot, pose) = robot(2);
    let mut exhaustive = Exhaustive::<f64>::new(&mesh).unwrap();
    let rest = exhaustive.minimum(&robot, &pose).unwrap();
    exhaustive.set_vertices(&moved).unwrap();
    let expected = exhaustive.minimum(&robot, &pose).unwrap();
    assert_ne!(rest.witness.triangle, expected.witness.triangle);
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
    // A call that every engine rejects changes nothing.
    let mut bad = mesh.vertices().to_vec();
    bad[3].y = Real::NAN;
    engine.set_vertices(&bad).unwrap_err();
    assert_eq!(engine.minimum(&robot, &pose).unwrap().distance, expected);
}

/// Kernels that run and write nothing must not pass for a clear margin.
#[test]
fn what_was_not_written_is_no_answer() {
    if gpu().is_none() {
        return;
    }
    let mesh = ball();
    // Crosses the wall.
    let robot = Chain::capsules(&[Vector::ZERO, Vector::X * 20.0], &[0.5]).unwrap();
    let mut gpu = Gpu::open_another(Precision::F32).unwrap();
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
