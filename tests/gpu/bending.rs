//! Robots of sections of constant curvature, whose points the device computes: the decisions about
//! the chains that the CPU builds from them.

use continuum_demo::ventricle;
use continuum_testing::{Random, gpu, rounds};
use parry_continuum::gpu::GpuSearch;
use parry_continuum::parry::math::{Pose, Vector};
use parry_continuum::parry::shape::{Ball, TriMesh};
use parry_continuum::proximity::{BvhSearch, PlacementFault, Proximity, ProximityError};
use parry_continuum::{BendingSection, Chain, ConstantCurvature};
use std::f64::consts::PI;

/// The answers about the chains, by the search on the CPU.
fn by_chains<const N: usize>(
    reference: &mut BvhSearch,
    robots: &[[BendingSection; N]],
    segments: usize,
    pose: &Pose,
    margin: f64,
) -> Vec<Result<bool, ProximityError>> {
    let decide = |sections: &[BendingSection; N]| {
        let (points, radii) = ConstantCurvature::new(sections)?.points(segments);
        reference.clears(&Chain::from_centreline(&points, &radii)?, pose, margin)
    };
    robots.iter().map(decide).collect()
}

/// Asserts that the answers are those about the chains. Returns how many are clear.
fn check<const N: usize>(
    (engine, reference): (&mut GpuSearch, &mut BvhSearch),
    robots: &[[BendingSection; N]],
    segments: usize,
    pose: &Pose,
    margin: f64,
) -> usize {
    let mut found = vec![Ok(true); 3];
    engine.clears_sections_batch(robots, segments, pose, margin, &mut found).unwrap();
    let expected = by_chains(reference, robots, segments, pose, margin);
    // As text, because NaN in an error does not equal itself.
    assert_eq!(format!("{found:?}"), format!("{expected:?}"), "{margin}");
    found.iter().filter(|found| **found == Ok(true)).count()
}

/// Sections with a total length of up to `reach`; each turns by up to `turn`.
fn robots<const N: usize>(
    random: &mut Random,
    count: usize,
    reach: f64,
    turn: f64,
) -> Vec<[BendingSection; N]> {
    let radii: [f64; N] =
        std::array::from_fn(|section| reach * (0.03 - 0.004 * (section % 5) as f64));
    let robot = |_| {
        radii.map(|radius| {
            let length = reach * random.between(0.2, 1.0) / N as f64;
            let curvature = random.between(0.0, turn) / length;
            let (sin, cos) = random.between(-PI, PI).sin_cos();
            BendingSection { length, radius, bend: [curvature * cos, curvature * sin] }
        })
    };
    (0..count).map(robot).collect()
}

fn distances<const N: usize>(
    reference: &mut BvhSearch,
    robots: &[[BendingSection; N]],
    segments: usize,
    pose: &Pose,
) -> Vec<f64> {
    let distance = |sections: &[BendingSection; N]| {
        let (points, radii) = ConstantCurvature::new(sections).unwrap().points(segments);
        let chain = Chain::from_centreline(&points, &radii).unwrap();
        reference.minimum(&chain, pose).unwrap().distance
    };
    robots.iter().map(distance).collect()
}

fn engines(mesh: &TriMesh) -> Option<(GpuSearch, BvhSearch)> {
    Some((gpu::search(mesh)?, BvhSearch::new(mesh).unwrap()))
}

/// Robots of `N` sections in a ball of this size; margins at which robots touch exactly.
fn in_a_ball<const N: usize>(seed: u64, size: f64, segments: usize) {
    let (vertices, indices) = Ball::new(size).to_trimesh(40, 20);
    let mesh = TriMesh::new(vertices, indices).unwrap();
    let Some((mut engine, mut reference)) = engines(&mesh) else { return };
    let mut random = Random::new(seed);
    let robots: Vec<[_; N]> = robots(&mut random, rounds(1000).max(100), 1.6 * size, 2.5);
    let mut pose = random.pose(1.0);
    pose.translation *= 0.3 * size;
    let mut margins = distances(&mut reference, &robots[..8], segments, &pose);
    margins.extend([0.0, 0.1 * size, 2.0 * size, f64::INFINITY]);
    let mut clear = 0;
    for &margin in &margins {
        let engines = (&mut engine, &mut reference);
        clear += check(engines, &robots, segments, &pose, margin);
    }
    let all = margins.len() * robots.len();
    assert!(all / 20 < clear && clear < all * 19 / 20, "{clear} of {all}");
    assert_eq!(engine.answered_on_cpu(), 0);
}

