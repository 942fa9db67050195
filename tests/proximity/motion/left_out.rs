//! Each term of a motion, omitted from the stated bound or stated too low, is detected with any
//! number of steps. Motions with correct bounds are never refused.

use super::speeds::Understated;
use continuum_testing::{Random, rounds};
use parry_continuum::parry::math::{Pose, Real, Vector};
use parry_continuum::{
    BendingMotion, BendingSection, DisplacementBound, LinearMotion, Motion, RigidMotion,
    RobotError, Speed, Tube, verify_motion,
};

/// How a tube is given.
#[derive(Clone, Copy, Debug)]
enum Given {
    /// By this many samples.
    Samples(usize),
    /// By samples, and off by this much.
    Rough(usize, Real),
}

/// An arc that does one thing at a time, each at a steady rate.
#[derive(Clone, Copy, Debug)]
struct Arc {
    given: Given,
    curvature: Real,
    length: Real,
    /// Added to the curvature during the motion, to the length, to the place, to the angle about
    /// an axis.
    bending: Real,
    growth: Real,
    shift: Vector,
    turn: Vector,
    /// The stated bound: all terms, or some of them scaled.
    stated: [Real; 4],
    turn_stated: Real,
}

const STILL: Arc = Arc {
    given: Given::Samples(40),
    curvature: 0.05,
    length: 30.0,
    bending: 0.0,
    growth: 0.0,
    shift: Vector::ZERO,
    turn: Vector::ZERO,
    stated: [1.0; 4],
    turn_stated: 1.0,
};

impl Motion for Arc {
    fn shape(&self, t: Real, tube: &mut Tube) -> Result<Pose, RobotError> {
        let (curvature, length) =
            (self.curvature + self.bending * t, self.length + self.growth * t);
        let (count, error) = match self.given {
            Given::Samples(count) => (count, 0.0),
            Given::Rough(count, error) => (count, error),
        };
        let point = |k: usize| {
            let s = length * k as Real / (count - 1) as Real;
            let (sin, cos) = (0.5 * curvature * s).sin_cos();
            // In the limit of no curvature a straight line.
            if curvature == 0.0 {
                Vector::Z * s
            } else {
                Vector::new(sin, 0.0, cos) * (2.0 * sin / curvature)
            }
        };
        let points: Vec<_> = (0..count).map(point).collect();
        tube.set_samples(&points, &vec![0.5; count - 1], None)?;
        *tube = std::mem::replace(tube, Tube::from_samples(&points[..2], &[0.5], None)?)
            .with_error(error)?;
        Ok(Pose::new(self.shift * t, self.turn * t))
    }

    fn speed(&self, _section: usize, shares: [Real; 2], _times: [Real; 2]) -> Speed {
        let s = (self.length + self.growth.max(0.0)) * shares[1];
        let [bending, growth, shift, turn] = self.stated;
        let turning = self.turn.length() * turn;
        let bent = self.curvature.abs() + self.bending.abs();
        let point = 0.5 * self.bending.abs() * s * s * bending
            + self.growth.abs() * shares[1] * growth
            + self.shift.length() * shift
            + turning * s;
        let angle = self.bending.abs() * s * bending
            + bent * self.growth.abs() * shares[1] * growth
            + turning;
        Speed { point: point * (1.0 + 1e-12), turn: angle * self.turn_stated * (1.0 + 1e-12) }
    }
}

/// Each kind of motion alone, of such a size that the tip moves by about 5.
fn each_alone() -> [Arc; 4] {
    [
        Arc { bending: 0.01, ..STILL },
        Arc { growth: 5.0, ..STILL },
        Arc { shift: Vector::new(3.0, 4.0, 0.0), ..STILL },
        Arc { turn: Vector::Y * 0.2, ..STILL },
    ]
}

fn step_counts() -> [u32; 5] {
    [1, 10, 100, rounds(1000), rounds(3000)]
}

#[test]
fn each_term_alone_is_missed() {
    for (term, motion) in each_alone().into_iter().enumerate() {
        for given in
            [Given::Samples(10), Given::Samples(40), Given::Rough(40, 0.1), Given::Rough(10, 0.5)]
        {
            for steps in step_counts() {
                let mut motion = Arc { given, ..motion };
                assert_eq!(verify_motion(&motion, steps), Ok(()), "{motion:?}, {steps}");
                motion.stated[term] = 0.0;
                assert!(verify_motion(&motion, steps).is_err(), "left out: {motion:?}, {steps}");
                // A tenth too slow makes 0.3 to 0.5 of a difference, in places whose error is none
                // at samples.
                motion.stated[term] = 1.0 / 1.1;
                let refused = verify_motion(&motion, steps).is_err();
                assert!(
                    refused || matches!(given, Given::Rough(..)),
                    "too low: {motion:?}, {steps}"
                );
            }
        }
    }
}

