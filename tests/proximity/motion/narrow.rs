//! What moves away from the nearest wall of a narrow tube, or along it, moves into another one. A
//! bound that counts the speed towards the nearest wall alone would not see it.

use continuum_testing::Random;
use parry_continuum::parry::math::{Pose, Real, Vector};
use parry_continuum::proximity::{BvhSearch, Decision};
use parry_continuum::{Chain, LinearMotion, RigidMotion, Tube};

/// How far the walls are from the axis of the tube, which goes along z.
const WALL: Real = 2.0;

const RADIUS: Real = 0.5;

const RESOLUTION: Real = 1e-3;

/// A square tube from z = -20 to z = 20, each wall in strips.
fn square_tube() -> BvhSearch {
    let corners = [[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]];
    let ring = |z: u32| corners.map(|[x, y]| Vector::new(WALL * x, WALL * y, Real::from(z) - 20.0));
    let vertices: Vec<_> = (0..=40).flat_map(ring).collect();
    let wall = |z: u32, k: u32| {
        let [a, b] = [4 * z + k, 4 * z + (k + 1) % 4];
        [[a, b, b + 4], [a, b + 4, a + 4]]
    };
    let triangles: Vec<_> = (0..40).flat_map(|z| (0..4).flat_map(move |k| wall(z, k))).collect();
    BvhSearch::from_triangles(&vertices, &triangles).unwrap()
}

/// Straight from one place in the tube to another, along it and across. The tube is convex, so the
/// needle comes nearest at an end of its way.
#[test]
fn a_needle_in_a_narrow_tube_meets_a_wall_that_is_not_the_nearest() {
    let (mut search, mut random) = (square_tube(), Random::new(3));
    let link = |at: Vector| [at, at + Vector::Z * 8.0];
    let needle = Chain::capsules(&link(Vector::ZERO), &[RADIUS]).unwrap();
    let gap = |at: Vector| WALL - RADIUS - at.x.abs().max(at.y.abs());
    let (mut clear, mut contact, mut opposite, mut along) = (0, 0, 0, 0);
    for _ in 0..700 {
        let y = random.between(-1.4, 1.4);
        let mut place =
            |most: Real| Vector::new(random.between(-most, most), y, random.between(-10.0, 5.0));
        let (from, to) = (place(1.45), place(1.9));
        let margin = [0.0, random.between(0.0, 0.1)][random.below(2) as usize];
        let least = gap(from).min(gap(to));
        // Nearer to the margin nothing has to be decided.
        if (least - margin).abs() < 2.0 * RESOLUTION {
            continue;
        }
        let expected = if least > margin { Decision::Clear } else { Decision::Contact };
        clear += usize::from(expected == Decision::Clear);
        contact += usize::from(expected == Decision::Contact);
        // At a quarter of its way it moves away from the wall that is nearest; or in the middle
        // along it.
        let [quarter, middle] = [0.25, 0.5].map(|share| from + (to - from) * share);
        let meets = gap(to) <= margin && gap(from) > margin;
        opposite += usize::from(meets && quarter.x * to.x < 0.0 && quarter.x.abs() > y.abs());
        along += usize::from(meets && middle.x.abs() < y.abs());
        let linear = LinearMotion::capsules(&link(from), &link(to), &[RADIUS]).unwrap();
        let poses = [from, to].map(Pose::from_translation);
        let rigid = RigidMotion::new(Tube::from(&needle), poses).unwrap();
        for decision in [
            search.clears_motion(&linear, margin, RESOLUTION).unwrap().decision,
            search.clears_motion(&rigid, margin, RESOLUTION).unwrap().decision,
            search.time_of_contact(&linear, margin, RESOLUTION).unwrap().decision,
        ] {
            assert_eq!(decision, expected, "{from} {to} {margin}");
        }
        let found = search.clearance_of_motion(&linear, RESOLUTION).unwrap();
        let least = least.max(0.0);
        assert!(
            found.resolved && found.lower <= least + 1e-12 && least <= found.upper + 1e-12,
            "{found:?} {least}"
        );
    }
    assert!(clear > 50 && contact > 50, "{clear} {contact}");
    assert!(opposite > 10 && along > 10, "{opposite} {along}");
}
