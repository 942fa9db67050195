//! Two motions at once against the truth: both robots in steps so fine that nothing fits between.

use super::speeds::Understated;
use super::{polyline, random_edge};
use continuum_demo::{ctr, ventricle};
use continuum_testing::{Random, rounds};
use parry_continuum::parry::math::{Pose, Real, Rotation, Vector};
use parry_continuum::proximity::{Decision, ProximityError, RobotMotionAnswer, RobotPair};
use parry_continuum::{
    BendingMotion, Chain, LinearMotion, Motion, MotionPath, MovingBase, RigidMotion, RobotError,
    Speed, Tube, verify_motion,
};

const STEPS: usize = 300;
const RESOLUTION: Real = 1e-3;

/// Any motion of a robot with this many sections, each with the largest radius.
struct Any {
    shape: Box<ShapeOf>,
    speed: Box<SpeedOf>,
    legs: usize,
    sections: usize,
    radius: Real,
}

type ShapeOf = dyn Fn(Real, &mut Tube) -> Result<Pose, RobotError>;

type SpeedOf = dyn Fn(usize, [Real; 2], [Real; 2]) -> Speed;

impl Any {
    fn new<M: Motion + Clone + 'static>(motion: M, sections: usize, radius: Real) -> Self {
        let (legs, fast) = (motion.time_parts(), motion.clone());
        let speed = move |section, shares, times| fast.speed(section, shares, times);
        Self {
            shape: Box::new(move |t, tube| motion.shape(t, tube)),
            speed: Box::new(speed),
            legs,
            sections,
            radius,
        }
    }

    /// How fast any of its points moves at most.
    fn fastest(&self, times: [Real; 2]) -> Real {
        let speeds = (0..self.sections).map(|section| {
            let Speed { point, turn } = self.speed(section, [0.0, 1.0], times);
            point + self.radius * turn
        });
        speeds.fold(0.0, Real::max)
    }
}

impl Motion for Any {
    fn shape(&self, t: Real, tube: &mut Tube) -> Result<Pose, RobotError> {
        (self.shape)(t, tube)
    }

    fn speed(&self, section: usize, shares: [Real; 2], times: [Real; 2]) -> Speed {
        (self.speed)(section, shares, times)
    }

    fn time_parts(&self) -> usize {
        self.legs
    }
}

/// A tube to be filled.
fn blank() -> Tube {
    Tube::from(&Chain::capsules(&[Vector::ZERO, Vector::X], &[1.0]).unwrap())
}

/// How near two motions come, and no nearer: the least of the steps, and what may be between them.
fn truth(pair: &mut RobotPair, motions: [&Any; 2]) -> [Real; 2] {
    let (mut shapes, mut bounds) = ([blank(), blank()], [Real::INFINITY; 2]);
    for step in 0..=STEPS {
        let t = step as Real / STEPS as Real;
        let times =
            [t - 0.5 / STEPS as Real, t + 0.5 / STEPS as Real].map(|t: Real| t.clamp(0.0, 1.0));
        let [first, second] = &mut shapes;
        let poses = [motions[0].shape(t, first).unwrap(), motions[1].shape(t, second).unwrap()];
        let found = pair.clearance(first, &poses[0], second, &poses[1], 1e-4).unwrap();
        let between = 0.5 / STEPS as Real * (motions[0].fastest(times) + motions[1].fastest(times));
        bounds = [bounds[0].min(found.lower - between), bounds[1].min(found.upper)];
    }
    bounds
}

