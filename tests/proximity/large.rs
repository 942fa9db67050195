//! Meshes of ten million triangles and chains of ten thousand links, answered and proven. Slow and
//! large, so run it by name: `cargo test --release --test proximity -- large --ignored --nocapture
//! --test-threads 1` (some 8 GB).

use parry_continuum::Chain;
use parry_continuum::parry::math::{Pose, Vector};
use parry_continuum::parry::shape::TriMesh;
use parry_continuum::proximity::{BvhSearch, Exhaustive, LinkProximity, Proximity};
use std::time::Instant;

/// A bumpy tube around the z axis, 120 long and about 40 wide: 2 x `around` x `along` triangles.
fn tube(around: u32, along: u32) -> TriMesh {
    let mut vertices = Vec::with_capacity((around * (along + 1)) as usize);
    for ring in 0..=along {
        let z = 120.0 * f64::from(ring) / f64::from(along) - 60.0;
        for spoke in 0..around {
            let angle = std::f64::consts::TAU * f64::from(spoke) / f64::from(around);
            let radius = 20.0 + 2.0 * (5.0 * angle + 0.2 * z).sin() + (0.9 * z + 3.0 * angle).cos();
            vertices.push(Vector::new(radius * angle.cos(), radius * angle.sin(), z));
        }
    }
    let mut indices = Vec::with_capacity((2 * around * along) as usize);
    for ring in 0..along {
        for spoke in 0..around {
            let next = (spoke + 1) % around;
            let [a, b] = [spoke, next].map(|spoke| ring * around + spoke);
            indices.extend([[a, b, a + around], [b, b + around, a + around]]);
        }
    }
    TriMesh::new(vertices, indices).expect("a mesh")
}

/// A helix of this many links near the wall, three tubes of different radius.
fn helix(links: usize) -> Chain {
    let points: Vec<_> = (0..=links)
        .map(|i| {
            let along = i as f64 / links as f64;
            let angle = 60.0 * along;
            let radius = 12.0 + 3.0 * (7.0 * angle).sin();
            Vector::new(radius * angle.cos(), radius * angle.sin(), 100.0 * along - 50.0)
        })
        .collect();
    let radii: Vec<_> = (0..links).map(|i| [0.9, 0.6, 0.3][3 * i / links]).collect();
    Chain::from_centreline(&points, &radii).expect("a robot")
}

/// Runs and says how long it took.
fn timed<T>(what: &str, run: impl FnOnce() -> T) -> T {
    let start = Instant::now();
    let result = run();
    println!("{what}: {:.3} s", start.elapsed().as_secs_f64());
    result
}

/// Each answer lies within a proof of its own pair, up to the rounding of numbers as large as the
/// scene.
fn assert_proven(answers: &[LinkProximity], robot: &Chain, pose: &Pose, mesh: &TriMesh) {
    assert_eq!(answers.len(), robot.links().len());
    for answer in answers {
        let proof = answer.certify(robot, pose, mesh).expect("an answer about this mesh");
        let rounding = 16.0 * f64::EPSILON * 0.5 * 4.0;
        let (low, high) = (proof.lower - rounding, proof.upper + rounding);
        assert!((low..=high).contains(&answer.distance), "{answer:?} {proof:?}");
    }
}

/// No other triangle of the mesh is nearer, by a proof that looks at every one.
fn assert_least(answer: &LinkProximity, robot: &Chain, pose: &Pose, mesh: &TriMesh) {
    let all = answer.certify_among_all(robot, pose, mesh).expect("an answer about this mesh");
    let rounding = 16.0 * f64::EPSILON * 0.5 * 4.0;
    let (low, high) = (all.lower - rounding, all.upper + rounding);
    assert!((low..=high).contains(&answer.distance), "{answer:?} {all:?}");
}

#[test]
#[ignore = "some 8 GB and a minute"]
fn ten_million_triangles() {
    let mesh = timed("mesh", || tube(2_500, 2_000));
    assert_eq!(mesh.indices().len(), 10_000_000);
    let pose = Pose::new(Vector::new(0.3, -0.2, 0.5), Vector::new(0.01, 0.02, -0.03));
    let (robot, mut found) = (helix(30), Vec::new());
    let mut search = timed("search, built", || BvhSearch::new(&mesh).expect("a mesh"));
    timed("search, 30 links, cold", || search.per_link(&robot, &pose, &mut found))
        .expect("a valid query");
    let expected = found.clone();
    timed("search, 30 links, warm", || search.per_link(&robot, &pose, &mut found))
        .expect("a valid query");
    assert_eq!(found, expected);
    assert_proven(&expected, &robot, &pose, &mesh);
    timed("proof that no triangle is nearer, 3 links", || {
        for link in [0, 14, 29] {
            assert_least(&expected[link], &robot, &pose, &mesh);
        }
    });
    drop(search);
    let mut every =
        timed("exhaustive f32, built", || Exhaustive::<f32>::new(&mesh).expect("a mesh"));
    timed("exhaustive f32, 30 links", || every.per_link(&robot, &pose, &mut found))
        .expect("a valid query");
    for (found, expected) in found.iter().zip(&expected) {
        assert_eq!(found.distance, expected.distance);
    }
    // A chain of ten thousand links in the same mesh.
    let robot = helix(10_000);
    let mut search = BvhSearch::new(&mesh).expect("a mesh");
    timed("search, 10,000 links, cold", || search.per_link(&robot, &pose, &mut found))
        .expect("a valid query");
    assert_proven(&found, &robot, &pose, &mesh);
    assert_least(&found[4_321], &robot, &pose, &mesh);
}

#[test]
#[ignore = "half a minute"]
fn ten_thousand_links() {
    let mesh = tube(250, 200);
    assert_eq!(mesh.indices().len(), 100_000);
    let robot = timed("chain", || helix(10_000));
    assert_eq!(robot.links().len(), 10_000);
    let pose = Pose::IDENTITY;
    let mut search = BvhSearch::new(&mesh).expect("a mesh");
    let mut expected = Vec::new();
    timed("search, cold", || search.per_link(&robot, &pose, &mut expected)).expect("a valid query");
    assert_proven(&expected, &robot, &pose, &mesh);
    let mut every = Exhaustive::<f32>::new(&mesh).expect("a mesh");
    let mut found = Vec::new();
    timed("exhaustive f32", || every.per_link(&robot, &pose, &mut found)).expect("a valid query");
    let mut nearest = &expected[0];
    for (found, expected) in found.iter().zip(&expected) {
        assert_eq!(found.distance, expected.distance);
        nearest = if expected.distance < nearest.distance { expected } else { nearest };
    }
    search.forget();
    let least =
        timed("search, the least", || search.minimum(&robot, &pose)).expect("a valid query");
    assert_eq!(least.distance, nearest.distance);
    assert_least(nearest, &robot, &pose, &mesh);
}
