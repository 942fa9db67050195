//! Answers belong to the mesh that an engine has now: the engine describes an answer, and an answer
//! that does not fit is an error.

use crate::agreement::{UNIT, engines};
use crate::scenes::{mesh_of, nasty_mesh};
use continuum_testing::{Random, rounds};
use parry_continuum::Chain;
use parry_continuum::parry::math::{Pose, Vector};
use parry_continuum::parry::shape::{Ball, TriMesh};
use parry_continuum::proximity::*;

/// A bumpy ball of triangles that share corners.
fn wall(random: &mut Random) -> TriMesh {
    let (vertices, indices) = Ball::new(5.0).to_trimesh(24, 12);
    let vertices = vertices.into_iter().map(|v| v * random.between(0.95, 1.05)).collect();
    TriMesh::new(vertices, indices).unwrap()
}

fn robot(random: &mut Random) -> Chain {
    let points =
        [Vector::ZERO, random.point() * 2.0, random.point() * 4.0, random.direction() * 4.6];
    match random.below(3) {
        0 => Chain::from_centreline(&points, &[0.5, 0.5, 0.25]).unwrap(),
        1 => Chain::capsules(&points, &[0.25; 3]).unwrap(),
        _ => Chain::cylinders(&points, &[0.0, 0.5, 0.5]).unwrap(),
    }
}

/// A mesh of what an engine has now.
fn now(engine: &dyn Proximity) -> TriMesh {
    TriMesh::new(engine.vertices().to_vec(), engine.triangles().to_vec()).unwrap()
}

fn is_unfit<T>(result: &Result<T, ProximityError>) -> bool {
    matches!(result, Err(ProximityError::AnswerDoesNotFit { .. }))
}

/// Whether an answer is one of a mesh: its distance is the proven one of its pair. Meshes here are
/// 10 large at most.
fn is_of(answer: &LinkProximity, robot: &Chain, pose: &Pose, mesh: &TriMesh) -> bool {
    let corners = *mesh.triangle(answer.witness.triangle).vertices();
    let proof = Certificate::between(&robot.links()[answer.link as usize], pose, corners).unwrap();
    let slack = 1e3 * UNIT * 10.0;
    proof.lower - slack <= answer.distance && answer.distance <= proof.upper + slack
}

/// A contact is what a fresh engine says of the moved mesh, or an error: never a mixture of two
/// meshes.
#[test]
fn after_the_mesh_moved_an_answer_is_right_or_an_error() {
    let (mut stale, mut still_right, mut fresh, mut touching) = (0, 0, 0, 0);
    for seed in 0..rounds(60) {
        let random = &mut Random::new(seed);
        let (mesh, robot, pose) = (wall(random), robot(random), random.pose(0.3));
        // Every vertex moves, or the vertices of one side alone.
        let side = if seed % 2 == 0 { -9.0 } else { 0.0 };
        let shift = random.point();
        let moved: Vec<_> =
            mesh.vertices().iter().map(|&v| if v.x > side { v + shift * 0.5 } else { v }).collect();
        let moved_mesh = TriMesh::new(moved.clone(), mesh.indices().to_vec()).unwrap();
        for (name, mut engine) in engines(&mesh) {
            let (mut before, mut after, mut contacts) = (Vec::new(), Vec::new(), Vec::new());
            engine.per_link(&robot, &pose, &mut before).unwrap();
            engine.set_vertices(&moved).unwrap();
            assert_eq!(
                (engine.vertices(), engine.triangles()),
                (&moved[..], mesh.indices()),
                "{name}"
            );
            for answer in &before {
                let contact = engine.contact_of(&robot, &pose, answer);
                let derivative = engine.derivative(&robot, &pose, answer);
                let proof = answer.certify(&robot, &pose, &now(&*engine));
                let together =
                    engine.contacts_of(&robot, &pose, std::slice::from_ref(answer), &mut contacts);
                assert_eq!(contact.is_err(), derivative.is_err(), "{name}, {seed}");
                assert_eq!(contact.is_err(), proof.is_err(), "{name}, {seed}");
                assert_eq!(contact.is_err(), together.is_err(), "{name}, {seed}");
                if is_unfit(&contact) {
                    assert!(
                        is_unfit(&derivative) && is_unfit(&proof) && contacts.is_empty(),
                        "{name}"
                    );
                    stale += 1;
                } else {
                    contact.unwrap();
                    assert!(
                        is_of(answer, &robot, &pose, &moved_mesh),
                        "{name}, {seed}: {answer:?}"
                    );
                    still_right += 1;
                }
            }
            engine.per_link(&robot, &pose, &mut after).unwrap();
            engine.contacts_of(&robot, &pose, &after, &mut contacts).unwrap();
            let of_moved = Exhaustive::<f64>::new(&moved_mesh).unwrap();
            for (answer, contact) in after.iter().zip(&contacts) {
                assert_eq!(
                    Ok(*contact),
                    engine.contact_of(&robot, &pose, answer),
                    "{name}, {seed}"
                );
                assert_eq!(
                    Ok(*contact),
                    of_moved.contact_of(&robot, &pose, answer),
                    "{name}, {seed}"
                );
                let derivative = engine.derivative(&robot, &pose, answer);
                assert_eq!(
                    derivative,
                    of_moved.derivative(&robot, &pose, answer),
                    "{name}, {seed}"
                );
                // The mesh from before the move certifies no answer about the moved mesh.
                assert!(answer.certify(&robot, &pose, &moved_mesh).is_ok(), "{name}, {seed}");
                let old = answer.certify(&robot, &pose, &mesh);
                assert!(is_unfit(&old) || is_of(answer, &robot, &pose, &mesh), "{name}, {seed}");
                assert_eq!(
                    is_unfit(&old),
                    is_unfit(&answer.certify_among_all(&robot, &pose, &mesh))
                );
                fresh += 1;
                touching += u32::from(answer.distance == 0.0);
            }
        }
    }
    let seen = [stale, still_right, fresh, touching];
    assert!(
        stale > rounds(300)
            && still_right > rounds(50)
            && fresh > rounds(500)
            && touching > rounds(30),
        "{seen:?}"
    );
}

