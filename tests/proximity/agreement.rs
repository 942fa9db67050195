//! Every engine gives the same answers, on pleasant and on nasty meshes.

use crate::scenes::{bent_towards, extent, mesh_of, nasty_mesh, random_robot};
use continuum_testing::{Random, answered};
use parry_continuum::Chain;
use parry_continuum::parry::math::{Pose, Real, Vector};
use parry_continuum::parry::shape::{Ball, TriMesh};
use parry_continuum::proximity::*;

pub const UNIT: f64 = f64::EPSILON / 2.0;

/// Every engine for a mesh, with a name.
pub fn engines(mesh: &TriMesh) -> Vec<(&'static str, Box<dyn Proximity>)> {
    #[allow(unused_mut)]
    let mut engines: Vec<(&'static str, Box<dyn Proximity>)> = vec![
        ("exhaustive f64", Box::new(Exhaustive::<f64>::new(mesh).unwrap())),
        ("exhaustive f32", Box::new(Exhaustive::<f32>::new(mesh).unwrap())),
        ("search", Box::new(BvhSearch::new(mesh).unwrap())),
    ];
    #[cfg(feature = "gpu")]
    for (name, precision) in continuum_testing::gpu::PRECISIONS {
        if let Some(gpu) = continuum_testing::gpu::open(precision) {
            engines.push((
                name,
                Box::new(parry_continuum::gpu::GpuExhaustive::on(gpu, mesh).unwrap()),
            ));
        }
    }
    #[cfg(feature = "gpu")]
    if let Some(search) = continuum_testing::gpu::search(mesh) {
        engines.push(("GPU search", Box::new(search)));
    }
    engines
}

/// All engines, all methods: the same distances, and witnesses that realise them.
pub fn check_agreement(mesh: &TriMesh, robot: &Chain, pose: &Pose, magnitude: f64) -> Vec<f64> {
    let unit = UNIT * (extent(mesh, robot) + magnitude);
    let mut reference: Vec<f64> = Vec::new();
    for (name, mut engine) in engines(mesh) {
        let mut answers = Vec::new();
        for round in 0..2 {
            engine.per_link(robot, pose, &mut answers).unwrap();
            assert_eq!(answers.len(), robot.links().len());
            if reference.is_empty() {
                reference = answers.iter().map(|answer| answer.distance).collect();
            }
            for (link, (answer, expected)) in answers.iter().zip(&reference).enumerate() {
                assert_eq!(answer.link as usize, link);
                let error = (answer.distance - expected).abs() / unit;
                assert!(
                    error <= 16.0,
                    "{name}, round {round}, link {link}: {} for {expected}",
                    answer.distance
                );
                let gap = (answer.witness.on_robot - answer.witness.on_mesh).length();
                assert!(
                    (gap - answer.distance).abs() <= 8.0 * unit,
                    "{name}: witnesses at {gap}, {answer:?}"
                );
                if answer.distance == 0.0 {
                    assert_eq!(answer.witness.on_robot, answer.witness.on_mesh, "{name}");
                }
            }
        }
        let least = answers.iter().map(|answer| answer.distance).fold(f64::INFINITY, f64::min);
        let minimum = engine.minimum(robot, pose).unwrap();
        assert_eq!(minimum.distance, least, "{name}");
        for margin in
            [0.0, least.next_down().max(0.0), least, least.next_up(), 2.0 * least, f64::INFINITY]
        {
            assert_eq!(
                engine.clears(robot, pose, margin).unwrap(),
                least > margin,
                "{name} {margin} {least}"
            );
        }
    }
    reference
}

#[test]
fn nasty_meshes_at_any_size_and_place() {
    nasty_meshes(7, 60);
}

#[test]
#[ignore = "a minute on a GPU, with the feature gpu; long on one in software"]
fn ten_thousand_nasty_meshes() {
    nasty_meshes(8, 10_000);
}

