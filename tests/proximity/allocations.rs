//! A control loop allocates nothing once it runs: centreline, chain, queries, contacts.

use continuum_demo::{ctr, ventricle};
use continuum_testing::answered;
use parry_continuum::parry::math::{Pose, Real, Vector};
use parry_continuum::parry::shape::{Ball, TriMesh};
use parry_continuum::proximity::{BvhSearch, Exhaustive, Proximity, RobotPair, Scene, SelfQuery};
use parry_continuum::{
    BendingMotion, BendingSection, Chain, LinearMotion, Motion, RigidMotion, RobotError, Speed,
    Tube, simplify,
};
use std::cell::Cell;

/// A robot that sways.
fn sway(points: &[Vector], tick: u32, moved: &mut Vec<Vector>) {
    let swing = 0.02 * f64::from(tick % 50);
    moved.clear();
    moved.extend(points.iter().map(|&point| point + Vector::new(swing * point.z * 0.1, 0.0, 0.0)));
}

/// How often a loop allocates after its first rounds.
fn steady_state(mut tick: impl FnMut(u32)) -> u64 {
    (0..100).for_each(&mut tick);
    allocation_counter::measure(|| (100..200).for_each(&mut tick)).count_total
}

#[test]
fn a_control_loop_allocates_nothing() {
    let (vertices, indices) = ventricle::mesh(6_000);
    let mesh = TriMesh::new(vertices, indices).unwrap();
    let line = ctr::three_tubes().centreline(&ventricle::goal(), 30);
    let (base, pose) = (ventricle::entry(), Pose::IDENTITY);
    let points: Vec<_> = line.points.iter().map(|&point| base * point).collect();
    let mut chain = Chain::from_centreline(&points, &line.radii).unwrap();
    let (mut moved, mut answers, mut contacts) = (Vec::new(), Vec::new(), Vec::new());

    let mut search = BvhSearch::new(&mesh).unwrap();
    let mut seen = Vec::new();
    let search = steady_state(|tick| {
        sway(&points, tick, &mut moved);
        chain.set_centreline(&moved, &line.radii).unwrap();
        let least = search.minimum(&chain, &pose).unwrap();
        search.per_link(&chain, &pose, &mut answers).unwrap();
        search.clears(&chain, &pose, 0.5).unwrap();
        search.clears_inside(&chain, &pose, 0.5).unwrap();
        search.contacts_within(&chain, &pose, 3.0, 0.1, &mut contacts).unwrap();
        assert!(!contacts.is_empty());
        search.contacts_within(&chain, &pose, 3.0, 0.0, &mut contacts).unwrap();
        assert!(contacts.len() > 1 && search.contact_of(&chain, &pose, &least).is_ok());
        if tick < 50 {
            seen.push(least.distance);
        }
    });
    assert_eq!(search, 0);
    seen.dedup();
    assert_eq!(seen.len(), 50, "the robot moves");

    // One thread: waking others may allocate.
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    let mut exhaustive = Exhaustive::<f32>::new(&mesh).unwrap();
    let exhaustive = pool.install(|| {
        steady_state(|tick| {
            sway(&points, tick, &mut moved);
            chain.set_centreline(&moved, &line.radii).unwrap();
            exhaustive.minimum(&chain, &pose).unwrap();
        })
    });
    assert_eq!(exhaustive, 0);

    // The counter counts.
    assert!(steady_state(|_| drop(simplify(&points, &line.radii, 0.1))) > 100);
}

/// A chain that is filled again equals a new chain, and stays unchanged if the new line is bad.
#[test]
fn two_robots_and_a_scene_allocate_nothing() {
    let (vertices, indices) = ventricle::mesh(6_000);
    let line = ctr::three_tubes().centreline(&ventricle::goal(), 30);
    let (base, mut moved) = (ventricle::entry(), Vec::new());
    let mut chain = Chain::from_centreline(&line.points, &line.radii).unwrap();
    let other = chain.clone();
    let mut scene = Scene::new();
    for (name, margin) in [("wall", Some(0.5)), ("target", None), ("vessel", Some(0.1))] {
        scene.add(name, BvhSearch::from_triangles(&vertices, &indices).unwrap(), margin).unwrap();
    }
    scene.set_robot_margin(Some(0.2)).unwrap();
    let (mut pair, mut own) = (RobotPair::new(), SelfQuery::new());
    let (mut places, mut walls, mut contacts) = (Vec::new(), Vec::new(), Vec::new());
    let allocated = steady_state(|tick| {
        sway(&line.points, tick, &mut moved);
        chain.set_centreline(&moved, &line.radii).unwrap();
        let there = Pose::from_translation(Vector::X * 4.0) * base;
        pair.minimum(&chain, &base, &other, &there).unwrap();
        pair.per_link(&chain, &base, &other, &there, &mut places).unwrap();
        pair.contacts_within(&chain, &base, &other, &there, 5.0, &mut places).unwrap();
        pair.clears(&chain, &base, &other, &there, 0.5).unwrap();
        own.minimum(&chain).unwrap();
        own.clears(&chain, 0.5).unwrap();
        let robots = [(&chain, base), (&other, there)];
        scene.clears(&robots).unwrap();
        assert!(scene.tightest(&robots).unwrap().is_some());
        scene.per_structure(&robots, &mut walls).unwrap();
        scene.contacts_within(&robots, 1.0, 0.0, &mut contacts).unwrap();
    });
    assert_eq!(allocated, 0);
}