/// Clones share a mesh until one of them moves it.
#[test]
fn a_clone_keeps_the_mesh_that_it_has() {
    let random = &mut Random::new(5);
    let (mesh, robot, pose) = (wall(random), robot(random), Pose::IDENTITY);
    let moved: Vec<_> = mesh.vertices().iter().map(|v| v * 1.5).collect();
    let mut search = BvhSearch::new(&mesh).unwrap();
    let closest = search.minimum(&robot, &pose).unwrap();
    let (kept, before) = (search.clone(), search.contact_of(&robot, &pose, &closest));
    search.set_vertices(&moved).unwrap();
    assert!(before.is_ok() && kept.contact_of(&robot, &pose, &closest) == before);
    assert_eq!(kept.vertices(), mesh.vertices());
    assert!(is_unfit(&search.contact_of(&robot, &pose, &closest)));
    assert_eq!(search.clone().vertices(), moved);
    // A refused move leaves what was there.
    assert!(search.set_vertices(&moved[1..]).is_err());
    assert_eq!(search.vertices(), moved);

    let mut exhaustive = Exhaustive::<f32>::new(&mesh).unwrap();
    let kept = exhaustive.clone();
    exhaustive.set_vertices(&moved).unwrap();
    assert!(
        kept.contact_of(&robot, &pose, &closest) == before && kept.vertices() == mesh.vertices()
    );
    assert!(is_unfit(&exhaustive.contact_of(&robot, &pose, &closest)));
}

/// What is written as text and read again may be off by a unit in the last place in every number.
fn rounded(answer: LinkProximity, random: &mut Random) -> LinkProximity {
    let mut off = |x: f64| match random.below(3) {
        0 => x.next_up(),
        1 => x.next_down(),
        _ => x,
    };
    let (mut distance, mut on_robot, mut on_mesh) =
        (answer.distance, answer.witness.on_robot, answer.witness.on_mesh);
    distance = off(distance).max(0.0);
    for point in [&mut on_robot, &mut on_mesh] {
        *point = Vector::new(off(point.x), off(point.y), off(point.z));
    }
    let mut rounded = answer;
    (rounded.distance, rounded.witness.on_robot, rounded.witness.on_mesh) =
        (distance, on_robot, on_mesh);
    rounded
}

