//! Motions in a mesh that moves at the same time, against the mesh in fine steps.

use super::{anatomy, random_edge};
use continuum_demo::{ctr, ventricle};
use continuum_testing::{Random, rounds};
use parry_continuum::parry::math::{Pose, Real, Vector};
use parry_continuum::proximity::{BvhSearch, Decision, MeshError, Proximity, ProximityError};
use parry_continuum::{Chain, LinearMotion, Motion, RigidMotion, Tube};

fn any_tube() -> Tube {
    Tube::from(&Chain::capsules(&[Vector::ZERO, Vector::X], &[1.0]).unwrap())
}

/// Where the vertices are at a time.
fn vertices_at(from: &[Vector], to: &[Vector], t: Real) -> Vec<Vector> {
    from.iter().zip(to).map(|(from, to)| from + (to - from) * t).collect()
}

#[derive(Debug, Default)]
struct Seen {
    clear: usize,
    contact: usize,
    undecided: usize,
    both_ends_clear: usize,
}

/// Compares the answers about a few margins with the clearance in this many steps.
fn judge(
    search: &BvhSearch,
    to: &[Vector],
    motion: &impl Motion,
    steps: usize,
    random: &mut Random,
    seen: &mut Seen,
) {
    let from = search.vertices().to_vec();
    let (mut asked, mut moved, mut tube) = (search.clone(), search.clone(), any_tube());
    let mut at = |t: Real, tolerance: Real| {
        moved.set_vertices(&vertices_at(&from, to, t)).unwrap();
        let pose = motion.shape(t, &mut tube).unwrap();
        moved.clearance(&tube, &pose, tolerance).unwrap()
    };
    let truth: Vec<_> = (0..=steps).map(|k| at(k as Real / steps as Real, 1e-4)).collect();
    let least = |side: fn(&parry_continuum::proximity::Clearance) -> Real| {
        truth.iter().map(side).fold(Real::INFINITY, Real::min)
    };
    let (lower, upper) = (least(|found| found.lower), least(|found| found.upper));
    for margin in [0.0, random.unit(), (lower - 0.05).max(0.0), upper + 2e-3] {
        let answer = asked.clears_motion_while(to, motion, margin, 1e-3).unwrap();
        match (answer.decision, answer.contact) {
            (Decision::Clear, _) => {
                seen.clear += 1;
                assert!(
                    upper > margin,
                    "clear, but a step comes as near as {upper}, margin {margin}"
                );
            }
            (Decision::Contact, Some(shape)) => {
                seen.contact += 1;
                let found = at(shape.t, 1e-6);
                assert!(
                    found.lower <= margin,
                    "contact at {}, but {found:?}, margin {margin}",
                    shape.t
                );
                assert!(
                    (shape.witness.on_robot - shape.witness.on_mesh).length() <= shape.upper + 1e-9
                );
                // The place is on the mesh as it is then.
                let corners = asked.triangles()[shape.witness.triangle as usize];
                let corners = corners.map(|corner| {
                    let (from, to) = (from[corner as usize], to[corner as usize]);
                    from + (to - from) * shape.t
                });
                let low = corners[0].min(corners[1]).min(corners[2]) - Vector::splat(1e-9);
                let high = corners[0].max(corners[1]).max(corners[2]) + Vector::splat(1e-9);
                assert!(
                    shape.witness.on_mesh.cmpge(low).all()
                        && shape.witness.on_mesh.cmple(high).all(),
                    "{shape:?}"
                );
                let ends = [&truth[0], &truth[steps]];
                seen.both_ends_clear += usize::from(ends.iter().all(|end| end.lower > margin));
            }
            (Decision::Undecided, _) => seen.undecided += 1,
            (Decision::Contact, None) => panic!("{answer:?}"),
        }
    }
    // The engine's mesh is where it was.
    assert_eq!(asked.vertices(), from);
}

/// Smooth motions of tissue, as breathing is, while a robot moves or stands still.
#[test]
fn no_motion_in_a_moving_mesh_is_misjudged() {
    let (search, robot, mut random) = (anatomy(), ctr::three_tubes(), Random::new(41));
    let from = search.vertices().to_vec();
    let (mut moving, mut still) = (Seen::default(), Seen::default());
    for round in 0..rounds(40) {
        let size = [0.1, 0.5, 2.0, 6.0][round % 4];
        let (shift, wave) = (random.point() * size, random.point() * size);
        let phase = random.direction() * random.between(0.05, 0.4);
        let to: Vec<_> =
            from.iter().map(|&point| point + shift + wave * point.dot(phase).sin()).collect();
        let motion = random_edge(&robot, &mut random, [0.5, 2.0, 6.0][round % 3]);
        judge(&search, &to, &motion, 60, &mut random, &mut moving);
        let at_rest =
            RigidMotion::new(motion.tube(random.unit()).unwrap(), [ventricle::entry(); 2]).unwrap();
        judge(&search, &to, &at_rest, 60, &mut random, &mut still);
    }
    println!("{moving:?}\n{still:?}");
    for seen in [&moving, &still] {
        assert!(
            seen.clear > rounds(20) && seen.contact > rounds(40) && seen.undecided < rounds(8),
            "{seen:?}"
        );
    }
    // One of 40 motions is seldom, but not never, clear at both ends only.
    let both_ends_clear = moving.both_ends_clear + still.both_ends_clear;
    assert!(both_ends_clear >= rounds(40) / 40, "{moving:?} {still:?}");
}

