//! A planner's own shapes, linear between them, against the curved robot that they were taken from.

use super::{Steps, anatomy, arcs, random_edge};
use continuum_demo::joint_motion::JointMotion;
use continuum_demo::{ctr, ventricle};
use continuum_testing::{Random, rounds};
use parry_continuum::parry::math::{Real, Vector};
use parry_continuum::proximity::{BvhSearch, Decision, MotionAnswer, ProximityError};
use parry_continuum::{Chain, RobotError};

/// Links per section.
const LINKS: u32 = 8;

/// The centreline at even shares of each section, in the mesh's frame.
fn points(motion: &JointMotion, t: Real, links: u32) -> Vec<Vector> {
    let (arcs, base) = (arcs(motion, t), ventricle::entry());
    let mut points = vec![base * arcs.at(0.0).0];
    let mut start = 0.0;
    for section in motion.sections(t) {
        let place = |k: u32| start + section.length * Real::from(k) / Real::from(links);
        points.extend((1..=links).map(|k| base * arcs.at(place(k)).0));
        start += section.length;
    }
    points
}

/// How far the curved robot leaves its shapes at most, place by place, and a little more for what
/// is between the samples.
fn deviation(motion: &JointMotion, steps: u32) -> Real {
    let (fine, moments) = (4, 12);
    let mut most: Real = 0.0;
    for step in 0..steps {
        let time =
            |k: u32| (Real::from(step) + Real::from(k) / Real::from(moments)) / Real::from(steps);
        let [from, to] = [0, moments].map(|k| points(motion, time(k), LINKS));
        for k in 0..=moments {
            let share = Real::from(k) / Real::from(moments);
            let line: Vec<_> = from.iter().zip(&to).map(|(a, b)| a + (b - a) * share).collect();
            for (k, point) in points(motion, time(k), LINKS * fine).into_iter().enumerate() {
                let (link, along) =
                    (k / fine as usize, (k % fine as usize) as Real / Real::from(fine));
                let next = line[(link + 1).min(line.len() - 1)];
                most = most.max((line[link] + (next - line[link]) * along - point).length());
            }
        }
    }
    1.1 * most
}

#[test]
fn no_path_is_misjudged() {
    let (mut search, robot, mut random) = (anatomy(), ctr::three_tubes(), Random::new(31));
    let (mut clear, mut contact, mut undecided) = (0, 0, 0);
    for round in 0..rounds(60) {
        let motion = random_edge(&robot, &mut random, [1.0, 3.0, 8.0][round % 3]);
        let steps = 1 + random.below(6);
        let radii: Vec<_> = motion
            .sections(0.0)
            .iter()
            .flat_map(|section| std::iter::repeat_n(section.radius, LINKS as usize))
            .collect();
        // Caps do not matter.
        let chain = [Chain::capsules, Chain::from_centreline, Chain::cylinders][round % 3];
        let shapes: Vec<_> = (0..=steps)
            .map(|k| {
                chain(&points(&motion, Real::from(k) / Real::from(steps), LINKS), &radii).unwrap()
            })
            .collect();
        let deviation = deviation(&motion, steps);
        let truth =
            Steps::new(&mut search, 150, 1e-4, |t| (motion.tube(t).unwrap(), ventricle::entry()));
        let [lower, upper] = truth.least();
        for margin in
            [0.0, 0.5, (lower - 2.5 * deviation).max(0.0), upper + 0.01, upper + 2.5 * deviation]
        {
            let answer = search.clears_path(&shapes, deviation, margin, 1e-3).unwrap();
            match (answer.decision, answer.contact) {
                (Decision::Clear, _) => {
                    clear += 1;
                    assert!(
                        upper > margin,
                        "clear, but a step comes as near as {upper}, margin {margin}"
                    );
                }
                (Decision::Contact, Some(shape)) => {
                    contact += 1;
                    let tube = motion.tube(shape.t).unwrap();
                    let at = search.clearance(&tube, &ventricle::entry(), 1e-6).unwrap();
                    assert!(
                        at.lower <= margin,
                        "contact at {}, but {at:?}, margin {margin}",
                        shape.t
                    );
                }
                (Decision::Undecided, _) => undecided += 1,
                (Decision::Contact, None) => panic!("{answer:?}"),
            }
        }
    }
    println!("{clear} {contact} {undecided}");
    assert!(
        clear > rounds(15) && contact > rounds(60) && undecided < rounds(100),
        "{clear} {contact} {undecided}"
    );
}

/// A wall across z.
fn wall(z: Real) -> BvhSearch {
    let corners = [[-30.0, -30.0], [30.0, -30.0], [0.0, 50.0]].map(|[x, y]| Vector::new(x, y, z));
    BvhSearch::from_triangles(&corners, &[[0, 1, 2]]).unwrap()
}

