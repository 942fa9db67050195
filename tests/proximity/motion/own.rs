//! Motions of one robot beside itself: against each of many steps, and against what may be between these.

use continuum_testing::Random;
use parry_continuum::parry::math::{Pose, Real, Rotation, Vector};
use parry_continuum::proximity::{Decision, RobotPair};
use parry_continuum::{
    BendingMotion, BendingSection, Chain, LinearMotion, Motion, RigidMotion, Speed, Tube, verify_motion,
};
use std::f64::consts::TAU;

const STEPS: usize = 250;
const RESOLUTION: Real = 1e-3;

/// What becomes of a motion at a margin.
#[derive(Clone, Copy, Default, Debug)]
struct Counts {
    decisions: [usize; 3],
    /// How often each step kept a margin so wide that all between steps keep this one.
    clear_steps: usize,
    /// How often a step did not keep it.
    contact_steps: usize,
}

/// A motion of a robot with so many sections, none of which is wider than this.
struct Robot<M> {
    motion: M,
    sections: usize,
    radius: Real,
}

impl<M: Motion> Robot<M> {
    /// By how much two points of it may come nearer between a time and the next step.
    fn between(&self) -> Real {
        let fastest = (0..self.sections).map(|section| {
            let Speed { point, turn } = self.motion.speed(section, [0.0, 1.0], [0.0, 1.0]);
            point + self.radius * turn
        });
        fastest.fold(0.0, Real::max) / STEPS as Real
    }

    /// Asks about margins, and holds each answer against all steps.
    fn check(&self, pair: &mut RobotPair, margins: &[Real], counts: &mut Counts) {
        verify_motion(&self.motion, 30).unwrap();
        let mut tube = Tube::from(&Chain::capsules(&[Vector::ZERO, Vector::X], &[1.0]).unwrap());
        let mut steps = |margin: Real| {
            let mut decisions = [0_usize; 3];
            for step in 0..=STEPS {
                self.motion.shape(step as Real / STEPS as Real, &mut tube).unwrap();
                decisions[pair.tube_self_clears(&tube, margin, 0.1 * RESOLUTION).unwrap() as usize] += 1;
            }
            decisions
        };
        let mut all = Vec::new();
        for &margin in margins {
            let [_, contacts, _] = steps(margin);
            let [clear, ..] = steps(margin + self.between() + 2.0 * RESOLUTION);
            let [_, near, unknown] = steps(margin + RESOLUTION);
            all.push((margin, contacts, clear, near + unknown));
        }
        for (margin, contacts, clear, near) in all {
            let found = pair.motion_self_clears(&self.motion, margin, RESOLUTION).unwrap();
            counts.decisions[found.decision as usize] += 1;
            let says = || format!("margin {margin}: {contacts} steps in contact, {clear} clear; {found:?}");
            if contacts > 0 {
                counts.contact_steps += 1;
                assert_ne!(found.decision, Decision::Clear, "{}", says());
            }
            if clear == STEPS + 1 {
                counts.clear_steps += 1;
                assert_eq!(found.decision, Decision::Clear, "{}", says());
            }
            if found.decision == Decision::Undecided {
                assert!(near > 0 || clear <= STEPS, "{}", says());
            }
            if let Some(contact) = found.contact {
                let pose = self.motion.shape(contact.t, &mut tube).unwrap();
                let decision =
                    pair.tube_self_clears(&tube, contact.upper * (1.0 + 1e-9) + 1e-12, 1e-6).unwrap();
                assert_ne!(decision, Decision::Clear, "{}", says());
                assert!(contact.upper <= margin && contact.sections[0] <= contact.sections[1], "{}", says());
                // Both points are on the robot where it is then.
                assert!(
                    (contact.on_first - contact.on_second).length() <= contact.upper + 1e-9,
                    "{}",
                    says()
                );
                for point in [contact.on_first, contact.on_second] {
                    let dot =
                        Tube::from(&Chain::capsules(&[point, point + Vector::X * 1e-6], &[0.0]).unwrap());
                    let away = pair.clearance(&tube, &pose, &dot, &Pose::IDENTITY, 1e-4).unwrap();
                    assert!(away.lower <= 1e-5, "{away:?} {}", says());
                }
            }
        }
    }
}

