//! Robots that move in a scene, against the single questions and against fine steps.

use continuum_testing::{Random, rounds};
use parry_continuum::parry::math::{Pose, Real, Vector};
use parry_continuum::parry::shape::Ball;
use parry_continuum::proximity::{
    BvhSearch, Decision, PlacementFault, Proximity, ProximityError, RobotPair, Scene, SceneError,
    SceneMotionContact, SelfQuery, UndecidedReason,
};
use parry_continuum::{
    BendingMotion, BendingSection, Chain, LinearMotion, Motion, MotionPath, MovingBase,
    RigidMotion, RobotError, Speed, Tube,
};

pub(super) const RESOLUTION: Real = 1e-3;
pub(super) const STEPS: u32 = 60;

pub(super) fn ball(radius: Real) -> BvhSearch {
    let (vertices, triangles) = Ball::new(radius).to_trimesh(12, 6);
    BvhSearch::from_triangles(&vertices, &triangles).unwrap()
}

/// Capsules whose vertices move straight.
#[derive(Clone)]
pub(super) struct Edge {
    ends: [Vec<Vector>; 2],
    radii: Vec<Real>,
}

impl Edge {
    /// A robot of a few links near the origin, and another shape of it.
    pub(super) fn random(random: &mut Random) -> Self {
        let mut from = vec![random.point() * 4.0];
        let mut heading = random.direction();
        let (sharp, links) = [(random.between(0.2, 1.2), 3), (1.8, 6)][random.below(2) as usize];
        for k in 0..links + random.below(4) as usize {
            heading = (heading + random.direction() * sharp).normalize();
            from.push(from[k] + heading * random.between(0.8, 1.6));
        }
        let most = [0.1, 1.0, 3.0][random.below(3) as usize];
        let shift = random.point() * most;
        let to = from.iter().map(|point| *point + shift + random.point() * 0.3 * most).collect();
        let radii = vec![random.between(0.05, 0.2); from.len() - 1];
        Self { ends: [from, to], radii }
    }

    pub(super) fn motion(&self) -> LinearMotion {
        LinearMotion::capsules(&self.ends[0], &self.ends[1], &self.radii).unwrap()
    }

    pub(super) fn chain(&self, t: Real) -> Chain {
        let pairs = self.ends[0].iter().zip(&self.ends[1]);
        let points: Vec<_> = pairs.map(|(from, to)| from.lerp(*to, t)).collect();
        Chain::capsules(&points, &self.radii).unwrap()
    }
}

/// A scene, and the same data for the single questions.
pub(super) struct Case {
    pub(super) scene: Scene,
    pub(super) organs: Vec<(BvhSearch, Option<Real>, Pose)>,
    between: Option<Real>,
    pub(super) itself: Option<Real>,
    nested: Vec<[usize; 2]>,
}

impl Case {
    pub(super) fn random(random: &mut Random) -> Self {
        let mut case = Self {
            scene: Scene::new(),
            organs: Vec::new(),
            between: [None, Some(random.between(0.0, 0.5))][random.below(2) as usize],
            itself: [None, Some(random.between(0.0, 0.8))][random.below(2) as usize],
            nested: if random.below(3) == 0 { vec![[2, 0]] } else { Vec::new() },
        };
        for number in 0..5 {
            let search = ball(random.between(0.3, 1.2));
            let margin = [None, Some(0.0), Some(random.between(0.0, 0.6))];
            let margin = margin[random.below(3) as usize];
            let mut pose = random.pose(1.0);
            pose.translation = random.direction() * random.between(2.0, 9.0);
            if random.below(4) == 0 {
                pose = Pose::IDENTITY;
            }
            case.scene.add(format!("organ {number}"), search.clone(), margin).unwrap();
            case.scene.set_pose(number, &pose).unwrap();
            case.organs.push((search, margin, pose));
        }
        case.scene.set_robot_margin(case.between).unwrap();
        case.scene.set_self_margin(case.itself).unwrap();
        case.scene.set_nested(&case.nested);
        case
    }

