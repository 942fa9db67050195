//! Solid structures against the sides of samples, and margins by pair against separate queries.

use continuum_testing::{Random, rounds};
use parry_continuum::parry::math::{Pose, Real, Vector};
use parry_continuum::parry::shape::{Ball, Cuboid};
use parry_continuum::proximity::{
    Between, BvhSearch, Decision, Proximity, Scene, SceneError, SceneMotionContact, ScenePlace,
    Side, StructureEnd,
};
use parry_continuum::{Chain, LinearMotion, Motion, RigidMotion, Tube};

type Triangles = (Vec<Vector>, Vec<[u32; 3]>);

const RESOLUTION: Real = 1e-3;

/// A box as a mesh of 12 triangles.
fn cuboid(half_extents: Vector) -> Triangles {
    Cuboid::new(half_extents).to_trimesh()
}

fn flipped(triangles: &[[u32; 3]]) -> Vec<[u32; 3]> {
    triangles.iter().map(|&[a, b, c]| [a, c, b]).collect()
}

/// One mesh of several. The second of each part says whether its triangles are flipped.
fn joined(parts: &[(Triangles, bool)]) -> Triangles {
    let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
    for ((points, faces), is_flipped) in parts {
        let first = vertices.len() as u32;
        let faces = if *is_flipped { flipped(faces) } else { faces.clone() };
        triangles.extend(faces.into_iter().map(|face| face.map(|corner| corner + first)));
        vertices.extend(points);
    }
    (vertices, triangles)
}

/// A closed mesh around the origin with extents of about 1: a box, a ball, a box in a box, a box
/// with a cavity, or two boxes that share an edge; with either winding.
fn closed_mesh(random: &mut Random) -> Triangles {
    let extents = Vector::new(1.0, random.between(0.3, 1.0), random.between(0.3, 1.0));
    let outer = cuboid(extents);
    let inner = cuboid(extents * 0.6);
    let is_flipped = random.below(2) == 1;
    let shifted = |shift: Vector| {
        let (vertices, triangles) = &outer;
        (vertices.iter().map(|vertex| *vertex + shift).collect(), triangles.clone())
    };
    match random.below(5) {
        0 => joined(&[(outer, is_flipped)]),
        1 => joined(&[(Ball::new(1.0).to_trimesh(8, 5), is_flipped)]),
        2 => joined(&[(outer, is_flipped), (inner, is_flipped)]),
        3 => joined(&[(outer, is_flipped), (inner, !is_flipped)]),
        _ => {
            let beside = shifted(Vector::new(2.0 * extents.x, 2.0 * extents.y, 0.0));
            joined(&[(outer, is_flipped), (beside, is_flipped)])
        }
    }
}

/// Points of a robot's axis, sampled.
fn samples(points: &[Vector], pose: &Pose) -> Vec<Vector> {
    let at = |ends: &[Vector], k: u32| pose * ends[0].lerp(ends[1], Real::from(k) / 8.0);
    points.windows(2).flat_map(|ends| (0..=8).map(move |k| at(ends, k))).collect()
}

