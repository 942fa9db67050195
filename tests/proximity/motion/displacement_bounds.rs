//! Motions with displacement bounds: fewer shapes are tested, no answer changes, and wrong bounds
//! are detected.

use super::{anatomy, polyline, random_edge};
use continuum_demo::{ctr, ventricle};
use continuum_testing::{Random, rounds};
use parry_continuum::parry::math::{Pose, Real, Vector};
use parry_continuum::proximity::{BvhSearch, Decision, Proximity};
use parry_continuum::{
    BendingMotion, Chain, DisplacementBound, LinearMotion, Motion, RigidMotion, RobotError, Speed,
    Tube, verify_motion,
};
use std::cell::Cell;

type State<'a> = &'a dyn Fn(DisplacementBound, [Real; 2], [Real; 2]) -> Option<DisplacementBound>;

/// A motion that states another course, between shares and between times.
struct Guided<'a> {
    motion: &'a dyn Motion,
    state: State<'a>,
    shapes: Cell<usize>,
}

fn guided<'a>(motion: &'a dyn Motion, state: State<'a>) -> Guided<'a> {
    Guided { motion, state, shapes: Cell::new(0) }
}

impl Motion for Guided<'_> {
    fn shape(&self, t: Real, tube: &mut Tube) -> Result<Pose, RobotError> {
        self.shapes.set(self.shapes.get() + 1);
        self.motion.shape(t, tube)
    }

    fn speed(&self, section: usize, shares: [Real; 2], times: [Real; 2]) -> Speed {
        self.motion.speed(section, shares, times)
    }

    fn displacement(
        &self,
        section: usize,
        shares: [Real; 2],
        times: [Real; 2],
    ) -> Option<DisplacementBound> {
        (self.state)(self.motion.displacement(section, shares, times)?, shares, times)
    }
}

/// A capsule that sets out slowly and goes on at a constant acceleration.
struct Accelerating(Real);

impl Motion for Accelerating {
    fn shape(&self, t: Real, tube: &mut Tube) -> Result<Pose, RobotError> {
        tube.set_chain(&Chain::capsules(&[Vector::ZERO, Vector::Z], &[0.1])?);
        Ok(Pose::from_translation(Vector::X * (0.5 * self.0 * t * t)))
    }

    fn speed(&self, _section: usize, _shares: [Real; 2], times: [Real; 2]) -> Speed {
        Speed { point: self.0 * times[1] * (1.0 + 1e-12), turn: 0.0 }
    }

    fn displacement(
        &self,
        _section: usize,
        _shares: [Real; 2],
        [from, to]: [Real; 2],
    ) -> Option<DisplacementBound> {
        let way = Vector::X * (0.5 * self.0 * (to * to - from * from));
        Some(DisplacementBound {
            ways: [way; 2],
            off: 0.125 * self.0 * (to - from) * (to - from) + 1e-12,
        })
    }
}

fn is_found(motion: &impl Motion, steps: u32) -> bool {
    match verify_motion(motion, steps) {
        Ok(()) => false,
        Err(RobotError::FartherOffThanStated { t, share, found, stated, .. }) => {
            assert!((0.0..=1.0).contains(&t) && (0.0..=1.0).contains(&share) && stated < found);
            true
        }
        Err(other) => panic!("{other:?}"),
    }
}

