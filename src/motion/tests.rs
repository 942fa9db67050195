//! Stated speeds against dense sampling, for any two shares and any two times.

use super::{
    BendingMotion, CarriedMotion, CarriedPiece, CommonFrame, LinearMotion, Motion, MotionPath,
    MovingBase, RigidMotion, RigidPath, Speed,
};
use crate::curve::Tube;
use crate::robot::BendingSection;
use crate::robot::RobotError;
use continuum_testing::Random;
use parry3d_f64::math::{Pose, Real, Vector};

/// The point and the direction in the mesh's frame.
pub(super) fn at(motion: &dyn Motion, t: Real, section: usize, share: Real) -> (Vector, Vector) {
    let mut tube = Tube::empty();
    let pose = motion.shape(t, &mut tube).unwrap();
    let here = tube.at_share(&tube.sections()[section], share);
    (pose * here.point, pose.rotation * here.direction)
}

pub(super) fn sections(random: &mut Random, radii: &[Real]) -> Vec<BendingSection> {
    let mut bend = || random.between(-0.3, 0.3);
    let bends: Vec<_> = radii.iter().map(|_| [bend(), bend()]).collect();
    let sections = radii.iter().zip(bends);
    sections
        .map(|(&radius, bend)| BendingSection { length: random.between(0.01, 8.0), radius, bend })
        .collect()
}

#[test]
fn stated_speeds_hold_between_any_shares_and_times() {
    let mut random = Random::new(1);
    // The largest used share of the stated speed, by kind of motion: points and turns.
    let mut used = [[0.0_f64; 2]; 4];
    for _ in 0..300 {
        let count = 1 + random.below(4) as usize;
        let radii: Vec<_> = (0..count).map(|_| random.between(0.1, 1.0)).collect();
        let from: Vec<_> =
            (0..=count).map(|k| random.point() * 2.0 + Vector::Z * k as Real).collect();
        let to: Vec<_> = from.iter().map(|&point| point + random.point() * 3.0).collect();
        let mut bent = [sections(&mut random, &radii), sections(&mut random, &radii)];
        if random.below(2) == 0 {
            // Only lengths change.
            let bends = bent[0].clone();
            bent[1].iter_mut().zip(&bends).for_each(|(to, from)| to.bend = from.bend);
        }
        let poses = [random.pose(3.0), random.pose(3.0)];
        let bending = BendingMotion::new(&bent[0], &bent[1], poses[0]).unwrap();
        let mut tube = Tube::empty();
        bending.shape(random.unit(), &mut tube).unwrap();
        let moving =
            MovingBase::new(bending.clone(), [random.pose(3.0), random.pose(3.0)]).unwrap();
        let motions: [&dyn Motion; 4] = [
            &LinearMotion::chain(&from, &to, &radii).unwrap(),
            &RigidMotion::new(tube, poses).unwrap(),
            &bending,
            &moving,
        ];
        for (motion, used) in motions.into_iter().zip(&mut used) {
            for _ in 0..4 {
                let section = random.below(count as u32) as usize;
                let mut pair = || {
                    let (a, b) = (random.unit(), random.unit());
                    [a.min(b), a.max(b)]
                };
                let (shares, times) = (pair(), pair());
                let stated = motion.speed(section, shares, times);
                for share in 0..=4 {
                    let share = shares[0] + (shares[1] - shares[0]) * Real::from(share) / 4.0;
                    let step = (times[1] - times[0]) / 16.0;
                    for k in 0..16 {
                        let t = times[0] + step * Real::from(k);
                        let [before, behind] = [t, t + step].map(|t| at(motion, t, section, share));
                        let moved = (behind.0 - before.0).length() / step;
                        let turned = (behind.1 - before.1).length() / step;
                        let rounding = 1e-13 / step;
                        assert!(
                            moved <= stated.point + rounding,
                            "{moved} {stated:?} {share} {times:?}"
                        );
                        assert!(
                            turned <= stated.turn + rounding,
                            "{turned} {stated:?} {share} {times:?}"
                        );
                        used[0] = used[0].max(moved / stated.point);
                        used[1] = used[1].max(turned / stated.turn);
                    }
                }
            }
        }
    }
    // No bound is so loose that it could never fail; a moving base's bound is a sum of others.
    assert!(used.iter().take(3).flatten().all(|used| *used > 0.8), "{used:?}");
    assert!(used[3].iter().all(|used| *used > 0.5), "{used:?}");
}

