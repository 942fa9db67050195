//! How much of a mesh a query looks at: figures that do not depend on the machine, and that no
//! change may exceed unnoticed.

use continuum_demo::steer::Random;
use continuum_demo::{cavity, ctr, lumen, ventricle};
use parry_continuum::Chain;
use parry_continuum::parry::math::{Pose, Vector};
use parry_continuum::parry::shape::TriMesh;
use parry_continuum::proximity::*;

/// Nodes, leaves and measurements for each link of a per-link query, without the last answers.
fn visits(level: u32, clearance: f64) -> [f64; 3] {
    let mut search = BvhSearch::new(&cavity::mesh(level)).unwrap();
    let (robot, frames) = (cavity::chain(clearance), cavity::frames(60));
    let mut out = Vec::new();
    for pose in &frames {
        search.forget();
        search.per_link(&robot, pose, &mut out).unwrap();
    }
    let Work { nodes, visited, measured, .. } = search.work();
    // A leaf has 16 triangles.
    [nodes, visited / 16, measured]
        .map(|count| count as f64 / (frames.len() * robot.links().len()) as f64)
}

/// The limits are what was counted, and a tenth for the rounding of other instruction sets.
#[test]
fn a_link_visits_few_nodes_and_leaves() {
    for (level, clearance, counted) in [
        (4, 2.0, [2.88, 2.84, 1.3]),
        (4, 20.0, [6.34, 5.27, 2.4]),
        (6, 2.0, [5.18, 5.18, 1.6]),
        (6, 20.0, [10.88, 8.68, 3.5]),
    ] {
        let visits = visits(level, clearance);
        for (visited, counted) in visits.into_iter().zip(counted) {
            assert!(visited <= 1.1 * counted, "level {level}, {clearance} mm: {visits:?}");
        }
    }
}

/// Nodes and leaves per shape of a planner after a warm-up, for touching shapes and for free ones.
fn visits_of_shapes(search: &mut BvhSearch, entry: Pose) -> [[f64; 2]; 2] {
    let (tubes, mut random) = (ctr::three_tubes(), Random(7));
    let mut visits = [[0; 2]; 2];
    let mut shapes = [0; 2];
    for round in 0..900 {
        let line = tubes.centreline(&tubes.any_joints(&mut random), 30);
        let robot = Chain::from_centreline(&line.points, &line.radii).unwrap();
        search.forget();
        let before = search.work();
        let kind = usize::from(search.clears(&robot, &entry, 0.0).unwrap());
        if round < 300 {
            continue;
        }
        shapes[kind] += 1;
        visits[kind][0] += search.work().nodes - before.nodes;
        visits[kind][1] += (search.work().visited - before.visited) / 16;
    }
    assert!(shapes.iter().all(|&count| count > 50), "{shapes:?}");
    [0, 1].map(|kind| visits[kind].map(|count| count as f64 / f64::from(shapes[kind])))
}

/// Where the robot seems to pass through the wall is looked at first; also where the mesh has been
/// moved far away since.
#[test]
fn a_planners_shape_visits_few_nodes_and_leaves() {
    let (vertices, triangles) = ventricle::mesh(ventricle::DEFAULT_TRIANGLES);
    let mut search = BvhSearch::new(&TriMesh::new(vertices.clone(), triangles).unwrap()).unwrap();
    for away in [0.0, 1000.0] {
        let away = Vector::new(away, 0.0, away);
        let moved: Vec<_> = vertices.iter().map(|&vertex| vertex + away).collect();
        search.set_vertices(&moved).unwrap();
        let visits =
            visits_of_shapes(&mut search, Pose::from_translation(away) * ventricle::entry());
        for (visited, counted) in visits.into_iter().zip([[4.33, 4.83], [5.86, 12.25]]) {
            let is_few =
                visited.into_iter().zip(counted).all(|(visited, counted)| visited <= 1.1 * counted);
            assert!(is_few, "{visits:?}");
        }
    }
}

/// Beside triangles larger than its links a robot is measured in long runs.
#[test]
fn a_planners_shape_beside_large_triangles_visits_few_leaves() {
    let mut search = BvhSearch::new(&lumen::mesh(12)).unwrap();
    let visits = visits_of_shapes(&mut search, lumen::entry());
    for (visited, counted) in visits.into_iter().zip([[2.37, 5.07], [2.01, 6.22]]) {
        let is_few =
            visited.into_iter().zip(counted).all(|(visited, counted)| visited <= 1.1 * counted);
        assert!(is_few, "{visits:?}");
    }
}