fn nasty_meshes(seed: u64, rounds: usize) {
    let mut random = Random::new(seed);
    let (mut apart, mut touching) = (0, 0);
    for round in 0..rounds {
        let size = [1.0, 1e-6, 1e6, 1e-30][round % 4];
        let offset = if round % 3 == 0 { random.direction() * size * 1e6 } else { Vector::ZERO };
        let mesh = nasty_mesh(&mut random, size, offset);
        let robot = random_robot(&mut random, size, offset, round as u32 % 3);
        let pose = if round % 3 == 0 { Pose::IDENTITY } else { random.pose(size) };
        let magnitude = offset.length() + pose.translation.length();
        for distance in check_agreement(&mesh, &robot, &pose, magnitude) {
            if distance > 0.0 { apart += 1 } else { touching += 1 }
        }
    }
    assert!(apart > rounds && touching > rounds / 3, "{apart} apart, {touching} touching");
}

/// A wall of triangles at the same distance from the robot up to 1e-8: in single precision all are
/// ties.
#[test]
fn near_ties_are_decided_in_double_precision() {
    let mut random = Random::new(9);
    for offset in [Vector::ZERO, Vector::new(1e6, -1e6, 0.5e6)] {
        let robot = Chain::capsules(&[offset, offset + Vector::Z * 40.0], &[1.0]).unwrap();
        let (mut triangles, mut distances) = (Vec::new(), Vec::new());
        for _ in 0..3000 {
            let (angle, height) = (random.between(-3.1, 3.1), random.between(1.0, 39.0));
            let outward = Vector::new(f64::cos(angle), f64::sin(angle), 0.0);
            let aside = outward.cross(Vector::Z);
            let tip = offset
                + outward * 10.0 * (1.0 + 1e-8 * random.between(0.0, 1.0))
                + Vector::Z * height;
            triangles
                .push([tip, tip + outward + aside, tip + outward - aside].map(|v| v.to_array()));
            distances.push((tip - offset).truncate().length() - 1.0);
        }
        let least = distances.iter().copied().fold(f64::INFINITY, f64::min);
        let single = least as f32;
        assert!(
            distances
                .iter()
                .all(|&distance| (distance as f32 - single).abs() <= single * f32::EPSILON)
        );
        assert!(distances.iter().filter(|&&distance| distance - least > 1e-8).count() > 2000);
        let mesh = mesh_of(&triangles);
        let found = check_agreement(&mesh, &robot, &Pose::IDENTITY, offset.length());
        let unit = UNIT * (extent(&mesh, &robot) + offset.length());
        assert!((found[0] - least).abs() <= 16.0 * unit, "{} for {least}", found[0]);
    }
}

/// The plane through the nearest axis point towards the triangle's centre has no direction there.
#[test]
fn a_triangle_with_its_centre_on_the_axis_is_seen() {
    let pierced = [[2.0, -1.0, 0.0], [-1.0, 2.0, 0.0], [-1.0, -1.0, 0.0]];
    let aside = [[2.0, -1.0, 3.0], [-1.0, 2.0, 3.0], [-1.0, -1.0, 3.0]];
    let robot = Chain::capsules(&[Vector::new(0.0, 0.0, -1.0), Vector::Z], &[0.25]).unwrap();
    for triangles in [vec![pierced], vec![aside, pierced], vec![pierced, aside]] {
        let found = check_agreement(&mesh_of(&triangles), &robot, &Pose::IDENTITY, 0.0);
        assert_eq!(found, [0.0]);
    }
}

#[test]
fn moved_vertices_are_seen() {
    let mut random = Random::new(11);
    let (mesh, other) =
        (nasty_mesh(&mut random, 1.0, Vector::ZERO), nasty_mesh(&mut random, 1.0, Vector::ZERO));
    let moved: Vec<_> =
        mesh.vertices().iter().map(|&v| v * 1.5 + Vector::new(0.1, 0.2, v.x)).collect();
    let robot = random_robot(&mut random, 1.0, Vector::ZERO, 0);
    let fresh = TriMesh::new(moved.clone(), mesh.indices().to_vec()).unwrap();
    let expected =
        Exhaustive::<f64>::new(&fresh).unwrap().minimum(&robot, &Pose::IDENTITY).unwrap();
    let bad = vec![Vector::NAN; moved.len()];
    for (name, mut engine) in engines(&mesh) {
        let before = engine.minimum(&robot, &Pose::IDENTITY).unwrap();
        assert_ne!(before.distance, expected.distance);
        assert!(
            matches!(engine.set_vertices(&moved[1..]), Err(MeshError::VertexCount { .. })),
            "{name}"
        );
        assert!(
            matches!(engine.set_vertices(&bad), Err(MeshError::NotFinite { vertex: 0, .. })),
            "{name}"
        );
        assert_eq!(
            engine.minimum(&robot, &Pose::IDENTITY).unwrap().distance,
            before.distance,
            "{name}"
        );
        engine.set_vertices(&moved).unwrap();
        assert_eq!(
            engine.minimum(&robot, &Pose::IDENTITY).unwrap().distance,
            expected.distance,
            "{name}"
        );
    }
    assert_ne!(other.vertices(), mesh.vertices());
}