/// The speeds that a middle shape gives, relative to the frame at rest and to the frame of another
/// motion, against differences in that frame.
#[test]
fn carried_speeds_hold_in_any_frame() {
    let mut random = Random::new(8);
    let mut used = [[0.0_f64; 2]; 4];
    for round in 0..200 {
        let start = random.point();
        let points: Vec<_> = (0..3).map(|k| start + Vector::Z * Real::from(k)).collect();
        let to: Vec<_> = points.iter().map(|&point| point + random.point()).collect();
        let shift = random.point() * 4.0;
        let shifted: Vec<_> = points.iter().map(|&point| point + shift).collect();
        let radii = [0.5, 0.4];
        let linear = LinearMotion::chain(&points, &to, &radii).unwrap();
        let together = LinearMotion::chain(&points, &shifted, &radii).unwrap();
        let mut tube = Tube::empty();
        linear.shape(0.5, &mut tube).unwrap();
        let mut poses = || [random.pose(3.0), random.pose(3.0)];
        let rigid = RigidMotion::new(tube.clone(), poses()).unwrap();
        let on_base = MovingBase::new(linear.clone(), poses()).unwrap();
        let nested =
            MovingBase::new(MovingBase::new(together.clone(), poses()).unwrap(), poses()).unwrap();
        let other = RigidMotion::new(tube.clone(), poses()).unwrap();
        let motions: [&dyn Motion; 4] = [&together, &rigid, &on_base, &nested];
        for (motion, used) in motions.into_iter().zip(&mut used) {
            let middle = random.between(0.2, 0.8);
            let half = [0.2, 0.02, 1e-3][round % 3] * random.unit().max(0.1);
            let times = [middle - half, middle + half];
            let carried = CarriedMotion::new(motion, times, half * (1.0 + 1e-12));
            assert!(carried.has_frame());
            let pose = motion.shape(0.5 * times[0] + 0.5 * times[1], &mut tube).unwrap();
            let section = random.below(2) as usize;
            let (a, b) = (random.unit(), random.unit());
            let shares = [a.min(b), a.max(b)];
            let piece = CarriedPiece::new(&tube, &pose, &tube.sections()[section], shares, true);
            let stated = carried.stated(section, shares);
            let beside =
                CommonFrame::of_path(&RigidPath::new(other_poses(&other)).unwrap(), middle);
            for (kind, frame) in [CommonFrame::REST, beside].into_iter().enumerate() {
                let speed = carried.speeds(stated, || piece, &frame).seen;
                let step = 2.0 * half / 8.0;
                for (k, share) in (0..8).flat_map(|k| shares.map(|share| (k, share))) {
                    let t = times[0] + step * Real::from(k);
                    let [before, behind] = [t, t + step].map(|t| {
                        let (point, way) = at(motion, t, section, share);
                        let seen = if kind == 0 {
                            Pose::IDENTITY
                        } else {
                            other.shape(t, &mut Tube::empty()).unwrap().inverse()
                        };
                        (seen * point, seen.rotation * way)
                    });
                    let moved = (behind.0 - before.0).length() / step;
                    let turned = (behind.1 - before.1).length() / step;
                    let rounding = 1e-13 / step;
                    assert!(moved <= speed.point + rounding, "{moved} {speed:?} {kind}");
                    assert!(turned <= speed.turn + rounding, "{turned} {speed:?} {kind}");
                    used[0] = used[0].max(moved / speed.point);
                    used[1] = used[1].max(turned / speed.turn);
                }
            }
        }
    }
    // A frame's own speed is reached within a tenth by some sample; the others are sums.
    assert!(used.iter().take(2).all(|used| used[0] > 0.9) && used[1][1] > 0.9, "{used:?}");
    assert!(used.iter().skip(2).flatten().all(|used| *used > 0.5), "{used:?}");
}

