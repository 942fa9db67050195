//! The first violated margin and the least slack in a scene, and structures that move: against fine
//! steps.

use super::scene_motions::{Asked, Case, Each, Edge, RESOLUTION, STEPS, asked, ball, edges};
use continuum_testing::{Random, rounds};
use parry_continuum::parry::math::{Pose, Real, Rotation, Vector};
use parry_continuum::proximity::{
    BvhSearch, Decision, Proximity, ProximityError, Scene, SceneError, SceneMotionContact,
    ScenePlace, StructureEnd,
};
use parry_continuum::{Chain, LinearMotion, Motion, RigidMotion, Tube};
use std::f64::consts::{FRAC_PI_2, SQRT_2};

fn steps() -> impl Iterator<Item = Real> {
    (0..=STEPS).map(|step| Real::from(step) / Real::from(STEPS))
}

fn place_of(place: &ScenePlace) -> (Asked, Real) {
    match place {
        ScenePlace::Structure { structure, robot, witness, .. } => {
            let apart = (witness.on_robot - witness.on_mesh).length();
            (Asked::Structure(*structure, *robot), apart)
        }
        ScenePlace::Robots { robots, witness, .. } => {
            (Asked::Pair(*robots), (witness.on_first - witness.on_second).length())
        }
        other => panic!("{other:?}"),
    }
}

#[test]
fn the_first_violation_is_the_earliest_of_all_questions() {
    let (mut seen, mut later) = ([0; 3], 0);
    for seed in 0..rounds(600) {
        let random = &mut Random::new(seed);
        let mut case = Case::random(random);
        if case.scene.clears(&[]).is_err() {
            continue;
        }
        let edges = edges(random, 3);
        let motions: Vec<_> = edges.iter().map(Edge::motion).collect();
        let answer = match case.scene.time_of_contact(&motions.each(), RESOLUTION) {
            // A joint that is sharp only for some time.
            Err(SceneError::Robot { error: ProximityError::JointTooSharp { .. }, .. }) => continue,
            answer => answer.unwrap(),
        };
        let any = case.scene.clears_motion(&motions.each(), RESOLUTION).unwrap();
        let [clear_until, t] = answer.interval;
        let mut first = Real::INFINITY;
        for question in case.asked(3) {
            for step in steps() {
                if step >= first {
                    break;
                }
                let (margin, distance) = case.distance(question, &edges, step);
                assert!(step >= clear_until || distance > margin, "{seed}: {question:?} at {step}");
                if distance <= margin {
                    first = step;
                }
            }
        }
        match answer.decision {
            Decision::Clear => assert!(any.is_clear() && first == Real::INFINITY, "{seed}"),
            Decision::Contact => {
                assert_eq!(any.decision, Decision::Contact, "{seed}");
                let contact = answer.contact.unwrap();
                let (found, apart) = asked(&contact);
                let (margin, distance) = case.distance(found, &edges, t);
                assert!(contact.t() == t && distance <= margin + 1e-9, "{seed}");
                assert!(apart <= contact.upper() + 1e-9 && contact.upper() <= margin, "{seed}");
                // The interval is short, but where something grazes before.
                seen[2] += u32::from(t <= first.min(1.0) + 0.02);
                later += u32::from(any.contact.is_some_and(|any| asked(&any).0 != found));
            }
            Decision::Undecided => assert!(first == Real::INFINITY, "{seed}"),
        }
        seen[answer.decision as usize % 2] += 1;
        assert_eq!(case.scene.clone().time_of_contact(&motions.each(), RESOLUTION), Ok(answer));
    }
    let [clear, contact, sharp] = seen;
    assert!(
        clear >= rounds(60) && contact >= rounds(60) && later >= rounds(20),
        "{seen:?} {later}"
    );
    assert!(20 * sharp >= 19 * contact, "{seen:?}");
}