/// What any engine answers fits, wherever the problem is and however large: touching, far out,
/// scaled, on meshes of slivers and points, as text and back.
#[test]
fn every_answer_fits() {
    let (mut touching, mut far, mut small, mut large) = (0, 0, 0, 0);
    for seed in 0..rounds(240) {
        let random = &mut Random::new(seed);
        let unit = 2.0_f64.powi([0, -300, -40, 40, 300][seed as usize % 5]);
        // How far out link and triangle are, beside what they measure.
        let out = if seed % 3 == 0 { 10.0_f64.powi(random.below(16) as i32) } else { 0.0 };
        let away = random.direction() * out * unit;
        let made = if seed % 4 == 0 { nasty_mesh(random, 1.0, Vector::ZERO) } else { wall(random) };
        let vertices: Vec<_> = made.vertices().iter().map(|&v| v * unit + away).collect();
        let centreline: Vec<_> = {
            let robot = robot(random);
            let ends = robot.links().iter().map(|link| link.end());
            std::iter::once(robot.links()[0].start())
                .chain(ends)
                .map(|point| point * unit)
                .collect()
        };
        let radii = vec![0.3 * unit; centreline.len() - 1];
        let robot = Chain::from_centreline(&centreline, &radii).unwrap();
        let turn = random.pose(1.0).rotation;
        let pose = Pose::from_parts(away, turn);
        let Ok(mesh) = TriMesh::new(vertices, made.indices().to_vec()) else { continue };
        for (name, mut engine) in engines(&mesh) {
            let (mut answers, mut contacts) = (Vec::new(), Vec::new());
            engine.per_link(&robot, &pose, &mut answers).unwrap();
            answers.push(engine.minimum(&robot, &pose).unwrap());
            engine.contacts_of(&robot, &pose, &answers, &mut contacts).unwrap();
            for &answer in &answers {
                for answer in [answer, rounded(answer, random)] {
                    let fits = engine.contact_of(&robot, &pose, &answer).map(|_| ());
                    assert_eq!(fits, Ok(()), "{name}, {seed}: {answer:?}");
                    let fits = engine.contacts_of(&robot, &pose, &[answer], &mut contacts);
                    assert_eq!(fits, Ok(()), "{name}, {seed}: {answer:?}");
                    let proof = answer.certify(&robot, &pose, &mesh).map(|_| ());
                    assert_eq!(proof, Ok(()), "{name}, {seed}: {answer:?}");
                }
                #[cfg(feature = "serde-serialize")]
                {
                    let text = serde_json::to_string(&answer).unwrap();
                    let read: LinkProximity = serde_json::from_str(&text).unwrap();
                    assert!(
                        engine.derivative(&robot, &pose, &read).is_ok(),
                        "{name}, {seed}: {text}"
                    );
                }
                touching += u32::from(answer.distance == 0.0);
                far += u32::from(out > 1e6);
                (small, large) = (small + u32::from(unit < 1.0), large + u32::from(unit > 1.0));
            }
        }
    }
    let seen = [touching, far, small, large];
    assert!(seen.iter().all(|&count| count > rounds(200)), "{seen:?}");
}

/// Each field of an answer, changed by much more than rounding explains, is found out; so is what
/// is no number.
#[test]
fn what_does_not_fit_is_an_error() {
    let (mut changed, mut alone) = (0, 0);
    for seed in 0..200 {
        let random = &mut Random::new(seed);
        let (mesh, robot, pose) = (wall(random), robot(random), random.pose(0.3));
        let mut search = BvhSearch::new(&mesh).unwrap();
        let mut answers = Vec::new();
        search.per_link(&robot, &pose, &mut answers).unwrap();
        let refused = |answer: &LinkProximity| {
            let contact = search.contact_of(&robot, &pose, answer).unwrap_err();
            // Compared as text: NaN is not itself.
            let text = contact.to_string();
            let together = search.contacts_of(&robot, &pose, &[*answer], &mut Vec::new());
            assert_eq!(search.derivative(&robot, &pose, answer).unwrap_err().to_string(), text);
            assert_eq!(answer.certify(&robot, &pose, &mesh).unwrap_err().to_string(), text);
            assert_eq!(together.unwrap_err().to_string(), text);
            contact
        };
        for answer in answers {
            for size in [1e-12, 1e-6, 1.0, 1e9, 1e200, f64::MAX, f64::INFINITY, f64::NAN] {
                let mut other = answer;
                other.distance += size;
                let field = |error| match error {
                    ProximityError::AnswerDoesNotFit { field, .. } => field,
                    other => panic!("{other}"),
                };
                assert_eq!(field(refused(&other)), "distance", "{seed}, {size}");
                if answer.distance == 0.0 {
                    continue;
                }
                // Out of the plane of its triangle, into the wall or out of it.
                let apart = (answer.witness.on_robot - answer.witness.on_mesh) / answer.distance;
                other = answer;
                other.witness.on_mesh -= apart * size;
                assert_eq!(field(refused(&other)), "on_mesh", "{seed}, {size}");
                other = answer;
                other.witness.on_robot -= apart * size;
                // Towards the wall is out of the link.
                assert_eq!(field(refused(&other)), "on_robot", "{seed}, {size}");
                changed += 1;
            }
            // Another place of the triangle or the link is in its shape, but not the nearest.
            // (Where the two touch at a corner, that corner is the place itself, but
            // for rounding.)
            let corners = *mesh.triangle(answer.witness.triangle).vertices();
            for corner in corners {
                let mut other = answer;
                other.witness.on_mesh = corner;
                other.distance = (corner - answer.witness.on_robot).length();
                if other.distance > answer.distance * (1.0 + 1e-9) + 1e-12 {
                    assert!(matches!(
                        refused(&other),
                        ProximityError::AnswerDoesNotFit { field: "distance", .. }
                    ));
                    alone += 1;
                }
            }
            let mut other = answer;
            other.link = 77;
            let links = robot.links().len();
            assert_eq!(refused(&other), ProximityError::NoSuchLink { link: 77, links });
            other = answer;
            other.witness.triangle = u32::MAX;
            let triangle = u32::MAX as usize;
            let triangles = mesh.indices().len();
            assert_eq!(refused(&other), ProximityError::NoSuchTriangle { triangle, triangles });
        }
        // Another pose, or another robot.
        let answer = search.minimum(&robot, &pose).unwrap();
        let turned = pose * Pose::translation(0.3, 0.1, 0.2);
        let other = search.contact_of(&robot, &turned, &answer);
        assert!(is_unfit(&other) || answer.distance == 0.0, "{seed}: {answer:?}");
    }
    assert!(changed > 1000 && alone > 500, "{changed} {alone}");
}