/// A point moves straight along x through the axis of a frame that turns about z. Seen from the
/// frame, it also moves along y when it has left the axis.
#[test]
fn a_point_that_leaves_the_axis_of_the_other_frame_is_seen_to_turn() {
    let from = [Vector::X * -0.5, Vector::Z - Vector::X * 0.75];
    let to = [Vector::X * 0.5, Vector::Z + Vector::X * 0.75];
    let motion = LinearMotion::chain(&from, &to, &[0.1]).unwrap();
    let mut tube = Tube::empty();
    let pose = motion.shape(0.5, &mut tube).unwrap();
    let (times, shares, turn) = ([0.0, 1.0], [0.0; 2], 3.0);
    let carried = CarriedMotion::new(&motion, times, 0.5);
    assert!(!carried.has_frame());
    let turned = [-0.5, 0.5].map(|share| Pose::rotation(Vector::Z * turn * share));
    let frame = CommonFrame::between(turned, times).unwrap();
    let piece = CarriedPiece::new(&tube, &pose, &tube.sections()[0], shares, true);
    let seen = carried.speeds(carried.stated(0, shares), || piece, &frame).seen;
    // Velocity 1 and arm 1/2 at either end of the interval.
    let fastest = Real::hypot(1.0, 0.5 * turn);
    assert!(fastest <= seen.point && seen.point < 1.5 * fastest, "{seen:?}");
}

/// The poses at both ends of a rigid motion.
fn other_poses(motion: &RigidMotion) -> [Pose; 2] {
    [0.0, 1.0].map(|t| motion.shape(t, &mut Tube::empty()).unwrap())
}

/// The largest used share of a stated speed at the tip, in fine steps of a part of the time.
fn used_at_tip(motion: &dyn Motion, times: [Real; 2]) -> [Real; 2] {
    let Speed { point, turn } = motion.speed(0, [1.0; 2], times);
    let step = (times[1] - times[0]) / 256.0;
    let mut used = [0.0_f64; 2];
    for k in 0..256 {
        let t = times[0] + step * Real::from(k);
        let [before, behind] = [t, t + step].map(|t| at(motion, t, 0, 1.0));
        used[0] = used[0].max((behind.0 - before.0).length() / step / point);
        used[1] = used[1].max((behind.1 - before.1).length() / step / turn);
    }
    used
}

/// Each term of a moving base's bound equals the measured differences: its push, its turn, the
/// bending on it, and the growing distance from the axis at times other than the known shapes'.
#[test]
fn each_term_of_a_moving_base_is_as_large_as_differences() {
    let section = |length, bend| BendingSection { length, radius: 0.5, bend: [bend, 0.0] };
    let inner = |from, to| BendingMotion::new(&[from], &[to], Pose::IDENTITY).unwrap();
    let still = inner(section(10.0, 0.0), section(10.0, 0.0));
    let moving = |motion: &BendingMotion, to: Pose| {
        MovingBase::new(motion.clone(), [Pose::IDENTITY, to]).unwrap()
    };
    let pushed = moving(&still, Pose::from_translation(Vector::new(1.0, 2.0, -3.0)));
    let turned = moving(&still, Pose::rotation(Vector::X * 0.5));
    let bent = moving(&inner(section(10.0, 0.0), section(10.0, 0.02)), Pose::IDENTITY);
    // Pushed along the tip's velocity as the base turns it.
    let both = moving(&still, Pose::new(Vector::Y * -3.0, Vector::X * 0.5));
    // Grows to twice the length: away from the axis, not only along itself.
    let growing =
        moving(&inner(section(1.0, 0.0), section(41.0, 0.0)), Pose::rotation(Vector::X * 3.0));
    for (name, motion, times, least) in [
        ("push", &pushed, [0.0, 1.0], [0.999, 0.0]),
        ("turn", &turned, [0.0, 1.0], [0.999, 0.999]),
        ("bend", &bent, [0.0, 1.0], [0.95, 0.95]),
        ("push and turn", &both, [0.0, 1.0], [0.95, 0.999]),
        // 3 x 41 across and 40 along. Without the movement since t = 1/2 it would be 3 x 21.
        ("turn of what grows", &growing, [0.9, 1.0], [0.75, 0.999]),
        ("turn of what is short", &growing, [0.0, 0.1], [0.7, 0.999]),
        ("turn of what is half out", &growing, [0.6, 0.75], [0.7, 0.999]),
    ] {
        let used = used_at_tip(motion, times);
        assert!((0..2).all(|k| least[k] <= used[k] || used[k].is_nan()), "{name}: {used:?}");
        assert!(used.iter().all(|used| *used <= 1.0 + 1e-9 || used.is_nan()), "{name}: {used:?}");
    }
}