#[test]
fn the_least_slack_of_motions_is_between_its_bounds() {
    let mut seen = [0; 3];
    for seed in 0..rounds(600) {
        let random = &mut Random::new(seed);
        let mut case = Case::random(random);
        let edges = edges(random, 3);
        let motions: Vec<_> = edges.iter().map(Edge::motion).collect();
        let found = case.scene.clearance_of_motion(&motions.each(), 1e-3).unwrap();
        let questions = case.asked(3).into_iter();
        let questions: Vec<_> =
            questions.filter(|asked| !matches!(asked, Asked::Itself(_))).collect();
        let Some(found) = found else {
            assert!(questions.is_empty(), "{seed}");
            continue;
        };
        assert!(found.resolved && found.upper - found.lower <= 1e-3, "{seed}: {found:?}");
        for question in questions {
            for t in steps() {
                let (margin, distance) = case.distance(question, &edges, t);
                assert!(found.lower <= distance - margin + 1e-9, "{seed}: {question:?} at {t}");
            }
        }
        let (place, apart) = place_of(&found.place);
        let (margin, distance) = case.distance(place, &edges, found.t);
        let slack = distance - margin;
        assert!(found.lower - 1e-9 <= slack && slack <= found.upper + 1e-9, "{seed}: {found:?}");
        assert!(apart - margin <= found.upper + 1e-9, "{seed}");
        seen[usize::from(matches!(place, Asked::Pair(_)))] += 1;
        seen[2] += u32::from(found.lower > 0.0);
        let fresh = case.scene.clone().clearance_of_motion(&motions.each(), 1e-3);
        assert_eq!(fresh, Ok(Some(found)), "{seed}");
        let rough = case.scene.clearance_of_motion(&motions.each(), 0.1).unwrap().unwrap();
        assert!(rough.lower <= found.lower && found.upper <= rough.upper, "{seed}");
    }
    assert!(seen.iter().all(|count| *count >= rounds(60)), "{seen:?}");
    let error = Scene::new().clearance_of_motion::<LinearMotion>(&[], Real::NAN);
    assert_eq!(error.map_err(|error| error.kind()), Err("negative"));
}

/// At rest the links of a chain are exact.
#[test]
fn the_least_slack_of_tubes_is_between_its_bounds() {
    let mut seen = [0; 2];
    for seed in 0..rounds(600) {
        let random = &mut Random::new(seed);
        let mut case = Case::random(random);
        let edges = edges(random, 3);
        let tubes: Vec<_> = edges.iter().map(|edge| Tube::from(&edge.chain(0.3))).collect();
        let robots: Vec<_> = tubes.iter().map(|tube| (tube, Pose::IDENTITY)).collect();
        let found = case.scene.clearance(&robots, 1e-3).unwrap();
        let mut least = Real::INFINITY;
        for question in case.asked(3) {
            if !matches!(question, Asked::Itself(_)) {
                let (margin, distance) = case.distance(question, &edges, 0.3);
                least = least.min(distance - margin);
            }
        }
        let Some(found) = found else {
            assert_eq!(least, Real::INFINITY, "{seed}");
            continue;
        };
        assert!(found.resolved && found.upper - found.lower <= 1e-3, "{seed}: {found:?}");
        assert!(found.lower <= least + 1e-9 && least <= found.upper + 1e-9, "{seed}: {least}");
        let (place, _) = place_of(&found.place);
        let (margin, distance) = case.distance(place, &edges, 0.3);
        assert!(distance - margin <= found.upper + 1e-9, "{seed}: {found:?}");
        seen[usize::from(matches!(place, Asked::Pair(_)))] += 1;
        assert_eq!(case.scene.clone().clearance(&robots, 1e-3), Ok(Some(found)), "{seed}");
    }
    assert!(seen.iter().all(|count| *count >= rounds(60)), "{seen:?}");
    let chain = Chain::capsules(&[Vector::ZERO, Vector::Z], &[0.1]).unwrap();
    let (tube, nowhere) = (Tube::from(&chain), Pose::translation(Real::NAN, 0.0, 0.0));
    let error = Scene::new().clearance(&[(&tube, Pose::IDENTITY), (&tube, nowhere)], 1.0);
    assert!(matches!(error, Err(SceneError::Robot { robot: 1, .. })));
}