/// A robot of sections that curl up, or do not quite.
fn curling(random: &mut Random) -> Robot<BendingMotion> {
    let sections = 1 + random.below(3) as usize;
    let turn = random.between(1.0, 8.0) / sections as Real;
    let (mut from, mut to) = (Vec::new(), Vec::new());
    let mut radius = random.between(0.3, 2.0);
    let widest = radius;
    for _ in 0..sections {
        let length = random.between(10.0, 30.0);
        let at = |share: Real, angle: Real| {
            let curvature = share * turn / length;
            BendingSection { length, radius, bend: [curvature * angle.cos(), curvature * angle.sin()] }
        };
        let angle = random.between(-0.6, 0.6);
        from.push(at(random.between(0.0, 0.5), angle));
        to.push(at(random.between(0.7, 1.0), angle + random.between(-0.3, 0.3)));
        radius *= [1.0, 0.5][random.below(2) as usize];
    }
    Robot {
        motion: BendingMotion::new(&from, &to, Pose::translation(3.0, 2.0, 1.0)).unwrap(),
        sections,
        radius: widest,
    }
}

/// A hairpin of links, the tip of which swings past the base, or into its face.
fn hairpin(random: &mut Random) -> Robot<LinearMotion> {
    let (gap, length) = (random.between(4.0, 9.0), random.between(15.0, 30.0));
    let low = [random.between(-6.0, 3.0), random.between(3.0, 10.0)][random.below(2) as usize];
    let aside = [0.0, random.between(-0.5, 0.5) * gap, -gap][random.below(3) as usize];
    let points = |y: Real, aside: Real| {
        [
            Vector::ZERO,
            Vector::Z * length,
            Vector::new(0.5 * gap, 0.0, length + 0.5 * gap),
            Vector::new(gap, 0.0, length),
            Vector::new(gap + aside, y, low),
        ]
    };
    let swing = random.between(1.0, 12.0);
    let radii = [[1.0; 4], [1.0, 0.5, 0.5, 0.5], [0.5, 0.5, 0.5, 1.0]][random.below(3) as usize];
    let (from, to) = (points(-swing, aside), points(swing * random.between(0.0, 1.0), aside));
    let motion = if random.below(2) == 0 {
        LinearMotion::chain(&from, &to, &radii)
    } else {
        LinearMotion::capsules(&from, &to, &radii)
    };
    Robot { motion: motion.unwrap(), sections: 4, radius: 1.0 }
}

/// A thick tube with a thin one in it, that comes out and curls round towards the wide face.
fn stepped(random: &mut Random) -> Robot<BendingMotion> {
    let turn = random.between(1.5, 6.0);
    let length = [random.between(8.0, 14.0), random.between(14.0, 25.0)];
    let at = |share: Real, grown: Real| {
        let bend = [share * turn / (length[1] * grown), 0.0];
        [
            BendingSection { length: length[0], radius: 3.0, bend: [0.0; 2] },
            BendingSection { length: length[1] * grown, radius: 0.4, bend },
        ]
    };
    let grown = random.between(0.5, 1.0);
    Robot {
        motion: BendingMotion::new(&at(0.1, grown), &at(1.0, 1.0), Pose::IDENTITY).unwrap(),
        sections: 2,
        radius: 3.0,
    }
}

/// A coil that is carried about as it is, and turned by much.
fn carried(random: &mut Random) -> Robot<RigidMotion> {
    let rise = random.between(0.5, 1.5);
    let coil = |k: u32| {
        let angle = TAU * Real::from(k) / 16.0;
        Vector::new(6.0 * angle.cos(), 6.0 * angle.sin(), rise * angle)
    };
    let points: Vec<_> = (0..=40).map(coil).collect();
    let tube = Tube::from(&Chain::from_centreline(&points, &[0.5; 40]).unwrap());
    let turn = Rotation::from_axis_angle(random.direction(), random.between(0.0, 2.0));
    let poses = [Pose::translation(9.0, 0.0, 5.0), Pose::from_parts(random.point() * 20.0, turn)];
    Robot { motion: RigidMotion::new(tube, poses).unwrap(), sections: 40, radius: 0.5 }
}

#[test]
fn a_robot_keeps_clear_of_itself_where_its_steps_do() {
    let (mut random, mut pair) = (Random::new(71), RobotPair::new());
    let mut counts = [Counts::default(); 4];
    for _ in 0..25 {
        let margins = [0.0, random.between(0.05, 1.0), random.between(1.0, 3.0)];
        curling(&mut random).check(&mut pair, &margins, &mut counts[0]);
        hairpin(&mut random).check(&mut pair, &margins, &mut counts[1]);
        stepped(&mut random).check(&mut pair, &margins, &mut counts[2]);
        carried(&mut random).check(&mut pair, &margins, &mut counts[3]);
    }
    println!("{counts:?}");
    for kind in counts {
        assert!(kind.decisions[0] >= 15 && kind.decisions[1] >= 5, "{counts:?}");
        assert!(kind.clear_steps >= 10 && kind.contact_steps >= 5, "{counts:?}");
    }
}