/// Narrower than they are, or elsewhere, of motions of every kind.
#[test]
fn courses_that_are_too_narrow_or_lead_elsewhere_are_found() {
    let (robot, mut random) = (ctr::three_tubes(), Random::new(8));
    let mut found = [0; 4];
    for _ in 0..rounds(40) {
        let joints = random_edge(&robot, &mut random, 5.0);
        let poses = [random.pose(5.0), random.pose(5.0)];
        let rigid = RigidMotion::new(joints.tube(0.0).unwrap(), poses).unwrap();
        let (from, radii) = polyline(&mut random, Vector::ZERO);
        let to: Vec<_> = from.iter().map(|&point| point + random.point()).collect();
        let linear = LinearMotion::chain(&from, &to, &radii).unwrap();
        let narrow = |factor: Real| {
            move |course: DisplacementBound, _: [Real; 2], _: [Real; 2]| {
                Some(DisplacementBound { off: course.off * factor, ..course })
            }
        };
        let aside = random.direction();
        let elsewhere = |far: Real| {
            move |course: DisplacementBound, _: [Real; 2], times: [Real; 2]| {
                let aside = aside * (far * (times[1] - times[0]));
                Some(DisplacementBound { ways: course.ways.map(|way| way + aside), ..course })
            }
        };
        found[0] += usize::from(is_found(&guided(&rigid, &narrow(0.3)), 32));
        found[1] += usize::from(is_found(&guided(&joints, &narrow(0.1)), 32));
        found[2] += usize::from(is_found(&guided(&linear, &elsewhere(1e-9)), 32));
        found[3] += usize::from(is_found(&guided(&joints, &elsewhere(2.0)), 1024));
        for motion in [&joints as &dyn Motion, &rigid, &linear] {
            verify_motion(&guided(motion, &|course, _, _| Some(course)), 32).unwrap();
        }
    }
    assert!(found.iter().all(|found| *found > rounds(30)), "{found:?}");
}

/// What shows only in the middle of a time, only between shapes far apart, only at one place or
/// only along a section.
#[test]
fn each_way_to_be_off_a_course_is_found() {
    let motion = Accelerating(8.0);
    verify_motion(&motion, 64).unwrap();
    // Both ends of the time are where they should be.
    assert!(is_found(
        &guided(&motion, &|course, _, _| Some(DisplacementBound {
            off: 0.9 * course.off,
            ..course
        })),
        64
    ));
    let long = |course: DisplacementBound, _: [Real; 2], times: [Real; 2]| {
        let off = if times[1] - times[0] > 0.3 { 0.0 } else { course.off };
        Some(DisplacementBound { off, ..course })
    };
    assert!(is_found(&guided(&motion, &long), 64));
    let straight = |shares: [Real; 2], is_point: bool| (shares[0] == shares[1]) == is_point;
    let (robot, mut random) = (ctr::three_tubes(), Random::new(9));
    let joints = random_edge(&robot, &mut random, 10.0);
    for is_point in [false, true] {
        let narrow = |course: DisplacementBound, shares: [Real; 2], _: [Real; 2]| {
            Some(DisplacementBound {
                off: if straight(shares, is_point) { 0.0 } else { course.off },
                ..course
            })
        };
        assert!(is_found(&guided(&joints, &narrow), 64), "{is_point}");
    }
}

/// Motions of a planner, with their courses and without: the same decisions, by fewer shapes.
#[test]
fn courses_spare_shapes_and_change_no_decision() {
    let (mut search, robot, mut random) = (anatomy(), ctr::three_tubes(), Random::new(17));
    let (mut shapes, mut clear, mut differ) = ([[0; 2]; 2], 0, 0);
    for round in 0..rounds(120) {
        let joints = random_edge(&robot, &mut random, [2.0, 5.0, 10.0][round % 3]);
        let bent =
            BendingMotion::new(&joints.sections(0.0), &joints.sections(1.0), ventricle::entry())
                .unwrap();
        let margin = [0.0, random.unit()][round % 2];
        let motions: [&dyn Motion; 2] = [&joints, &bent];
        for (kind, motion) in motions.into_iter().enumerate() {
            let with = guided(motion, &|course, _, _| Some(course));
            let without = guided(motion, &|_, _, _| None);
            let decisions = [&with, &without]
                .map(|motion| search.clears_motion(motion, margin, 1e-3).unwrap().decision);
            differ += usize::from(decisions[0] != decisions[1]);
            if decisions == [Decision::Clear; 2] {
                clear += 1;
                shapes[kind][0] += with.shapes.get();
                shapes[kind][1] += without.shapes.get();
            }
        }
    }
    assert!(clear > rounds(24) && differ == 0, "{clear} {differ}");
    assert!(shapes.iter().all(|[with, without]| 10 * with < 6 * without), "{shapes:?}");
}

/// A floor of two triangles at the height 0.
fn floor() -> BvhSearch {
    let corners = [[-50.0, -50.0], [50.0, -50.0], [50.0, 50.0], [-50.0, 50.0]];
    let vertices = corners.map(|[x, y]| Vector::new(x, y, 0.0));
    BvhSearch::from_triangles(&vertices, &[[0, 1, 2], [0, 2, 3]]).unwrap()
}

