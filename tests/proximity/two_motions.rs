//! Two robots that move: the first contact and the least clearance, against fine steps.

use super::scene_motions::{Edge, RESOLUTION, STEPS};
use continuum_testing::{Random, rounds};
use parry_continuum::parry::math::{Pose, Real, Vector};
use parry_continuum::proximity::{Decision, ProximityError, RobotPair, UndecidedReason};
use parry_continuum::{Chain, LinearMotion, MotionPath, RigidMotion, Tube};

fn distance(edges: &[Edge; 2], t: Real) -> Real {
    let [a, b] = edges.each_ref().map(|edge| edge.chain(t));
    let at = Pose::IDENTITY;
    RobotPair::new().minimum(&a, &at, &b, &at).unwrap().distance
}

fn steps() -> impl Iterator<Item = Real> {
    (0..=STEPS).map(|step| Real::from(step) / Real::from(STEPS))
}

#[test]
fn the_least_clearance_of_two_motions_is_between_its_bounds() {
    let (mut pair, mut touching, mut inside) = (RobotPair::new(), 0, 0);
    for seed in 0..rounds(600) {
        let random = &mut Random::new(seed);
        let edges = [0; 2].map(|_| Edge::random(random));
        let [a, b] = edges.each_ref().map(Edge::motion);
        let found = pair.clearance_of_motion(&a, &b, 1e-3).unwrap();
        assert!(found.resolved && found.upper - found.lower <= 1e-3, "{seed}: {found:?}");
        for t in steps() {
            let distance = distance(&edges, t);
            assert!(found.lower <= distance + 1e-12, "{seed}: {distance} at {t}, {found:?}");
        }
        let at = distance(&edges, found.t);
        assert!(at <= found.upper + 1e-12 && at >= found.lower - 1e-12, "{seed}: {at} {found:?}");
        let apart = (found.witness.on_first - found.witness.on_second).length();
        assert!(apart <= found.upper + 1e-12, "{seed}");
        touching += u32::from(found.upper == 0.0);
        inside += u32::from(found.upper > 0.0 && found.t > 0.02 && found.t < 0.98);
        // What was asked before does not matter, and a finer tolerance is no looser.
        assert_eq!(RobotPair::new().clearance_of_motion(&a, &b, 1e-3).unwrap(), found);
        let rough = pair.clearance_of_motion(&a, &b, 0.1).unwrap();
        assert!(rough.lower <= found.lower && found.upper <= rough.upper, "{seed}");
    }
    assert!(touching >= rounds(10) && inside >= rounds(48), "{touching} {inside}");
}

/// The tips of two needles pass one another: the clearance is known, and when.
#[test]
fn needles_that_pass_are_nearest_in_the_middle() {
    let needle = |y: Real, x: [Real; 2]| {
        let ends = x.map(|x| [Vector::new(x, y, -40.0), Vector::new(x, y, 0.0)]);
        LinearMotion::capsules(&ends[0], &ends[1], &[1.0]).unwrap()
    };
    let (first, second) = (needle(0.0, [-10.0, 10.0]), needle(3.0, [10.0, -10.0]));
    let found = RobotPair::new().clearance_of_motion(&first, &second, 1e-6).unwrap();
    assert!(found.lower <= 1.0 && 1.0 <= found.upper && found.upper - found.lower <= 1e-6);
    assert!((found.t - 0.5).abs() < 1e-3, "{found:?}");
    // The same in the second motion of a path, beside a path of three motions at rest.
    let rest = needle(0.0, [-10.0; 2]);
    let a = MotionPath::new(vec![rest, first]).unwrap();
    let still = needle(3.0, [10.0; 2]);
    let b = MotionPath::new(vec![still.clone(), still, needle(3.0, [10.0, -10.0])]).unwrap();
    // From t = 2/3 on they are at x = 40 t - 30 and 50 - 60 t.
    let found = RobotPair::new().clearance_of_motion(&a, &b, 1e-6).unwrap();
    assert!(found.lower <= 1.0 && 1.0 <= found.upper && found.upper - found.lower <= 1e-6);
    assert!((found.t - 0.8).abs() < 1e-3, "{found:?}");
}

#[test]
fn robots_at_rest_are_as_far_apart_as_their_tubes() {
    let chain = Chain::capsules(&[Vector::ZERO, Vector::Z * 4.0], &[0.5]).unwrap();
    let at_rest = |x: Real| {
        RigidMotion::new(Tube::from(&chain), [Pose::translation(x, 0.0, 0.0); 2]).unwrap()
    };
    let found = RobotPair::new().clearance_of_motion(&at_rest(0.0), &at_rest(3.0), 1e-9).unwrap();
    assert!(found.lower <= 2.0 && 2.0 <= found.upper && found.upper - found.lower <= 1e-9);
    // Equal shapes overlap at all times.
    let found = RobotPair::new().clearance_of_motion(&at_rest(1.0), &at_rest(1.0), 1e-3).unwrap();
    assert_eq!((found.lower, found.upper), (0.0, 0.0));
    let answer = RobotPair::new().time_of_contact(&at_rest(0.0), &at_rest(3.0), 2.5, 1e-3).unwrap();
    assert_eq!((answer.decision, answer.interval[0]), (Decision::Contact, 0.0));
    let error = RobotPair::new().clearance_of_motion(&at_rest(0.0), &at_rest(3.0), -1.0);
    assert!(matches!(error, Err(ProximityError::Negative { parameter: "tolerance", .. })));
}