/// A robot that is in contact with a solid either touches its surface or has all of its points
/// inside. All queries agree about that, for robots at rest and in motion, in any unit and pose.
#[test]
fn a_robot_inside_of_a_solid_is_in_contact() {
    let (mut inside, mut outside, mut touching) = (0, 0, 0);
    for seed in 0..rounds(1500_u64) {
        let random = &mut Random::new(seed);
        let unit = [1.0, 2.0_f64.powi(-200), 2.0_f64.powi(200), 1e-3][random.below(4) as usize];
        let (vertices, triangles) = closed_mesh(random);
        let vertices: Vec<_> = vertices.iter().map(|vertex| *vertex * unit).collect();
        let mut search = BvhSearch::from_triangles(&vertices, &triangles).unwrap();
        let moved = [Pose::IDENTITY, random.pose(unit)][random.below(2) as usize];
        let length = unit * [1e-6, 0.1, 0.5, 8.0][random.below(4) as usize];
        let mut points = vec![random.point() * unit * 1.2];
        for _ in 0..1 + random.below(3) {
            points.push(points[points.len() - 1] + random.direction() * length);
        }
        let radius = length * random.between(0.01, 0.3);
        let make = [Chain::capsules, Chain::cylinders][random.below(2) as usize];
        let Ok(chain) = make(&points, &vec![radius; points.len() - 1]) else { continue };
        let margin = unit * [0.0, 1e-9, 0.2][random.below(3) as usize];

        let mut scene = Scene::new();
        let solid = scene.add("solid", search.clone(), Some(margin)).unwrap();
        scene.add("far", search.clone(), Some(margin)).unwrap();
        scene.set_pose(1, &Pose::translation(1e3 * unit, 0.0, 0.0)).unwrap();
        scene.set_pose(solid, &moved).unwrap();
        let robots = [(&chain, moved)];
        let at = moved.inverse() * moved;
        let surface = search.minimum(&chain, &at).unwrap();
        assert_eq!(scene.clears(&robots).unwrap(), surface.distance > margin, "seed {seed}");
        scene.set_solid(solid, true).unwrap();
        assert!(scene.is_solid(solid) && !scene.is_solid(1));

        let sides = samples(&points, &at).into_iter().map(|point| search.side(point));
        let sides: Vec<_> = sides.filter(|side| *side != Side::Undecided).collect();
        if surface.distance > 0.0 {
            assert!(sides.iter().all(|side| *side == sides[0]), "seed {seed}");
        }
        let is_inside = surface.distance > 0.0 && sides[0] == Side::Inside;
        inside += u32::from(is_inside);
        outside += u32::from(surface.distance > margin && !is_inside);
        touching += u32::from(surface.distance == 0.0);

        let distance = if is_inside { 0.0 } else { surface.distance };
        for _ in 0..2 {
            let tightest = scene.tightest(&robots).unwrap().unwrap();
            let Between::Structure(near) = tightest.between else { panic!("seed {seed}") };
            assert_eq!((near.structure, near.robot), (0, 0), "seed {seed}");
            assert_eq!(near.nearest.distance, distance, "seed {seed}");
            assert_eq!(tightest.slack, distance - margin, "seed {seed}");
            let witness = near.nearest.witness;
            assert_eq!(witness.on_robot == witness.on_mesh, distance == 0.0, "seed {seed}");
            let clears = scene.clears(&robots).unwrap();
            assert_eq!(clears, distance > margin, "seed {seed}");
        }
        let mut each = Vec::new();
        scene.per_structure(&robots, &mut each).unwrap();
        assert_eq!(each[0].nearest.distance, distance, "seed {seed}");
        assert_eq!(each[0].slack, Some(distance - margin), "seed {seed}");

        // The same as a tube, and as a motion at rest.
        if (surface.distance - margin).abs() < 1e-2 * unit && !is_inside {
            continue;
        }
        let expected = if distance > margin { Decision::Clear } else { Decision::Contact };
        let tube = Tube::from(&chain);
        let resolution = RESOLUTION * unit;
        let decided = scene.clears_tube(&[(&tube, moved)], resolution).unwrap();
        assert_eq!(decided, expected, "seed {seed}");
        let bounds = scene.clearance(&[(&tube, moved)], resolution).unwrap().unwrap();
        assert!(bounds.lower <= distance - margin + 1e-12 * unit, "seed {seed}");
        assert!(distance - margin <= bounds.upper + 1e-12 * unit, "seed {seed}");
        let rests = RigidMotion::new(tube, [moved; 2]).unwrap();
        let answer = scene.clears_motion(&[&rests], resolution).unwrap();
        assert_eq!(answer.decision, expected, "seed {seed}");
        let bounds = scene.clearance_of_motion(&[&rests], resolution).unwrap().unwrap();
        assert!(bounds.lower <= distance - margin + 1e-12 * unit, "seed {seed}");
        assert!(distance - margin <= bounds.upper + 1e-12 * unit, "seed {seed}");
        if is_inside {
            assert_eq!(answer.interval, [0.0; 2], "seed {seed}");
            let first = scene.time_of_contact(&[&rests], resolution).unwrap();
            assert_eq!(first.interval, [0.0; 2], "seed {seed}");
            assert_eq!([bounds.lower, bounds.upper], [-margin; 2], "seed {seed}");
            let Some(SceneMotionContact::Structure { structure: 0, shape, .. }) = answer.contact
            else {
                panic!("seed {seed}")
            };
            assert_eq!((shape.t, shape.upper), (0.0, 0.0));
            let local = moved.inverse() * shape.witness.on_robot;
            assert_eq!(search.side(local), Side::Inside, "seed {seed}");
            assert!(matches!(bounds.place, ScenePlace::Structure { structure: 0, .. }));
        }
    }
    assert!(inside > 8 && outside > 15 && touching > 15, "{inside} {outside} {touching}");
}