/// Not the points, but the directions move more than stated.
#[test]
fn turns_alone_are_missed() {
    for motion in [Arc { bending: 0.01, ..STILL }, Arc { turn: Vector::X * 0.2, ..STILL }] {
        for (count, share) in [(10, 0.0), (40, 0.0), (10, 1.0 / 1.1), (40, 1.0 / 1.1)] {
            for steps in step_counts() {
                let motion = Arc { given: Given::Samples(count), turn_stated: share, ..motion };
                let refused = verify_motion(&motion, steps);
                assert!(
                    matches!(refused, Err(RobotError::TurnsFasterThanStated { .. })),
                    "{refused:?}: {motion:?}, {steps}"
                );
            }
        }
    }
}

/// A robot that moves there and back is where it was; only the times between show the motion.
#[test]
fn a_way_there_and_back_is_missed() {
    struct ThereAndBack(Real);
    impl Motion for ThereAndBack {
        fn shape(&self, t: Real, tube: &mut Tube) -> Result<Pose, RobotError> {
            STILL.shape(0.0, tube)?;
            Ok(Pose::from_translation(Vector::Y * (5.0 * (std::f64::consts::PI * t).sin())))
        }
        fn speed(&self, _: usize, _: [Real; 2], _: [Real; 2]) -> Speed {
            Speed { point: 5.0 * std::f64::consts::PI * self.0, turn: 0.0 }
        }
    }
    for steps in [10, 100, 1000] {
        assert_eq!(verify_motion(&ThereAndBack(1.0), steps), Ok(()));
        for share in [0.0, 0.5] {
            assert!(verify_motion(&ThereAndBack(share), steps).is_err(), "{share}, {steps}");
        }
    }
}

/// A needle that turns about its base, and states of a range of shares what holds of a part of it
/// only.
struct Turning<F> {
    /// From a range of shares to the share whose speed is stated.
    stated: F,
    is_course: bool,
}

const TURN: Real = 1.0;

impl<F: Fn([Real; 2]) -> Real> Turning<F> {
    fn point(share: Real, t: Real) -> Vector {
        let (sin, cos) = (TURN * t).sin_cos();
        Vector::new(sin, 0.0, cos) * (30.0 * share)
    }
}

impl<F: Fn([Real; 2]) -> Real> Motion for Turning<F> {
    fn shape(&self, t: Real, tube: &mut Tube) -> Result<Pose, RobotError> {
        let points: Vec<_> = (0..=10).map(|k| Self::point(Real::from(k) / 10.0, t)).collect();
        tube.set_samples(&points, &[0.5; 10], None)?;
        Ok(Pose::IDENTITY)
    }

    fn speed(&self, _: usize, shares: [Real; 2], _: [Real; 2]) -> Speed {
        let share = if self.is_course { shares[1] } else { (self.stated)(shares) };
        Speed { point: 30.0 * TURN * share, turn: TURN }
    }

    fn displacement(
        &self,
        _: usize,
        shares: [Real; 2],
        times: [Real; 2],
    ) -> Option<DisplacementBound> {
        if !self.is_course {
            return None;
        }
        let [here, there] = times.map(|t| shares.map(|share| Self::point(share, t)));
        let turn = TURN * (times[1] - times[0]);
        // The acceleration is TURN^2 30 share.
        let off = 0.125 * 30.0 * (self.stated)(shares) * turn * turn * (1.0 + 1e-9) + 1e-12;
        Some(DisplacementBound { ways: [there[0] - here[0], there[1] - here[1]], off })
    }
}

/// The share whose speed is stated for a range.
type Stated = fn([Real; 2]) -> Real;

/// A stated bound must hold for the whole range. A bound from one end, from the middle or from the
/// length is too low for one place, for the whole section, or for none.
#[test]
fn a_bound_for_a_part_of_a_range_is_missed() {
    let understated: [(&str, Stated); 6] = [
        ("the nearer end", |shares| shares[0]),
        ("the middle", |shares| 0.5 * (shares[0] + shares[1])),
        ("the length", |shares| shares[1] - shares[0]),
        (
            "the nearer end, but for the whole",
            |shares| if shares == [0.0, 1.0] { 1.0 } else { shares[0] },
        ),
        ("the nearer end, of short ranges", |shares| {
            if shares[1] - shares[0] < 0.2 { shares[0] } else { shares[1] }
        }),
        ("the middle, of ranges off the grid", |shares| {
            let is_on_grid = |share: Real| (8.0 * share).fract() == 0.0;
            if shares.into_iter().any(is_on_grid) {
                shares[1]
            } else {
                0.5 * (shares[0] + shares[1])
            }
        }),
    ];
    for is_course in [false, true] {
        for steps in step_counts() {
            let right = Turning { stated: |shares: [Real; 2]| shares[1], is_course };
            assert_eq!(verify_motion(&right, steps), Ok(()), "{is_course} {steps}");
            for (name, stated) in understated {
                // A single step has no shape at its middle, where a course would be left, and draws
                // one range only.
                if steps == 1 && (is_course || name.ends_with("grid")) {
                    continue;
                }
                let found = verify_motion(&Turning { stated, is_course }, steps);
                let is_found = match found {
                    Err(RobotError::FasterThanStated { .. }) => !is_course,
                    Err(RobotError::FartherOffThanStated { .. }) => is_course,
                    _ => false,
                };
                assert!(is_found, "{name}, {steps} steps, {is_course}: {found:?}");
            }
        }
    }
}