/// A structure that moves as a whole, or whose vertices move, and where it is at a time.
enum End {
    Pose { from: Pose, turn: Vector, shift: Vector },
    Vertices { pose: Pose, from: Vec<Vector>, to: Vec<Vector> },
}

impl End {
    /// Most structures approach the origin, where the robot is.
    fn random(random: &mut Random, pose: Pose, vertices: &[Vector]) -> Self {
        let way = -pose.translation * random.between(0.0, 1.1) + random.point();
        if random.below(2) == 0 {
            let turn =
                random.direction() * [0.0, random.between(0.0, 3.0)][random.below(2) as usize];
            return Self::Pose { from: pose, turn, shift: way };
        }
        let (size, shift) = (random.between(0.3, 1.5), pose.rotation.inverse() * way);
        let to = vertices.iter().map(|vertex| *vertex * size + shift + random.point() * 0.05);
        Self::Vertices { pose, to: to.collect(), from: vertices.to_vec() }
    }

    fn pose(&self, t: Real) -> Pose {
        match self {
            Self::Pose { from, turn, shift } => Pose::from_parts(
                from.translation + *shift * t,
                from.rotation * Rotation::from_scaled_axis(*turn * t),
            ),
            Self::Vertices { pose, .. } => *pose,
        }
    }

    fn end(&self) -> StructureEnd<'_> {
        match self {
            Self::Pose { .. } => StructureEnd::Pose(self.pose(1.0)),
            Self::Vertices { to, .. } => StructureEnd::Vertices(to),
        }
    }
}

#[test]
fn structures_that_move_are_followed() {
    let mut seen = [[0; 3]; 2];
    for seed in 0..rounds(1200) {
        let random = &mut Random::new(seed);
        let mut case = Case::random(random);
        case.scene.set_robot_margin(None).unwrap();
        case.scene.set_self_margin(None).unwrap();
        // The first structure moves alone.
        let margin = random.between(0.0, 0.5);
        for number in 0..case.organs.len() {
            case.organs[number].1 = (number == 0).then_some(margin);
            case.scene.set_margin(number, case.organs[number].1).unwrap();
        }
        let edge = Edge::random(random);
        let motion = edge.motion();
        let (mut search, _, pose) = case.organs[0].clone();
        let end = End::random(random, pose, search.vertices());
        let answer =
            case.scene.clears_motion_while(&[(0, end.end())], &[&motion], RESOLUTION).unwrap();
        let mut distance = |t: Real| {
            if let End::Vertices { from, to, .. } = &end {
                let moved = from.iter().zip(to).map(|(from, to)| from.lerp(*to, t));
                search.set_vertices(&moved.collect::<Vec<_>>()).unwrap();
            }
            search.minimum(&edge.chain(t), &end.pose(t).inverse()).unwrap().distance
        };
        let kind = usize::from(matches!(end, End::Vertices { .. }));
        seen[kind][answer.decision as usize] += 1;
        match answer.decision {
            Decision::Clear => {
                for t in steps() {
                    assert!(distance(t) > margin, "{seed}: {t}");
                }
            }
            Decision::Contact => {
                let Some(SceneMotionContact::Structure { structure: 0, robot: 0, shape, .. }) =
                    answer.contact
                else {
                    panic!("{answer:?}")
                };
                assert!(distance(shape.t) <= margin + 1e-9, "{seed}: {answer:?}");
                // The witness is on the structure where it is then, in the scene's frame.
                let local = end.pose(shape.t).inverse() * shape.witness.on_mesh;
                let point = [local, local + Vector::X * 1e-9];
                let point = Chain::capsules(&point, &[1e-9]).unwrap();
                let off = search.minimum(&point, &Pose::IDENTITY).unwrap().distance;
                assert!(off < 1e-8, "{seed}: {off}");
            }
            Decision::Undecided => {}
        }
    }
    for kind in seen {
        assert!(kind[0] >= rounds(400) && kind[1] >= rounds(40), "{seen:?}");
    }
}