/// A robot that moves about within a solid, deep inside, is in contact although it never touches
/// the surface. The bounding boxes and the distance cache skip nothing.
#[test]
fn a_walk_into_a_solid_is_followed() {
    let (vertices, triangles) = cuboid(Vector::splat(10.0));
    let search = BvhSearch::from_triangles(&vertices, &triangles).unwrap();
    let mut scene = Scene::new();
    scene.add("box", search.clone(), Some(0.5)).unwrap();
    scene.set_solid(0, true).unwrap();
    let robot = Chain::from_centreline(&[Vector::ZERO, Vector::Z], &[0.25]).unwrap();
    for step in 0..600 {
        let x = 15.0 - 0.05 * Real::from(step);
        let robots = [(&robot, Pose::translation(x, 0.0, 0.0))];
        // The robot is beyond the margin if x - 0.25 > 10.5; on the other side it never is.
        let expected = (x.abs() - 0.25 - 10.0).max(0.0);
        assert_eq!(scene.clears(&robots).unwrap(), expected > 0.5, "{x}");
        let slack = scene.tightest(&robots).unwrap().unwrap().slack;
        assert!((slack - (expected - 0.5)).abs() < 1e-12, "{x}: {slack}");
    }
    // A motion within, and one from outside to another place outside, through nothing.
    let tube = Tube::from(&robot);
    let moves = |from: Real, to: Real| {
        let poses = [from, to].map(|x| Pose::translation(x, 0.0, 0.0));
        RigidMotion::new(tube.clone(), poses).unwrap()
    };
    let within = moves(-5.0, 5.0);
    assert_eq!(scene.clears_motion(&[&within], RESOLUTION).unwrap().decision, Decision::Contact);
    assert_eq!(scene.time_of_contact(&[&within], RESOLUTION).unwrap().interval, [0.0; 2]);
    assert!(scene.clears_motion(&[&moves(12.0, 14.0)], RESOLUTION).unwrap().is_clear());
    let enters = scene.time_of_contact(&[&moves(14.0, 0.0)], RESOLUTION).unwrap();
    assert!((enters.interval[1] - (14.0 - 10.75) / 14.0).abs() < 1e-3);

    // The box moves over the robot; it grows around it.
    let rests = moves(30.0, 30.0);
    let to = |x: Real| [(0, StructureEnd::Pose(Pose::translation(x, 0.0, 0.0)))];
    let while_it_moves =
        |scene: &mut Scene, ends: &[(usize, StructureEnd)], motion: &dyn Motion| {
            scene.clears_motion_while(ends, &[motion], RESOLUTION).unwrap().decision
        };
    assert_eq!(while_it_moves(&mut scene, &to(19.0), &rests), Decision::Clear);
    assert_eq!(while_it_moves(&mut scene, &to(20.0), &rests), Decision::Contact);
    let swims = LinearMotion::chain(&[Vector::ZERO, Vector::Z], &[Vector::X, Vector::ONE], &[0.25]);
    let swims = swims.unwrap();
    let poses = [(0, StructureEnd::Pose(Pose::translation(1.0, 0.0, 0.0)))];
    assert_eq!(while_it_moves(&mut scene, &poses, &swims), Decision::Contact);
    let grown: Vec<_> = vertices.iter().map(|vertex| *vertex * 1.5).collect();
    let grows = [(0, StructureEnd::Vertices(&grown))];
    assert_eq!(while_it_moves(&mut scene, &grows, &swims), Decision::Contact);
    assert_eq!(while_it_moves(&mut scene, &grows, &rests), Decision::Clear);
}

