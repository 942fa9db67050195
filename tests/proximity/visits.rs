//! How much of a mesh a query looks at: figures that do not depend on the machine, and that no change may exceed unnoticed.

use continuum_scene::cavity;
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
    [nodes, visited / 16, measured].map(|count| count as f64 / (frames.len() * robot.links().len()) as f64)
}

/// The limits are what was counted, and a tenth for the rounding of other instruction sets.
#[test]
fn a_link_visits_few_nodes_and_leaves() {
    for (level, clearance, counted) in [
        (4, 2.0, [4.42, 2.84, 1.3]),
        (4, 20.0, [7.55, 5.27, 2.4]),
        (6, 2.0, [6.67, 5.18, 1.6]),
        (6, 20.0, [12.01, 8.79, 3.5]),
    ] {
        let visits = visits(level, clearance);
        for (visited, counted) in visits.into_iter().zip(counted) {
            assert!(visited <= 1.1 * counted, "level {level}, {clearance} mm: {visits:?}");
        }
    }
}