#[test]
fn a_chain_is_filled_again() {
    let lines = [
        (
            vec![[0.0, 0.0, 0.0], [0.0, 0.0, 3.0], [1.0, 0.0, 5.0], [1.0, 1.0, 9.0]],
            vec![1.25, 0.5, 0.5],
        ),
        (
            vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 0.0, 0.0], [2.0, 0.5, 0.0]],
            vec![0.2, 0.9, 0.2],
        ),
        (vec![[5.0, 0.0, 0.0], [5.0, 2.0, 0.0]], vec![0.1]),
    ];
    let line = |number: usize| -> (Vec<Vector>, &[f64]) {
        (lines[number].0.iter().map(|&point| Vector::from_array(point)).collect(), &lines[number].1)
    };
    let (points, radii) = line(0);
    let mut chain = Chain::from_centreline(&points, radii).unwrap();
    for number in [1, 2, 0, 2, 1] {
        let (points, radii) = line(number);
        let anew = Chain::from_centreline(&points, radii).unwrap();
        chain.set_centreline(&points, radii).unwrap();
        assert_eq!(chain, anew);
        assert_eq!(chain.local_aabb(), anew.local_aabb());
        assert!(chain.set_centreline(&points[..1], radii).is_err());
        assert!(chain.set_centreline(&vec![Vector::X; points.len()], radii).is_err());
        assert_eq!(chain, anew);
    }
}

/// Samples, tube, clearance and decision.
#[test]
fn a_control_loop_about_a_tube_allocates_nothing() {
    let (vertices, indices) = ventricle::mesh(6_000);
    let mesh = TriMesh::new(vertices, indices).unwrap();
    let line = ctr::three_tubes().centreline(&ventricle::goal(), 200);
    let (base, pose) = (ventricle::entry(), Pose::IDENTITY);
    let points: Vec<_> = line.points.iter().map(|&point| base * point).collect();
    let mut tube = Tube::from_samples(&points, &line.radii, None).unwrap();
    let (mut search, mut moved, mut seen) =
        (BvhSearch::new(&mesh).unwrap(), Vec::new(), Vec::new());
    let allocated = steady_state(|tick| {
        sway(&points, tick, &mut moved);
        tube.set_samples(&moved, &line.radii, None).unwrap();
        let found = search.clearance(&tube, &pose, 0.05).unwrap();
        search.clears_tube(&tube, &pose, 0.5, 0.05).unwrap();
        if tick < 50 {
            seen.push(found.upper);
        }
    });
    assert_eq!(allocated, 0);
    seen.dedup();
    assert!(seen.len() > 10, "the robot moves");
}

/// Samples in pairs, far from one another: in a straight tube nothing is known between two pairs,
/// in one that bends it is.
#[test]
fn a_tube_that_begins_to_bend_allocates_nothing() {
    let places: Vec<_> =
        (0..40).flat_map(|k| [0.0, 0.1].map(|off| 3.0 * f64::from(k) + off)).collect();
    let radii = vec![0.5; places.len() - 1];
    let (mut tube, mut points) =
        (Tube::from(&Chain::capsules(&[Vector::ZERO, Vector::Z], &[0.5]).unwrap()), Vec::new());
    let mut curve = |tick: u32| {
        let curvature: f64 = if tick < 100 { 0.0 } else { 1e-4 * f64::from(tick) };
        points.clear();
        points.extend(places.iter().map(|&s| {
            let (sin, cos) = (curvature * s).sin_cos();
            if curvature > 0.0 {
                Vector::new(1.0 - cos, 0.0, sin) / curvature
            } else {
                Vector::Z * s
            }
        }));
        tube.set_samples(&points, &radii, None).unwrap();
    };
    assert_eq!(steady_state(&mut curve), 0);
}

