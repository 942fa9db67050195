//! Stated displacements against dense sampling, and each of their terms alone.

use super::tests::{at, sections};
use super::{
    BendingMotion, BendingRates, DisplacementBound, LinearMotion, Motion, MotionPath, MovingBase,
    RigidMotion, ShapePath, Speed, bending_displacement,
};
use crate::curve::Tube;
use crate::robot::{BendingSection, ConstantCurvature};
use crate::robot::{Chain, RobotError};
use continuum_testing::Random;
use parry3d_f64::math::{Pose, Real, Vector};
use std::f64::consts::FRAC_PI_3;

/// The largest used share of `off`: the distance of a point from its stated displacement, seen from
/// both ends of the time.
fn used_of_course(
    motion: &dyn Motion,
    section: usize,
    shares: [Real; 2],
    times: [Real; 2],
) -> Real {
    let bound = motion.displacement(section, shares, times).unwrap();
    let mut most: Real = 0.0;
    for part in [0.0, 0.25, 0.5, 0.75, 1.0] {
        let share = shares[0] + (shares[1] - shares[0]) * part;
        let way = bound.way(part);
        let [first, last] = times.map(|t| at(motion, t, section, share).0);
        for q in [0.0, 0.25, 0.5, 0.75, 1.0] {
            let here = at(motion, times[0] + (times[1] - times[0]) * q, section, share).0;
            let off =
                (here - first - way * q).length().max((last - here - way * (1.0 - q)).length());
            most = most.max(off / bound.off);
        }
    }
    most
}

#[test]
fn stated_courses_hold_between_any_shares_and_times() {
    let mut random = Random::new(12);
    let (mut used, mut off) = ([0.0_f64; 5], [0.0_f64; 5]);
    for _ in 0..300 {
        let count = 1 + random.below(4) as usize;
        let radii: Vec<_> = (0..count).map(|_| random.between(0.1, 1.0)).collect();
        let from: Vec<_> =
            (0..=count).map(|k| random.point() * 2.0 + Vector::Z * k as Real).collect();
        let to: Vec<_> = from.iter().map(|&point| point + random.point() * 3.0).collect();
        let bent = [0; 4].map(|_| sections(&mut random, &radii));
        let poses = [random.pose(3.0), random.pose(3.0)];
        let bending = BendingMotion::new(&bent[0], &bent[1], poses[0]).unwrap();
        let mut tube = Tube::empty();
        bending.shape(random.unit(), &mut tube).unwrap();
        let bases = [0; 4].map(|_| random.pose(3.0));
        let leg = |k: usize| {
            let bending = BendingMotion::new(&bent[k], &bent[k + 1], poses[0]).unwrap();
            MovingBase::new(bending, [bases[k], bases[k + 1]]).unwrap()
        };
        let moving = leg(0);
        let path = MotionPath::new((0..3).map(leg).collect()).unwrap();
        let motions: [&dyn Motion; 5] = [
            &LinearMotion::chain(&from, &to, &radii).unwrap(),
            &RigidMotion::new(tube, poses).unwrap(),
            &bending,
            &moving,
            &path,
        ];
        for (kind, motion) in motions.into_iter().enumerate() {
            let section = random.below(count as u32) as usize;
            let mut pair = || {
                let (a, b) = (random.unit(), random.unit());
                [a.min(b), a.max(b)]
            };
            let (shares, times) = (pair(), pair());
            // Times within one motion of the path.
            let times = if kind == 4 { times.map(|t| (1.0 + t) / 3.0) } else { times };
            let most = used_of_course(motion, section, shares, times);
            used[kind] = used[kind].max(most);
            off[kind] = off[kind].max(motion.displacement(section, shares, times).unwrap().off);
        }
    }
    assert!(used.iter().all(|used| *used <= 1.0), "{used:?}");
    // No bound is so loose that it could never fail; links deviate by rounding only.
    assert!(
        off[0] < 1e-12 && used[1] > 0.8 && used[2] > 0.3 && used[3] > 0.2 && used[4] > 0.2,
        "{used:?} {off:?}"
    );
}