#[test]
fn decisions_are_those_about_the_chains() {
    in_a_ball::<1>(91, 10.0, 30);
    in_a_ball::<2>(92, 0.01, 15);
    in_a_ball::<3>(93, 1e4, 10);
    in_a_ball::<5>(94, 10.0, 13);
}

/// Bases at the wall of a real shape, small steps of the margin around the distances, and a mesh
/// that has moved.
#[test]
fn robots_enter_a_ventricle() {
    let (vertices, indices) = ventricle::mesh(20_000);
    let mesh = TriMesh::new(vertices, indices).unwrap();
    let Some((mut engine, mut reference)) = engines(&mesh) else { return };
    let mut random = Random::new(95);
    let robots: Vec<[_; 3]> = robots(&mut random, rounds(2000).max(200), 60.0, 1.2);
    let pose = ventricle::entry();
    for least in distances(&mut reference, &robots[..5], 10, &pose) {
        for step in [-1e-3, -1e-6, 0.0, 1e-6, 1e-3] {
            let margin = (least + step).max(0.0);
            check((&mut engine, &mut reference), &robots, 10, &pose, margin);
        }
    }
    let moved: Vec<_> = mesh.vertices().iter().map(|v| *v * 1.3).collect();
    engine.set_vertices(&moved).unwrap();
    reference.set_vertices(&moved).unwrap();
    let clear = check((&mut engine, &mut reference), &robots, 10, &pose, 0.2);
    assert!(clear > 0 && clear < robots.len(), "{clear}");
    assert_eq!(engine.answered_on_cpu(), 0);
}

/// What the device cannot compute is left to the CPU; what is no robot is an error.
#[test]
fn bad_sections_cost_the_others_nothing() {
    let (vertices, indices) = Ball::new(10.0).to_trimesh(40, 20);
    let mesh = TriMesh::new(vertices, indices).unwrap();
    let Some((mut engine, mut reference)) = engines(&mesh) else { return };
    let mut random = Random::new(96);
    let mut robots: Vec<[BendingSection; 2]> = robots(&mut random, 60, 12.0, 2.0);
    let (pose, segments) = (Pose::from_translation(Vector::X * 3.0), 4);
    // Left to the CPU: more than a turn, a far tip, a tiny section, a huge radius.
    robots[0][0].bend = [7.0 / robots[0][0].length, 0.0];
    robots[1][1].length = 1e9;
    robots[2][1].length = 1e-9;
    robots[3][0].radius = 1e9;
    for margin in [0.0, 0.5] {
        check((&mut engine, &mut reference), &robots, segments, &pose, margin);
    }
    assert_eq!(engine.answered_on_cpu(), 8);
    // Errors.
    robots[10][0].length = 0.0;
    robots[11][1].length = -1.0;
    robots[12][0].radius = -1.0;
    robots[13][0].radius = f64::NAN;
    robots[14][1].bend[1] = f64::NAN;
    robots[15][1].bend[0] = f64::INFINITY;
    robots[16][1].length = 1e300;
    robots[59][0].length = f64::NAN;
    for min_links in [Some(0), Some(usize::MAX)] {
        engine.set_min_links(min_links);
        check((&mut engine, &mut reference), &robots, segments, &pose, 0.5);
        let bad = by_chains(&mut reference, &robots, segments, &pose, 0.5);
        assert_eq!(bad.iter().filter(|answer| answer.is_err()).count(), 8);
        check::<2>((&mut engine, &mut reference), &[], segments, &pose, 0.5);
        check::<0>((&mut engine, &mut reference), &[[], []], segments, &pose, 0.5);
        // No count of links overflows.
        let none = [[BendingSection { length: f64::NAN, radius: 1.0, bend: [0.0; 2] }; 2]; 2];
        check((&mut engine, &mut reference), &none, usize::MAX, &pose, 0.5);
        // Fewer than one segment count as one.
        check((&mut engine, &mut reference), &robots, 0, &pose, 0.5);
        let mut out = vec![Ok(true)];
        let nowhere = Pose::from_translation(Vector::NAN);
        let error = engine.clears_sections_batch(&robots, segments, &nowhere, 0.5, &mut out);
        assert_eq!(error, Err(ProximityError::Pose(PlacementFault::PoseNotFinite)));
        let error = engine.clears_sections_batch(&robots, segments, &pose, -1.0, &mut out);
        assert!(error.is_err() && out.is_empty());
    }
}

