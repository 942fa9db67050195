//! The moving robot equals the robot at each time, and is at most as fast as it states.

use continuum_demo::ctr::{Joints, Robot, three_tubes};
use continuum_demo::joint_motion::JointMotion;
use continuum_demo::steer::Random;
use continuum_demo::ventricle;
use parry_continuum::parry::math::Real;
use parry_continuum::{Motion, RobotError, Speed, Tube, parry::math::Pose, verify_motion};

/// Any motion of joints that are allowed.
fn motion(robot: &Robot, random: &mut Random) -> JointMotion {
    let [from, to] = [0; 2].map(|_| robot.any_joints(random));
    JointMotion::new(robot, [&from, &to], ventricle::entry()).unwrap()
}

#[test]
fn a_moving_robot_is_that_of_its_joints() {
    let (robot, mut random) = (three_tubes(), Random(1));
    for _ in 0..200 {
        let motion = motion(&robot, &mut random);
        for t in [0.0, 0.3, 1.0] {
            let joints = motion.joints(t);
            let tip =
                ventricle::entry() * robot.frames(&joints, &[robot.length(&joints)])[0].translation;
            assert!((motion.tip(t) - tip).length() < 1e-6, "{joints:?}");
            motion.tube(t).unwrap().verify(50).unwrap();
        }
    }
}

/// A motion that states a share of its speed.
struct Slower(JointMotion);

impl Motion for Slower {
    fn shape(&self, t: Real, tube: &mut Tube) -> Result<Pose, RobotError> {
        self.0.shape(t, tube)
    }

    fn speed(&self, section: usize, shares: [Real; 2], times: [Real; 2]) -> Speed {
        let Speed { point, turn } = self.0.speed(section, shares, times);
        Speed { point: 0.3 * point, turn: 0.3 * turn }
    }
}

#[test]
fn stated_speeds_hold_and_are_not_loose() {
    let (robot, mut random, mut found) = (three_tubes(), Random(2), 0);
    for _ in 0..200 {
        let motion = motion(&robot, &mut random);
        verify_motion(&motion, 100).unwrap();
        found += usize::from(verify_motion(&Slower(motion), 100).is_err());
    }
    assert!(found > 190, "{found}");
}

#[test]
fn what_cannot_be_bounded_is_refused() {
    let robot = three_tubes();
    let joints =
        |extensions: [Real; 3]| Joints { extensions: extensions.to_vec(), angles: vec![0.0; 3] };
    let is_good =
        |from, to| JointMotion::new(&robot, [&joints(from), &joints(to)], Pose::IDENTITY).is_some();
    assert!(is_good([30.0, 36.0, 12.0], [0.1, 0.1, 0.1]));
    // The second tube is straight where the first is long, and a section that is not out has no
    // length.
    assert!(!is_good([1.0, 1.0, 1.0], [31.0, 36.0, 1.0]));
    assert!(!is_good([1.0, 1.0, 0.0], [1.0, 1.0, 1.0]));
}
