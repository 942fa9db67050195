//! Motions through a wall, and into one at once.

use continuum_testing::Random;
use parry_continuum::parry::math::{Pose, Real, Vector};
use parry_continuum::parry::shape::TriMesh;
use parry_continuum::proximity::{BvhSearch, Decision};
use parry_continuum::{
    BendingMotion, BendingSection, Chain, LinearMotion, Motion, RigidMotion, Tube,
};

/// Between their ends, motions jump through a wall that no coarse step detects.
#[test]
fn a_jump_through_a_wall_is_seen() {
    let wall = [[-60.0, -60.0], [60.0, -60.0], [60.0, 60.0], [-60.0, 60.0]];
    let vertices = wall.iter().map(|&[x, y]| Vector::new(x, y, 0.1 * x)).collect();
    let mut search =
        BvhSearch::new(&TriMesh::new(vertices, vec![[0, 1, 2], [0, 2, 3]]).unwrap()).unwrap();
    let (mut random, mut jumps) = (Random::new(3), 0);
    for round in 0..400 {
        let radius = random.between(0.01, 0.5);
        let mut points = vec![random.point() * 5.0 + Vector::Z * 10.0];
        for k in 0..4 {
            points.push(
                points[k] + (random.direction() + Vector::Z) * radius * random.between(0.5, 3.0),
            );
        }
        let shift = Vector::new(
            random.between(-5.0, 5.0),
            random.between(-5.0, 5.0),
            random.between(-50.0, -35.0),
        );
        let to: Vec<_> =
            points.iter().map(|&point| point + shift + random.point() * radius).collect();
        let (from, radii) = (&points, [radius; 4]);
        let linear =
            [LinearMotion::capsules, LinearMotion::chain][round % 2](from, &to, &radii).unwrap();
        let tube = Tube::from(&Chain::capsules(from, &radii).unwrap());
        let turn = random.direction() * random.between(0.0, 0.1);
        let rigid =
            RigidMotion::new(tube.clone(), [Pose::IDENTITY, Pose::new(shift, turn)]).unwrap();
        let coarse = [0.0, 0.125, 0.25, 0.375, 0.5, 0.625, 0.75, 0.875, 1.0];
        let is_seen = |search: &mut BvhSearch, motion: &dyn Fn(&mut Tube, Real) -> Pose| {
            coarse.iter().any(|&t| {
                let mut tube = tube.clone();
                let pose = motion(&mut tube, t);
                search.clears_tube(&tube, &pose, 0.0, 1e-6).unwrap() != Decision::Clear
            })
        };
        let linear_seen = is_seen(&mut search, &|tube, t| linear.shape(t, tube).unwrap());
        let rigid_seen = is_seen(&mut search, &|tube, t| rigid.shape(t, tube).unwrap());
        jumps += usize::from(!linear_seen) + usize::from(!rigid_seen);
        for answer in [
            search.clears_motion(&linear, 0.0, 1e-4).unwrap(),
            search.clears_motion(&rigid, 0.0, 1e-4).unwrap(),
        ] {
            assert_eq!(answer.decision, Decision::Contact, "{answer:?}");
        }
    }
    assert!(jumps > 400, "{jumps} of 800");
}

/// A link's start becomes round when it is one radius away from the base, and fills a corner of the
/// robot at once.
#[test]
fn an_end_that_becomes_round_counts() {
    let corner = Vector::new(-1.0, 0.0, 1.0).normalize() * 0.95;
    let speck = [corner, corner + Vector::Y * 1e-3, corner + Vector::new(-1e-3, 0.0, 1e-3)];
    let mut search =
        BvhSearch::new(&TriMesh::new(speck.to_vec(), vec![[0, 1, 2]]).unwrap()).unwrap();
    let line = |base: Real| [Vector::Z * -base, Vector::ZERO, Vector::X * 0.5];
    // Flat ends leave the speck 0.67 away.
    let flat = LinearMotion::chain(&line(0.9), &line(0.99), &[1.0; 2]).unwrap();
    assert!(search.clears_motion(&flat, 0.3, 1e-3).unwrap().is_clear());
    let opening = LinearMotion::chain(&line(0.9), &line(1.05), &[1.0; 2]).unwrap();
    let answer = search.clears_motion(&opening, 0.3, 1e-3).unwrap();
    assert!(answer.contact.is_some_and(|shape| shape.t > 0.666), "{answer:?}");
}

/// A ball at a joint one radius from the base would stick out of it, since the centreline bends.
/// The tube does not.
#[test]
fn a_joint_near_the_base_does_not_reach_through_it() {
    let section = |length, bend| BendingSection { length, radius: 1.0, bend: [bend, 0.0] };
    let motion = BendingMotion::new(
        &[section(1.03, 0.5), section(5.0, 0.05)],
        &[section(1.03, 0.6), section(5.0, 0.1)],
        Pose::IDENTITY,
    )
    .unwrap();
    // Less than the ball would stick out, and more than the margin.
    let gap = 0.01;
    let corners = [[-3.0, -3.0], [3.0, -3.0], [0.0, 5.0]].map(|[x, y]| Vector::new(x, y, -gap));
    let mut search =
        BvhSearch::new(&TriMesh::new(corners.to_vec(), vec![[0, 1, 2]]).unwrap()).unwrap();
    let mut clears = |margin| search.clears_motion(&motion, margin, 0.05 * gap).unwrap().decision;
    assert_eq!(clears(0.8 * gap), Decision::Clear);
    assert_eq!(clears(1.2 * gap), Decision::Contact);
}

/// However little a robot turns, its tip moves.
#[test]
fn the_smallest_turn_counts() {
    let tube = Tube::from(&Chain::capsules(&[Vector::ZERO, 40.0 * Vector::Z], &[0.5]).unwrap());
    for angle in [1e-6, 1.9e-8, 1e-9] {
        // Tips that turn about x move along -y, by half of the distance of the wall, or twice that.
        let moved = 40.0 * angle;
        let wall = |share: Real| {
            let y = -0.5 - share * moved;
            let corners =
                [[-9.0, 39.5], [9.0, 39.5], [0.0, 45.0]].map(|[x, z]| Vector::new(x, y, z));
            BvhSearch::new(&TriMesh::new(corners.to_vec(), vec![[0, 1, 2]]).unwrap()).unwrap()
        };
        let motion = RigidMotion::new(
            tube.clone(),
            [Pose::IDENTITY, Pose::new(Vector::ZERO, Vector::X * angle)],
        )
        .unwrap();
        let clears =
            |share| wall(share).clears_motion(&motion, 0.0, 0.01 * moved).unwrap().decision;
        assert_eq!(clears(0.5), Decision::Contact, "{angle}");
        assert_eq!(clears(2.0), Decision::Clear, "{angle}");
        let half = motion.shape(0.5, &mut tube.clone()).unwrap();
        let tip = half * (40.0 * Vector::Z);
        assert!((tip.y + 0.5 * moved).abs() < 1e-3 * moved, "{angle}: {tip}");
    }
}