/// A thin disc turns about its own middle, whose place hardly changes; its rim comes down. In the
/// middle of the time it is level.
#[test]
fn a_disc_that_turns_about_its_middle_is_not_taken_for_one_at_rest() {
    const RADIUS: Real = 5.0;
    const HALF: Real = 0.05;
    const MARGIN: Real = 0.5;
    let (mut search, mut random) = (floor(), Random::new(21));
    let tube =
        Tube::from(&Chain::cylinders(&[Vector::Z * -HALF, Vector::Z * HALF], &[RADIUS]).unwrap());
    let mut seen = [0; 2];
    for _ in 0..200 {
        let (angle, height) = (random.between(0.1, 0.7), random.between(1.0, 4.5));
        let lowest = height - RADIUS * angle.sin() - HALF * angle.cos() - MARGIN;
        if lowest.abs() < 0.01 {
            continue;
        }
        let axis = Vector::new(random.unit(), random.unit(), 0.0).normalize();
        let poses = [-angle, angle].map(|angle| Pose::new(Vector::Z * height, axis * angle));
        let motion = RigidMotion::new(tube.clone(), poses).unwrap();
        let expected = if lowest > 0.0 { Decision::Clear } else { Decision::Contact };
        assert_eq!(
            search.clears_motion(&motion, MARGIN, 1e-3).unwrap().decision,
            expected,
            "{angle} {height}"
        );
        seen[usize::from(lowest > 0.0)] += 1;
    }
    assert!(seen.iter().all(|seen| *seen > 40), "{seen:?}");
}

/// What moves goes along the floor, and the floor comes up; or it goes up with it and stays away.
#[test]
fn a_wall_that_comes_nearer_counts_beside_the_course() {
    let (mut search, mut random) = (floor(), Random::new(22));
    let mut seen = [0; 2];
    for _ in 0..200 {
        let (rise, lift) =
            (random.between(0.0, 4.0), [0.0, random.between(0.0, 3.0)][random.below(2) as usize]);
        // At first the centreline is at 2, and at last it is at 2 + lift - rise above the floor.
        let least = 1.0 + (lift - rise).min(0.0);
        if least.abs() < 0.01 {
            continue;
        }
        let points = [Vector::Z * 2.0, Vector::new(3.0, 0.0, 2.0)];
        let goes = points.map(|point| point + Vector::X * 6.0 + Vector::Z * lift);
        let motion = LinearMotion::capsules(&points, &goes, &[1.0]).unwrap();
        let to: Vec<_> = search.vertices().iter().map(|vertex| vertex + Vector::Z * rise).collect();
        let expected = if least > 0.0 { Decision::Clear } else { Decision::Contact };
        let answer = search.clears_motion_while(&to, &motion, 0.0, 1e-3).unwrap();
        assert_eq!(answer.decision, expected, "{rise} {lift}");
        seen[usize::from(least > 0.0)] += 1;
    }
    assert!(seen.iter().all(|seen| *seen > 20), "{seen:?}");
}

/// A capsule at rest until half of its time, which then moves down evenly by `way`, plus a bulge of
/// depth `bulge`.
#[derive(Debug)]
struct Bulging {
    way: Real,
    bulge: Real,
}

impl Motion for Bulging {
    fn shape(&self, t: Real, tube: &mut Tube) -> Result<Pose, RobotError> {
        tube.set_chain(&Chain::capsules(&[Vector::ZERO, Vector::X], &[1.0])?);
        let q = (2.0 * t - 1.0).max(0.0);
        Ok(Pose::from_translation(Vector::Z * -(self.way * q + 4.0 * self.bulge * q * (1.0 - q))))
    }

    fn speed(&self, _section: usize, _shares: [Real; 2], times: [Real; 2]) -> Speed {
        let fastest = 2.0 * (self.way + 4.0 * self.bulge);
        Speed { point: if times[1] > 0.5 { fastest } else { 0.0 }, turn: 0.0 }
    }

