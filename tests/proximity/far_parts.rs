//! A vertex, a triangle or a robot far out does not change answers or their cost.

use crate::agreement::{UNIT, engines};
use continuum_testing::Random;
use parry_continuum::parry::math::{Pose, Vector};
use parry_continuum::parry::query::QueryDispatcher;
use parry_continuum::parry::shape::{Ball, TriMesh};
use parry_continuum::proximity::{BvhSearch, Exhaustive, Proximity, Work};
use parry_continuum::{Chain, ContinuumDispatcher};

/// The cylinder ends 2 above the triangle's plane and reaches 5 through it.
fn pierced(far: f64, is_used: bool) -> (TriMesh, Chain) {
    let (a, b, c) =
        (Vector::new(-9.0, -9.0, 3.0), Vector::new(9.0, -9.0, 3.0), Vector::new(0.0, 9.0, 3.0));
    let mut triangles = vec![[0, 1, 2]];
    if is_used {
        triangles.push([3, 3, 3]);
    }
    let mesh = TriMesh::new(vec![a, b, c, Vector::new(far, 0.0, 0.0)], triangles).unwrap();
    (mesh, Chain::cylinders(&[Vector::ZERO, Vector::new(0.0, 0.0, 5.0)], &[0.5]).unwrap())
}

#[test]
fn a_far_vertex_does_not_hide_a_near_triangle() {
    for (exponent, is_used) in
        (0..=149).step_by(7).flat_map(|exponent| [(exponent, false), (exponent, true)])
    {
        let (mesh, robot) = pierced(10.0_f64.powi(exponent), is_used);
        for (name, mut engine) in engines(&mesh) {
            let mut answers = Vec::new();
            engine.per_link(&robot, &Pose::IDENTITY, &mut answers).unwrap();
            assert_eq!(
                (answers[0].distance, answers[0].witness.triangle),
                (0.0, 0),
                "{name}, 1e{exponent}, {is_used}"
            );
            assert_eq!(
                engine.minimum(&robot, &Pose::IDENTITY).unwrap().distance,
                0.0,
                "{name}, 1e{exponent}"
            );
            assert!(!engine.clears(&robot, &Pose::IDENTITY, 0.0).unwrap(), "{name}, 1e{exponent}");
            // A gap of 0.5 beside the cylinder's end.
            let beside = Pose::from_translation(Vector::new(0.0, 0.0, 3.5));
            engine.per_link(&robot, &beside, &mut answers).unwrap();
            assert!(
                (answers[0].distance - 0.5).abs() <= 16.0 * UNIT * 18.0,
                "{name}, 1e{exponent}: {answers:?}"
            );
        }
        let dispatcher = ContinuumDispatcher::default();
        let near = dispatcher.distance(&Pose::IDENTITY, &robot, &mesh).unwrap();
        assert_eq!(near.distance, 0.0, "dispatcher, 1e{exponent}, {is_used}");
    }
}

/// A ball of 100 with what is put beside it, and a bent robot inside it.
fn ball_with(far: Option<(Vector, bool)>) -> TriMesh {
    let (mut vertices, mut triangles) = Ball::new(100.0).to_trimesh(100, 50);
    if let Some((point, is_used)) = far {
        vertices.push(point);
        if is_used {
            let far = vertices.len() as u32 - 1;
            triangles.push([0, 1, far]);
        }
    }
    TriMesh::new(vertices, triangles).unwrap()
}

fn robot(random: &mut Random) -> Chain {
    let mut points = vec![Vector::new(0.0, 0.0, 60.0)];
    for _ in 0..30 {
        let last = points[points.len() - 1];
        points.push(last + Vector::new(random.between(-1.0, 1.0), random.between(-1.0, 1.0), 1.3));
    }
    Chain::from_centreline(&points, &[1.0; 30]).unwrap()
}