/// More vertices than one thread takes at a time: each is checked, moves and counts for the mesh's
/// frame.
#[test]
fn many_moved_vertices_are_seen() {
    let (vertices, indices) = Ball::new(10.0).to_trimesh(260, 130);
    let mesh = TriMesh::new(vertices, indices).unwrap();
    let count = mesh.vertices().len();
    assert!(count > 2 * 16_384, "{count}");
    let robot = Chain::capsules(&[Vector::ZERO, Vector::Z], &[0.5]).unwrap();
    let place = count - 3000;
    let mut moved: Vec<_> = mesh.vertices().iter().map(|&v| v * 100.0).collect();
    // All others are a hundred times as far out.
    moved[place] = moved[place].normalize() * 10.0;
    let mut bad = moved.clone();
    bad[place].y = Real::INFINITY;
    for (name, mut engine) in engines(&mesh) {
        let refused = engine.set_vertices(&bad);
        assert!(
            matches!(refused, Err(MeshError::NotFinite { vertex, .. }) if vertex == place),
            "{name}: {refused:?}"
        );
        engine.set_vertices(&moved).unwrap();
        let nearest = engine.minimum(&robot, &Pose::IDENTITY).unwrap();
        let expected = point_segment(moved[place]) - 0.5;
        assert!(
            (nearest.distance - expected).abs() < 1e-12,
            "{name}: {} for {expected}",
            nearest.distance
        );
        let corners = mesh.indices()[nearest.witness.triangle as usize];
        assert!(corners.contains(&(place as u32)), "{name}: {corners:?}");
    }
}

/// How far a point is from the segment between the origin and the unit point of z.
fn point_segment(point: Vector) -> Real {
    (point - Vector::Z * point.z.clamp(0.0, 1.0)).length()
}

#[test]
fn a_batch_is_its_robots_one_by_one() {
    let mut random = Random::new(13);
    let mesh = nasty_mesh(&mut random, 1.0, Vector::ZERO);
    let robots: Vec<_> = (0..5)
        .map(|i| (random_robot(&mut random, 1.0, Vector::ZERO, i % 3), random.pose(0.3)))
        .collect();
    let robots: Vec<_> = robots.iter().map(|(robot, pose)| (robot, *pose)).collect();
    for (name, mut engine) in engines(&mesh) {
        let (mut per_link, mut minimum, mut clears) =
            (vec![Ok(Vec::new()); 9], Vec::new(), vec![Ok(true); 9]);
        engine.per_link_batch(&robots, &mut per_link).unwrap();
        engine.minimum_batch(&robots, &mut minimum).unwrap();
        // A margin that some keep and others do not.
        let (per_link, minimum) = (answered(&per_link), answered(&minimum));
        let mut distances: Vec<_> = minimum.iter().map(|answer| answer.distance).collect();
        distances.sort_by(f64::total_cmp);
        let margin = distances[2];
        engine.clears_batch(&robots, margin, &mut clears).unwrap();
        let clears = answered(&clears);
        assert_eq!([per_link.len(), minimum.len(), clears.len()], [robots.len(); 3]);
        assert!(clears.contains(&true) && clears.contains(&false), "{name}: {clears:?}");
        for (number, (robot, pose)) in robots.iter().enumerate() {
            let mut alone = Vec::new();
            engine.per_link(robot, pose, &mut alone).unwrap();
            let distances =
                |answers: &[LinkProximity]| answers.iter().map(|a| a.distance).collect::<Vec<_>>();
            assert_eq!(distances(&alone), distances(&per_link[number]), "{name}");
            let least = engine.minimum(robot, pose).unwrap().distance;
            assert_eq!(least, minimum[number].distance, "{name}");
            assert_eq!(clears[number], least > margin, "{name}");
        }
    }
}