/// Each term of a displacement bound is as large as measured differences: without it the test
/// fails.
#[test]
fn each_term_of_a_course_is_as_large_as_differences() {
    let section = |length, bend| BendingSection { length, radius: 0.1, bend: [bend, 0.0] };
    let bending = |from: &[BendingSection], to: &[BendingSection]| {
        BendingMotion::new(from, to, Pose::IDENTITY).unwrap()
    };
    let turned = Pose::rotation(Vector::X * 0.5);
    let on_base =
        |motion: &BendingMotion| MovingBase::new(motion.clone(), [Pose::IDENTITY, turned]).unwrap();
    // Straight at first, so that the whole turn is across the part that turns.
    let alone = bending(&[section(10.0, 0.0)], &[section(10.0, 0.05)]);
    // The end of the first section turns the whole second section.
    let carried =
        bending(&[section(0.5, 0.0), section(10.0, 0.0)], &[section(0.5, 1.0), section(10.0, 0.0)]);
    let pushed =
        bending(&[section(0.5, 0.0), section(0.1, 0.0)], &[section(0.5, 0.5), section(10.0, 0.0)]);
    // Bent across the axis of the turn.
    let arc = BendingSection { length: 10.0, radius: 0.1, bend: [0.0, 0.08] };
    let bent = bending(&[arc], &[arc]);
    let bent_and_carried = bending(&[section(0.5, 0.0), arc], &[section(0.5, 1.0), arc]);
    let still = bending(&[section(10.0, 0.0)], &[section(10.0, 0.0)]);
    let growing = bending(&[section(0.1, 0.0)], &[section(10.0, 0.0)]);
    let mut arc = Tube::empty();
    bent.shape(0.0, &mut arc).unwrap();
    let rigid = RigidMotion::new(arc, [Pose::IDENTITY, turned]).unwrap();
    let (straight, arced, grown) = (on_base(&still), on_base(&bent), on_base(&growing));
    let early = [0.0, 0.02];
    type Case<'a> = (&'a str, &'a dyn Motion, usize, [Real; 2], [Real; 2], Real);
    let cases: [Case; 9] = [
        ("a bend", &alone, 0, [1.0; 2], early, 0.6),
        ("what a bend carries", &carried, 1, [1.0; 2], early, 0.6),
        ("what grows on a bend", &pushed, 1, [1.0; 2], early, 0.6),
        ("a bend along the curve", &alone, 0, [0.0, 1.0], early, 0.5),
        ("what a bend carries, along its curve", &bent_and_carried, 1, [0.0, 1.0], early, 0.3),
        ("a turn", &straight, 0, [1.0; 2], [0.0, 0.5], 0.9),
        ("what grows while it turns", &grown, 0, [1.0; 2], early, 0.6),
        ("a turn of what is bent", &rigid, 0, [0.0, 1.0], early, 0.6),
        ("the same on a base", &arced, 0, [0.0, 1.0], early, 0.6),
    ];
    for (name, motion, section, shares, times, least) in cases {
        let used = used_of_course(motion, section, shares, times);
        assert!((least..=1.0).contains(&used), "{name}: {used}");
    }
}

/// A curvature vector that turns, and so changes at a varying rate.
#[test]
fn what_a_curvature_changes_by_unevenly_counts_in_a_course() {
    const RATE: Real = 10.0;
    let (curvature, length) = (0.005, 10.0);
    let point = |share: Real, t: Real| {
        let (sin, cos) = (RATE * t).sin_cos();
        let bend = [curvature * cos, curvature * sin];
        let robot =
            ConstantCurvature::new(&[BendingSection { length, radius: 0.1, bend }]).unwrap();
        robot.at_share(0, share)
    };
    let rates =
        BendingRates { length, growth: 0.0, curvature, bending: curvature * RATE, step: 0.0 };
    let used = |bends: &[Real]| {
        let times = [0.3, 0.32];
        let bound = bending_displacement(&[rates], bends, 0, [1.0; 2], times, point);
        let off = point(1.0, 0.31) - point(1.0, times[0]) - bound.way(0.0) * 0.5;
        off.length() / bound.off
    };
    let turning = curvature * RATE * RATE;
    assert!((0.8..=1.0).contains(&used(&[turning])), "{}", used(&[turning]));
    assert!(used(&[0.0]) > 1.0, "{}", used(&[0.0]));
    assert_eq!(used(&[]), 0.0);
}