const SQUARE: [[u32; 3]; 2] = [[0, 1, 2], [0, 2, 3]];

/// A square of 20 at a height.
fn square(z: Real) -> [Vector; 4] {
    [[-10.0, -10.0], [10.0, -10.0], [10.0, 10.0], [-10.0, 10.0]].map(|[x, y]| Vector::new(x, y, z))
}

/// Walls that come as near as the margin, or by 1e-9 more or less; that pass through a robot which
/// is clear at both ends; that collapse to a line on the way; and that go far away.
#[test]
fn walls_that_touch_pass_and_collapse_are_judged() {
    let needle = [Vector::new(-2.0, 0.0, 5.0), Vector::new(2.0, 0.5, 5.0)];
    let at_rest = LinearMotion::capsules(&needle, &needle, &[1.0]).unwrap();
    let decide = |from: &[Vector], to: &[Vector], margin: Real, resolution: Real| {
        let mut search = BvhSearch::from_triangles(from, &SQUARE).unwrap();
        search.clears_motion_while(to, &at_rest, margin, resolution).unwrap().decision
    };
    // The wall rises to 2: 2 stay.
    let (below, high) = (square(2.0 - 1e-3), square(2.0));
    assert_eq!(decide(&below, &high, 2.0 - 1e-9, 1e-10), Decision::Clear);
    assert_eq!(decide(&high, &below, 2.0 - 1e-9, 1e-10), Decision::Clear);
    assert_ne!(decide(&below, &high, 2.0, 1e-10), Decision::Clear);
    assert_ne!(decide(&below, &high, 2.0 + 1e-9, 1e-10), Decision::Clear);
    let low = square(0.0);
    assert_eq!(decide(&low, &high, 1.999, 1e-3), Decision::Clear);
    assert_eq!(decide(&low, &square(2.1), 2.0, 1e-3), Decision::Contact);
    // Through the robot, clear at both ends.
    assert_eq!(decide(&low, &square(10.0), 0.0, 1e-3), Decision::Contact);
    assert_eq!(decide(&low, &square(1e6), 0.0, 0.5), Decision::Contact);
    // Away from it.
    assert_eq!(decide(&low, &square(-1e6), 3.0, 0.5), Decision::Clear);
    // Turned over about a line: no area at half time.
    let over = square(0.0).map(|corner| Vector::new(-corner.x, corner.y, corner.z));
    assert_eq!(decide(&low, &over, 3.9, 1e-3), Decision::Clear);
    assert_eq!(decide(&low, &over, 4.1, 1e-3), Decision::Contact);
    // It passes the needle's side while it tips up: no corner ever comes near.
    let mut tipped = square(0.0);
    (tipped[2].z, tipped[3].z) = (12.0, 12.0);
    assert_eq!(decide(&low, &tipped, 0.0, 1e-3), Decision::Contact);
}

/// A robot that goes with the wall keeps its distance, whichever the way.
#[test]
fn a_robot_that_goes_with_the_wall_keeps_its_distance() {
    let needle = [Vector::new(-2.0, 0.0, 5.0), Vector::new(2.0, 0.5, 5.0)];
    let mut search = BvhSearch::from_triangles(&square(0.0), &SQUARE).unwrap();
    for shift in [Vector::Z * 3.0, Vector::new(0.5, -0.2, -2.0)] {
        let motion =
            LinearMotion::capsules(&needle, &needle.map(|point| point + shift), &[1.0]).unwrap();
        let to = square(0.0).map(|corner| corner + shift);
        let mut decide =
            |margin| search.clears_motion_while(&to, &motion, margin, 1e-2).unwrap().decision;
        assert_eq!(decide(3.9), Decision::Clear);
        // At the margin itself rounding decides.
        assert_ne!(decide(4.0), Decision::Clear);
        assert_eq!(decide(4.1), Decision::Contact);
    }
    // The questions about a mesh at rest are not changed by that.
    let tube = Tube::from(&Chain::capsules(&needle, &[1.0]).unwrap());
    let found = search.clearance(&tube, &Pose::IDENTITY, 0.0).unwrap();
    assert!((found.upper - 4.0).abs() < 1e-12, "{found:?}");
    assert!(
        search
            .clears_motion(&RigidMotion::new(tube, [Pose::IDENTITY; 2]).unwrap(), 3.9, 1e-3)
            .unwrap()
            .is_clear()
    );
}

#[test]
fn a_mesh_that_cannot_move_there_is_refused() {
    let mut search = BvhSearch::from_triangles(&square(0.0), &SQUARE).unwrap();
    let needle = [Vector::Z * 5.0, Vector::Z * 6.0];
    let motion = LinearMotion::capsules(&needle, &needle, &[1.0]).unwrap();
    let few = search.clears_motion_while(&square(1.0)[1..], &motion, 0.0, 1e-3).unwrap_err();
    assert_eq!(few, ProximityError::Mesh(MeshError::VertexCount { expected: 4, got: 3 }));
    let mut broken = square(1.0);
    broken[2].y = Real::NAN;
    let broken = search.clears_motion_while(&broken, &motion, 0.0, 1e-3).unwrap_err();
    assert!(
        matches!(broken, ProximityError::Mesh(MeshError::NotFinite { vertex: 2, .. })),
        "{broken}"
    );
    assert!(search.clears_motion_while(&square(1.0), &motion, -1.0, 1e-3).is_err());
}