/// A motion that counts its shapes.
struct Counted<M>(M, Cell<u64>);

impl<M: Motion> Motion for Counted<M> {
    fn shape(&self, t: Real, tube: &mut Tube) -> Result<Pose, RobotError> {
        self.1.set(self.1.get() + 1);
        self.0.shape(t, tube)
    }

    fn speed(&self, section: usize, shares: [Real; 2], times: [Real; 2]) -> Speed {
        self.0.speed(section, shares, times)
    }
}

/// Allocations of a planner that tests edge after edge, and the number of shapes that it tests.
fn planner(search: &mut BvhSearch, edges: Vec<impl Motion>) -> [u64; 2] {
    let edges: Vec<_> = edges.into_iter().map(|edge| Counted(edge, Cell::new(0))).collect();
    let mut round = || {
        edges.iter().for_each(|edge| {
            search.clears_motion(edge, 0.3, 1e-2).unwrap();
            search.time_of_contact(edge, 0.3, 1e-2).unwrap();
        });
    };
    round();
    edges.iter().for_each(|edge| edge.1.set(0));
    let allocated = allocation_counter::measure(round).count_total;
    [allocated, edges.iter().map(|edge| edge.1.get()).sum()]
}

/// Whole edges, proven or not.
#[test]
fn motions_are_judged_in_memory_that_is_used_again() {
    let (vertices, indices) = ventricle::mesh(6_000);
    let mut search = BvhSearch::new(&TriMesh::new(vertices, indices).unwrap()).unwrap();
    let line = ctr::three_tubes().centreline(&ventricle::goal(), 60);
    let base = ventricle::entry();
    let points: Vec<_> = line.points.iter().map(|&point| base * point).collect();
    let shifts: Vec<_> = (0..20).map(|k| Vector::X * (0.1 * f64::from(k))).collect();

    let moved = |shift: &Vector| points.iter().map(|point| point + shift).collect::<Vec<_>>();
    let edges = shifts
        .iter()
        .map(|shift| LinearMotion::chain(&points, &moved(shift), &line.radii).unwrap());
    let [allocated, shapes] = planner(&mut search, edges.collect());
    assert!(allocated == 0 && shapes > 100, "{allocated} {shapes}");

    let tube = Tube::from_samples(&line.points, &line.radii, None).unwrap();
    let edge = |shift: &Vector| {
        let to = Pose::from_parts(base.translation + shift, base.rotation);
        RigidMotion::new(tube.clone(), [base, to]).unwrap()
    };
    let [allocated, shapes] = planner(&mut search, shifts.iter().map(edge).collect());
    assert!(allocated == 0 && shapes > 100, "{allocated} {shapes}");

    let section =
        |length: f64, bend: f64| BendingSection { length, radius: 0.8, bend: [bend, 0.01] };
    let edge = |shift: &Vector| {
        let sections = [
            [section(8.0, 0.01), section(6.0, 0.02)],
            [section(9.0, 0.02), section(7.0, 0.02 * shift.x)],
        ];
        BendingMotion::new(&sections[0], &sections[1], base).unwrap()
    };
    let [allocated, shapes] = planner(&mut search, shifts.iter().map(edge).collect());
    assert!(allocated <= 12 * shapes && shapes > 40, "{allocated} {shapes}");
}

/// A robot of this many links that wind through the ball of radius 1.
fn long_robot(links: u32, turn: f64) -> Chain {
    let point = |k: u32| {
        let (sin, cos) = (turn + 0.3 * f64::from(k)).sin_cos();
        Vector::new(0.3 * cos, 0.3 * sin, f64::from(k) / f64::from(links) - 0.5)
    };
    Chain::capsules(&(0..=links).map(point).collect::<Vec<_>>(), &vec![0.01; links as usize])
        .unwrap()
}