/// An interval in which nothing moves by more than the rounding of places, far from the origin.
#[test]
fn courses_allow_for_rounding() {
    let mut random = Random::new(14);
    let mut used = [0.0_f64; 6];
    for _ in 0..200 {
        let radii = [random.between(0.1, 1.0), random.between(0.1, 1.0)];
        let far = random.direction() * 1e6;
        let mut place = || {
            let pose = random.pose(3.0);
            Pose::from_parts(pose.translation + far, pose.rotation)
        };
        let poses = [place(), place()];
        let from: Vec<_> = (0..3).map(|k| far + random.point() + Vector::Z * k as Real).collect();
        let to: Vec<_> = from.iter().map(|&point| point + random.point() * 3.0).collect();
        let bent = [sections(&mut random, &radii), sections(&mut random, &radii)];
        let bending = BendingMotion::new(&bent[0], &bent[1], poses[0]).unwrap();
        let mut tube = Tube::empty();
        let near = BendingMotion::new(&bent[0], &bent[1], Pose::IDENTITY).unwrap();
        near.shape(0.5, &mut tube).unwrap();
        let moving = MovingBase::new(near, poses).unwrap();
        let chains =
            [&from, &to, &from].map(|points| Chain::from_centreline(points, &radii).unwrap());
        let shapes = ShapePath::new(&chains, 0.0).unwrap();
        assert_eq!(shapes.displacement(0, [0.0, 1.0], [0.4, 0.6]), None, "it jumps in between");
        let linear = LinearMotion::chain(&from, &to, &radii).unwrap();
        let back = LinearMotion::chain(&to, &from, &radii).unwrap();
        let path = MotionPath::new(vec![linear.clone(), back, linear.clone()]).unwrap();
        let rigid = RigidMotion::new(tube, poses).unwrap();
        let motions: [&dyn Motion; 6] = [&linear, &rigid, &bending, &moving, &path, &shapes];
        for (kind, motion) in motions.into_iter().enumerate() {
            let t = random.between(0.34, 0.49);
            let times = [t, t + 1e-13 * random.unit()];
            used[kind] = used[kind].max(used_of_course(
                motion,
                random.below(2) as usize,
                [0.25, 0.75],
                times,
            ));
        }
    }
    assert!(used.iter().all(|used| *used <= 1.0 && *used > 0.002), "{used:?}");
}

/// A point that moves about one place, up to 1 from it, until a time; then it rests.
struct Wandering {
    until: Real,
}

impl Motion for Wandering {
    fn shape(&self, t: Real, tube: &mut Tube) -> Result<Pose, RobotError> {
        tube.set_chain(&Chain::capsules(&[Vector::ZERO, Vector::Z], &[0.1])?);
        // From the place to a distance of 1, around it and back, and to a place that is 1 from it
        // and 1 from the former.
        let third = FRAC_PI_3;
        let at = |angle: Real| Vector::new(angle.cos(), angle.sin(), 0.0);
        let t = (t / self.until).min(1.0);
        let place =
            if t < 0.5 { at(-third) * (2.0 * t) } else { at(-third + (2.0 * t - 1.0) * third) };
        Ok(Pose::from_translation(place))
    }

    fn speed(&self, _section: usize, _shares: [Real; 2], _times: [Real; 2]) -> Speed {
        Speed { point: 2.2 / self.until, turn: 0.0 }
    }

    fn displacement(
        &self,
        _section: usize,
        _shares: [Real; 2],
        times: [Real; 2],
    ) -> Option<DisplacementBound> {
        let off = if times[0] < self.until { 1.0 } else { 0.0 };
        Some(DisplacementBound { ways: [Vector::ZERO; 2], off: off + 1e-12 })
    }
}

/// A base that turns also turns the error of the displacement.
#[test]
fn what_is_off_its_course_on_a_base_that_turns_counts() {
    let turned = Pose::rotation(Vector::Z);
    let on_base = |until| MovingBase::new(Wandering { until }, [Pose::IDENTITY, turned]).unwrap();
    let motion = on_base(1.0);
    for times in [[0.0, 1.0], [0.0, 0.6], [0.4, 1.0], [0.2, 0.9], [0.7, 1.0]] {
        let used = used_of_course(&motion, 0, [0.0; 2], times);
        assert!((0.1..=1.0).contains(&used), "{times:?}: {used}");
    }
    // 1 off at the middle and at the end, 60 degrees apart; then half of the turn gives that.
    let [middle, end] = [0.5, 1.0].map(|t| at(&motion, t, 0, 0.0).0);
    assert!((middle - end).length() > 1.39);
    // It rests 1 from its supposed place and is turned by 0.8.
    let used = used_of_course(&on_base(0.2), 0, [0.0; 2], [0.2, 1.0]);
    assert!((0.5..=1.0).contains(&used), "{used}");
}
