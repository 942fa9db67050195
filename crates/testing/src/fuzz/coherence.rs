//! One engine in a long loop, beside a fresh engine for each query. Earlier queries and moved
//! vertices change no answer, and a margin has one meaning everywhere.

use super::source::Source;
use crate::WarmAndFresh;
use parry_continuum::parry::math::{Pose, Vector};
use parry_continuum::parry::shape::TriMesh;
use parry_continuum::proximity::{BvhSearch, Decision, Exhaustive, LinkProximity, Proximity};
use parry_continuum::{Chain, Tube};

/// A moving mesh, two robots, the number of the queried robot, and that robot's pose.
#[derive(Debug)]
struct Scene {
    vertices: Vec<Vector>,
    indices: Vec<[u32; 3]>,
    robots: [Chain; 2],
    robot: usize,
    pose: Pose,
}

impl Scene {
    fn mesh(&self) -> Option<TriMesh> {
        TriMesh::new(self.vertices.clone(), self.indices.clone()).ok()
    }

    fn problem(&self) -> String {
        let robot = &self.robots[self.robot];
        format!("\n{robot:?}\n{:?}\n{:?} {:?}", self.pose, self.vertices, self.indices)
    }
}

/// Runs a sequence of changes, mostly tiny, and of queries.
pub fn coherence(bytes: &[u8]) {
    let mut source = Source::new(bytes);
    let (vertices, indices) = source.wall();
    let (Some(first), Some(second)) = (source.chain(), source.chain()) else { return };
    let mut scene =
        Scene { vertices, indices, robots: [first, second], robot: 0, pose: source.pose() };
    let Some(search) = scene.mesh().and_then(|mesh| BvhSearch::new(&mesh).ok()) else { return };
    let mut both = WarmAndFresh::new(search);
    for _ in 0..2 + source.below(10) {
        change(&mut source, &mut scene, &mut both.warm);
        let Some(mesh) = scene.mesh() else { return };
        let Ok(fresh) = BvhSearch::new(&mesh) else { return };
        both.fresh = fresh;
        ask(&mut source, &scene, &mut both, &mesh);
    }
}

fn change(source: &mut Source, scene: &mut Scene, search: &mut BvhSearch) {
    match source.below(8) {
        0..3 => scene.pose = source.nudged(scene.pose),
        3 => {
            let before = scene.vertices.clone();
            let way = source.point();
            match source.below(3) {
                0 => scene.vertices.iter_mut().for_each(|vertex| *vertex += way),
                1 => scene.vertices.iter_mut().step_by(3).for_each(|vertex| vertex.z *= 0.5),
                _ => scene.vertices[0] = way,
            }
            // A refused change has no effect.
            if search.set_vertices(&scene.vertices).is_err() {
                scene.vertices = before;
            }
        }
        4 => scene.robot = 1 - scene.robot,
        5 => *search = search.clone(),
        6 => search.forget(),
        // No change: the same query again.
        _ => {}
    }
}

/// Runs queries on both engines and asserts equal answers.
fn ask(source: &mut Source, scene: &Scene, both: &mut WarmAndFresh<BvhSearch>, mesh: &TriMesh) {
    let (robot, pose) = (&scene.robots[scene.robot], &scene.pose);
    let problem = || scene.problem();
    let Ok(each) = both.ask(scene, |search| {
        let mut each = Vec::new();
        search.per_link(robot, pose, &mut each).map(|()| each)
    }) else {
        assert!(both.warm.minimum(robot, pose).is_err(), "{}", problem());
        return;
    };
    let nearer = |least: LinkProximity, link: &LinkProximity| {
        let (one, other) =
            ((least.distance, least.witness.triangle), (link.distance, link.witness.triangle));
        if other < one { *link } else { least }
    };
    let least =
        each.iter().copied().reduce(|least, link| nearer(least, &link)).expect("a robot has links");
    assert_eq!(both.ask(scene, |search| search.minimum(robot, pose)).as_ref(), Ok(&least));
    let mut exhaustive = Exhaustive::<f32>::new(mesh).expect("a mesh as before");
    assert_eq!(exhaustive.minimum(robot, pose).as_ref(), Ok(&least), "exhaustive{}", problem());

    let distance = least.distance;
    let margin = match source.below(12) {
        0 => f64::INFINITY,
        1 => f64::MAX,
        2 => -0.0,
        3 => -1.0,
        4 => f64::NAN,
        5 => distance,
        6 => distance.next_up(),
        7 => distance.next_down(),
        8 => 2.0 * distance,
        _ => source.number(),
    };
    for _ in 0..2 {
        match both.ask(scene, |search| search.clears(robot, pose, margin)) {
            Ok(clears) => {
                assert!(
                    margin >= 0.0 && clears == (distance > margin),
                    "{margin} {distance}{}",
                    problem()
                )
            }
            Err(_) => assert!(margin.is_nan() || margin < 0.0, "clears {margin}{}", problem()),
        }
        match both.ask(scene, |search| search.minimum_within(robot, pose, margin)) {
            Ok(Some(found)) => {
                assert!(found == least && distance <= margin, "{margin} {found:?}{}", problem())
            }
            Ok(None) => {
                assert!(distance > margin, "nothing within {margin}, but {distance}{}", problem())
            }
            Err(_) => {
                assert!(margin.is_nan() || margin < 0.0, "minimum within {margin}{}", problem())
            }
        }
    }
    let found = both.ask(scene, |search| {
        let mut contacts = Vec::new();
        search.contacts_within(robot, pose, margin, 0.0, &mut contacts).map(|()| contacts)
    });
    assert_eq!(found.is_ok(), margin >= 0.0, "within {margin}{}", problem());
    let contacts = found.unwrap_or_default();
    assert!(
        contacts.iter().all(|contact| contact.distance <= margin),
        "beyond {margin}{}",
        problem()
    );
    if distance <= margin && margin >= 0.0 {
        let nearest = contacts.iter().map(|contact| contact.distance).fold(f64::INFINITY, f64::min);
        assert_eq!(nearest, distance, "within {margin}{}", problem());
    }

    let places: Vec<_> = (0..source.below(4)).map(|_| (robot, source.nudged(*pose))).collect();
    let mut batch = Vec::new();
    if both.warm.minimum_batch(&places, &mut batch).is_ok() {
        for ((robot, place), answer) in places.iter().zip(&batch) {
            assert_eq!(both.fresh.minimum(robot, place), *answer, "{place:?}{}", problem());
        }
    }
    tube(both, scene, distance, margin);
}

/// Asserts that the bounds of a chain's tube contain the chain's distance, at poses without
/// rounding.
fn tube(both: &mut WarmAndFresh<BvhSearch>, scene: &Scene, distance: f64, margin: f64) {
    let tube = Tube::from(&scene.robots[scene.robot]);
    if scene.pose != Pose::IDENTITY {
        return;
    }
    let tolerance = 1e-3 * tube.length();
    for _ in 0..2 {
        if let Ok(found) = both.ask(scene, |search| search.clearance(&tube, &scene.pose, tolerance))
        {
            let holds = found.lower <= distance && distance <= found.upper;
            assert!(holds, "{found:?} for {distance}{}", scene.problem());
        }
        match both.ask(scene, |search| search.clears_tube(&tube, &scene.pose, margin, tolerance)) {
            Ok(Decision::Clear) => {
                assert!(distance > margin, "clear of {margin} at {distance}{}", scene.problem())
            }
            Ok(Decision::Contact) => {
                assert!(distance <= margin, "within {margin} at {distance}{}", scene.problem())
            }
            _ => {}
        }
    }
}
