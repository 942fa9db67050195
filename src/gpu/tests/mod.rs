//! Cases that no caller can bring about: small buffers, failing devices and drivers. Without a GPU
//! these tests print that they are skipped, unless PARRY_CONTINUUM_REQUIRE_GPU is set.

mod failures;
mod search;

use super::layout::{FACE_VECTORS, LinkRecord, Round};
use super::opened::Gpu;
use super::plan::{Plan, Tuning};
use super::wgsl::{self, CONVEX};
use super::{GpuExhaustive, Precision};
use crate::answer::LinkProximity;
use crate::engine::{Exhaustive, Proximity};
use crate::mesh::Mesh;
use crate::robot::Chain;
use gpu_batch::Record;
use gpu_batch::wgpu::naga;
use parry3d_f64::math::{Pose, Real, Vector};
use parry3d_f64::shape::{Ball, TriMesh};
use std::sync::OnceLock;

/// The GPU of this machine in single precision, if there is one.
pub(super) fn gpu() -> Option<&'static Gpu> {
    static GPU: OnceLock<Option<Gpu>> = OnceLock::new();
    let open = || match Gpu::open(Precision::F32) {
        Ok(gpu) => Some(gpu),
        Err(error) => {
            assert!(std::env::var_os("PARRY_CONTINUUM_REQUIRE_GPU").is_none(), "{error}");
            None
        }
    };
    let gpu = GPU.get_or_init(open).as_ref();
    if gpu.is_none() {
        continuum_testing::gpu::print_skipped();
    }
    gpu
}

/// Parts of at most `part` triangles, few threads with several pairs each, and small rounds and
/// submissions.
fn in_parts(part: usize) -> Tuning {
    Tuning { part, threads: 1 << 12, round: 1 << 10, answer: 100 << 10, ..Tuning::default() }
}

fn ball() -> TriMesh {
    let (vertices, indices) = Ball::new(10.0).to_trimesh(40, 20);
    TriMesh::new(vertices, indices).unwrap()
}

/// A bent robot with another pose for every number.
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
    let moved: Vec<_> =
        mesh.vertices().iter().map(|&v| v * 0.9 + Vector::new(0.1, 0.2, 0.3)).collect();
    let (robot, pose) = robot(3);
    let mut exhaustive = Exhaustive::<f64>::new(&mesh).unwrap();
    for most in [1, 7, 300, 1599] {
        // One part per triangle is slow, so 20 triangles are enough.
        let mesh = if most == 1 {
            TriMesh::new(mesh.vertices().to_vec(), mesh.indices()[..20].to_vec()).unwrap()
        } else {
            mesh.clone()
        };
        let mut expected =
            if most == 1 { Exhaustive::<f64>::new(&mesh).unwrap() } else { exhaustive };
        let mut engine =
            GpuExhaustive::tuned(gpu, Mesh::new(&mesh).unwrap(), in_parts(most)).unwrap();
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
    let mut engine = GpuExhaustive::tuned(gpu, Mesh::new(&mesh).unwrap(), in_parts(900)).unwrap();
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
    for (one, other) in
        continuum_testing::answered(&one).iter().zip(continuum_testing::answered(&other))
    {
        assert_eq!(distances(one), distances(&other));
    }
    assert_eq!(engine.answered_on_cpu(), 0);
}

/// A wall of many triangles along the robot: more of them are equally near than come back.
#[test]
fn too_many_equals_are_measured_on_the_cpu() {
    let Some(gpu) = gpu() else { return };
    let count = 200;
    let vertices = (0..=count)
        .flat_map(|i| [-1.0, 1.0].map(|side| Vector::new(Real::from(i) * 0.1, side, 0.0)))
        .collect();
    let indices =
        (0..count).flat_map(|i| [[2 * i, 2 * i + 1, 2 * i + 2], [2 * i + 1, 2 * i + 3, 2 * i + 2]]);
    let mesh = TriMesh::new(vertices, indices.collect()).unwrap();
    let points =
        [Vector::new(1.0, 0.0, 2.0), Vector::new(19.0, 0.0, 2.0), Vector::new(19.0, 0.0, 5.0)];
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

/// Rust and WGSL agree on the size of a record.
#[test]
fn records_are_as_large_as_shaders_see_them() {
    for precision in [Precision::F32, Precision::F64] {
        let kernel = wgsl::nearest(precision, CONVEX);
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