/// An open mesh, or one whose triangles face opposite ways, is refused, with the number of edges.
#[test]
fn a_mesh_that_bounds_no_volume_cannot_be_solid() {
    let (vertices, triangles) = cuboid(Vector::ONE);
    let mut scene = Scene::new();
    let mut add = |name: &str, vertices: &[Vector], triangles: &[[u32; 3]]| {
        let search = BvhSearch::from_triangles(vertices, triangles).unwrap();
        let number = scene.add(name, search, None).unwrap();
        let refused = scene.set_solid(number, true);
        assert_eq!(scene.is_solid(number), refused.is_ok(), "{name}");
        match refused {
            Ok(()) => [0, 0],
            Err(SceneError::NotSolid { name: of, open_edges, unbalanced_edges }) => {
                assert_eq!(of, name);
                [open_edges, unbalanced_edges]
            }
            Err(error) => panic!("{error}"),
        }
    };
    assert_eq!(add("closed", &vertices, &triangles), [0, 0]);
    assert_eq!(add("flipped", &vertices, &flipped(&triangles)), [0, 0]);
    assert_eq!(add("open", &vertices, &triangles[1..]), [3, 0]);
    assert_eq!(add("one triangle", &vertices, &triangles[..1]), [3, 0]);
    let mut turned = triangles.clone();
    turned[0].swap(0, 1);
    assert_eq!(add("one turned", &vertices, &turned), [0, 3]);
    let twice: Vec<_> = triangles.iter().chain(&triangles[..1]).copied().collect();
    assert_eq!(add("one twice", &vertices, &twice), [0, 3]);
    // Each triangle with its own corners.
    let soup: Vec<_> = triangles.iter().flatten().map(|&k| vertices[k as usize]).collect();
    let own: Vec<_> = (0..12).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]).collect();
    assert_eq!(add("soup", &soup, &own), [0, 0]);

    // Vertices that move open the soup: the next query says so, until they close it again.
    let robot = Chain::capsules(&[Vector::ZERO, Vector::Z * 0.1], &[0.01]).unwrap();
    let robots = [(&robot, Pose::IDENTITY)];
    let mut scene = Scene::new();
    scene.add("soup", BvhSearch::from_triangles(&soup, &own).unwrap(), Some(0.0)).unwrap();
    scene.set_solid(0, true).unwrap();
    let mut torn = soup.clone();
    torn[0] *= 1.5;
    let rests = RigidMotion::new(Tube::from(&robot), [Pose::IDENTITY; 2]).unwrap();
    let tears = [(0, StructureEnd::Vertices(&torn))];
    let refused = scene.clears_motion_while(&tears, &[&rests], RESOLUTION);
    assert_eq!(refused.unwrap_err().kind(), "not_solid");
    assert!(!scene.clears(&robots).unwrap());
    scene.set_vertices(0, &torn).unwrap();
    assert_eq!(scene.clears(&robots).unwrap_err().kind(), "not_solid");
    assert_eq!(scene.tightest(&robots).unwrap_err().kind(), "not_solid");
    assert_eq!(scene.per_structure(&robots, &mut Vec::new()).unwrap_err().kind(), "not_solid");
    let refused = scene.clears_motion(&[&rests], RESOLUTION).unwrap_err();
    assert_eq!(refused.to_string().split(':').next(), Some("structure `soup` cannot be solid"));
    scene.set_vertices(0, &soup).unwrap();
    assert!(!scene.clears(&robots).unwrap());
    assert_eq!(scene.set_solid(3, true).unwrap_err().kind(), "no_such_structure");
}