/// Two robots that pass one another somehow, and what they are.
fn motions(random: &mut Random, kind: u32) -> [Any; 2] {
    let robot = ctr::three_tubes();
    match kind {
        // Two bending robots that enter side by side, or from opposite sides.
        0 | 1 => {
            let bending = |random: &mut Random| {
                let joints = random_edge(&robot, random, 8.0);
                let (from, to) = (joints.sections(0.0), joints.sections(1.0));
                let radius = from.iter().fold(0.0, |most: Real, section| most.max(section.radius));
                (BendingMotion::new(&from, &to, ventricle::entry()).unwrap(), from.len(), radius)
            };
            let [(first, count, radius), (second, count_of_second, radius_of_second)] =
                [bending(random), bending(random)];
            let entry = ventricle::entry();
            let across = entry.rotation * random.direction().cross(Vector::Z).normalize();
            let beside = if kind == 0 {
                Pose::from_translation(across * random.between(1.0, 8.0))
            } else {
                let far =
                    entry.translation + entry.rotation * Vector::Z * random.between(20.0, 60.0);
                let turn = Rotation::from_axis_angle(across, std::f64::consts::PI);
                Pose::from_parts(
                    far + across * random.between(0.0, 4.0) - turn * entry.translation,
                    turn,
                )
            };
            let moved = Pose::from_translation(across * random.between(-3.0, 3.0)) * beside;
            let second = MovingBase::new(second, [beside, moved]).unwrap();
            [Any::new(first, count, radius), Any::new(second, count_of_second, radius_of_second)]
        }
        // Chains with steps and short links; one chain may be at rest.
        2 => [0, 1].map(|k| {
            let base = random.point() * 3.0;
            let (from, radii) = polyline(random, base);
            let moves = if k == 0 && random.below(3) == 0 { 0.0 } else { 3.0 };
            let to: Vec<_> = from.iter().map(|&point| point + random.point() * moves).collect();
            let largest = radii.iter().copied().fold(0.0, Real::max);
            Any::new(LinearMotion::chain(&from, &to, &radii).unwrap(), radii.len(), largest)
        }),
        // The same chain twice, parallel or coaxial; one passes along the other.
        3 => {
            let (points, radii) = ([Vector::ZERO, Vector::Z * 4.0, Vector::Z * 6.0], [1.0, 0.5]);
            let chain = Chain::from_centreline(&points, &radii).unwrap();
            let off = [Vector::ZERO, Vector::X * 2.0, Vector::X * 3.5][random.below(3) as usize];
            let ends = [
                off - Vector::Z * random.between(2.0, 15.0),
                off + Vector::Z * random.between(7.0, 15.0),
            ];
            let ends =
                if random.below(2) == 0 { ends } else { [ends[0], ends[0] + Vector::Y * 0.5] };
            let turn = if random.below(2) == 0 {
                Rotation::IDENTITY
            } else {
                Rotation::from_axis_angle(Vector::X, std::f64::consts::PI)
            };
            let tube = Tube::from(&chain);
            let poses = ends.map(|end| Pose::from_parts(end, turn));
            [
                Any::new(RigidMotion::new(tube.clone(), [Pose::IDENTITY; 2]).unwrap(), 2, 1.0),
                Any::new(RigidMotion::new(tube, poses).unwrap(), 2, 1.0),
            ]
        }
        // A fast needle crosses the other one, or just misses it, on its second leg.
        _ => {
            let needle =
                |ends: [Vector; 2]| move |to: [Vector; 2]| LinearMotion::chain(&ends, &to, &[0.5]);
            let standing = [Vector::ZERO, Vector::Z * 20.0];
            let high = [5.0, 19.0, 20.9, 21.2][random.below(4) as usize];
            let at = |x: Real| [Vector::new(x, -9.0, high), Vector::new(x, 9.0, high)];
            let legs =
                [needle(at(-90.0))(at(-30.0)), needle(at(-30.0))(at(random.between(20.0, 300.0)))];
            let path = MotionPath::new(legs.map(Result::unwrap).to_vec()).unwrap();
            [Any::new(needle(standing)(standing).unwrap(), 1, 0.5), Any::new(path, 1, 0.5)]
        }
    }
}

/// Whether an answer is true, given what the clearance is at least and at most.
fn assert_true(
    pair: &mut RobotPair,
    motions: [&Any; 2],
    margin: Real,
    truth: [Real; 2],
    found: &RobotMotionAnswer,
) {
    match found.decision {
        Decision::Clear => assert!(margin < truth[1], "{margin} {truth:?}"),
        Decision::Contact => {
            assert!(margin >= truth[0], "{margin} {truth:?}");
            let contact = found.contact.unwrap();
            let mut shapes = [blank(), blank()];
            let [first, second] = &mut shapes;
            let poses = [
                motions[0].shape(contact.t, first).unwrap(),
                motions[1].shape(contact.t, second).unwrap(),
            ];
            let there = pair.clearance(first, &poses[0], second, &poses[1], 1e-6).unwrap();
            assert!(there.lower <= contact.upper && contact.upper <= margin);
            assert!(
                (contact.witness.on_first - contact.witness.on_second).length()
                    <= contact.upper + 1e-12
            );
            assert_eq!(found.interval, [0.0, contact.t]);
        }
        Decision::Undecided => {
            // Between steps the truth is not known that closely.
            let near = truth[0] - RESOLUTION..=truth[1] + RESOLUTION;
            assert!(near.contains(&margin), "{margin} {truth:?}");
        }
    }
}

