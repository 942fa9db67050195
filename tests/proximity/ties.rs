//! Of triangles at the same distance, 0 or not, every engine names the lowest, and of links that
//! share it the lowest, on any number of threads.

use crate::planner;
use continuum_testing::answered;
use parry_continuum::Chain;
use parry_continuum::parry::math::{Pose, Vector};
use parry_continuum::parry::shape::TriMesh;
use parry_continuum::proximity::*;
use std::f64::consts::TAU;

/// A straight tube around the z axis with a robot on it: thousands of triangles are as near as one
/// another.
fn straight_tube(around: u32, along: u32, flat: bool) -> (TriMesh, Chain) {
    let vertex = |k: u32| {
        let (sin, cos) = (f64::from(k % around) / f64::from(around) * TAU).sin_cos();
        Vector::new(5.0 * cos, 5.0 * sin, f64::from(k / around) / f64::from(along) * 100.0 - 50.0)
    };
    let triangles = (0..around * along).flat_map(|k| {
        let (row, next) = (k / around * around, (k + 1) % around);
        let [a, b] = [k, row + next];
        [[a, a + around, b + around], [a, b + around, b]]
    });
    let mesh =
        TriMesh::new((0..around * (along + 1)).map(vertex).collect(), triangles.collect()).unwrap();
    let points: Vec<_> = (0..=30).map(|k| Vector::Z * (f64::from(k) * 2.0 - 30.0)).collect();
    let build = if flat { Chain::cylinders } else { Chain::from_centreline };
    (mesh, build(&points, &[0.5; 30]).unwrap())
}

/// Whether no triangle before the named one is as near to the link: the distances in a mesh of
/// those alone.
fn is_lowest(mesh: &TriMesh, robot: &Chain, pose: &Pose, answers: &[LinkProximity]) {
    for answer in answers.iter().filter(|answer| answer.witness.triangle > 0) {
        let before = mesh.indices()[..answer.witness.triangle as usize].to_vec();
        let before = TriMesh::new(mesh.vertices().to_vec(), before).unwrap();
        let mut out = Vec::new();
        Exhaustive::<f64>::new(&before).unwrap().per_link(robot, pose, &mut out).unwrap();
        let lower = out[answer.link as usize].distance;
        assert!(lower > answer.distance, "{lower} before {answer:?}");
    }
}

/// All engines on several numbers of threads, cold and warm, alone and in a batch: the same answers
/// to the last bit. How many of the links touch.
fn check(mesh: &TriMesh, robot: &Chain, pose: &Pose) -> usize {
    let mut expected = Vec::new();
    let mut reference = Exhaustive::<f64>::new(mesh).unwrap();
    #[cfg(feature = "laboratory")]
    reference.set_culling(false);
    let pool = |threads| rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    pool(1).install(|| reference.per_link(robot, pose, &mut expected)).unwrap();
    let key =
        |answer: &&LinkProximity| (answer.distance.to_bits(), answer.witness.triangle, answer.link);
    let least = *expected.iter().min_by_key(key).unwrap();
    for threads in [1, 2, 3] {
        #[allow(unused_mut)]
        let mut engines: Vec<(&str, Box<dyn Proximity + Send>)> = vec![
            ("exhaustive f64", Box::new(Exhaustive::<f64>::new(mesh).unwrap())),
            ("exhaustive f32", Box::new(Exhaustive::<f32>::new(mesh).unwrap())),
            ("search", Box::new(BvhSearch::new(mesh).unwrap())),
        ];
        #[cfg(feature = "gpu")]
        if let Some(search) = continuum_testing::gpu::search(mesh) {
            engines.push(("GPU search", Box::new(search)));
        }
        for (name, mut engine) in engines {
            pool(threads).install(|| {
                let (mut out, mut batch, mut minima) = (Vec::new(), Vec::new(), Vec::new());
                for _ in 0..3 {
                    engine.per_link(robot, pose, &mut out).unwrap();
                    assert_eq!(out, expected, "{name}, {threads} threads");
                    assert_eq!(
                        engine.minimum(robot, pose).unwrap(),
                        least,
                        "{name}, {threads} threads"
                    );
                }
                let robots = vec![(robot, *pose); 5];
                engine.per_link_batch(&robots, &mut batch).unwrap();
                assert!(
                    answered(&batch).iter().all(|out| *out == expected),
                    "{name}, {threads} threads"
                );
                engine.minimum_batch(&robots, &mut minima).unwrap();
                assert_eq!(answered(&minima), [least; 5], "{name}, {threads} threads");
            });
        }
    }
    is_lowest(mesh, robot, pose, &expected);
    expected.iter().filter(|answer| answer.distance <= 0.0).count()
}

#[test]
fn a_straight_robot_on_the_axis_of_a_tube() {
    for flat in [false, true] {
        let (mesh, robot) = straight_tube(64, 48, flat);
        assert_eq!(check(&mesh, &robot, &Pose::IDENTITY), 0);
        // The mirror image of the tube is itself: links to both sides of the middle are as near.
        let mut out = Vec::new();
        BvhSearch::new(&mesh).unwrap().per_link(&robot, &Pose::IDENTITY, &mut out).unwrap();
        let least = out.iter().map(|answer| answer.distance).fold(f64::INFINITY, f64::min);
        assert!(out.iter().filter(|answer| answer.distance <= least).count() > 1);
    }
}

#[test]
fn shapes_that_run_through_the_wall() {
    let (mesh, pose) = planner::scene();
    let shapes = planner::shapes(60);
    let touching: usize = shapes.iter().step_by(8).map(|shape| check(&mesh, shape, &pose)).sum();
    assert!(touching > 10, "{touching}");
}

/// Every triangle three times over, near and far apart in the mesh.
#[test]
fn of_equal_triangles_the_first() {
    let (mesh, pose) = planner::scene();
    let indices = mesh.indices();
    let (some, rest) = indices.split_at(indices.len() / 3);
    let thrice: Vec<_> = [rest, some, some, indices, rest].concat();
    let mesh = TriMesh::new(mesh.vertices().to_vec(), thrice).unwrap();
    for shape in planner::shapes(30).iter().step_by(15) {
        check(&mesh, shape, &pose);
    }
}