/// A wall that slides in its own plane is as near as before, at the same place. One that turns
/// about that place is nearer elsewhere, although the place is on it still.
#[test]
fn a_wall_may_move_where_the_answer_stays() {
    let square = [[-4.0, -4.0, 0.0], [4.0, -4.0, 0.0], [0.0, 4.0, 0.0]];
    let mesh = mesh_of(&[square]);
    let robot = Chain::capsules(&[Vector::Z, Vector::Z * 3.0], &[0.25]).unwrap();
    let pose = Pose::translation(0.5, -0.5, 0.0);
    for (name, mut engine) in engines(&mesh) {
        let answer = engine.minimum(&robot, &pose).unwrap();
        assert_eq!(
            (answer.distance, answer.witness.on_mesh),
            (0.75, Vector::new(0.5, -0.5, 0.0)),
            "{name}"
        );
        let slid: Vec<_> = mesh.vertices().iter().map(|v| v + Vector::new(1.0, 0.5, 0.0)).collect();
        engine.set_vertices(&slid).unwrap();
        let contact = engine.contact_of(&robot, &pose, &answer).unwrap();
        assert_eq!((contact.distance, contact.normal), (0.75, Some(Vector::Z)), "{name}");
        let away: Vec<_> =
            mesh.vertices().iter().map(|v| v + Vector::new(40.0, 0.0, 0.0)).collect();
        engine.set_vertices(&away).unwrap();
        let found = engine.contact_of(&robot, &pose, &answer);
        assert!(
            matches!(found, Err(ProximityError::AnswerDoesNotFit { field: "on_mesh", off, .. }) if off > 30.0)
        );
        let about = Pose::rotation(Vector::X * 0.3);
        let turned: Vec<_> = mesh
            .vertices()
            .iter()
            .map(|&v| answer.witness.on_mesh + about * (v - answer.witness.on_mesh))
            .collect();
        engine.set_vertices(&turned).unwrap();
        let found = engine.contact_of(&robot, &pose, &answer);
        assert!(
            matches!(found, Err(ProximityError::AnswerDoesNotFit { field: "distance", .. })),
            "{found:?}"
        );
    }
}

