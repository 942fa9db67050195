//! A base that moves while the robot bends and grows: each term of its speed alone, left out, is
//! found.

use continuum_testing::rounds;
use parry_continuum::parry::math::{Pose, Real, Rotation, Vector};
use parry_continuum::proximity::BvhSearch;
use parry_continuum::{
    BendingMotion, BendingSection, LinearMotion, Motion, MotionPath, MovingBase, RobotError, Speed,
    Tube, verify_motion,
};

type Stated = fn(&MovingBase<BendingMotion>, &BendingMotion, usize, [Real; 2], [Real; 2]) -> Speed;

/// What a motion would state if something were left out.
struct States {
    motion: MovingBase<BendingMotion>,
    inner: BendingMotion,
    stated: Stated,
}

impl Motion for States {
    fn shape(&self, t: Real, tube: &mut Tube) -> Result<Pose, RobotError> {
        self.motion.shape(t, tube)
    }

    fn speed(&self, section: usize, shares: [Real; 2], times: [Real; 2]) -> Speed {
        (self.stated)(&self.motion, &self.inner, section, shares, times)
    }
}

fn section(length: Real, bend: [Real; 2]) -> BendingSection {
    BendingSection { length, radius: 0.5, bend }
}

#[test]
fn each_term_that_is_left_out_is_found() {
    let still = section(20.0, [0.03, 0.01]);
    let place = Pose::new(Vector::new(3.0, -2.0, 1.0), Vector::new(0.3, 0.2, -0.4));
    let moved = |shift: Vector, turn: Vector| place * Pose::new(shift, turn);
    let all: Stated = |motion, _, section, shares, times| motion.speed(section, shares, times);
    let inner_alone: Stated =
        |_, inner, section, shares, times| inner.speed(section, shares, times);
    // As if the robot were at all times as long as in the middle, or did not move in the frame of
    // its base.
    let base_alone: Stated = |motion, inner, section, shares, times| {
        let all = motion.speed(section, shares, [0.5, 0.5]);
        let own = inner.speed(section, shares, times);
        Speed { point: all.point - own.point, turn: all.turn - own.turn }
    };
    let short: Stated = |motion, _, section, shares, _| motion.speed(section, shares, [0.0, 0.0]);
    let bend = [section(20.0, [0.0, 0.0]), section(20.0, [0.03, 0.0])];
    let grow = [section(20.0, [0.03, 0.0]), section(26.0, [0.03, 0.0])];
    let longer = [section(2.0, [0.0, 0.0]), section(26.0, [0.0, 0.0])];
    let cases = [
        ("push", [still, still], moved(Vector::Y * 4.0, Vector::ZERO), inner_alone),
        ("roll", [still, still], moved(Vector::ZERO, Vector::Z * 0.4), inner_alone),
        ("turn", [still, still], moved(Vector::ZERO, Vector::X * 0.4), inner_alone),
        ("bend", bend, place, base_alone),
        ("grow", grow, place, base_alone),
        ("longer", longer, moved(Vector::ZERO, Vector::X * 1.5), short),
    ];
    for (name, [from, to], end, stated) in cases {
        let inner = BendingMotion::new(&[from], &[to], Pose::IDENTITY).unwrap();
        let motion = MovingBase::new(inner.clone(), [place, end]).unwrap();
        for steps in [1, 7, 100, rounds(1000)] {
            let mut states = States { motion: motion.clone(), inner: inner.clone(), stated: all };
            assert_eq!(verify_motion(&states, steps), Ok(()), "{name}, {steps}");
            states.stated = stated;
            // One step shows that both ends of a path stated for its beginning are as near as
            // allowed.
            let refused = verify_motion(&states, steps);
            assert!(
                refused.is_err() || steps == 1 && name == "longer",
                "{name} was left out, {steps}"
            );
        }
    }
}

/// Pushed, rolled, bent and grown at once: the stated bound holds, and is at most a few times the
/// true motion.
#[test]
fn all_at_once_is_stated() {
    let from = [section(10.0, [0.0, 0.02]), section(5.0, [0.05, 0.0])];
    let to = [section(14.0, [0.03, 0.0]), section(9.0, [0.0, -0.05])];
    let inner = BendingMotion::new(&from, &to, Pose::new(Vector::X, Vector::Y * 0.1)).unwrap();
    let ends = [Pose::IDENTITY, Pose::new(Vector::Z * 3.0, Vector::new(0.1, 0.0, 0.5))];
    let motion = MovingBase::new(inner, ends).unwrap();
    for steps in [1, 10, rounds(500)] {
        assert_eq!(verify_motion(&motion, steps), Ok(()));
    }
    let refused =
        MovingBase::new(motion.clone(), [Pose::IDENTITY, Pose::from_translation(Vector::NAN)]);
    assert!(matches!(refused, Err(RobotError::BadPose { parameter: "to", .. })));
    // A base on a base.
    let twice = MovingBase::new(motion, [Pose::IDENTITY, Pose::rotation(Vector::X * 0.2)]).unwrap();
    assert_eq!(verify_motion(&twice, 100), Ok(()));
}

/// A rotation that scales is no rotation, in a base that moves as everywhere else.
#[test]
fn a_motion_whose_pose_scales_is_refused() {
    struct Scales;
    impl Motion for Scales {
        fn shape(&self, _: Real, tube: &mut Tube) -> Result<Pose, RobotError> {
            tube.set_samples(&[Vector::ZERO, Vector::Z * 10.0], &[0.5], None)?;
            Ok(Pose::from_parts(Vector::ZERO, Rotation::from_xyzw(0.0, 0.0, 0.0, 0.5)))
        }

        fn speed(&self, _: usize, _: [Real; 2], _: [Real; 2]) -> Speed {
            Speed { point: 0.0, turn: 0.0 }
        }
    }
    let turned = Pose::new(Vector::ZERO, Vector::X);
    let refused = MovingBase::new(Scales, [Pose::IDENTITY, turned]).map(|_| ());
    assert!(
        matches!(refused, Err(RobotError::PoseNotRigid { parameter: "motion", .. })),
        "{refused:?}"
    );
}

/// A link that is turned over loses its direction on the way, in one leg of a path and not in the
/// next.
#[test]
fn a_link_may_fade_in_one_leg_of_a_path() {
    let leg = |from: Vector, to: Vector| {
        LinearMotion::chain(&[Vector::ZERO, from], &[Vector::ZERO, to], &[0.1]).unwrap()
    };
    let path =
        MotionPath::new(vec![leg(Vector::Z, -Vector::Z), leg(-Vector::Z, Vector::X - Vector::Z)])
            .unwrap();
    let far = [[-9.0, -9.0], [9.0, -9.0], [0.0, 9.0]].map(|[x, y]| Vector::new(x, y, 5.0));
    let mut search = BvhSearch::from_triangles(&far, &[[0, 1, 2]]).unwrap();
    assert!(search.clears_motion(&path, 1.0, 1e-3).unwrap().is_clear());
    assert!(!search.clears_motion(&path, 4.5, 1e-3).unwrap().is_clear());
}
