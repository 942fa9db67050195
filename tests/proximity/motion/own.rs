//! Motions of one robot beside itself: against each of many steps, and against what may be between
//! these.

use super::speeds::Understated;
use continuum_testing::narrow_phase::disc_disc;
use continuum_testing::{Random, rounds};
use parry_continuum::distance::Vec3;
use parry_continuum::parry::math::{Pose, Real, Rotation, Vector};
use parry_continuum::proximity::{Decision, RobotPair, SelfQuery};
use parry_continuum::{
    BendingMotion, BendingSection, Chain, ConstantCurvature, LinearMotion, Motion, RigidMotion,
    RobotError, Speed, Tube, verify_motion,
};
use std::f64::consts::{PI, TAU};

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

/// A motion of a robot with this many sections, with at most this radius.
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
    fn check(&self, query: &mut SelfQuery, margins: &[Real], counts: &mut Counts) {
        verify_motion(&self.motion, 30).unwrap();
        let mut tube = Tube::from(&Chain::capsules(&[Vector::ZERO, Vector::X], &[1.0]).unwrap());
        let mut steps = |margin: Real| {
            let mut decisions = [0_usize; 3];
            for step in 0..=STEPS {
                self.motion.shape(step as Real / STEPS as Real, &mut tube).unwrap();
                decisions[query.clears_tube(&tube, margin, 0.1 * RESOLUTION).unwrap() as usize] +=
                    1;
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
            let found = query.clears_motion(&self.motion, margin, RESOLUTION).unwrap();
            counts.decisions[found.decision as usize] += 1;
            let says = || {
                format!("margin {margin}: {contacts} steps in contact, {clear} clear; {found:?}")
            };
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
                    query.clears_tube(&tube, contact.upper * (1.0 + 1e-9) + 1e-12, 1e-6).unwrap();
                assert_ne!(decision, Decision::Clear, "{}", says());
                assert!(
                    contact.upper <= margin && contact.sections[0] <= contact.sections[1],
                    "{}",
                    says()
                );
                // Both points are on the robot where it is then.
                assert!(
                    (contact.witness.on_first - contact.witness.on_second).length()
                        <= contact.upper + 1e-9,
                    "{}",
                    says()
                );
                for point in [contact.witness.on_first, contact.witness.on_second] {
                    let dot = Tube::from(
                        &Chain::capsules(&[point, point + Vector::X * 1e-6], &[0.0]).unwrap(),
                    );
                    let away = RobotPair::new()
                        .clearance(&tube, &pose, &dot, &Pose::IDENTITY, 1e-4)
                        .unwrap();
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
            BendingSection {
                length,
                radius,
                bend: [curvature * angle.cos(), curvature * angle.sin()],
            }
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

/// A hairpin of links whose tip swings past the base, or into its face.
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
    let (mut random, mut query) = (Random::new(71), SelfQuery::new());
    let mut counts = [Counts::default(); 4];
    for _ in 0..rounds(25) {
        let margins = [0.0, random.between(0.05, 1.0), random.between(1.0, 3.0)];
        curling(&mut random).check(&mut query, &margins, &mut counts[0]);
        hairpin(&mut random).check(&mut query, &margins, &mut counts[1]);
        stepped(&mut random).check(&mut query, &margins, &mut counts[2]);
        // Up to where parts are near that turn by less than pi.
        let margins = margins.map(|margin| 4.0 * margin);
        carried(&mut random).check(&mut query, &margins, &mut counts[3]);
    }
    for kind in counts {
        assert!(kind.decisions[0] >= rounds(15) && kind.clear_steps >= rounds(10), "{counts:?}");
    }
    let sum = |of: fn(&Counts) -> usize| counts.iter().map(of).sum::<usize>();
    let contacts = [sum(|kind| kind.decisions[1]), sum(|kind| kind.contact_steps)];
    assert!(contacts.iter().all(|&count| count >= rounds(40)), "{counts:?}");
}

/// A robot that is straight, except for a moment in which it curls up.
struct Flick {
    length: Real,
    radius: Real,
    /// By how much it turns then.
    turn: Real,
    at: Real,
    /// For how long before and after that it bends at all.
    lasts: Real,
}

impl Flick {
    /// How near its discs come that turn by pi between them.
    fn apart(&self) -> Real {
        let disc = |k: u32| {
            let angle = self.turn * Real::from(k) / 200.0;
            let bend = self.length / self.turn;
            let centre = Vec3::from([bend * (1.0 - angle.cos()), 0.0, bend * angle.sin()]);
            (angle, centre, Vec3::from([angle.sin(), 0.0, angle.cos()]))
        };
        let discs: Vec<_> = (0..=200).map(disc).collect();
        let mut apart = Real::INFINITY;
        for (first, from, normal) in &discs {
            for (second, to, direction) in &discs {
                if second - first >= PI {
                    let found =
                        disc_disc(*from, *normal, self.radius, *to, *direction, self.radius);
                    apart = apart.min(found.distance);
                }
            }
        }
        apart
    }
}

impl Motion for Flick {
    fn shape(&self, t: Real, tube: &mut Tube) -> Result<Pose, RobotError> {
        let share = (1.0 - (t - self.at).abs() / self.lasts).max(0.0);
        let bend = [share * self.turn / self.length, 0.0];
        let section = BendingSection { length: self.length, radius: self.radius, bend };
        *tube = ConstantCurvature::new(&[section])?.tube()?;
        Ok(Pose::IDENTITY)
    }

    fn speed(&self, _: usize, shares: [Real; 2], times: [Real; 2]) -> Speed {
        let rate = if times[1] < self.at - self.lasts || times[0] > self.at + self.lasts {
            0.0
        } else {
            self.turn / self.length / self.lasts
        };
        let arc = self.length * shares[1];
        Speed { point: 0.5 * rate * arc * arc, turn: rate * arc }
    }
}

#[test]
fn a_flick_between_two_steps_is_seen() {
    let mut query = SelfQuery::new();
    for (radius, lasts) in [(0.0, 0.01), (0.5, 0.01), (1.0, 0.2)] {
        let flick = Flick { length: 40.0, radius, turn: 5.5, at: 0.7, lasts };
        verify_motion(&flick, 1000).unwrap();
        let apart = flick.apart();
        let found = query.clears_motion(&flick, apart + 0.5, 1e-2).unwrap();
        let contact = found.contact.unwrap();
        assert!((contact.t - 0.7).abs() < lasts, "{found:?}");
        assert!(query.clears_motion(&flick, apart - 0.1, 1e-2).unwrap().is_clear());
        // `verify_motion` detects a speed that is too low; the query trusts the speed.
        let slow = Understated(&flick, 1e-6);
        assert!(verify_motion(&slow, 1000).is_err());
        assert!(query.clears_motion(&slow, apart - 0.1, 1e-2).unwrap().is_clear());
    }
}

/// A robot whose tip passes its base, carried along by a part that grows a thousand times as fast
/// as it is thick.
fn passing(gap: Real) -> LinearMotion {
    let at = |z: Real| {
        let tip = [Vector::new(10.0, 0.0, z), Vector::new(0.5 + gap, 0.0, z)];
        let way = [
            [0.0, -3.0, 0.0],
            [0.0, 3.0, 0.0],
            [10.0, 3.0, 0.0],
            [10.0, 3.0, -1000.0],
            [10.0, 0.0, -1000.0],
        ];
        way.map(Vector::from_array).into_iter().chain(tip).collect::<Vec<_>>()
    };
    LinearMotion::chain(&at(-700.0), &at(300.0), &[0.5; 6]).unwrap()
}

#[test]
fn a_pass_between_two_steps_is_seen() {
    let mut query = SelfQuery::new();
    // The other parts that are near one another keep 2.
    for gap in [0.25, 1.5] {
        // The tip is flat, and the base's side is round.
        let motion = passing(gap);
        let contact = query.clears_motion(&motion, gap + 0.05, 1e-3).unwrap().contact.unwrap();
        assert!((contact.t - 0.7).abs() < 2e-3 && contact.sections == [0, 5], "{contact:?}");
        assert!(query.clears_motion(&motion, gap - 2e-3, 1e-3).unwrap().is_clear());
        let slow = Understated(&motion, 1e-6);
        assert!(query.clears_motion(&slow, 0.9 * gap, 1e-3).unwrap().is_clear());
    }
}

#[test]
fn what_turns_by_nearly_half_a_turn_is_not_asked_about_for_moving() {
    // A thick arc with near parts that turn by about three quarters of half a turn. Points move by
    // less than the resolution, so one shape would be enough if they did not turn.
    let at = |turn: Real| [BendingSection { length: turn / 0.9, radius: 1.0, bend: [0.9, 0.0] }];
    let motion = BendingMotion::new(&at(2.2), &at(2.6), Pose::IDENTITY).unwrap();
    let mut query = SelfQuery::new();
    assert!(query.clears_motion(&motion, 0.1, 10.0).unwrap().is_clear());
    // What turns by far more comes as near as that.
    let motion = BendingMotion::new(&at(2.6), &at(5.8), Pose::IDENTITY).unwrap();
    assert!(query.clears_motion(&motion, 0.1, 1e-3).unwrap().contact.is_some());
    // With a margin wider than the bend, the queried pairs are unknown, and the query ends early.
    let motion = BendingMotion::new(&at(2.9), &at(3.1), Pose::IDENTITY).unwrap();
    let found = query.clears_motion(&motion, 0.5, 1e-3).unwrap();
    assert!(found.decision == Decision::Undecided && found.reason.is_some(), "{found:?}");
}

#[test]
fn what_may_come_to_be_asked_about_is_no_contact() {
    // Links with 170 degrees between them, 4 apart, that are carried about and turned: they never
    // count.
    let directions = [0.0, 85.0_f64, 170.0].map(|angle| {
        let (sin, cos) = angle.to_radians().sin_cos();
        Vector::new(sin, 0.0, cos)
    });
    let mut points = vec![Vector::ZERO];
    for (direction, length) in directions.into_iter().zip([30.0, 5.0, 30.0]) {
        points.push(points[points.len() - 1] + direction * length);
    }
    let tube = Tube::from(&Chain::from_centreline(&points, &[0.5; 3]).unwrap());
    let mut query = SelfQuery::new();
    for turn in [0.0, 0.2, 1.0] {
        let turned = Pose::from_parts(Vector::Y * 9.0, Rotation::from_axis_angle(Vector::X, turn));
        let motion = RigidMotion::new(tube.clone(), [Pose::IDENTITY, turned]).unwrap();
        assert!(query.clears_motion(&motion, 4.5, 1e-3).unwrap().is_clear(), "{turn}");
    }
}

/// Links of length 1 that turn by this much at each joint.
fn arc(turn: Real, count: usize) -> Vec<Vector> {
    let mut points = vec![Vector::ZERO];
    for k in 0..count {
        let (sin, cos) = (turn * k as Real).sin_cos();
        points.push(points[k] + Vector::new(sin, 0.0, cos));
    }
    points
}

/// A taper, ribs, or rounding on a constant radius: the robot is thinner or as thick beyond most
/// joints, and overlaps its neighbours.
#[test]
fn steps_in_radius_do_not_meet_their_own_neighbourhood_while_they_bend() {
    let (mut random, mut query, mut overlapping) = (Random::new(72), SelfQuery::new(), 0);
    for round in 0..60 {
        let count = 4 + random.below(6) as usize;
        let turns = [0.0, random.between(0.1, 1.2)].map(|turn| turn / count as Real);
        let radius = random.between(0.2, 0.7) * 0.5 / (0.5 * turns[1]).tan();
        let thinner = [1e-12, 0.01, 0.1][random.below(3) as usize];
        let is_ribbed = round % 3 == 0;
        let of_link = |k: usize| if is_ribbed { (k % 2) as Real } else { k as Real };
        let radii: Vec<_> =
            (0..count).map(|k| radius * (1.0 - thinner * of_link(k) / count as Real)).collect();
        let [from, to] = turns.map(|turn| arc(turn, count));
        let motion = if is_ribbed || round % 2 == 0 {
            LinearMotion::capsules(&from, &to, &radii)
        } else {
            LinearMotion::chain(&from, &to, &radii)
        };
        let found = query.clears_motion(&motion.unwrap(), 0.0, 1e-3).unwrap();
        assert!(found.is_clear(), "{round}: {turns:?} {radii:?} {found:?}");
        overlapping += usize::from(radius > 1.0);
    }
    assert!(overlapping > 10, "{overlapping}");
}

/// A hairpin at rest, that states any speed, and has any joints.
struct Any {
    speed: Speed,
    joint: Vector,
    count: usize,
}

impl Motion for Any {
    fn shape(&self, t: Real, tube: &mut Tube) -> Result<Pose, RobotError> {
        let ends =
            [Vector::new(5.0, 0.0, 30.0), Vector::new(5.0, 0.0, 0.0), Vector::new(5.0, 0.0, -9.0)];
        let count = if t > 0.6 { self.count } else { 1 };
        let points: Vec<_> = [Vector::ZERO, self.joint]
            .into_iter()
            .chain(ends.into_iter().take(count + 1))
            .collect();
        tube.set_chain(&Chain::from_centreline(&points, &vec![0.5; points.len() - 1])?);
        Ok(Pose::translation(0.0, 5.0, 0.0))
    }

    fn speed(&self, _: usize, _: [Real; 2], _: [Real; 2]) -> Speed {
        self.speed
    }
}

/// The turn of a link that loses its length is infinite: no mistake of the caller, but too fast.
#[test]
fn a_link_that_passes_through_length_0_turns_too_fast() {
    let from = [0.0, 10.0, 12.0, 20.0].map(|z| Vector::Z * z);
    let to = [0.0, 12.0, 10.0, 20.0].map(|z| Vector::Z * z);
    let radii = [1.0, 0.5, 0.25];
    for motion in
        [LinearMotion::chain(&from, &to, &radii), LinearMotion::capsules(&from, &to, &radii)]
    {
        let error = SelfQuery::new().clears_motion(&motion.unwrap(), 0.1, 1e-3).unwrap_err();
        assert_eq!(error.kind(), "turns_too_fast", "{error}");
    }
}

#[test]
fn what_is_wrong_is_told() {
    let mut query = SelfQuery::new();
    let any = |point: Real, turn: Real| {
        let speed = Speed { point, turn };
        Any { speed, joint: Vector::Z * 30.0, count: 1 }
    };
    assert!(query.clears_motion(&any(0.0, 0.0), 1.0, 1e-3).unwrap().is_clear());
    let mut kind = |motion: &Any, margin, resolution| {
        query.clears_motion(motion, margin, resolution).unwrap_err().kind().to_owned()
    };
    for wrong in [Real::NAN, Real::INFINITY, -1.0] {
        assert_eq!(kind(&any(wrong, 0.0), 1.0, 1e-3), "bad_speed");
    }
    for wrong in [Real::NAN, -1.0] {
        assert_eq!(kind(&any(0.0, wrong), 1.0, 1e-3), "bad_speed");
    }
    for fast in [1e6, Real::INFINITY] {
        assert_eq!(kind(&any(0.0, fast), 1.0, 1e-3), "turns_too_fast");
    }
    assert_eq!(kind(&any(1e12, 0.0), 3.9, 1e-9), "too_fast");
    assert_eq!(kind(&any(0.0, 0.0), -1.0, 1e-3), "negative");
    assert_eq!(kind(&any(0.0, 0.0), 1.0, Real::NAN), "negative");
    assert_eq!(kind(&any(0.0, 0.0), 1.0, 0.0), "tolerance_too_fine");
    assert_eq!(kind(&Any { count: 2, ..any(0.0, 9.0) }, 1.0, 1e-3), "sections_change");
    assert_eq!(
        kind(&Any { joint: Vector::new(5.0, 0.0, 29.8), ..any(0.0, 0.0) }, 1.0, 1e-3),
        "joint_too_sharp"
    );
}