/// A face may stand any way: it is in the ball around its centre, and holds that. On the side of
/// the tube only the deviation counts.
#[test]
fn faces_of_unknown_direction_are_bounded_by_ball_and_centre() {
    let needle = |tip: Real| {
        Chain::from_centreline(&[Vector::ZERO, Vector::Z * 5.0, Vector::Z * tip], &[1.0; 2])
    };
    let shapes = [10.0, 11.0, 12.0].map(|tip| needle(tip).unwrap());
    let (deviation, resolution) = (0.1, 1e-3);
    let mut ahead = wall(20.0);
    let mut decide = |margin| ahead.clears_path(&shapes, deviation, margin, resolution).unwrap();
    // The centre of the face ends 8 before the wall, and reaches a radius farther if it is turned.
    assert_eq!(decide(8.0 - 1.0 - 0.1 - 0.002).decision, Decision::Clear);
    assert_eq!(decide(8.0 - 1.0 - 0.1 + 0.002).decision, Decision::Undecided);
    assert_eq!(decide(8.1 - 0.002).decision, Decision::Undecided);
    let contact: MotionAnswer = decide(8.1 + 0.5);
    assert!(contact.contact.is_some_and(|shape| shape.t >= 0.75), "{contact:?}");

    // Beside the wall.
    let beside = |y: Real| {
        let line = [0.0, 5.0, 10.0].map(|z| Vector::new(z, y, 0.0));
        Chain::from_centreline(&line, &[1.0; 2]).unwrap()
    };
    let lowered = [3.0, 2.0].map(beside);
    let corners = [[-30.0, -30.0], [30.0, -30.0], [0.0, 50.0]].map(|[x, z]| Vector::new(x, 0.0, z));
    let mut floor = BvhSearch::from_triangles(&corners, &[[0, 1, 2]]).unwrap();
    let mut decide =
        |margin| floor.clears_path(&lowered, deviation, margin, resolution).unwrap().decision;
    assert_eq!(decide(1.0 - 0.1 - 0.002), Decision::Clear);
    assert_eq!(decide(1.0 - 0.1 + 0.002), Decision::Undecided);
    assert_eq!(decide(1.0 + 0.1 - 0.002), Decision::Undecided);
    assert_eq!(decide(1.0 + 0.1 + 0.4), Decision::Contact);
}

/// A shape alone is a path, and shapes between which the robot jumps through a wall are not clear.
#[test]
fn shapes_on_both_sides_of_a_wall_are_no_clear_path() {
    let needle =
        |z: Real| Chain::capsules(&[Vector::Z * z, Vector::new(5.0, 0.0, z)], &[0.5]).unwrap();
    let mut search = wall(0.0);
    let one = search.clears_path(&[needle(3.0)], 0.1, 1.0, 1e-3).unwrap();
    assert!(one.is_clear(), "{one:?}");
    let through =
        search.clears_path(&[needle(3.0), needle(-3.0), needle(-4.0)], 0.1, 0.0, 1e-3).unwrap();
    assert!(through.contact.is_some_and(|shape| (0.1..0.4).contains(&shape.t)), "{through:?}");
}

#[test]
fn paths_that_are_none_are_refused() {
    let mut search = wall(0.0);
    let chain = |radius: Real| Chain::capsules(&[Vector::Z, Vector::Z * 2.0], &[radius]).unwrap();
    let refused = |search: &mut BvhSearch, shapes: &[Chain], deviation: Real| {
        search.clears_path(shapes, deviation, 0.0, 1e-3).unwrap_err()
    };
    let none = refused(&mut search, &[], 0.0);
    assert_eq!(none, ProximityError::Motion(RobotError::NoMotions { parameter: "shapes" }));
    let differ = refused(&mut search, &[chain(0.1), chain(0.1), chain(0.2)], 0.0);
    assert_eq!(differ, ProximityError::Motion(RobotError::ShapesDiffer { index: 2 }));
    // Segments without length in other places: between the two, links would stand for other
    // stretches.
    let turning = |points: [[Real; 2]; 4]| {
        Chain::capsules(&points.map(|[y, z]| Vector::new(0.0, y, z)), &[0.5; 3]).unwrap()
    };
    let first = turning([[0.0, 0.0], [0.0, 0.0], [20.0, 0.0], [40.0, 0.0]]);
    let second = turning([[0.0, 20.0], [20.0, 20.0], [20.0, 20.0], [40.0, 20.0]]);
    let differ = refused(&mut search, &[first, second], 0.0);
    assert_eq!(differ, ProximityError::Motion(RobotError::ShapesDiffer { index: 1 }));
    for deviation in [-1.0, Real::NAN] {
        let refused = refused(&mut search, &[chain(0.1)], deviation);
        assert!(
            matches!(refused, ProximityError::Negative { parameter: "deviation", .. }),
            "{refused}"
        );
    }
    let infinite = refused(&mut search, &[chain(0.1)], Real::INFINITY);
    assert!(matches!(infinite, ProximityError::Motion(RobotError::Negative { .. })), "{infinite}");
}

/// A path of many legs is fast, and its times are rounded all the same.
#[test]
fn one_shape_of_ten_thousand_is_not_missed_by_rounding() {
    let link =
        |x: Real| Chain::capsules(&[Vector::X * x, Vector::new(x, 0.0, 1.0)], &[0.25]).unwrap();
    let corners = [[-30.0, -30.0], [30.0, -30.0], [0.0, 50.0]].map(|[y, z]| Vector::new(2.0, y, z));
    let mut search = BvhSearch::from_triangles(&corners, &[[0, 1, 2]]).unwrap();
    for near in [5005, 8049] {
        let shapes: Vec<_> =
            (0..=10_000).map(|k| link(if k == near { 1.0 } else { 0.0 })).collect();
        // The robot comes as near as 0.75.
        for margin in [0.75, 0.75 + 1e-13] {
            let found = search.clears_path(&shapes, 0.0, margin, 1e-3).unwrap();
            assert!(!found.is_clear(), "{near} {margin}: {found:?}");
        }
        assert!(search.clears_path(&shapes, 0.0, 0.745, 1e-3).unwrap().is_clear());
    }
}