#[test]
fn no_step_before_the_first_contact_of_two_motions_is_within_the_margin() {
    let (mut pair, mut seen) = (RobotPair::new(), [0; 3]);
    for seed in 0..rounds(1200) {
        let random = &mut Random::new(seed);
        let edges = [0; 2].map(|_| Edge::random(random));
        let [a, b] = edges.each_ref().map(Edge::motion);
        let margin = [0.0, random.between(0.0, 1.0)][random.below(2) as usize];
        let answer = pair.time_of_contact(&a, &b, margin, RESOLUTION).unwrap();
        let any = pair.clears_motions(&a, &b, margin, RESOLUTION).unwrap().decision;
        let [clear_until, t] = answer.interval;
        for step in steps().filter(|step| *step < clear_until) {
            let distance = distance(&edges, step);
            assert!(distance > margin, "{seed}: {distance} at {step}, {answer:?}");
        }
        match answer.decision {
            Decision::Clear => assert_eq!((any, clear_until), (Decision::Clear, 1.0), "{seed}"),
            Decision::Contact => {
                assert_eq!(any, Decision::Contact, "{seed}");
                let contact = answer.contact.unwrap();
                assert_eq!(contact.t, t);
                assert!(distance(&edges, t) <= margin + 1e-12 && contact.upper <= margin);
                // Nothing comes within the resolution before, but where motions graze.
                seen[2] += u32::from(t - clear_until < 0.02);
            }
            Decision::Undecided => assert_eq!(answer.reason, Some(UndecidedReason::Near)),
        }
        seen[answer.decision as usize % 2] += 1;
        assert_eq!(RobotPair::new().time_of_contact(&a, &b, margin, RESOLUTION), Ok(answer));
    }
    let [clear, contact, sharp] = seen;
    assert!(clear >= rounds(100) && contact >= rounds(100), "{seen:?}");
    assert!(10 * sharp >= 9 * contact, "{seen:?}");
}

#[test]
fn batches_of_pairs_answer_as_if_alone() {
    let random = &mut Random::new(3);
    let edges: Vec<_> = (0..50).map(|_| [0; 2].map(|_| Edge::random(random))).collect();
    let motions: Vec<_> = edges.iter().map(|[a, b]| (a.motion(), b.motion())).collect();
    let mut answers = Vec::new();
    RobotPair::new().clears_motions_batch(&motions, 0.3, RESOLUTION, &mut answers).unwrap();
    for ((a, b), answer) in motions.iter().zip(&answers) {
        assert_eq!(*answer, RobotPair::new().clears_motions(a, b, 0.3, RESOLUTION));
    }
    let clear = answers.iter().flatten().filter(|answer| answer.is_clear()).count();
    assert!((1..50).contains(&clear), "{clear}");
    let error = RobotPair::new().clears_motions_batch(&motions, -1.0, RESOLUTION, &mut answers);
    assert!(error.is_err() && answers.is_empty());

    let chains: Vec<_> = edges.iter().map(|[a, b]| [a.chain(0.0), b.chain(0.0)]).collect();
    let beside = |k: usize| Pose::translation(if k == 7 { Real::NAN } else { 0.0 }, 0.0, 0.0);
    let pairs: Vec<_> = chains
        .iter()
        .enumerate()
        .map(|(k, [a, b])| [(a, Pose::IDENTITY), (b, beside(k))])
        .collect();
    let (mut clears, mut minima) = (Vec::new(), Vec::new());
    RobotPair::new().clears_batch(&pairs, 0.5, &mut clears).unwrap();
    RobotPair::new().minimum_batch(&pairs, &mut minima);
    for ((pair, clears), minimum) in pairs.iter().zip(&clears).zip(&minima) {
        let [(a, pose_a), (b, pose_b)] = pair;
        assert_eq!(*clears, RobotPair::new().clears(a, pose_a, b, pose_b, 0.5));
        assert_eq!(*minimum, RobotPair::new().minimum(a, pose_a, b, pose_b));
    }
    assert!(clears[7].is_err() && clears[8].is_ok() && minima.len() == 50);
    assert!(
        RobotPair::new().clears_batch(&pairs, Real::NAN, &mut clears).is_err() && clears.is_empty()
    );
}