/// A robot that is refused costs the others of its batch nothing.
#[test]
fn each_robot_of_a_batch_has_a_result_of_its_own() {
    let mut random = Random::new(14);
    let mesh = nasty_mesh(&mut random, 1.0, Vector::ZERO);
    let robot = random_robot(&mut random, 1.0, Vector::ZERO, 0);
    let bad = [
        Pose::from_translation(Vector::X * 1e200),
        Pose::from_translation(Vector::splat(f64::NAN)),
    ];
    let mut robots = vec![(&robot, Pose::IDENTITY); 40];
    (robots[13].1, robots[29].1) = (bad[0], bad[1]);
    let refusals = [
        (13, ProximityError::Pose(PlacementFault::OutOfRange { link: 0, limit: 1e150 })),
        (29, ProximityError::Pose(PlacementFault::PoseNotFinite)),
    ];
    for (name, mut engine) in engines(&mesh) {
        let (mut per_link, mut minimum, mut clears) = (Vec::new(), Vec::new(), Vec::new());
        engine.per_link_batch(&robots, &mut per_link).unwrap();
        engine.minimum_batch(&robots, &mut minimum).unwrap();
        engine.clears_batch(&robots, 0.0, &mut clears).unwrap();
        assert_eq!([per_link.len(), minimum.len(), clears.len()], [40; 3], "{name}");
        for place in 0..40 {
            let expected =
                refusals.iter().find(|(refused, _)| *refused == place).map(|(_, error)| *error);
            let errors = [
                per_link[place].as_ref().err().copied(),
                minimum[place].err(),
                clears[place].err(),
            ];
            assert_eq!(errors, [expected; 3], "{name}, {place}");
            if expected.is_none() {
                assert_eq!(per_link[place], per_link[0], "{name}, {place}");
                assert_eq!(minimum[place], minimum[0], "{name}, {place}");
                assert_eq!(
                    clears[place],
                    minimum[0].map(|least| least.distance > 0.0),
                    "{name}, {place}"
                );
            }
        }
        let margin = engine.clears_batch(&robots[..9], -1.0, &mut clears);
        assert_eq!(
            (margin, clears.len()),
            (Err(ProximityError::Negative { parameter: "margin", value: -1.0 }), 0),
            "{name}"
        );
    }
}

/// A clone keeps its mesh when the other engine's mesh moves.
#[test]
fn clones_share_the_mesh_until_one_moves_it() {
    let mut random = Random::new(15);
    let mesh = nasty_mesh(&mut random, 1.0, Vector::ZERO);
    let moved: Vec<_> =
        mesh.vertices().iter().map(|&v| v * 1.5 + Vector::new(0.1, 0.2, v.x)).collect();
    let robot = random_robot(&mut random, 1.0, Vector::ZERO, 0);
    fn check(
        mut engine: impl Proximity + Clone + std::fmt::Debug + Send,
        robot: &Chain,
        moved: &[Vector],
    ) {
        let mut other = engine.clone();
        let before = engine.minimum(robot, &Pose::IDENTITY).unwrap().distance;
        engine.set_vertices(moved).unwrap();
        let after = engine.minimum(robot, &Pose::IDENTITY).unwrap().distance;
        assert_ne!(before, after);
        assert_eq!(other.minimum(robot, &Pose::IDENTITY).unwrap().distance, before);
        other.set_vertices(moved).unwrap();
        assert_eq!(other.minimum(robot, &Pose::IDENTITY).unwrap().distance, after);
        assert!(format!("{engine:?}").contains("triangles"));
    }
    check(BvhSearch::new(&mesh).unwrap(), &robot, &moved);
    check(Exhaustive::<f32>::new(&mesh).unwrap(), &robot, &moved);
    check(Exhaustive::<f64>::new(&mesh).unwrap(), &robot, &moved);
}

