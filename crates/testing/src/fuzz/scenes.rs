//! Two robots that move among two structures. One of the structures may move too.

use super::source::Source;
use parry_continuum::parry::math::{Pose, Rot3, Vector};
use parry_continuum::proximity::{
    BvhSearch, Decision, Proximity, RobotPair, Scene, SceneMotionContact, StructureEnd,
};
use parry_continuum::{Chain, LinearMotion};

/// The number of times at which answers are compared with shapes.
const TIMES: u32 = 12;

/// Where a robot's points are at both ends of its motion.
type Ends = [Vec<Vector>; 2];

struct Case {
    search: BvhSearch,
    poses: [Pose; 2],
    /// The displacement of the second structure.
    shift: Vector,
    robots: [(Ends, Vec<f64>); 2],
    margin: f64,
    /// The largest coordinate.
    largest: f64,
}

impl Case {
    /// The robots at a time, unless rounding decides which links have a length or a direction.
    fn chains(&self, t: f64) -> Option<[Chain; 2]> {
        let chain = |(ends, radii): &(Ends, Vec<f64>)| {
            let points: Vec<_> =
                ends[0].iter().zip(&ends[1]).map(|(from, to)| from.lerp(*to, t)).collect();
            let is_short = |ends: &[Vector]| (ends[1] - ends[0]).length() <= 1e-9 * self.largest;
            if points.windows(2).any(is_short) {
                return None;
            }
            Chain::capsules(&points, radii).ok()
        };
        Some([chain(&self.robots[0])?, chain(&self.robots[1])?])
    }

    /// The least slack of all that the scene tests at a time; of resting structures only.
    fn slack(&mut self, t: f64, shift: Vector) -> Option<f64> {
        let [a, b] = self.chains(t)?;
        let mut least = f64::INFINITY;
        for (number, pose) in self.poses.into_iter().enumerate() {
            let shift = if number == 1 { shift * t } else { Vector::ZERO };
            let pose = (Pose::from_translation(shift) * pose).inverse();
            for chain in [&a, &b] {
                least = least.min(self.search.minimum(chain, &pose).ok()?.distance);
            }
        }
        let at = Pose::IDENTITY;
        let apart = RobotPair::new().minimum(&a, &at, &b, &at).ok()?.distance;
        Some(least.min(apart) - self.margin)
    }
}

/// Asks every question about moving robots in a scene, and compares the answers with shapes.
pub fn scenes(bytes: &[u8]) {
    let mut source = Source::new(bytes);
    let (vertices, indices) = source.wall();
    let Ok(search) = BvhSearch::from_triangles(&vertices, &indices) else { return };
    let mut pose = || {
        let turn = Rot3::from_scaled_axis(source.way());
        Pose::from_parts(source.way(), if source.flag() { turn } else { Rot3::IDENTITY })
    };
    let poses = [Pose::IDENTITY, pose()];
    let mut robot = || {
        let (points, radii) = source.centreline();
        let to = points.iter().map(|point| *point + source.way() * 0.5).collect();
        ([points, to], radii)
    };
    let robots = [robot(), robot()];
    let shift = if source.flag() { source.way() } else { Vector::ZERO };
    let points = robots.iter().flat_map(|(ends, _)| ends).flatten();
    let largest = points.chain(&vertices).fold(4.0, |most: f64, p| most.max(p.abs().max_element()));
    let margin = [0.0, 0.125, source.number().abs().min(1e3)][source.below(3)];
    let mut case = Case { search, poses, shift, robots, margin, largest };
    check(&mut case);
}

fn check(case: &mut Case) {
    let motion =
        |(ends, radii): &(Ends, Vec<f64>)| LinearMotion::capsules(&ends[0], &ends[1], radii).ok();
    let [Some(first), Some(second)] = case.robots.each_ref().map(motion) else { return };
    let motions = [&first, &second];
    let mut scene = Scene::new();
    for (number, pose) in case.poses.iter().enumerate() {
        let name = format!("structure {number}");
        let added = scene.add(name, case.search.clone(), Some(case.margin));
        assert_eq!(added, Ok(number));
        if scene.set_pose(number, pose).is_err() {
            return;
        }
    }
    assert_eq!(scene.set_robot_margin(Some(case.margin)), Ok(()));
    let resolution = 1e-3 * case.largest;
    let end = Pose::from_translation(case.shift) * case.poses[1];
    let ends = [(1, StructureEnd::Pose(end))];
    let answers = [
        scene.clears_motion(&motions, resolution),
        scene.time_of_contact(&motions, resolution),
        scene.clears_motion_while(&ends, &motions, resolution),
    ];
    let least = scene.clearance_of_motion(&motions, resolution);
    let again = [
        scene.clears_motion(&motions, resolution),
        scene.time_of_contact(&motions, resolution),
        scene.clears_motion_while(&ends, &motions, resolution),
    ];
    assert_eq!(format!("{again:?}"), format!("{answers:?}"), "asked again");
    let problem = |case: &Case| {
        let of = [&case.robots[0], &case.robots[1]];
        format!("{answers:?} {least:?}\n{of:?} {:?} {} {}", case.poses, case.shift, case.margin)
    };
    let rounding = 1e-11 * case.largest;
    let times = || (0..=TIMES).map(|k| f64::from(k) / f64::from(TIMES));
    for (number, answer) in answers.iter().enumerate() {
        let shift = if number == 2 { case.shift } else { Vector::ZERO };
        let Ok(answer) = answer else { continue };
        if let Some(contact) = &answer.contact {
            assert!((0.0..=1.0).contains(&contact.t()), "{}", problem(case));
            assert!(contact.upper() <= case.margin, "{}", problem(case));
            let slack = case.slack(contact.t(), shift);
            assert!(slack.is_none_or(|slack| slack <= rounding), "{slack:?} {}", problem(case));
            if let SceneMotionContact::Structure { shape, .. } = contact {
                let apart = (shape.witness.on_robot - shape.witness.on_mesh).length();
                assert!(apart <= contact.upper() + rounding, "{apart} {}", problem(case));
            }
        }
        let clear_until = if answer.is_clear() { 2.0 } else { answer.interval[0] };
        for t in times().filter(|t| *t < clear_until) {
            let slack = case.slack(t, shift);
            let is_kept = slack.is_none_or(|slack| slack > -rounding);
            assert!(is_kept, "{slack:?} at {t} {}", problem(case));
        }
    }
    if case.shift == Vector::ZERO {
        let decisions = [0, 2].map(|k: usize| answers[k].as_ref().map(|answer| answer.decision));
        let contradict = [Ok(Decision::Clear), Ok(Decision::Contact)];
        assert!(
            !contradict.iter().all(|decision| decisions.contains(decision)),
            "{}",
            problem(case)
        );
    }
    if let Ok(Some(least)) = least {
        assert!(least.lower <= least.upper, "{}", problem(case));
        for t in times() {
            let slack = case.slack(t, Vector::ZERO);
            let is_kept = slack.is_none_or(|slack| slack >= least.lower - rounding);
            assert!(is_kept, "{slack:?} at {t} {}", problem(case));
        }
        let slack = case.slack(least.t, Vector::ZERO);
        let is_realised = slack.is_none_or(|slack| slack <= least.upper + rounding);
        assert!(is_realised, "{slack:?} {}", problem(case));
    }
}