#[test]
fn two_motions_are_clear_where_their_steps_are() {
    let (mut random, mut pair) = (Random::new(41), RobotPair::new());
    let mut counts = [[0_usize; 3]; 5];
    for round in 0..rounds(150) {
        let kind = round % 5;
        let [first, second] = motions(&mut random, kind);
        let both = [&first, &second];
        let truth = truth(&mut pair, both);
        let step = 0.05 * truth[1].max(0.1);
        let margins = [
            0.0,
            0.5 * truth[0].max(0.0),
            truth[0] - step,
            truth[1] - 0.5 * RESOLUTION,
            truth[1] + step,
        ];
        for margin in margins.into_iter().filter(|margin| *margin >= 0.0) {
            let found = pair.clears_motions(&first, &second, margin, RESOLUTION).unwrap();
            assert_true(&mut pair, both, margin, truth, &found);
            counts[kind as usize][found.decision as usize] += 1;
            // The order of the robots matters only for undecided answers.
            let other = pair.clears_motions(&second, &first, margin, RESOLUTION).unwrap();
            assert_true(&mut pair, [&second, &first], margin, truth, &other);
            if margin <= truth[0] - 2.0 * RESOLUTION {
                assert!(
                    found.is_clear() && other.is_clear(),
                    "{kind} {margin} {truth:?} {found:?}"
                );
            }
            if margin >= truth[1] + 2.0 * RESOLUTION {
                assert!(
                    found.contact.is_some() && other.contact.is_some(),
                    "{kind} {margin} {truth:?}"
                );
            }
        }
    }
    for decision in [0, 1] {
        let of_kinds = counts.map(|kind| kind[decision]);
        assert!(of_kinds.iter().sum::<usize>() >= rounds(150), "{counts:?}");
        // Of each kind where there are many rounds.
        assert!(of_kinds.iter().all(|&count| count >= rounds(20) / 10), "{counts:?}");
    }
}

#[test]
fn a_pass_between_two_steps_is_seen() {
    // Two needles cross at t = 0.7 alone, a thousand times as fast as they are thick: only the
    // speeds tell.
    let standing = [-Vector::Z * 20.0, Vector::Z * 20.0];
    let at_rest = LinearMotion::chain(&standing, &standing, &[0.5]).unwrap();
    let mut pair = RobotPair::new();
    for gap in [0.0, 0.25, 3.0] {
        let crossing = |x: Real| [Vector::new(x, 1.0 + gap, -3.0), Vector::new(x, 1.0 + gap, 3.0)];
        let fast = LinearMotion::chain(&crossing(-700.0), &crossing(300.0), &[0.5]).unwrap();
        // Both are round along the gap: the least distance is the gap.
        let found = pair.clears_motions(&at_rest, &fast, gap + 1e-3, 1e-4).unwrap();
        let contact = found.contact.unwrap();
        assert!((contact.t - 0.7).abs() < 1e-3 && contact.upper <= gap + 1e-3, "{found:?}");
        if gap > 0.0 {
            assert!(pair.clears_motions(&at_rest, &fast, gap - 1e-3, 1e-4).unwrap().is_clear());
        }
        // `verify_motion` detects a speed that is too low; the query trusts the speed.
        let slow = Understated(&fast, 1e-6);
        assert!(verify_motion(&slow, 100).is_err());
        assert!(pair.clears_motions(&at_rest, &slow, 0.9 * gap, 1e-4).unwrap().is_clear());
    }
}

