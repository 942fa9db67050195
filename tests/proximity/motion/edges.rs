//! Edges of a planner, where each point moves on its own curve, against fine steps.

use super::{Steps, anatomy, arcs, random_edge};
use continuum_demo::joint_motion::JointMotion;
use continuum_demo::{ctr, ventricle};
use continuum_testing::{Random, rounds};
use parry_continuum::parry::math::{Pose, Real};
use parry_continuum::proximity::{BvhSearch, Decision, Proximity};
use parry_continuum::{Chain, Motion, RobotError, Speed, Tube};
use std::cell::Cell;

/// A motion that counts its shapes.
struct Counted<'a>(&'a JointMotion, Cell<u64>);

impl Motion for Counted<'_> {
    fn shape(&self, t: Real, tube: &mut Tube) -> Result<Pose, RobotError> {
        self.1.set(self.1.get() + 1);
        self.0.shape(t, tube)
    }

    fn speed(&self, section: usize, shares: [Real; 2], times: [Real; 2]) -> Speed {
        self.0.speed(section, shares, times)
    }
}

#[derive(Debug, Default)]
struct Seen {
    clear: usize,
    contact: usize,
    undecided: usize,
    both_ends_clear_but_contact: usize,
    shapes: u64,
}

const RESOLUTION: Real = 1e-3;

/// Compares an answer with the steps, which are `fine` apart at most.
fn judge(
    search: &mut BvhSearch,
    motion: &JointMotion,
    steps: &Steps,
    fine: Real,
    margin: Real,
    seen: &mut Seen,
) {
    let counted = Counted(motion, Cell::new(0));
    let answer = search.clears_motion(&counted, margin, RESOLUTION).unwrap();
    seen.shapes += counted.1.get();
    let [lower, upper] = steps.least();
    match (answer.decision, answer.contact) {
        (Decision::Clear, _) => {
            seen.clear += 1;
            assert!(
                upper > margin,
                "certified, but a step comes as near as {upper}, margin {margin}"
            );
        }
        (Decision::Contact, Some(shape)) => {
            let (t, upper, arc_length) = (shape.t, shape.upper, shape.witness.arc_length);
            let (on_robot, on_mesh) = (shape.witness.on_robot, shape.witness.on_mesh);
            seen.contact += 1;
            assert!(upper <= margin && (on_robot - on_mesh).length() <= upper + 1e-9);
            let tube = motion.tube(t).unwrap();
            assert!((0.0..=tube.length() + 1e-9).contains(&arc_length));
            let found = search.clearance(&tube, &ventricle::entry(), 1e-6).unwrap();
            assert!(found.lower <= margin, "false contact: {found:?} at {t}, margin {margin}");
            // By the links that follow from the same curve, too.
            let (points, radii) = arcs(motion, t).samples(0.05, &[1e-5, 1e-4, 1e-3]);
            let chain = Chain::from_centreline(&points, &radii).unwrap();
            let links = search.minimum(&chain, &ventricle::entry()).unwrap().distance;
            assert!(links <= margin + 1e-4, "false contact: {links} at {t}, margin {margin}");
            assert!(lower <= margin + fine, "no step is near: {lower}, margin {margin}");
            let ends = [steps.bounds[0][0], steps.bounds[steps.bounds.len() - 1][0]];
            seen.both_ends_clear_but_contact += usize::from(ends.iter().all(|end| *end > margin));
        }
        (Decision::Undecided, _) => {
            let interval = answer.interval;
            seen.undecided += 1;
            assert!(0.0 <= interval[0] && interval[0] < interval[1] && interval[1] <= 1.0);
            assert!(
                lower <= margin + RESOLUTION + fine && upper >= margin - fine,
                "{lower} {upper} {margin}"
            );
        }
        (Decision::Contact, None) => panic!("{answer:?}"),
    }
}

/// Edges in steps in which no point moves by more than about `fine`.
fn judge_edges(search: &mut BvhSearch, random: &mut Random, edges: usize, fine: Real) -> Seen {
    let robot = ctr::three_tubes();
    let mut seen = Seen::default();
    for edge in 0..edges {
        let distance = [0.5, 1.0, 2.0, 5.0, 10.0, 20.0][edge % 6] * random.between(0.8, 1.0);
        // Most as planners ask about them, with both ends clear.
        let motion = loop {
            let motion = random_edge(&robot, random, distance);
            let mut is_clear = |t: &Real| {
                search
                    .clears_tube(&motion.tube(*t).unwrap(), &ventricle::entry(), 0.0, 1e-3)
                    .unwrap()
                    == Decision::Clear
            };
            if edge % 8 == 7 || [0.0, 1.0].iter().all(&mut is_clear) {
                break motion;
            }
        };
        let fastest = motion
            .speed(2, [0.0, 1.0], [0.0, 1.0])
            .point
            .max(motion.speed(0, [0.0, 1.0], [0.0, 1.0]).point);
        // The bound is about twice the speed.
        let count = (0.5 * fastest.max(distance) / fine).ceil() as usize;
        let steps = Steps::new(search, count, 0.1 * fine, |t| {
            (motion.tube(t).unwrap(), ventricle::entry())
        });
        let [lower, upper] = steps.least();
        let margins = [
            [0.0, 0.25, 0.5, 1.0][random.below(4) as usize],
            random.unit(),
            // Grazing, on either side.
            (lower - random.between(1.0, 3.0) * fine).max(0.0),
            upper + random.between(0.1, 3.0) * fine,
        ];
        for margin in margins {
            judge(search, &motion, &steps, 2.0 * fine, margin, &mut seen);
        }
    }
    seen
}

#[test]
fn no_edge_is_misjudged() {
    let seen = judge_edges(&mut anatomy(), &mut Random::new(1), rounds(200), 0.05);
    println!("{seen:?}");
    assert!(
        seen.clear > rounds(200)
            && seen.contact > rounds(200)
            && seen.both_ends_clear_but_contact > rounds(30),
        "{seen:?}"
    );
    assert!(seen.undecided <= rounds(10), "{seen:?}");
}

#[test]
#[ignore = "10,000 edges in steps of 0.01 mm take 7 minutes of one core, in release"]
fn no_edge_of_ten_thousand_is_misjudged() {
    let seen = judge_edges(&mut anatomy(), &mut Random::new(2), 10_000, 0.01);
    println!("{seen:?}");
    assert!(
        seen.clear > 10_000 && seen.contact > 10_000 && seen.both_ends_clear_but_contact > 2000,
        "{seen:?}"
    );
    assert!(seen.undecided < 40, "{seen:?}");
}