/// The memory of an exhaustive engine does not grow with the robots per thread of a batch, or with
/// the near pairs of links and triangles.
#[test]
fn an_exhaustive_engine_keeps_little_at_once() {
    let ball = |rows: u32, columns: u32| {
        let (vertices, indices) = Ball::new(1.0).to_trimesh(rows, columns);
        TriMesh::new(vertices, indices).unwrap()
    };
    let mesh = ball(16, 8);
    let robots: Vec<_> = (0..100).map(|turn| long_robot(20, f64::from(turn))).collect();
    let batch: Vec<_> = (0..4000).map(|k| (&robots[k % 100], Pose::IDENTITY)).collect();
    let (mut each, mut least, mut clears) = (Vec::new(), Vec::new(), Vec::new());
    let pool = rayon::ThreadPoolBuilder::new().num_threads(16).build().unwrap();
    let kept = pool.install(|| {
        let mut engine = Exhaustive::<f32>::new(&mesh).unwrap();
        engine.clears_batch(&batch[..1], 0.1, &mut clears).unwrap();
        allocation_counter::measure(|| {
            engine.clears_batch(&batch, 0.1, &mut clears).unwrap();
            engine.minimum_batch(&batch, &mut least).unwrap();
        })
    });
    assert!(kept.bytes_max < 16 << 20, "{} bytes for {} robots", kept.bytes_max, batch.len());
    // Robots that are answered together with others than their neighbours are answered alike.
    let mut engine = Exhaustive::<f32>::new(&mesh).unwrap();
    engine.per_link_batch(&batch, &mut each).unwrap();
    let (each, least, clears) = (answered(&each), answered(&least), answered(&clears));
    assert!(each.len() == batch.len() && least.len() == batch.len() && clears.len() == batch.len());
    for (place, answers) in each.iter().enumerate() {
        assert!(least[place] == least[place % 100] && *answers == each[place % 100]);
        assert!(answers.len() == 20 && answers.contains(&least[place]));
        assert!(clears[place] == (least[place].distance > 0.1));
    }
    // A robot without an answer does not change the others' answers.
    let mut refused = batch.clone();
    refused[2000].1.translation.x = f64::NAN;
    let (mut others, mut theirs, mut kept) = (Vec::new(), Vec::new(), Vec::new());
    engine.per_link_batch(&refused, &mut others).unwrap();
    engine.minimum_batch(&refused, &mut theirs).unwrap();
    engine.clears_batch(&refused, 0.1, &mut kept).unwrap();
    for place in 0..batch.len() {
        let is_refused = others[place].is_err() && theirs[place].is_err() && kept[place].is_err();
        assert_eq!(is_refused, place == 2000);
        let is_same = || {
            others[place].as_ref() == Ok(&each[place])
                && theirs[place] == Ok(least[place])
                && kept[place] == Ok(clears[place])
        };
        assert!(is_refused || is_same(), "{place}");
    }

    let (mesh, robot, mut contacts) = (ball(100, 60), long_robot(120, 0.0), Vec::new());
    assert!(mesh.indices().len() * robot.links().len() > 1_300_000);
    let mut engine = Exhaustive::<f32>::new(&mesh).unwrap();
    let one = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    let kept = one.install(|| {
        allocation_counter::measure(|| {
            engine
                .contacts_within(&robot, &Pose::IDENTITY, f64::INFINITY, 0.0, &mut contacts)
                .unwrap();
        })
    });
    assert!(kept.bytes_max < 20 << 20, "{} bytes for all pairs", kept.bytes_max);
    let (mut expected, mut search) = (Vec::new(), BvhSearch::new(&mesh).unwrap());
    search.contacts_within(&robot, &Pose::IDENTITY, f64::INFINITY, 0.0, &mut expected).unwrap();
    assert!(contacts.len() >= 120 && contacts == expected);
}

/// All places of two robots take as much memory as the robots and the places, and some megabytes,
/// however many pairs of links are within the margin.
#[test]
fn places_of_two_robots_take_little_memory() {
    let wave = |turn: f64| {
        let points: Vec<_> = (0..=700)
            .map(|k| f64::from(k) * 0.1)
            .map(|s| Vector::new((s * turn).sin(), (s * 0.7).cos(), 0.5 * s))
            .collect();
        Chain::capsules(&points, &[0.01; 700]).unwrap()
    };
    let (a, b, away) = (wave(1.0), wave(1.3), Pose::translation(9.0, 0.0, 0.0));
    let (mut pair, mut places) = (RobotPair::new(), Vec::new());
    let memory = allocation_counter::measure(|| {
        pair.contacts_within(&a, &Pose::IDENTITY, &b, &away, 1000.0, &mut places).unwrap();
    });
    assert!(places.len() > 10, "{}", places.len());
    // 490,000 pairs, each of 88 bytes as an answer.
    assert!(memory.bytes_max < 16 << 20, "{} bytes", memory.bytes_max);
}