#[test]
fn robots_of_many_links_may_be_fast() {
    // All links of one may meet all of the other in the first interval: 67,600 pairs, more than
    // are listed.
    let count = 260;
    let at = |y: Real, x: Real| -> Vec<_> {
        (0..=count).map(|k| Vector::new(x, y, Real::from(k) - 0.5 * Real::from(count))).collect()
    };
    let radii = vec![0.25; count as usize];
    let slow = LinearMotion::chain(&at(0.0, 0.0), &at(0.0, 0.0), &radii).unwrap();
    let fast = LinearMotion::chain(&at(1.0, -700.0), &at(1.0, 300.0), &radii).unwrap();
    let mut pair = RobotPair::new();
    assert!(pair.clears_motions(&slow, &fast, 0.4, 1e-3).unwrap().is_clear());
    let contact = pair.clears_motions(&slow, &fast, 0.6, 1e-3).unwrap().contact.unwrap();
    assert!((contact.t - 0.7).abs() < 1e-2, "{contact:?}");
    // A wrong speed is reported for any number of pairs.
    let wrong = |point: Real, turn: Real| Any {
        shape: Box::new({
            let fast = fast.clone();
            move |t, tube| fast.shape(t, tube)
        }),
        speed: Box::new(move |_, _, _| Speed { point, turn }),
        legs: 1,
        sections: 260,
        radius: 0.25,
    };
    for (motion, kind) in [
        (wrong(0.0, Real::NAN), "bad_speed"),
        (wrong(0.0, -1.0), "bad_speed"),
        (wrong(1e12, 0.0), "too_fast"),
    ] {
        assert_eq!(pair.clears_motions(&slow, &motion, 0.4, 1e-3).unwrap_err().kind(), kind);
    }
    // Robots that overlap all the time are found to do so at once.
    let short = |y: Real| -> Vec<_> {
        (0..=count).map(|k| Vector::new(0.0, y, 0.1 * Real::from(k))).collect()
    };
    let thick = vec![2.0; count as usize];
    let one = LinearMotion::capsules(&short(0.0), &short(0.5), &thick).unwrap();
    let other = LinearMotion::capsules(&short(2.0), &short(30.0), &thick).unwrap();
    assert_eq!(pair.clears_motions(&one, &one, 0.0, 1e-3).unwrap().contact.unwrap().t, 0.5);
    assert!(pair.clears_motions(&one, &other, 0.0, 1e-3).unwrap().contact.is_some());
}

#[test]
fn a_fast_link_far_from_many_slow_ones_is_seen() {
    // Two robots at rest beside one another, 67,600 pairs of links. One has a last link far away,
    // that swings to the other.
    let (count, radii) = (260, vec![0.1; 262]);
    let beside = |x: Real| (0..=count).map(move |k| Vector::new(x, 0.0, Real::from(k) / 1.3));
    let resting: Vec<_> = beside(0.0).collect();
    let slow = LinearMotion::chain(&resting, &resting, &radii[2..]).unwrap();
    let swinging = |y: Real| -> Vec<_> {
        beside(5.0).chain([Vector::new(105.0, 0.0, 200.0), Vector::new(0.0, y, 150.0)]).collect()
    };
    let fast = LinearMotion::chain(&swinging(700.0), &swinging(-300.0), &radii).unwrap();
    let mut pair = RobotPair::new();
    for swap in [false, true] {
        let found = if swap {
            pair.clears_motions(&fast, &slow, 0.1, 1e-3).unwrap()
        } else {
            pair.clears_motions(&slow, &fast, 0.1, 1e-3).unwrap()
        };
        let contact = found.contact.unwrap();
        assert!((contact.t - 0.7).abs() < 1e-2 && contact.sections.contains(&261), "{contact:?}");
    }
}

#[test]
fn a_disc_that_turns_about_its_centre_sweeps_its_rim() {
    // A thin disc of radius 10 turns by 2 rad: its centre stays, and its rim passes the needle
    // after a quarter of a turn alone, which no middle of a large interval shows.
    let disc = Chain::cylinders(&[Vector::ZERO, Vector::Z * 0.1], &[10.0]).unwrap();
    let over = Pose::from_parts(Vector::ZERO, Rotation::from_axis_angle(Vector::X, 2.0));
    let turning = RigidMotion::new(Tube::from(&disc), [Pose::IDENTITY, over]).unwrap();
    let needle = [Vector::Z * 11.0, Vector::Z * 30.0];
    let at_rest = LinearMotion::chain(&needle, &needle, &[0.2]).unwrap();
    let mut pair = RobotPair::new();
    for swap in [false, true] {
        let mut ask = |margin: Real| {
            if swap {
                pair.clears_motions(&at_rest, &turning, margin, 1e-3).unwrap()
            } else {
                pair.clears_motions(&turning, &at_rest, margin, 1e-3).unwrap()
            }
        };
        // The rim is at most hypot(10, 0.1) from the disc's first centre.
        assert!(ask(0.99).is_clear());
        let contact = ask(1.01).contact.unwrap();
        assert!((contact.t - 0.25 * std::f64::consts::PI).abs() < 0.05, "{contact:?}");
    }
}

#[test]
fn a_link_that_loses_its_length_is_no_fault() {
    // Its direction gets lost, so that it turns as fast as anything; its bodies are round.
    let (from, to) =
        ([Vector::ZERO, Vector::Z, Vector::Z * 3.0], [Vector::ZERO, Vector::Z, Vector::Z]);
    let radii = [0.5; 2];
    let fading =
        [LinearMotion::capsules(&from, &to, &radii), LinearMotion::chain(&from, &to, &radii)];
    let needle = [Vector::new(2.0, 0.0, -9.0), Vector::new(2.0, 0.0, 9.0)];
    let at_rest = LinearMotion::chain(&needle, &needle, &[0.5]).unwrap();
    let mut pair = RobotPair::new();
    for fading in fading.map(Result::unwrap) {
        assert!(pair.clears_motions(&fading, &at_rest, 0.99, 1e-3).unwrap().is_clear());
        assert!(pair.clears_motions(&at_rest, &fading, 1.01, 1e-3).unwrap().contact.is_some());
    }
}