/// In a sequence of motions, each is as fast as stated in its own part of the time.
#[test]
fn a_path_is_as_fast_as_its_motions() {
    let way = |from: Real, to: Real| {
        LinearMotion::capsules(
            &[Vector::X * from, Vector::X * from + Vector::Z],
            &[Vector::X * to, Vector::X * to + Vector::Z],
            &[0.1],
        )
    };
    let motions = vec![way(0.0, 1.0).unwrap(), way(1.0, 5.0).unwrap(), way(5.0, 5.0).unwrap()];
    let path = MotionPath::new(motions).unwrap();
    super::verify_motion(&path, 30).unwrap();
    let speed = |times| path.speed(0, [0.0, 1.0], times).point;
    let third = 1.0 / 3.0;
    for (times, expected) in [
        ([0.0, third], 3.0),
        ([0.1, 0.2], 3.0),
        ([0.3, 0.4], 12.0),
        ([third, 2.0 * third], 12.0),
        ([2.0 * third, 1.0], 0.0),
        ([0.7, 0.7], 0.0),
        ([0.0, 1.0], 12.0),
    ] {
        assert!((speed(times) - expected).abs() < 1e-9, "{times:?}: {}", speed(times));
    }
    assert_eq!(path.part_at(0.0), (0, 0.0));
    assert_eq!(path.part_at(1.0), (2, 1.0));
    assert_eq!(path.part_at(0.5).0, 1);
    assert!((path.part_at(0.5).1 - 0.5).abs() < 1e-15);
    assert!((at(&path, 0.5, 0, 0.0).0 - Vector::X * 3.0).length() < 1e-12);
    assert!(MotionPath::<LinearMotion>::new(Vec::new()).is_err());
}

/// Motions that meet within rounding are joined; motions that leave a gap are refused.
#[test]
fn a_path_has_no_gap() {
    let mut random = Random::new(91);
    for round in 0..200 {
        let unit = [1.0, 1e-3, 1e6, 1e-200][round % 4];
        let radii = [0.3 * unit, 0.2 * unit];
        let mut shape =
            || [0, 1, 2].map(|k| (random.point() + Vector::Z * (3.0 * Real::from(k))) * unit);
        let shapes = [0; 4].map(|_| shape());
        let part = |k: usize| LinearMotion::chain(&shapes[k], &shapes[k + 1], &radii).unwrap();
        MotionPath::new((0..3).map(part).collect()).unwrap();
        // One part in 10^12 of the size is no rounding.
        let off = random.direction() * (1e-12 * 10.0 * unit);
        let moved = shapes[1].map(|point| point + off);
        let apart = vec![part(0), LinearMotion::chain(&moved, &shapes[2], &radii).unwrap()];
        let refused = MotionPath::new(apart).unwrap_err();
        assert!(
            matches!(refused, RobotError::MotionsApart { index: 1, section: 0, .. }),
            "{refused}"
        );
    }
    for round in 0..200 {
        let bent = [0; 3].map(|_| sections(&mut random, &[0.3, 0.2]));
        let (bases, shift) = ([0; 3].map(|_| random.pose(9.0)), random.direction() * 1e-9);
        let part = |k: usize, to: Pose| {
            let bending = BendingMotion::new(&bent[k], &bent[k + 1], bases[0]).unwrap();
            MovingBase::new(bending, [to, bases[k + 1]]).unwrap()
        };
        let joined = MotionPath::new(vec![part(0, bases[0]), part(1, bases[1])]);
        super::verify_motion(&joined.unwrap(), 8).unwrap();
        let there = match round % 3 {
            0 => Pose::from_parts(bases[1].translation + shift, bases[1].rotation),
            1 => bases[2],
            _ => Pose::new(Vector::ZERO, Vector::X * 1e-6) * bases[1],
        };
        let refused = MotionPath::new(vec![part(0, bases[0]), part(1, there)]).unwrap_err();
        assert_eq!(refused.kind(), "motions_apart", "{refused}");
    }
}