#[test]
fn scaling_by_a_power_of_two_scales_the_answers_bit_for_bit() {
    let mut random = Random::new(17);
    let mesh = nasty_mesh(&mut random, 1.0, Vector::ZERO);
    let mut plain = Vec::new();
    for robot in [random_robot(&mut random, 1.0, Vector::ZERO, 0), bent_towards(&mesh)] {
        for (k, (_, mut engine)) in engines(&mesh).into_iter().enumerate() {
            engine.per_link(&robot, &Pose::IDENTITY, &mut plain).unwrap();
            for power in [-900, -300, -40, 40, 300] {
                let factor = 2.0_f64.powi(power);
                let vertices = mesh.vertices().iter().map(|&vertex| vertex * factor).collect();
                let scaled_mesh = TriMesh::new(vertices, mesh.indices().to_vec()).unwrap();
                let mut points = vec![robot.links()[0].start() * factor];
                points.extend(robot.links().iter().map(|link| link.end() * factor));
                let radii: Vec<_> =
                    robot.links().iter().map(|link| link.radius() * factor).collect();
                let scaled = Chain::from_centreline(&points, &radii).unwrap();
                let mut answers = Vec::new();
                let (name, mut engine) = engines(&scaled_mesh).remove(k);
                engine.per_link(&scaled, &Pose::IDENTITY, &mut answers).unwrap();
                for (answer, plain) in answers.iter().zip(&plain) {
                    assert_eq!(answer.distance, plain.distance * factor, "{name} 2^{power}");
                }
                let least =
                    plain.iter().map(|answer| answer.distance).fold(f64::INFINITY, f64::min)
                        * factor;
                assert!(least > 0.0, "{least}");
                let minimum = engine.minimum(&scaled, &Pose::IDENTITY).unwrap().distance;
                assert_eq!(minimum, least, "{name} 2^{power}");
                for (margin, clears) in [(least, false), (least.next_down(), true)] {
                    let found = engine.clears(&scaled, &Pose::IDENTITY, margin).unwrap();
                    assert_eq!(found, clears, "{name} 2^{power} {margin}");
                }
            }
        }
    }
}

#[test]
fn bad_input_is_an_error() {
    let mut random = Random::new(19);
    let mesh = nasty_mesh(&mut random, 1.0, Vector::ZERO);
    let robot = random_robot(&mut random, 1.0, Vector::ZERO, 0);
    let nan = Pose::from_translation(Vector::new(0.0, f64::NAN, 0.0));
    let far = Pose::from_translation(Vector::X * 1e200);
    for (name, mut engine) in engines(&mesh) {
        let mut out = vec![engine.minimum(&robot, &Pose::IDENTITY).unwrap()];
        assert_eq!(
            engine.per_link(&robot, &nan, &mut out),
            Err(ProximityError::Pose(PlacementFault::PoseNotFinite)),
            "{name}"
        );
        assert!(out.is_empty());
        assert!(matches!(
            engine.minimum(&robot, &far),
            Err(ProximityError::Pose(PlacementFault::OutOfRange { link: 0, .. }))
        ));
        for margin in [-1e-300, f64::NAN, f64::NEG_INFINITY] {
            let error = engine.clears(&robot, &Pose::IDENTITY, margin).unwrap_err();
            assert!(error.to_string().contains(&format!("{margin:?}")), "{name}: {error}");
        }
        engine.per_link(&robot, &Pose::IDENTITY, &mut out).unwrap();
        assert_eq!(out.len(), 12);
    }
    let mut vertices = mesh.vertices().to_vec();
    for value in [f64::NAN, f64::INFINITY, 1e151] {
        vertices[7].y = value;
        let bad = mesh.clone();
        let bad = TriMesh::new(vertices.clone(), bad.indices().to_vec());
        // parry's own hierarchy may refuse such a mesh; if it does not, the engines do.
        if let Ok(bad) = bad {
            for error in [
                BvhSearch::new(&bad).err(),
                Exhaustive::<f64>::new(&bad).err(),
                Exhaustive::<f32>::new(&bad).err(),
            ] {
                let message = error.expect("an error").to_string();
                assert!(message.contains("vertex 7"), "{message}");
            }
        }
    }
}