/// Triangles that are given as such are the same mesh, and each bad index is named.
#[test]
fn engines_from_triangles() {
    let random = &mut Random::new(8);
    let (mesh, robot, pose) = (wall(random), robot(random), Pose::IDENTITY);
    let (vertices, triangles) = (mesh.vertices(), mesh.indices());
    let mut search = BvhSearch::from_triangles(vertices, triangles).unwrap();
    let mut exhaustive = Exhaustive::<f32>::from_triangles(vertices, triangles).unwrap();
    let expected = BvhSearch::new(&mesh).unwrap().minimum(&robot, &pose);
    assert_eq!(
        (search.minimum(&robot, &pose), exhaustive.minimum(&robot, &pose)),
        (expected, expected)
    );

    let mut far = triangles.to_vec();
    far[3][1] = vertices.len() as u32;
    let mut broken = vertices.to_vec();
    broken[7].y = f64::NAN;
    let refused = |vertices: &[Vector], triangles: &[[u32; 3]]| {
        let error = BvhSearch::from_triangles(vertices, triangles).unwrap_err();
        let other = Exhaustive::<f64>::from_triangles(vertices, triangles).unwrap_err();
        assert_eq!(other.to_string(), error.to_string());
        error
    };
    let (vertex, count) = (vertices.len() as u32, vertices.len());
    let missing = MeshError::NoSuchVertex { triangle: 3, vertex, vertices: count };
    assert_eq!(refused(vertices, &far), missing);
    assert_eq!(
        missing.to_string(),
        format!(
            "triangle 3 names vertex {vertex}, but there are {count} vertices; repair the mesh's triangles"
        )
    );
    far[0][0] = u32::MAX;
    assert!(matches!(
        refused(vertices, &far),
        MeshError::NoSuchVertex { triangle: 0, vertex: u32::MAX, .. }
    ));
    assert!(matches!(refused(&broken, triangles), MeshError::NotFinite { vertex: 7, .. }));
    assert_eq!(refused(vertices, &[]), MeshError::Empty);
    assert!(matches!(
        refused(&[], triangles),
        MeshError::NoSuchVertex { triangle: 0, vertices: 0, .. }
    ));
}

/// Queries of several meshes in turn, each bounded by the slack of the last, with violated margins:
/// a bound below zero returns nothing.
#[test]
fn the_tightest_of_several_meshes_where_a_margin_is_violated() {
    let (mut violated, mut beyond) = (0, 0);
    for seed in 0..rounds(200) {
        let random = &mut Random::new(seed);
        let robot = robot(random);
        let meshes: Vec<_> = (0..3)
            .map(|_| {
                let away = random.point() * 2.0;
                let moved = wall(random).vertices().iter().map(|&v| v + away).collect();
                (
                    TriMesh::new(moved, wall(random).indices().to_vec()).unwrap(),
                    random.between(0.0, 3.0),
                )
            })
            .collect();
        let names: Vec<_> = engines(&meshes[0].0).into_iter().map(|(name, _)| name).collect();
        for (which, name) in names.into_iter().enumerate() {
            let (mut room, mut tightest, mut all) = (f64::INFINITY, None, Vec::new());
            for (number, (mesh, margin)) in meshes.iter().enumerate() {
                let (_, mut engine) = engines(mesh).swap_remove(which);
                let bound = room + margin;
                if let Some(found) = engine.minimum_within(&robot, &Pose::IDENTITY, bound).unwrap()
                {
                    assert!(bound >= 0.0);
                    (room, tightest) = (found.distance - margin, Some(number));
                }
                all.push(engine.minimum(&robot, &Pose::IDENTITY).unwrap().distance - margin);
                violated += u32::from(room < 0.0);
                beyond += u32::from(bound < 0.0);
            }
            let least = all.iter().copied().fold(f64::INFINITY, f64::min);
            assert_eq!(room, least, "{name}, {seed}");
            assert_eq!(all[tightest.unwrap()], least, "{name}, {seed}");
        }
    }
    assert!(violated > rounds(300) && beyond > rounds(30), "{violated} {beyond}");
}

#[test]
fn a_bound_below_zero_asks_for_nothing() {
    let mesh = mesh_of(&[[[-4.0, -4.0, 0.0], [4.0, -4.0, 0.0], [0.0, 4.0, 0.0]]]);
    let robot = Chain::capsules(&[-Vector::Z, Vector::Z], &[0.25]).unwrap();
    for (name, mut engine) in engines(&mesh) {
        let mut within = |bound| engine.minimum_within(&robot, &Pose::IDENTITY, bound);
        for bound in [-f64::MIN_POSITIVE, -1e-300, -0.48, -1e300, f64::NEG_INFINITY] {
            assert_eq!(within(bound), Ok(None), "{name}");
        }
        for bound in [0.0, -0.0, f64::INFINITY] {
            assert!(within(bound).unwrap().is_some_and(|found| found.distance == 0.0), "{name}");
        }
        let message = within(f64::NAN).unwrap_err().to_string();
        assert!(message.contains("`bound` is NaN"), "{name}: {message}");
        let nowhere = Pose::translation(f64::NAN, 0.0, 0.0);
        let refused = engine.minimum_within(&robot, &nowhere, -1.0);
        assert_eq!(refused, Err(ProximityError::Pose(PlacementFault::PoseNotFinite)), "{name}");
    }
}