/// A flat end that turns about its centre is a gap: its rim jumps.
#[test]
fn a_direction_that_jumps_is_a_gap() {
    let points = [Vector::ZERO, Vector::Z, Vector::Z * 2.0];
    let at_rest = |tilt: Real| {
        let ends = [Vector::Z, Vector::Z + Vector::X * tilt];
        let tube = Tube::from_samples(&points, &[0.5; 2], Some(ends)).unwrap();
        RigidMotion::new(tube, [Pose::IDENTITY; 2]).unwrap()
    };
    MotionPath::new(vec![at_rest(0.1), at_rest(0.1)]).unwrap();
    let refused = MotionPath::new(vec![at_rest(0.0), at_rest(0.1)]).unwrap_err();
    assert!(
        matches!(refused, RobotError::MotionsApart { off: 0.0, turn, .. } if turn > 0.05),
        "{refused}"
    );
}

#[test]
fn a_path_keeps_its_sections() {
    let way = |radius: Real| {
        LinearMotion::capsules(&[Vector::ZERO, Vector::Z], &[Vector::ZERO, Vector::Z], &[radius])
            .unwrap()
    };
    let refused = MotionPath::new(vec![way(0.1), way(0.1), way(0.2)]).unwrap_err();
    assert_eq!(refused, RobotError::SectionsChange { t: 2.0 / 3.0 });
}

/// Scaled by a power of two, the same motion: points move that much slower, directions turn alike.
/// The squares of all lengths underflow or nearly overflow.
#[test]
fn speeds_scale_with_the_robot() {
    let mut random = Random::new(9);
    for power in [-900, -700, 400] {
        let scale = 2.0_f64.powi(power);
        for _ in 0..30 {
            let radii = [random.between(0.1, 1.0), 0.0];
            let from: Vec<_> = (0..3).map(|k| random.point() + Vector::Z * f64::from(k)).collect();
            let to: Vec<_> = from.iter().map(|&point| point + random.point()).collect();
            let poses = [random.pose(1.0), random.pose(1.0)];
            let speeds = |scale: Real| {
                let scaled = |points: &[Vector]| points.iter().map(|p| *p * scale).collect();
                let [from, to]: [Vec<_>; 2] = [scaled(&from), scaled(&to)];
                let radii = radii.map(|radius| radius * scale);
                let poses = poses.map(|pose| {
                    Pose::from_parts(pose.translation * scale, pose.rotation.normalize())
                });
                let linear = LinearMotion::chain(&from, &to, &radii).unwrap();
                let mut tube = Tube::empty();
                linear.shape(0.0, &mut tube).unwrap();
                let rigid = RigidMotion::new(tube, poses).unwrap();
                let moving = MovingBase::new(linear.clone(), poses).unwrap();
                let motions: [&dyn Motion; 3] = [&linear, &rigid, &moving];
                motions.map(|motion| motion.speed(1, [0.25, 0.75], [0.125, 0.5]))
            };
            for (kind, (small, usual)) in speeds(scale).into_iter().zip(speeds(1.0)).enumerate() {
                let is_near = |a: Real, b: Real| (a - b).abs() <= 1e-12 * b;
                let is_scaled = is_near(small.point / scale, usual.point);
                assert!(
                    is_scaled && is_near(small.turn, usual.turn),
                    "{kind}: {small:?} {usual:?}"
                );
                assert!(usual.point > 0.01, "{kind}: {usual:?}");
            }
        }
    }
}