    fn displacement(
        &self,
        _section: usize,
        _shares: [Real; 2],
        times: [Real; 2],
    ) -> Option<DisplacementBound> {
        if times[0] < 0.5 && times[1] > 0.5 {
            return None;
        }
        let [from, to] = times.map(|t| {
            let q = (2.0 * t - 1.0).max(0.0);
            Vector::Z * -(self.way * q + 4.0 * self.bulge * q * (1.0 - q))
        });
        let apart = if times[0] < 0.5 { 0.0 } else { 2.0 * (times[1] - times[0]) };
        Some(DisplacementBound { ways: [to - from; 2], off: self.bulge * apart * apart + 1e-12 })
    }
}

/// Off its way, a capsule touches the floor, between shapes that are both clear of it; the floor is
/// the nearest wall, or a ceiling is, from which the capsule goes away.
#[test]
fn what_may_be_off_a_course_counts() {
    let mut random = Random::new(23);
    let mut seen = [[0; 2]; 2];
    for _ in 0..400 {
        let has_ceiling = random.below(2) == 1;
        let bulge = random.between(0.1, 3.0);
        let motion = Bulging { way: if has_ceiling { bulge } else { 0.0 }, bulge };
        verify_motion(&motion, 16).unwrap();
        // Of q + 4 q (1 - q) at q = 5/8, and of 4 q (1 - q) at 1/2.
        let deepest = bulge * if has_ceiling { 1.5625 } else { 1.0 };
        let gap = deepest * random.between(0.8, 1.2);
        if (gap - deepest).abs() < 0.005 {
            continue;
        }
        let ceiling = if has_ceiling { 1.0 + random.between(1.05, 1.2) * bulge } else { 100.0 };
        let square = |z: Real| {
            [[-50.0, -50.0], [50.0, -50.0], [50.0, 50.0], [-50.0, 50.0]]
                .map(|[x, y]| Vector::new(x, y, z))
        };
        let vertices = [square(-1.0 - gap), square(ceiling)].concat();
        let triangles = [[0, 1, 2], [0, 2, 3], [4, 5, 6], [4, 6, 7]];
        let mut search = BvhSearch::from_triangles(&vertices, &triangles).unwrap();
        let is_clear = gap > deepest;
        let expected = if is_clear { Decision::Clear } else { Decision::Contact };
        let answer = search.clears_motion(&motion, 0.0, 1e-3).unwrap();
        assert_eq!(answer.decision, expected, "{motion:?} {gap} {ceiling}");
        seen[usize::from(has_ceiling)][usize::from(is_clear)] += 1;
    }
    assert!(seen.as_flattened().iter().all(|seen| *seen > 40), "{seen:?}");
}

/// A course that is none does not count: the robot goes into the floor all the same.
#[test]
fn a_course_that_is_none_counts_as_none() {
    let mut search = floor();
    let points = [Vector::Z * 4.0, Vector::new(3.0, 0.0, 4.0)];
    let [down, along] = [Vector::Z * -3.5, Vector::X * 6.0].map(|way| {
        LinearMotion::capsules(&points, &points.map(|point| point + way), &[1.0]).unwrap()
    });
    for off in [-100.0, Real::NAN, Real::INFINITY, Real::NEG_INFINITY] {
        let state = |course: DisplacementBound, _: [Real; 2], _: [Real; 2]| {
            Some(DisplacementBound { off, ..course })
        };
        let mut decide = |motion: &LinearMotion| {
            search.clears_motion(&guided(motion, &state), 0.0, 1e-3).unwrap().decision
        };
        assert_eq!((decide(&down), decide(&along)), (Decision::Contact, Decision::Clear), "{off}");
    }
    for way in [Vector::splat(Real::NAN), Vector::X * Real::INFINITY, Vector::Z * Real::INFINITY] {
        let state = |course: DisplacementBound, _: [Real; 2], _: [Real; 2]| {
            Some(DisplacementBound { ways: [course.ways[0], way], ..course })
        };
        let mut decide = |motion: &LinearMotion| {
            search.clears_motion(&guided(motion, &state), 0.0, 1e-3).unwrap().decision
        };
        assert_eq!((decide(&down), decide(&along)), (Decision::Contact, Decision::Clear), "{way}");
    }
}