/// Margins of single robots: as separate scenes with one robot and one structure each.
#[test]
fn margins_by_pair_are_those_of_separate_queries() {
    let (mut clear, mut violated) = (0, 0);
    for seed in 0..rounds(600_u64) {
        let random = &mut Random::new(seed);
        let choose = |random: &mut Random| {
            [None, Some(0.0), Some(random.between(0.0, 3.0)), Some(Real::INFINITY)]
                [[0, 1, 2, 2, 2, 2, 2, 3][random.below(8) as usize]]
        };
        let mut scene = Scene::new();
        let mut structures = Vec::new();
        for number in 0..3 {
            let (vertices, triangles) = closed_mesh(random);
            let search = BvhSearch::from_triangles(&vertices, &triangles).unwrap();
            scene.add(format!("organ {number}"), search.clone(), choose(random)).unwrap();
            let pose = Pose::from_translation(random.point() * 5.0);
            scene.set_pose(number, &pose).unwrap();
            if random.below(2) == 0 {
                scene.set_solid(number, true).unwrap();
            }
            structures.push((search, pose));
        }
        let chains: Vec<_> = (0..3)
            .map(|_| {
                let base = random.point() * 6.0;
                Chain::capsules(&[base, base + random.direction()], &[0.1]).unwrap()
            })
            .collect();
        let mut margins = [[None; 3]; 3];
        for (structure, margins) in margins.iter_mut().enumerate() {
            for (robot, margin) in margins.iter_mut().enumerate() {
                *margin = scene.margin(structure);
                if random.below(3) == 0 {
                    // The last one counts.
                    scene.set_margin_between(structure, robot, Some(9.0)).unwrap();
                    *margin = choose(random);
                    scene.set_margin_between(structure, robot, *margin).unwrap();
                }
                assert_eq!(scene.margin_between(structure, robot), *margin);
            }
        }
        scene.set_margin_between(0, 17, Some(100.0)).unwrap();

        let robots: Vec<_> = chains.iter().map(|chain| (chain, Pose::IDENTITY)).collect();
        let mut each = Vec::new();
        scene.per_structure(&robots, &mut each).unwrap();
        let (mut least, mut clears) = (Real::INFINITY, true);
        for (number, (search, pose)) in structures.iter().enumerate() {
            let mut alone = Scene::new();
            alone.add("organ", search.clone(), Some(0.0)).unwrap();
            alone.set_pose(0, pose).unwrap();
            alone.set_solid(0, scene.is_solid(number)).unwrap();
            let (mut rows, mut of_structure) = (Vec::new(), Vec::new());
            for (robot, margin) in robots.iter().zip(margins[number]) {
                alone.per_structure(&[*robot], &mut rows).unwrap();
                let distance = rows[0].nearest.distance;
                if let Some(margin) = margin {
                    alone.set_margin(0, Some(margin)).unwrap();
                    clears &= alone.clears(&[*robot]).unwrap();
                    least = least.min(distance - margin);
                }
                of_structure.push((margin.map(|margin| distance - margin), distance));
            }
            let found = &each[number];
            let slacks = of_structure.iter().filter_map(|(slack, _)| *slack);
            if let Some(least) = slacks.reduce(Real::min) {
                assert_eq!(found.slack, Some(least), "seed {seed}, structure {number}");
            } else {
                let distances = of_structure.iter().map(|(_, distance)| *distance);
                let least = distances.fold(Real::INFINITY, Real::min);
                assert_eq!((found.slack, found.nearest.distance), (None, least), "seed {seed}");
            }
            let (slack, distance) = of_structure[found.robot as usize];
            assert_eq!((found.slack, found.nearest.distance), (slack, distance), "seed {seed}");
        }
        if margins.as_flattened().iter().all(Option::is_none) {
            assert_eq!(scene.tightest(&robots).unwrap(), None, "seed {seed}");
            continue;
        }
        let tightest = scene.tightest(&robots).unwrap().unwrap();
        assert_eq!(tightest.slack, least, "seed {seed}");
        for _ in 0..2 {
            assert_eq!(scene.clears(&robots).unwrap(), clears, "seed {seed}");
        }
        clear += u32::from(clears);
        violated += u32::from(!clears);
        if least.abs() < 1e-2 {
            continue;
        }
        let tubes: Vec<_> = chains.iter().map(Tube::from).collect();
        let expected = if clears { Decision::Clear } else { Decision::Contact };
        let placed: Vec<_> = tubes.iter().map(|tube| (tube, Pose::IDENTITY)).collect();
        assert_eq!(scene.clears_tube(&placed, RESOLUTION).unwrap(), expected, "seed {seed}");
        let motions: Vec<_> = tubes
            .iter()
            .map(|tube| RigidMotion::new(tube.clone(), [Pose::IDENTITY; 2]).unwrap())
            .collect();
        let motions: Vec<_> = motions.iter().collect();
        let answer = scene.clears_motion(&motions, RESOLUTION).unwrap();
        assert_eq!(answer.decision, expected, "seed {seed}");
        let tubes = scene.clearance(&placed, RESOLUTION).unwrap().unwrap();
        let motions = scene.clearance_of_motion(&motions, RESOLUTION).unwrap().unwrap();
        for [lower, upper] in [[tubes.lower, tubes.upper], [motions.lower, motions.upper]] {
            assert!(lower <= least && least <= upper, "seed {seed}: {lower} {least} {upper}");
        }
    }
    assert!(clear > 5 && violated > 20, "{clear} {violated}");
}

/// A name belongs to one structure, and errors name the structure that was queried.
#[test]
fn names_are_unique_and_stand_in_errors() {
    let (vertices, triangles) = cuboid(Vector::ONE);
    let search = BvhSearch::from_triangles(&vertices, &triangles).unwrap();
    let mut scene = Scene::new();
    scene.add("wall", search.clone(), Some(1.0)).unwrap();
    let refused = scene.add("wall", search.clone(), Some(1.0)).unwrap_err();
    assert_eq!(refused, SceneError::NameTaken { name: "wall".into(), structure: 0 });
    assert_eq!((scene.len(), refused.kind()), (1, "name_taken"));
    scene.add("Wall", search, Some(1.0)).unwrap();
    let refused = scene.set_margin_between(1, 0, Some(-1.0)).unwrap_err();
    assert!(refused.to_string().starts_with("structure `Wall`: "), "{refused}");
    assert_eq!(scene.set_margin_between(2, 0, None).unwrap_err().kind(), "no_such_structure");

    // A resolution that is finer than rounding: the error is about the structure, too.
    let poses = [3.0, 8.0].map(|x| Pose::translation(x, 0.0, 0.0));
    let needle = Chain::capsules(&[Vector::ZERO, Vector::Z], &[0.5]).unwrap();
    let moves = RigidMotion::new(Tube::from(&needle), [poses[1], poses[0]]).unwrap();
    let refused = scene.clears_motion(&[&moves], 1e-30);
    if let Err(refused) = refused {
        assert!(refused.to_string().starts_with("robot 0 beside structure `"), "{refused}");
    }
}