/// Rounding and the uncertainty of samples never refuse a motion with correct bounds.
#[test]
fn honest_motions_pass() {
    let (mut random, mut rigid_ones, mut found) = (Random::new(12), 0, 0);
    for round in 0..rounds(150) {
        let size = [1e-6, 1.0, 1e6][round % 3];
        let far = [0.0, 1e7][random.below(2) as usize] * size;
        // Three show the bend of an arc.
        let count = 3 + random.below(20) as usize;
        let given = match random.below(3) {
            0 => Given::Rough(count, random.unit() * size),
            _ => Given::Samples(count),
        };
        let motion = Arc {
            given,
            curvature: random.between(-0.03, 0.03) / size,
            length: random.between(1.0, 30.0) * size,
            bending: [0.0, random.between(-0.03, 0.03)][random.below(2) as usize] / size,
            growth: [0.0, random.unit()][random.below(2) as usize] * 10.0 * size,
            shift: random.point() * ([0.0, 1.0, 1e-9][random.below(3) as usize] * size),
            turn: random.direction() * [0.0, 1.0, 1e-9][random.below(3) as usize],
            ..STILL
        };
        let steps = [1, 7, 64, 300][random.below(4) as usize];
        match motion
            .shape(0.0, &mut Tube::from_samples(&[Vector::ZERO, Vector::Z], &[0.1], None).unwrap())
        {
            Ok(_) => {}
            // Too few samples for its bend.
            Err(_) => continue,
        }
        // In one plane, so that bends and turns sum to at most the stated bound.
        let checked = verify_motion(&motion, steps);
        assert!(
            matches!(
                checked,
                Ok(())
                    | Err(RobotError::TurnsTooSharply { .. } | RobotError::BendsWithinRadius { .. })
            ),
            "{checked:?}: {motion:?}, {steps}"
        );
        let radii = [0.3 * size; 3];
        let mut points = |spread: Real| -> Vec<_> {
            (0..4)
                .map(|k| random.point() * spread + Vector::Z * (k as Real * size) + Vector::X * far)
                .collect()
        };
        let (from, to) = (points(size), points(size));
        verify_motion(&LinearMotion::chain(&from, &to, &radii).unwrap(), steps).unwrap();
        verify_motion(&LinearMotion::capsules(&from, &to, &radii).unwrap(), steps).unwrap();
        // A chain that does not turn.
        let shift = random.point() * size;
        let moved: Vec<_> = from.iter().map(|&point| point + shift).collect();
        verify_motion(&LinearMotion::chain(&from, &moved, &radii).unwrap(), steps).unwrap();
        let mut bent = || -> Vec<_> {
            (0..3)
                .map(|_| BendingSection {
                    length: random.between(0.1, 3.0) * size,
                    radius: 0.3 * size,
                    bend: [0, 1].map(|_| random.between(-0.5, 0.5) / size),
                })
                .collect()
        };
        let (from, to) = (bent(), bent());
        let place = |random: &mut Random| {
            Pose::from_parts(random.point() * (size + far), random.pose(0.0).rotation)
        };
        verify_motion(&BendingMotion::new(&from, &to, place(&mut random)).unwrap(), steps).unwrap();
        let mut tube = Tube::from_samples(&[Vector::ZERO, Vector::Z], &[0.1], None).unwrap();
        if motion.shape(0.5, &mut tube).is_ok() {
            let rigid = RigidMotion::new(tube, [place(&mut random), place(&mut random)]).unwrap();
            verify_motion(&rigid, steps).unwrap();
            // The bound adds up the shift and the turn, which may cancel.
            rigid_ones += 1;
            found += u32::from(verify_motion(&Understated(&rigid, 0.3), steps).is_err());
        }
    }
    assert!(rigid_ones > rounds(50) && found > rigid_ones / 2, "{found} of {rigid_ones}");
}