/// Robots with another number of sections than most are left to the CPU, wherever they stand.
#[test]
fn robots_may_have_different_numbers_of_sections() {
    let (vertices, indices) = Ball::new(10.0).to_trimesh(40, 20);
    let mesh = TriMesh::new(vertices, indices).unwrap();
    let Some((mut engine, mut reference)) = engines(&mesh) else { return };
    let mut random = Random::new(99);
    let three: Vec<[BendingSection; 3]> = robots(&mut random, 60, 12.0, 2.0);
    let mut batch: Vec<_> = three.iter().map(|robot| robot.to_vec()).collect();
    for (number, left) in [(0, 2), (7, 1), (8, 0), (30, 1), (59, 2)] {
        batch[number].truncate(left);
    }
    let (mut found, mut expected) = (Vec::new(), Vec::new());
    engine.clears_sections_batch(&batch, 5, &Pose::IDENTITY, 0.5, &mut found).unwrap();
    reference.clears_sections_batch(&batch, 5, &Pose::IDENTITY, 0.5, &mut expected).unwrap();
    assert_eq!(found, expected);
    assert_eq!(found.iter().filter(|answer| answer.is_err()).count(), 1);
    // All but the robot without sections, which is refused before.
    assert_eq!(engine.answered_on_cpu(), 4);
}

/// A mesh so far out that double precision rounds the chain's place, and lengths near the limit of
/// coordinates: what the CPU rounds or refuses, the device must not decide.
#[test]
fn far_and_huge_robots_are_those_of_the_chains() {
    let mut random = Random::new(98);
    let (mut clear, mut all) = (0, 0);
    for (far, size) in
        [(0.0, 1.0), (1e9, 1.0), (1e12, 1.0), (1e14, 1.0), (0.0, 1e148), (0.0, 1e-140)]
    {
        let origin = random.direction() * far;
        let (mut vertices, indices) = Ball::new(size).to_trimesh(12, 6);
        vertices.iter_mut().for_each(|vertex| *vertex += origin);
        let mesh = TriMesh::new(vertices, indices).unwrap();
        let Some((mut engine, mut reference)) = engines(&mesh) else { return };
        for _ in 0..8 {
            let mut robots: Vec<[_; 2]> = robots(&mut random, 30, 1.5 * size, 2.0);
            robots[7][1].length *= 1e3;
            robots[8][0].radius *= 1e3;
            let mut pose = random.pose(1.0);
            let out = [0.3, 200.0][random.below(2) as usize];
            pose.translation = origin + random.point() * (out * size);
            let (points, radii) = ConstantCurvature::new(&robots[0]).unwrap().points(3);
            let chain = Chain::from_centreline(&points, &radii).unwrap();
            let least = reference.minimum(&chain, &pose).map_or(size, |found| found.distance);
            for margin in [0.0, least, least * (1.0 + 1e-6), 0.1 * size] {
                clear += check((&mut engine, &mut reference), &robots, 3, &pose, margin);
                all += robots.len();
            }
        }
    }
    assert!(all / 10 < clear && clear < all * 9 / 10, "{clear} of {all}");
}

/// A batch of more links than the device gets at once, in turn with chains.
#[test]
fn a_batch_of_sections_takes_several_chunks() {
    let (vertices, indices) = Ball::new(10.0).to_trimesh(8, 4);
    let mesh = TriMesh::new(vertices, indices).unwrap();
    let Some((mut engine, mut reference)) = engines(&mesh) else { return };
    let mut random = Random::new(97);
    let robots: Vec<[_; 2]> = robots(&mut random, 40_000, 12.0, 2.0);
    let chain = Chain::from_centreline(&[-Vector::X * 5.0, -Vector::X * 7.0], &[0.5]).unwrap();
    for _ in 0..2 {
        // Three chunks: two of 2^15 parts, and a smaller one.
        check((&mut engine, &mut reference), &robots, 20, &Pose::IDENTITY, 0.5);
        let pose = Pose::IDENTITY;
        assert_eq!(engine.minimum(&chain, &pose), reference.minimum(&chain, &pose));
        // As few, so that the buffers are used again.
        for _ in 0..2 {
            check((&mut engine, &mut reference), &robots[..3], 20, &pose, 0.5);
            assert_eq!(engine.minimum(&chain, &pose), reference.minimum(&chain, &pose));
        }
    }
    assert_eq!(engine.answered_on_cpu(), 0);
}