    /// The answers of all single questions, in order; `None` if a joint is too sharp for one.
    fn singles(&mut self, motions: &[LinearMotion]) -> Option<Vec<(Decision, Asked)>> {
        let mut answers = Vec::new();
        for asked in self.asked(motions.len()) {
            let decision = match asked {
                Asked::Structure(number, robot) => {
                    let (search, margin, pose) = &mut self.organs[number as usize];
                    let (motion, margin) = (&motions[robot as usize], margin.unwrap());
                    let answer = if *pose == Pose::IDENTITY {
                        search.clears_motion(motion, margin, RESOLUTION)
                    } else {
                        let carried = MovingBase::new(motion.clone(), [pose.inverse(); 2]).unwrap();
                        search.clears_motion(&carried, margin, RESOLUTION)
                    };
                    answer.unwrap().decision
                }
                Asked::Pair(pair) => {
                    let [a, b] = pair.map(|robot| &motions[robot as usize]);
                    let margin = self.between.unwrap();
                    RobotPair::new().clears_motions(a, b, margin, RESOLUTION).unwrap().decision
                }
                Asked::Itself(robot) => {
                    let (motion, margin) = (&motions[robot as usize], self.itself.unwrap());
                    let answer = SelfQuery::new().clears_motion(motion, margin, RESOLUTION);
                    answer.ok()?.decision
                }
            };
            answers.push((decision, asked));
        }
        Some(answers)
    }

    /// All questions, in order.
    pub(super) fn asked(&self, robots: usize) -> Vec<Asked> {
        let mut asked = Vec::new();
        for (number, (_, margin, _)) in self.organs.iter().enumerate() {
            let of = |robot| Asked::Structure(number as u32, robot as u32);
            asked.extend((0..robots).filter(|_| margin.is_some()).map(of));
        }
        for a in 0..robots {
            for b in a + 1..robots {
                if self.between.is_some() && !self.nested.contains(&[b, a]) {
                    asked.push(Asked::Pair([a as u32, b as u32]));
                }
            }
        }
        let own = (0..robots).filter(|_| self.itself.is_some());
        asked.extend(own.map(|robot| Asked::Itself(robot as u32)));
        asked
    }

