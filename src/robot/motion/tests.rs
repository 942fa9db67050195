//! Stated speeds against dense sampling, between any two shares and any two times.

use super::{BendingMotion, LinearMotion, Motion, RigidMotion};
use crate::robot::BendingSection;
use crate::robot::Tube;
use continuum_testing::Random;
use parry3d_f64::math::{Real, Vector};

/// The point and the direction in the mesh's frame.
fn at(motion: &dyn Motion, t: Real, section: usize, share: Real) -> (Vector, Vector) {
    let mut tube = Tube::empty();
    let pose = motion.shape(t, &mut tube).unwrap();
    let here = tube.at_share(&tube.sections()[section], share);
    (pose * here.point, pose.rotation * here.direction)
}

fn sections(random: &mut Random, radii: &[Real]) -> Vec<BendingSection> {
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
    // How much of the stated speed is used at most, by kind of motion: points and turns.
    let mut used = [[0.0_f64; 2]; 3];
    for _ in 0..300 {
        let count = 1 + random.below(4) as usize;
        let radii: Vec<_> = (0..count).map(|_| random.between(0.1, 1.0)).collect();
        let from: Vec<_> = (0..=count).map(|k| random.point() * 2.0 + Vector::Z * k as Real).collect();
        let to: Vec<_> = from.iter().map(|&point| point + random.point() * 3.0).collect();
        let mut bent = [sections(&mut random, &radii), sections(&mut random, &radii)];
        if random.below(2) == 0 {
            // Lengths alone change.
            let bends = bent[0].clone();
            bent[1].iter_mut().zip(&bends).for_each(|(to, from)| to.bend = from.bend);
        }
        let poses = [random.pose(3.0), random.pose(3.0)];
        let bending = BendingMotion::new(&bent[0], &bent[1], poses[0]).unwrap();
        let mut tube = Tube::empty();
        bending.shape(random.unit(), &mut tube).unwrap();
        let motions: [&dyn Motion; 3] = [
            &LinearMotion::chain(&from, &to, &radii).unwrap(),
            &RigidMotion::new(tube, poses).unwrap(),
            &bending,
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
                        assert!(moved <= stated.point + rounding, "{moved} {stated:?} {share} {times:?}");
                        assert!(turned <= stated.turn + rounding, "{turned} {stated:?} {share} {times:?}");
                        used[0] = used[0].max(moved / stated.point);
                        used[1] = used[1].max(turned / stated.turn);
                    }
                }
            }
        }
    }
    // No bound is so loose that nothing could break it.
    assert!(used.iter().flatten().all(|used| *used > 0.8), "{used:?}");
}