/// An organ passes the robot in the middle of its way: neither end shows it.
#[test]
fn an_organ_that_passes_in_between_is_found() {
    let chain = Chain::capsules(&[Vector::ZERO, Vector::Z], &[0.1]).unwrap();
    let at_rest = RigidMotion::new(Tube::from(&chain), [Pose::IDENTITY; 2]).unwrap();
    let mut scene = Scene::new();
    scene.add("organ", ball(0.5), Some(0.1)).unwrap();
    let mut ask = |from: Pose, to: Pose| {
        scene.set_pose(0, &from).unwrap();
        let ends = [(0, StructureEnd::Pose(to))];
        let motions: [&dyn Motion; 1] = [&at_rest];
        scene.clears_motion_while(&ends, &motions, RESOLUTION).unwrap().decision
    };
    let at = |x: Real, y: Real| Pose::translation(x, y, 0.5);
    assert_eq!(ask(at(-9.0, 0.0), at(9.0, 0.0)), Decision::Contact);
    assert_eq!(ask(at(-9.0, 1.0), at(9.0, 1.0)), Decision::Clear);
    // Half a turn about an axis through the mesh's own origin sweeps nothing.
    let turned = Pose::from_parts(Vector::new(0.0, 1.0, 0.5), Rotation::from_rotation_x(3.1));
    assert_eq!(ask(at(0.0, 1.0), turned), Decision::Clear);
    let nowhere = [(0, StructureEnd::Pose(at(Real::NAN, 0.0)))];
    let error = scene.clears_motion_while(&nowhere, &[&at_rest], 1e-3).unwrap_err();
    assert!(matches!(error, SceneError::Structure { .. }));
    assert!(error.to_string().contains("`: the pose is not finite"), "{error}");
    assert!(matches!(
        scene.clears_motion_while(&[(0, StructureEnd::Vertices(&[]))], &[&at_rest], 1e-3),
        Err(SceneError::Structure { .. })
    ));
    assert!(matches!(
        scene.clears_motion_while(&[(4, StructureEnd::Vertices(&[]))], &[&at_rest], 1e-3),
        Err(SceneError::NoSuchStructure { structure: 4, .. })
    ));
}

/// A long bar turns past a robot at rest: its tip comes near between both ends of the motion only.
#[test]
fn a_bar_that_turns_past_is_found() {
    // The tip is at 5 (cos a, sin a). The robot is a needle of radius 0.1 at an angle of pi / 4.
    let bar = [Vector::ZERO, Vector::new(5.0, 0.0, 0.0), Vector::new(5.0, 0.0, 1.0)];
    let mut scene = Scene::new();
    scene.add("bar", BvhSearch::from_triangles(&bar, &[[0, 1, 2]]).unwrap(), Some(0.1)).unwrap();
    let ends = [(0, StructureEnd::Pose(Pose::rotation(Vector::Z * FRAC_PI_2)))];
    for (from_axis, decision) in [(4.5, Decision::Contact), (5.21, Decision::Clear)] {
        let place = Vector::new(from_axis, from_axis, 0.0) / SQRT_2;
        let chain = Chain::capsules(&[place, place + Vector::Z], &[0.1]).unwrap();
        let at_rest = RigidMotion::new(Tube::from(&chain), [Pose::IDENTITY; 2]).unwrap();
        let motions: [&dyn Motion; 1] = [&at_rest];
        let answer = scene.clears_motion_while(&ends, &motions, 1e-3).unwrap();
        assert_eq!(answer.decision, decision, "{from_axis}");
        if let Some(SceneMotionContact::Structure { shape, .. }) = answer.contact {
            // Angles whose bar is at most radius and margin away from the needle's axis.
            let half = (0.2 / from_axis).asin() / FRAC_PI_2;
            assert!((shape.t - 0.5).abs() <= half + 1e-3, "{}", shape.t);
            let on_mesh = shape.witness.on_mesh;
            let angle = on_mesh.y.atan2(on_mesh.x);
            assert!((angle - shape.t * FRAC_PI_2).abs() < 1e-9, "{on_mesh}");
        }
    }
}