/// How much the queries of all kinds compute.
fn work(mesh: &TriMesh, robot: &Chain, pose: &Pose) -> [(&'static str, Work); 2] {
    let mut answers = Vec::new();
    let mut search = BvhSearch::new(mesh).unwrap();
    search.per_link(robot, pose, &mut answers).unwrap();
    search.minimum(robot, pose).unwrap();
    search.clears(robot, pose, 0.5).unwrap();
    let mut exhaustive = Exhaustive::<f32>::new(mesh).unwrap();
    exhaustive.per_link(robot, pose, &mut answers).unwrap();
    exhaustive.minimum(robot, pose).unwrap();
    exhaustive.clears(robot, pose, 0.5).unwrap();
    [("search", search.work()), ("exhaustive", exhaustive.work())]
}

/// In single precision alone, nearly every triangle of such a scene would be measured.
#[test]
fn what_is_far_away_does_not_make_queries_slow() {
    let mut random = Random::new(31);
    let robot = robot(&mut random);
    let plain = work(&ball_with(None), &robot, &Pose::IDENTITY);
    let far_pose = Pose::from_translation(Vector::new(6e6, 3e6, 8e6));
    let far_vertex = Vector::new(3e8, 1e9, -2e8);
    let scenes = [
        ("a vertex that no triangle uses", ball_with(Some((far_vertex, false))), Pose::IDENTITY),
        ("a triangle", ball_with(Some((Vector::new(1e5, 1e7, 2e6), true))), Pose::IDENTITY),
        ("the robot", ball_with(None), far_pose),
    ];
    for (what, mesh, pose) in scenes {
        for ((name, plain), (_, far)) in plain.iter().zip(work(&mesh, &robot, &pose)) {
            // Of the robot far away all triangles are as near within the rounding of its place.
            let measured =
                if what == "the robot" { 40 * plain.measured } else { 3 * plain.measured };
            assert!(far.nodes <= 4 * plain.nodes, "{name}, {what}: {far:?} and {plain:?}");
            assert!(far.measured <= measured, "{name}, {what}: {far:?} and {plain:?}");
        }
    }
}

/// So far out that the ends of links are rounded to a grid, each on its own: links may leave the
/// line between base and tip.
#[test]
fn robots_far_out_clear_exactly_what_their_distance_exceeds() {
    let (mut off, mut clear) = (0, 0);
    for seed in 0..3000 {
        let random = &mut Random::new(seed);
        let far = 2.0_f64.powi(30 + random.below(13) as i32);
        let grid = far * f64::EPSILON;
        let points: Vec<_> = (0..=2 + random.below(6))
            .map(|k| Vector::new(random.between(-1.0, 1.0) * grid, 0.0, 0.3 * f64::from(k)))
            .collect();
        let robot = Chain::capsules(&points, &vec![0.1; points.len() - 1]).unwrap();
        let place = Vector::X * far;
        let corners = [[-0.75, -0.5], [0.75, -0.5], [0.0, 2.0]];
        let corners =
            corners.map(|[y, z]| place + Vector::new(0.25 + random.between(0.0, 0.1), y, z));
        let mesh = TriMesh::new(corners.to_vec(), vec![[0, 1, 2]]).unwrap();
        let pose = Pose::from_translation(place);
        let mut search = BvhSearch::new(&mesh).unwrap();
        let distance = search.minimum(&robot, &pose).unwrap().distance;
        let placed = points.iter().map(|&point| (pose * point).x - far);
        off += usize::from(placed.fold(0.0, f64::max) > 0.0 && distance > 0.0);
        let mut found = Vec::new();
        for (margin, clears) in [(distance, false), (distance.next_down(), distance > 0.0)] {
            if margin < 0.0 {
                continue;
            }
            let mut fresh = BvhSearch::new(&mesh).unwrap();
            assert_eq!(fresh.clears(&robot, &pose, margin).unwrap(), clears, "{seed}: {margin}");
            fresh.contacts_within(&robot, &pose, margin, 0.0, &mut found).unwrap();
            assert_eq!(found.is_empty(), clears, "{seed}: {margin}");
            clear += usize::from(clears);
        }
    }
    assert!(off > 1000 && clear > 2000, "{off} {clear}");
}
