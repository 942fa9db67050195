//! Whether motions keep to the speeds that they state.

use super::{polyline, random_edge};
use continuum_demo::{ctr, ventricle};
use continuum_testing::{Random, rounds};
use parry_continuum::parry::math::{Pose, Real, Vector};
use parry_continuum::{
    BendingMotion, LinearMotion, Motion, RigidMotion, RobotError, Speed, Tube, verify_motion,
};

/// A motion that states a share of the speeds that it should.
pub(super) struct Understated<'a, M>(pub &'a M, pub Real);

impl<M: Motion> Motion for Understated<'_, M> {
    fn shape(&self, t: Real, tube: &mut Tube) -> Result<Pose, RobotError> {
        self.0.shape(t, tube)
    }

    fn speed(&self, section: usize, shares: [Real; 2], times: [Real; 2]) -> Speed {
        let Speed { point, turn } = self.0.speed(section, shares, times);
        Speed { point: point * self.1, turn: turn * self.1 }
    }
}

#[test]
fn speeds_that_are_too_low_are_found() {
    let (robot, mut random) = (ctr::three_tubes(), Random::new(6));
    let mut found = [0; 4];
    for _ in 0..rounds(60) {
        let joints = random_edge(&robot, &mut random, 5.0);
        verify_motion(&joints, 60).unwrap();
        let bending =
            BendingMotion::new(&joints.sections(0.0), &joints.sections(1.0), ventricle::entry())
                .unwrap();
        verify_motion(&bending, 60).unwrap();
        let poses = [random.pose(5.0), random.pose(5.0)];
        let rigid = RigidMotion::new(joints.tube(0.0).unwrap(), poses).unwrap();
        verify_motion(&rigid, 60).unwrap();
        let (from, radii) = polyline(&mut random, Vector::ZERO);
        let to: Vec<_> = from.iter().map(|&point| point + random.point()).collect();
        let linear = LinearMotion::chain(&from, &to, &radii).unwrap();
        verify_motion(&linear, 60).unwrap();
        let too_low = |result: Result<(), RobotError>, stated_share: Real| match result {
            Ok(()) => 0,
            Err(
                RobotError::FasterThanStated { t, share, found, stated, .. }
                | RobotError::TurnsFasterThanStated { t, share, found, stated, .. },
            ) => {
                assert!((0.0..=1.0).contains(&t) && (0.0..=1.0).contains(&share));
                // The true bound holds, so the speed is between the two.
                assert!(stated < found && found <= stated / stated_share * (1.0 + 1e-9) + 1e-9);
                1
            }
            Err(other) => panic!("{other:?}"),
        };
        found[0] += too_low(verify_motion(&Understated(&joints, 0.5), 60), 0.5);
        found[1] += too_low(verify_motion(&Understated(&bending, 0.5), 60), 0.5);
        found[2] += too_low(verify_motion(&Understated(&rigid, 0.3), 60), 0.3);
        found[3] += too_low(verify_motion(&Understated(&linear, 0.99), 60), 0.99);
    }
    assert!(found.iter().all(|found| *found > rounds(50)), "{found:?}");
}