#[test]
fn an_end_of_which_no_speed_is_stated_is_undecided() {
    // The first link's end is flat because the tip is near. The speed of that change is unknown,
    // so the end may become round, and come nearer to the needle than the tip.
    let shape = |_: Real, tube: &mut Tube| {
        tube.set_chain(&Chain::from_centreline(
            &[0.0, 5.0, 5.5].map(|z| Vector::Z * z),
            &[1.0, 1.0],
        )?);
        Ok(Pose::IDENTITY)
    };
    let needle = [-2.0, 2.0].map(|x| Vector::new(x, 0.0, 6.0));
    let at_rest = LinearMotion::chain(&needle, &needle, &[0.1]).unwrap();
    for speed in [Real::INFINITY, Real::NAN, -1.0] {
        let stated = move |section, shares: [Real; 2], _| {
            let point = if section == 1 && shares == [1.0, 1.0] { speed } else { 0.0 };
            Speed { point, turn: 0.0 }
        };
        let motion = Any {
            shape: Box::new(shape),
            speed: Box::new(stated),
            legs: 1,
            sections: 2,
            radius: 1.0,
        };
        let decide = |margin| {
            RobotPair::new().clears_motions(&motion, &at_rest, margin, 1e-3).unwrap().decision
        };
        assert_eq!(decide(0.2), Decision::Undecided);
        assert_eq!(decide(0.41), Decision::Contact);
    }
}

#[test]
fn what_is_wrong_names_the_motion() {
    let (mut pair, needle) = (RobotPair::new(), [Vector::ZERO, Vector::Z]);
    let at_rest = LinearMotion::chain(&needle, &needle, &[0.1]).unwrap();
    let broken = |speed: Real, far: Real, count: usize| {
        let shape = move |t: Real, tube: &mut Tube| {
            let points: Vec<_> =
                (0..=count + usize::from(t > 0.6)).map(|k| Vector::X * k as Real).collect();
            tube.set_samples(&points, &vec![0.1; points.len() - 1], None)?;
            Ok(Pose::translation(0.0, 5.0, far))
        };
        let speed = Box::new(move |_, _, _| Speed { point: speed, turn: 0.0 });
        Any { shape: Box::new(shape), speed, legs: 1, sections: 1, radius: 0.1 }
    };
    let good = broken(0.0, 0.0, 1);
    assert!(pair.clears_motions(&at_rest, &good, 1.0, 1e-3).unwrap().is_clear());
    for (motion, kind) in [
        (broken(Real::NAN, 0.0, 1), "bad_speed"),
        (broken(-1.0, 0.0, 1), "bad_speed"),
        (broken(Real::INFINITY, 0.0, 1), "bad_speed"),
        (broken(0.0, 1e300, 1), "tube_out_of_range"),
        (broken(0.0, Real::NAN, 1), "pose_not_finite"),
    ] {
        let first = pair.clears_motions(&motion, &at_rest, 0.1, 1e-3).unwrap_err();
        let second = pair.clears_motions(&at_rest, &motion, 0.1, 1e-3).unwrap_err();
        assert_eq!([first.kind(), second.kind()], [kind; 2]);
        assert!(
            first.to_string().starts_with("`a`: ") && second.to_string().starts_with("`b`: "),
            "{first}"
        );
    }
    let negative =
        |margin, resolution| pair.clone().clears_motions(&at_rest, &at_rest, margin, resolution);
    assert!(matches!(
        negative(-1.0, 1e-3),
        Err(ProximityError::Negative { parameter: "margin", .. })
    ));
    assert!(matches!(
        negative(1.0, Real::NAN),
        Err(ProximityError::Negative { parameter: "resolution", .. })
    ));
    assert!(matches!(
        negative(1.0, 0.0),
        Err(ProximityError::ToleranceTooFine { parameter: "resolution", .. })
    ));
    // A robot that moves so fast that time runs out of numbers.
    let fast = broken(1e12, 0.0, 1);
    assert!(matches!(
        pair.clears_motions(&at_rest, &fast, 4.0, 1e-9),
        Err(ProximityError::TooFast { section: 0, speed: 1e12, .. })
    ));
}