    /// The margin of a question, and the distance at a time.
    pub(super) fn distance(&mut self, asked: Asked, edges: &[Edge], t: Real) -> (Real, Real) {
        match asked {
            Asked::Structure(number, robot) => {
                let (search, margin, pose) = &mut self.organs[number as usize];
                let chain = edges[robot as usize].chain(t);
                let found = search.minimum(&chain, &pose.inverse()).unwrap();
                (margin.unwrap(), found.distance)
            }
            Asked::Pair(pair) => {
                let [a, b] = pair.map(|robot| edges[robot as usize].chain(t));
                let at = Pose::IDENTITY;
                let found = RobotPair::new().minimum(&a, &at, &b, &at).unwrap();
                (self.between.unwrap(), found.distance)
            }
            Asked::Itself(robot) => {
                // A joint may be too sharp between the shapes that the query makes.
                let found = SelfQuery::new().minimum(&edges[robot as usize].chain(t));
                let distance = found.ok().flatten().map_or(Real::INFINITY, |found| found.distance);
                (self.itself.unwrap(), distance)
            }
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Asked {
    Structure(u32, u32),
    Pair([u32; 2]),
    Itself(u32),
}

/// What a contact is about, and how far apart its points are.
pub(super) fn asked(contact: &SceneMotionContact) -> (Asked, Real) {
    match contact {
        SceneMotionContact::Structure { structure, robot, shape } => {
            let apart = (shape.witness.on_robot - shape.witness.on_mesh).length();
            (Asked::Structure(*structure, *robot), apart)
        }
        SceneMotionContact::Robots { robots, shapes } => {
            let apart = (shapes.witness.on_first - shapes.witness.on_second).length();
            (Asked::Pair(*robots), apart)
        }
        SceneMotionContact::Itself { robot, shapes } => {
            let apart = (shapes.witness.on_first - shapes.witness.on_second).length();
            (Asked::Itself(*robot), apart)
        }
        other => panic!("{other:?}"),
    }
}

/// Robots whose joints are not too sharp for questions about a robot and itself.
pub(super) fn edges(random: &mut Random, count: usize) -> Vec<Edge> {
    let mut edges = Vec::new();
    while edges.len() < count {
        let edge = Edge::random(random);
        if SelfQuery::new().clears_motion(&edge.motion(), 0.0, RESOLUTION).is_ok() {
            edges.push(edge);
        }
    }
    edges
}

#[test]
fn a_scene_decides_as_the_single_questions_and_no_step_is_nearer() {
    let mut seen = [0; 6];
    for seed in 0..rounds(5000) {
        let random = &mut Random::new(seed);
        let mut case = Case::random(random);
        if case.scene.clears(&[]).is_err() {
            continue;
        }
        let edges = edges(random, 3);
        let motions: Vec<_> = edges.iter().map(Edge::motion).collect();
        let answer = case.scene.clears_motion(&motions.each(), RESOLUTION);
        let Some(singles) = case.singles(&motions) else {
            let is_clear = answer.is_ok_and(|answer| answer.is_clear());
            assert!(!is_clear, "seed {seed}");
            continue;
        };
        let answer = answer.unwrap();
        let first = singles.iter().find(|(decision, _)| *decision == Decision::Contact);
        let is_open = singles.iter().any(|(decision, _)| *decision == Decision::Undecided);
        match answer.decision {
            Decision::Clear => {
                seen[0] += 1;
                assert!(first.is_none(), "seed {seed}: {singles:?}");
                assert_eq!((answer.interval, answer.contact), ([1.0; 2], None));
                for (_, asked) in &singles {
                    for step in 0..=STEPS {
                        let t = Real::from(step) / Real::from(STEPS);
                        let (margin, distance) = case.distance(*asked, &edges, t);
                        assert!(distance > margin, "seed {seed}: {asked:?} at {t}");
                    }
                }
            }
            Decision::Contact => {
                let contact = answer.contact.unwrap();
                let (found, apart) = asked(&contact);
                seen[match found {
                    Asked::Structure(number, _) => {
                        let is_moved = case.organs[number as usize].2 != Pose::IDENTITY;
                        1 + usize::from(is_moved)
                    }
                    Asked::Pair(_) => 3,
                    Asked::Itself(_) => 4,
                }] += 1;
                assert!(singles.contains(&(Decision::Contact, found)), "seed {seed}: {found:?}");
                // Structures come first, then pairs, then each robot and itself.
                let kind = |asked: &Asked| match asked {
                    Asked::Structure(..) => 0,
                    Asked::Pair(_) => 1,
                    Asked::Itself(_) => 2,
                };
                assert_eq!(first.map(|first| kind(&first.1)), Some(kind(&found)), "seed {seed}");
                let (margin, distance) = case.distance(found, &edges, contact.t());
                assert!(distance <= margin + 1e-9 && contact.upper() <= margin, "seed {seed}");
                assert!(apart <= contact.upper() + 1e-9, "seed {seed}: {apart}");
                assert_eq!(answer.interval, [0.0, contact.t()]);
            }
            Decision::Undecided => {
                seen[5] += 1;
                assert!(first.is_none() && is_open, "seed {seed}: {singles:?}");
                assert_eq!(answer.reason, Some(UndecidedReason::Near));
            }
        }
        // Another scene and other memory do not matter.
        let fresh = case.scene.clone().clears_motion(&motions.each(), RESOLUTION);
        assert_eq!(fresh, Ok(answer), "seed {seed}");
        assert_eq!(Scene::clone(&case.scene).clears_motion(&motions.each(), RESOLUTION), fresh);
    }
    let least = rounds(40);
    assert!(seen[..5].iter().all(|count| *count >= least), "{seen:?}");
}

/// References to all items.
pub(super) trait Each<T> {
    fn each(&self) -> Vec<&T>;
}

impl<T> Each<T> for Vec<T> {
    fn each(&self) -> Vec<&T> {
        self.iter().collect()
    }
}

#[test]
fn what_was_asked_before_does_not_matter() {
    let random = &mut Random::new(7);
    let mut case = Case::random(random);
    case.scene.set_margin(0, Some(0.1)).unwrap();
    let asked: Vec<Vec<_>> =
        (0..20).map(|_| edges(random, 2).iter().map(Edge::motion).collect()).collect();
    let ask = |scene: &mut Scene, motions: &Vec<LinearMotion>| {
        scene.clears_motion(&motions.each(), RESOLUTION).unwrap()
    };
    let alone: Vec<_> = asked.iter().map(|motions| ask(&mut case.scene.clone(), motions)).collect();
    let mut used = case.scene.clone();
    for _ in 0..2 {
        let together: Vec<_> = asked.iter().map(|motions| ask(&mut used, motions)).collect();
        assert_eq!(together, alone);
    }
    let backwards: Vec<_> = asked.iter().rev().map(|motions| ask(&mut used, motions)).collect();
    assert!(backwards.iter().eq(alone.iter().rev()));
    let decisions = alone.iter().map(|answer| answer.decision);
    let clear = decisions.filter(|decision| *decision == Decision::Clear).count();
    assert!((1..20).contains(&clear), "{clear}");
}

/// A batch answers each edge as if it were alone, also if another one has an error.
#[test]
fn a_batch_answers_each_edge_as_if_it_were_alone() {
    let random = &mut Random::new(11);
    let mut case = Case::random(random);
    case.scene.set_margin(0, Some(0.1)).unwrap();
    case.scene.set_self_margin(Some(0.1)).unwrap();
    let motions: Vec<_> =
        (0..40).map(|_| edges(random, 2).iter().map(Edge::motion).collect::<Vec<_>>()).collect();
    let sharp = [Vector::ZERO, Vector::Z, Vector::X * 0.1].map(|point| point + Vector::Y * 30.0);
    let sharp = LinearMotion::chain(&sharp, &sharp, &[0.3; 2]).unwrap();
    let mut sets: Vec<Vec<_>> = motions.iter().map(Each::each).collect();
    sets[17] = vec![&sharp];
    let sets: Vec<_> = sets.iter().map(Vec::as_slice).collect();
    let mut answers = Vec::new();
    for _ in 0..2 {
        case.scene.clears_motion_batch(&sets, RESOLUTION, &mut answers);
        assert_eq!(answers.len(), sets.len());
        for (set, answer) in sets.iter().zip(&answers) {
            assert_eq!(*answer, case.scene.clone().clears_motion(set, RESOLUTION));
        }
    }
    assert!(matches!(&answers[17], Err(SceneError::Robot { robot: 0, .. })));
    let clear = answers.iter().flatten().filter(|answer| answer.is_clear()).count();
    assert!((1..39).contains(&clear), "{clear}");
    case.scene.clears_motion_batch::<LinearMotion>(&[], RESOLUTION, &mut answers);
    assert!(answers.is_empty());
}

#[test]
fn tubes_in_a_scene_are_decided_as_by_the_single_questions() {
    let mut seen = [0; 3];
    for seed in 0..rounds(400) {
        let random = &mut Random::new(seed);
        let mut case = Case::random(random);
        if case.scene.clears(&[]).is_err() {
            continue;
        }
        let edges = edges(random, 3);
        let tubes: Vec<_> = edges.iter().map(|edge| Tube::from(&edge.chain(0.3))).collect();
        let poses = [0; 3].map(|_| Pose::from_translation(random.point() * 0.5));
        let robots: Vec<_> = tubes.iter().zip(poses).collect();
        let mut singles = Vec::new();
        for (search, margin, pose) in &mut case.organs {
            let Some(margin) = *margin else { continue };
            for (tube, at) in &robots {
                let at = pose.inverse() * *at;
                singles.push(search.clears_tube(tube, &at, margin, RESOLUTION).unwrap());
            }
        }
        if let Some(margin) = case.between {
            for [a, b] in [[0, 1], [0, 2], [1, 2]]
                .into_iter()
                .filter(|[a, b]| !case.nested.contains(&[*b, *a]))
            {
                let ((first, at), (second, beside)) = (&robots[a], &robots[b]);
                let answer =
                    RobotPair::new().clears_tubes(first, at, second, beside, margin, RESOLUTION);
                singles.push(answer.unwrap());
            }
        }
        if let Some(margin) = case.itself {
            for tube in &tubes {
                singles.push(SelfQuery::new().clears_tube(tube, margin, RESOLUTION).unwrap());
            }
        }
        let expected = if singles.contains(&Decision::Contact) {
            Decision::Contact
        } else if singles.contains(&Decision::Undecided) {
            Decision::Undecided
        } else {
            Decision::Clear
        };
        for _ in 0..2 {
            assert_eq!(case.scene.clears_tube(&robots, RESOLUTION), Ok(expected), "seed {seed}");
        }
        seen[expected as usize] += 1;
    }
    assert!(seen[0] > 10 && seen[1] > 10, "{seen:?}");
    // A pose that is not finite belongs to its robot, with or without anything near.
    let tube = needle(Vector::ZERO, Vector::Z, 0.1);
    let mut scene = Scene::new();
    let at = |x: Real| (&tube, Pose::translation(x, 0.0, 0.0));
    assert_eq!(scene.clears_tube(&[at(0.0)], RESOLUTION), Err(SceneError::NoMargin));
    scene.set_robot_margin(Some(0.1)).unwrap();
    assert_eq!(scene.clears_tube(&[at(0.0), at(1.0)], RESOLUTION), Ok(Decision::Clear));
    assert_eq!(
        scene.clears_tube(&[at(0.0), at(Real::NAN)], RESOLUTION),
        Err(SceneError::Robot {
            robot: 1,
            structure: None,
            error: ProximityError::Pose(PlacementFault::PoseNotFinite)
        })
    );
    assert_eq!(scene.clears_tube(&[], -1.0).map_err(|error| error.kind()), Err("negative"));
}

/// A needle from `base` to `tip`.
fn needle(base: Vector, tip: Vector, radius: Real) -> Tube {
    Tube::from(&Chain::capsules(&[base, tip], &[radius]).unwrap())
}

/// A large square in the plane z = 0.
fn floor(size: Real) -> BvhSearch {
    let corners = [[-9.0, -9.0], [9.0, -9.0], [9.0, 9.0], [-9.0, 9.0]];
    let corners = corners.map(|[x, y]| Vector::new(x, y, 0.0) * size);
    BvhSearch::from_triangles(&corners, &[[0, 1, 2], [0, 2, 3]]).unwrap()
}

/// At rest, and at a distance of exactly the margin, in several units.
#[test]
fn a_margin_equal_to_the_clearance_is_not_kept() {
    for size in [1.0, 2.0_f64.powi(-40), 2.0_f64.powi(60)] {
        let tube = needle(Vector::Z * 3.0 * size, Vector::Z * 7.0 * size, size);
        let at_rest = RigidMotion::new(tube, [Pose::IDENTITY; 2]).unwrap();
        let beside = Pose::translation(4.0 * size, 0.0, 0.0);
        let tube = needle(Vector::Z * 3.0 * size, Vector::Z * 7.0 * size, size);
        let second = RigidMotion::new(tube, [beside; 2]).unwrap();
        let ask = |floor_margin: Real, robot_margin: Real| {
            let mut scene = Scene::new();
            scene.add("floor", floor(size), Some(floor_margin * size)).unwrap();
            scene.set_robot_margin(Some(robot_margin * size)).unwrap();
            scene.clears_motion(&[&at_rest, &second], 1e-6 * size).unwrap()
        };
        assert!(ask(1.99, 1.99).is_clear());
        // Both clearances are 2.
        for answer in [ask(2.0, 1.99), ask(1.99, 2.0)] {
            assert!(!answer.is_clear(), "{size}: {answer:?}");
        }
        let touching = ask(2.01, 2.01);
        assert!(matches!(
            touching.contact,
            Some(SceneMotionContact::Structure { structure: 0, .. })
        ));
        let touching = ask(1.99, 2.01);
        let Some(SceneMotionContact::Robots { robots: [0, 1], shapes, .. }) = touching.contact
        else {
            panic!("{touching:?}")
        };
        assert!((shapes.upper / size - 2.0).abs() < 1e-9);
    }
}

/// Two robots with the same motion touch, unless they are nested.
#[test]
fn equal_robots_touch_unless_they_are_nested() {
    let from = [Vector::ZERO, Vector::Z, Vector::new(0.3, 0.0, 2.0)];
    let motion = LinearMotion::chain(&from, &from.map(|point| point + Vector::X), &[0.1; 2]);
    let motion = motion.unwrap();
    let mut scene = Scene::new();
    scene.set_robot_margin(Some(0.0)).unwrap();
    let answer = scene.clears_motion(&[&motion, &motion], RESOLUTION).unwrap();
    assert_eq!(answer.contact.map(|contact| contact.upper()), Some(0.0));
    scene.set_nested(&[[1, 0]]);
    assert!(scene.clears_motion(&[&motion, &motion], RESOLUTION).unwrap().is_clear());
}

/// A link that grows from nothing, in a structure that is far out.
#[test]
fn a_link_that_grows_is_followed_in_a_moved_structure() {
    let far = Vector::new(1e5, -2e5, 1e5);
    let mut scene = Scene::new();
    scene.add("floor", floor(1.0), Some(0.5)).unwrap();
    scene.set_pose(0, &Pose::from_translation(far)).unwrap();
    // From a height of 6 down to `end`, with a round end of 0.5.
    let grows = |end: Real| {
        let top = far + Vector::Z * 6.0;
        let tip = far + Vector::Z * end;
        LinearMotion::capsules(
            &[top + Vector::Z, top, top],
            &[top + Vector::Z, top, tip],
            &[0.5; 2],
        )
        .unwrap()
    };
    assert!(scene.clears_motion(&[&grows(1.1)], RESOLUTION).unwrap().is_clear());
    let answer = scene.clears_motion(&[&grows(0.9)], RESOLUTION).unwrap();
    let Some(SceneMotionContact::Structure { shape, .. }) = answer.contact else {
        panic!("{answer:?}")
    };
    // The point of the floor, in the scene's frame.
    assert!((shape.witness.on_mesh - far).length() < 1e-6 && shape.t > 0.98);
}

/// A robot that goes far in the middle of its motion alone: a path of two motions.
#[test]
fn an_organ_beside_the_middle_of_a_path_is_found() {
    let line = |x: Real| [Vector::X * x, Vector::new(x, 0.0, 1.0)];
    let edge = |from: Real, to: Real| LinearMotion::chain(&line(from), &line(to), &[0.1]).unwrap();
    let path = MotionPath::new(vec![edge(0.0, 8.0), edge(8.0, 0.0)]).unwrap();
    let mut scene = Scene::new();
    scene.add("organ", ball(1.0), Some(0.1)).unwrap();
    for (x, is_clear) in [(10.0, true), (9.0, false), (20.0, true), (-1.0, false), (-9.0, true)] {
        scene.set_pose(0, &Pose::translation(x, 0.0, 0.5)).unwrap();
        let answer = scene.clears_motion(&[&path], RESOLUTION).unwrap();
        assert_eq!(answer.is_clear(), is_clear, "{x}: {answer:?}");
    }
}

/// A motion that counts its shapes.
struct Counted<M>(M, std::cell::Cell<usize>);

impl<M: Motion> Motion for Counted<M> {
    fn shape(&self, t: Real, tube: &mut Tube) -> Result<Pose, RobotError> {
        self.1.set(self.1.get() + 1);
        self.0.shape(t, tube)
    }

    fn speed(&self, section: usize, shares: [Real; 2], times: [Real; 2]) -> Speed {
        self.0.speed(section, shares, times)
    }
}

/// Thirty organs, and another robot, cost one shape of a robot that is well clear of them.
#[test]
fn one_shape_serves_all_questions() {
    let [from, to] = [0.0, 0.01].map(|bend| BendingSection {
        length: 3.0,
        radius: 0.1,
        bend: [0.1 + bend, 0.0],
    });
    let bending = BendingMotion::new(&[from], &[to], Pose::IDENTITY).unwrap();
    let mut scene = Scene::new();
    for number in 0..30 {
        let distance = if number < 10 { 2.0 } else { 20.0 };
        scene.add(format!("organ {number}"), ball(0.5), Some(0.1)).unwrap();
        let pose = Pose::translation(0.0, distance, 0.2 * Real::from(number));
        scene.set_pose(number as usize, &pose).unwrap();
    }
    scene.set_robot_margin(Some(0.1)).unwrap();
    scene.set_self_margin(Some(0.1)).unwrap();
    let moving = Counted(bending.clone(), Default::default());
    let pushed = Pose::translation(0.0, -2.0, 0.0);
    let second = Counted(MovingBase::new(bending, [pushed; 2]).unwrap(), Default::default());
    let answer = scene.clears_motion::<dyn Motion>(&[&moving, &second], RESOLUTION).unwrap();
    assert!(answer.is_clear(), "{answer:?}");
    assert_eq!((moving.1.get(), second.1.get()), (1, 1));
}

/// A robot that slides along a wall within the resolution: the answer states the reason.
#[test]
fn an_undecided_scene_says_why() {
    let tube = needle(Vector::Z * 3.0, Vector::Z * 7.0, 1.0);
    let slides = RigidMotion::new(tube, [0.0, 4.0].map(|x| Pose::translation(x, 0.0, 0.0)));
    // Its speed is known alone, not that it moves along the wall.
    let slides = Counted(slides.unwrap(), Default::default());
    let mut scene = Scene::new();
    scene.add("far", ball(1.0), Some(0.1)).unwrap();
    scene.set_pose(0, &Pose::translation(0.0, 0.0, 50.0)).unwrap();
    scene.add("floor", floor(1.0), Some(2.0 - 1e-5)).unwrap();
    let answer = scene.clears_motion(&[&slides], RESOLUTION).unwrap();
    assert_eq!(answer.decision, Decision::Undecided);
    assert_eq!((answer.reason, answer.contact), (Some(UndecidedReason::Near), None));
    assert!(answer.interval[0] < answer.interval[1]);
}

/// A motion without a shape at t = 0.
struct WithoutStart(RigidMotion);

impl Motion for WithoutStart {
    fn shape(&self, t: Real, tube: &mut Tube) -> Result<Pose, RobotError> {
        let radius = if t == 0.0 { Real::NAN } else { 0.1 };
        tube.set_samples(&[Vector::ZERO, Vector::Z], &[radius], None)?;
        self.0.shape(t, tube)
    }

    fn speed(&self, section: usize, shares: [Real; 2], times: [Real; 2]) -> Speed {
        self.0.speed(section, shares, times)
    }
}

/// A contact with the surface of a solid is reported although the side at t = 0 is unknown; and
/// then nothing is clear before it.
#[test]
fn a_contact_outweighs_a_start_without_a_shape() {
    let from_to = |from: Real, to: Real, y: Real| {
        let poses = [from, to].map(|x| Pose::translation(x, y, 0.0));
        WithoutStart(RigidMotion::new(needle(Vector::ZERO, Vector::Z, 0.1), poses).unwrap())
    };
    let (through, stays_near) = (from_to(-4.0, 4.0, 0.0), from_to(0.85, 0.9, 0.85));
    for is_solid in [false, true] {
        let mut scene = Scene::new();
        scene.add("organ", ball(1.0), Some(0.3)).unwrap();
        scene.set_solid(0, is_solid).unwrap();
        let answer = scene.clears_motion(&[&through], RESOLUTION).unwrap();
        assert_eq!(answer.decision, Decision::Contact, "{is_solid}");
        let first = scene.time_of_contact(&[&through], RESOLUTION).unwrap();
        assert_eq!(first.decision, Decision::Contact, "{is_solid}");
        // The needle touches the margin when it is 1.4 away, at t = 2.6 / 8.
        assert_eq!(first.interval[0] > 0.3, !is_solid, "{first:?}");
        // Without a contact the error remains. The robot is within the bounding box.
        scene.set_margin(0, Some(0.0)).unwrap();
        assert_eq!(scene.clears_motion(&[&stays_near], RESOLUTION).is_err(), is_solid);
    }
}

#[test]
fn an_error_names_the_robot() {
    let fine = LinearMotion::capsules(&[Vector::ZERO, Vector::Z], &[Vector::X, Vector::Z], &[0.1]);
    let fine = fine.unwrap();
    let sharp = [Vector::X * 9.0, Vector::new(9.0, 0.0, 1.0), Vector::new(9.0, 0.1, 0.0)];
    let sharp = LinearMotion::chain(&sharp, &sharp, &[0.3; 2]).unwrap();
    let mut scene = Scene::new();
    let ask = |scene: &mut Scene, motions: &[&dyn Motion], resolution: Real| {
        scene.clears_motion(motions, resolution).map(|answer| answer.decision)
    };
    assert_eq!(ask(&mut scene, &[&fine], RESOLUTION), Err(SceneError::NoMargin));

    scene.set_self_margin(Some(0.1)).unwrap();
    assert!(matches!(
        ask(&mut scene, &[&fine, &sharp], RESOLUTION),
        Err(SceneError::Robot { robot: 1, error: ProximityError::JointTooSharp { .. }, .. })
    ));
    // The chains of that robot have the same error.
    let points = [Vector::X * 9.0, Vector::new(9.0, 0.0, 1.0), Vector::new(9.0, 0.1, 0.0)];
    let chain = Chain::from_centreline(&points, &[0.3; 2]).unwrap();
    assert!(matches!(
        scene.clears(&[(&chain, Pose::IDENTITY)]),
        Err(SceneError::Robot { robot: 0, error: ProximityError::JointTooSharp { .. }, .. })
    ));

    /// Has two links at first, then three.
    struct Changes;
    impl Motion for Changes {
        fn shape(&self, t: Real, tube: &mut Tube) -> Result<Pose, RobotError> {
            let (middle, end) = (Vector::Z * 0.3, Vector::Z);
            let points =
                [Vector::ZERO, middle, end].map(|point| point + Vector::Y * (4.0 - 4.0 * t));
            let radii = if t == 0.5 { [0.1; 2] } else { [0.2, 0.1] };
            tube.set_samples(&points, &radii, None)?;
            Ok(Pose::IDENTITY)
        }
        fn speed(&self, _: usize, _: [Real; 2], _: [Real; 2]) -> Speed {
            Speed { point: 4.0, turn: 0.0 }
        }
    }
    scene.set_self_margin(None).unwrap();
    scene.set_robot_margin(Some(0.5)).unwrap();
    let changes = ask(&mut scene, &[&fine, &Changes], RESOLUTION);
    let Err(SceneError::Robot { robot: 1, error: ProximityError::Motion(fault), .. }) = changes
    else {
        panic!("{changes:?}")
    };
    assert!(matches!(fault, RobotError::SectionsChange { .. }));

    /// Capsules along z, of this many sections. The last has this speed; no query needs another
    /// speed.
    struct Sections(usize, Real);
    impl Motion for Sections {
        fn shape(&self, t: Real, tube: &mut Tube) -> Result<Pose, RobotError> {
            let across = Vector::Y * (0.6 * (self.0 as Real) + self.1.min(1.0) * t);
            let points: Vec<_> = (0..=self.0).map(|k| across + Vector::Z * k as Real).collect();
            // Different radii: equal ones in a straight line are one section.
            let radii: Vec<_> = (0..self.0).map(|k| 0.1 + 0.01 * k as Real).collect();
            tube.set_samples(&points, &radii, None)?;
            Ok(Pose::IDENTITY)
        }
        fn speed(&self, section: usize, _: [Real; 2], _: [Real; 2]) -> Speed {
            assert!(section < self.0, "a section that the robot does not have");
            Speed { point: if section + 1 == self.0 { self.1 } else { 0.0 }, turn: 0.0 }
        }
    }
    let (short, long) = (Sections(1, 0.0), Sections(3, 1e12));
    for (robots, faster) in [([&short, &long], 1), ([&long, &short], 0)] {
        let too_fast = ask(&mut scene, &robots.map(|robot| robot as &dyn Motion), 1e-9);
        let Err(SceneError::Robot {
            robot, error: ProximityError::TooFast { section, .. }, ..
        }) = too_fast
        else {
            panic!("{too_fast:?}")
        };
        assert_eq!((robot, section), (faster, 2));
    }

    let errors = [-1.0, Real::NAN].map(|resolution| ask(&mut scene, &[&fine], resolution));
    for error in errors {
        assert_eq!(error.map_err(|error| error.kind()), Err("negative"));
    }
    assert!(scene.set_self_margin(Some(-1.0)).is_err());
    // Only the margin to themselves counts for chains, too.
    scene.set_robot_margin(None).unwrap();
    scene.set_self_margin(Some(0.1)).unwrap();
    let hairpin = [[0.0, 0.0], [0.0, 9.0], [1.0, 9.0], [1.0, 0.0]];
    let points = hairpin.map(|[x, z]| Vector::new(x, 0.0, z));
    let chain = Chain::capsules(&points, &[0.2; 3]).unwrap();
    assert_eq!(scene.clears(&[(&chain, Pose::IDENTITY)]), Ok(true));
    scene.set_self_margin(Some(0.7)).unwrap();
    assert_eq!(scene.clears(&[(&chain, Pose::IDENTITY)]), Ok(false));
}
