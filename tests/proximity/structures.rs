//! A scene of several structures answers as its structures one by one.

use continuum_testing::Random;
use parry_continuum::Chain;
use parry_continuum::parry::math::{Pose, Vector};
use parry_continuum::parry::shape::Ball;
use parry_continuum::proximity::{
    Between, BvhSearch, PlacementFault, Proximity, ProximityError, RobotPair, Scene, SceneError,
    Tightest,
};

fn ball(centre: Vector, radius: f64) -> BvhSearch {
    let (vertices, triangles) = Ball::new(radius).to_trimesh(12, 6);
    let vertices: Vec<_> = vertices.iter().map(|vertex| *vertex + centre).collect();
    BvhSearch::from_triangles(&vertices, &triangles).unwrap()
}

fn robot(random: &mut Random) -> Chain {
    let mut points = vec![random.point() * 8.0];
    for _ in 0..8 {
        points.push(points[points.len() - 1] + random.point());
    }
    Chain::from_centreline(&points, &[0.3; 8]).unwrap()
}

/// The tightest pair, from every structure and robot in turn.
fn one_by_one(
    structures: &mut [(BvhSearch, Option<f64>, Pose)],
    robots: &[(&Chain, Pose)],
) -> Option<(f64, [usize; 2])> {
    let mut best: Option<(f64, [usize; 2])> = None;
    for (number, (search, margin, pose)) in structures.iter_mut().enumerate() {
        let Some(margin) = *margin else { continue };
        for (robot, (chain, at)) in robots.iter().enumerate() {
            let at = if *pose == Pose::IDENTITY { *at } else { pose.inverse() * *at };
            let slack = search.minimum(chain, &at).unwrap().distance - margin;
            if best.is_none_or(|(least, _)| slack < least) {
                best = Some((slack, [number, robot]));
            }
        }
    }
    best
}

#[test]
fn the_tightest_is_that_of_all_structures_in_turn() {
    let mut random = Random::new(1);
    let (mut clear, mut met, mut moved) = (0, 0, 0);
    for round in 0..40 {
        let mut structures: Vec<_> = (0..8)
            .map(|_| {
                let search = ball(random.point() * 10.0, random.between(0.5, 2.0));
                let margin =
                    [None, Some(0.0), Some(random.between(0.0, 2.0))][random.below(3) as usize];
                (search, margin, Pose::IDENTITY)
            })
            .collect();
        let mut scene = Scene::new();
        for (number, (search, margin, _)) in structures.iter().enumerate() {
            assert_eq!(scene.add(format!("organ {number}"), search.clone(), *margin), Ok(number));
        }
        assert_eq!((scene.len(), scene.name(3), scene.name(8)), (8, Some("organ 3"), None));
        for step in 0..6 {
            if step > 2 {
                let number = random.below(8) as usize;
                structures[number].2 = random.pose(2.0);
                scene.set_pose(number, &structures[number].2).unwrap();
                moved += 1;
            }
            let chains = [robot(&mut random), robot(&mut random)];
            let robots = [(&chains[0], random.pose(0.1)), (&chains[1], Pose::IDENTITY)];
            let expected = one_by_one(&mut structures, &robots);
            let found = scene.tightest(&robots).unwrap();
            match (found, expected) {
                (
                    Some(Tightest { slack, between: Between::Structure(near), .. }),
                    Some((least, pair)),
                ) => {
                    assert_eq!(slack, least, "round {round}");
                    assert_eq!([near.structure as usize, near.robot as usize], pair);
                    assert_eq!(near.slack, Some(slack));
                    let way = near.nearest.witness.on_robot - near.nearest.witness.on_mesh;
                    assert!((way.length() - near.nearest.distance).abs() < 1e-12);
                }
                (found, expected) => {
                    assert_eq!((found.is_none(), expected.is_none()), (true, true))
                }
            }
            let clears = scene.clears(&robots).unwrap();
            assert_eq!(clears, expected.is_none_or(|(slack, _)| slack > 0.0));
            if clears {
                clear += 1
            } else {
                met += 1
            }

            let mut each = Vec::new();
            scene.per_structure(&robots, &mut each).unwrap();
            assert_eq!(each.len(), 8);
            for (number, near) in each.iter().enumerate() {
                let (search, margin, pose) = &mut structures[number];
                let least = robots.iter().map(|(chain, at)| {
                    let at = if *pose == Pose::IDENTITY { *at } else { pose.inverse() * *at };
                    search.minimum(chain, &at).unwrap().distance
                });
                assert_eq!(near.nearest.distance, least.fold(f64::INFINITY, f64::min));
                assert_eq!(near.slack, margin.map(|margin| near.nearest.distance - margin));
            }

            let mut contacts = Vec::new();
            scene.contacts_within(&robots, 1.0, 0.0, &mut contacts).unwrap();
            for (number, near) in each.iter().enumerate() {
                let of_it = contacts.iter().filter(|found| found.structure as usize == number);
                let least = of_it.map(|found| found.contact.distance).fold(f64::INFINITY, f64::min);
                assert_eq!(least <= 1.0, near.nearest.distance <= 1.0);
                if least <= 1.0 {
                    assert_eq!(least, near.nearest.distance);
                }
            }
        }
    }
    assert!(clear > 30 && met > 15 && moved > 50, "{clear} {met} {moved}");
}

#[test]
fn of_equal_slacks_the_lowest_structure_counts() {
    let robot = Chain::from_centreline(&[Vector::ZERO, Vector::Z], &[0.5]).unwrap();
    let robots = [(&robot, Pose::IDENTITY)];
    let at = |x: f64| ball(Vector::X * x, 1.0);
    let mut scene = Scene::new();
    for (number, x) in [9.0, 4.0, -4.0, 4.0].into_iter().enumerate() {
        scene.add(format!("organ {number}"), at(x), Some(1.0)).unwrap();
    }
    let structure =
        |scene: &mut Scene| match scene.tightest(&robots).unwrap().map(|found| found.between) {
            Some(Between::Structure(near)) => near.structure,
            other => panic!("{other:?}"),
        };
    assert_eq!(structure(&mut scene), 1);
    scene.set_margin(1, None).unwrap();
    // Structure 2 is the mirror image of 3, and may differ by rounding; the same mesh twice does
    // not.
    scene.set_margin(2, None).unwrap();
    assert_eq!(structure(&mut scene), 3);
    scene.set_margin(1, Some(1.0)).unwrap();
    // Structure 3 was tightest last, and is searched first.
    assert_eq!(structure(&mut scene), 1);
}

#[test]
fn robots_are_held_against_one_another_where_they_have_a_margin() {
    let robot = Chain::from_centreline(&[Vector::ZERO, Vector::Z], &[0.5]).unwrap();
    let robots = [(&robot, Pose::IDENTITY), (&robot, Pose::translation(3.0, 0.0, 0.0))];
    let mut scene = Scene::new();
    assert_eq!(scene.tightest(&robots).unwrap(), None);
    assert_eq!(scene.clears(&robots), Err(SceneError::NoMargin));
    scene.set_robot_margin(Some(0.5)).unwrap();
    let tightest = scene.tightest(&robots).unwrap().unwrap();
    let apart = RobotPair::new().minimum(&robot, &robots[0].1, &robot, &robots[1].1).unwrap();
    assert_eq!(tightest.slack, apart.distance - 0.5);
    assert_eq!(tightest.between, Between::Robots { robots: [0, 1], nearest: apart });
    assert!(scene.clears(&robots).unwrap());
    scene.set_robot_margin(Some(2.0)).unwrap();
    assert!(!scene.clears(&robots).unwrap());
    // A structure that is tighter counts before them.
    scene.add("wall", ball(Vector::X * 5.5, 1.0), Some(3.0)).unwrap();
    assert!(matches!(scene.tightest(&robots).unwrap().unwrap().between, Between::Structure(_)));
}

#[test]
fn a_tube_inside_another_does_not_collide_with_it() {
    let outer = Chain::from_centreline(&[Vector::ZERO, Vector::Z * 5.0], &[1.0]).unwrap();
    let inner = Chain::from_centreline(&[Vector::ZERO, Vector::Z * 9.0], &[0.5]).unwrap();
    let robots = [
        (&outer, Pose::IDENTITY),
        (&inner, Pose::IDENTITY),
        (&outer, Pose::translation(4.0, 0.0, 0.0)),
    ];
    let mut scene = Scene::new();
    scene.set_robot_margin(Some(0.25)).unwrap();
    assert!(!scene.clears(&robots).unwrap());
    for nested in [[0, 1], [1, 0]] {
        scene.set_nested(&[nested, [7, 8]]);
        assert!(scene.clears(&robots).unwrap());
        // The others are compared with one another as before.
        let tightest = scene.tightest(&robots).unwrap().unwrap();
        assert_eq!(tightest.slack, 1.75);
        assert!(matches!(tightest.between, Between::Robots { robots: [0, 2], .. }));
        scene.set_robot_margin(Some(2.0)).unwrap();
        assert!(!scene.clears(&robots).unwrap());
        scene.set_robot_margin(Some(0.25)).unwrap();
    }
    // The second robot of a nested pair still needs a finite pose.
    let nowhere = [robots[0], (&inner, Pose::from_translation(Vector::splat(f64::NAN)))];
    scene.set_nested(&[[0, 1]]);
    assert!(matches!(scene.clears(&nowhere), Err(SceneError::Robot { robot: 1, .. })));
    assert!(matches!(scene.tightest(&nowhere), Err(SceneError::Robot { robot: 1, .. })));
    scene.set_nested(&[]);
    assert_eq!(scene.tightest(&robots).unwrap().unwrap().slack, -0.25);
}

#[test]
fn a_structure_moves_with_its_vertices() {
    let robot = Chain::from_centreline(&[Vector::ZERO, Vector::Z], &[0.5]).unwrap();
    let robots = [(&robot, Pose::IDENTITY)];
    let mut scene = Scene::new();
    let organ = scene.add("organ", ball(Vector::X * 50.0, 1.0), Some(1.0)).unwrap();
    assert!(scene.clears(&robots).unwrap());
    let near: Vec<_> = ball(Vector::X * 2.0, 1.0).vertices().to_vec();
    scene.set_vertices(organ, &near).unwrap();
    assert!(!scene.clears(&robots).unwrap());
}

#[test]
fn who_is_at_fault_is_named() {
    let robot = Chain::from_centreline(&[Vector::ZERO, Vector::Z], &[0.5]).unwrap();
    let mut scene = Scene::new();
    let error = scene.add("liver", ball(Vector::ZERO, 1.0), Some(-1.0)).unwrap_err();
    assert!(
        error.to_string().contains("`liver`") && error.to_string().contains("`margin`"),
        "{error}"
    );
    assert_eq!(error.kind(), "negative");
    assert!(scene.is_empty());
    let liver = scene.add("liver", ball(Vector::ZERO, 1.0), Some(1.0)).unwrap();
    let error = scene.set_vertices(liver, &[Vector::ZERO]).unwrap_err();
    assert!(error.to_string().contains("`liver`"), "{error}");
    let nowhere = Pose::from_translation(Vector::splat(f64::INFINITY));
    let robots = [(&robot, Pose::IDENTITY), (&robot, nowhere)];
    for error in [scene.clears(&robots[1..]).unwrap_err(), scene.tightest(&robots).unwrap_err()] {
        assert!(matches!(error, SceneError::Robot { .. }), "{error}");
        assert_eq!(error.kind(), "pose_not_finite");
    }
    assert_eq!(scene.set_margin(7, None).unwrap_err().kind(), "no_such_structure");
}

/// Parameters are checked in a scene without structures too, under their own names.
#[test]
fn bad_lengths_are_refused_under_their_own_names() {
    let robot = Chain::from_centreline(&[Vector::ZERO, Vector::Z], &[0.5]).unwrap();
    let robots = [(&robot, Pose::IDENTITY)];
    let mut scene = Scene::new();
    for structures in 0..2 {
        for (reach, prominence, name) in
            [(-1.0, 0.0, "reach"), (f64::NAN, 0.0, "reach"), (1.0, -1.0, "prominence")]
        {
            let refused =
                scene.contacts_within(&robots, reach, prominence, &mut Vec::new()).unwrap_err();
            assert_eq!(refused.kind(), "negative");
            assert!(refused.to_string().starts_with(&format!("`{name}` is ")), "{refused}");
        }
        scene.contacts_within(&robots, 1.0, 0.0, &mut Vec::new()).unwrap();
        scene.add(format!("{structures}"), ball(Vector::X * 5.0, 1.0), None).unwrap();
    }
}

/// Contacts less prominent than asked for are left out, as of each mesh alone.
#[test]
fn contacts_have_a_prominence() {
    let mut random = Random::new(14);
    let robot = robot(&mut random);
    let pose = random.pose(0.1);
    // A mesh that is rough by 0.5.
    let (vertices, triangles) = Ball::new(8.0).to_trimesh(48, 24);
    let rough: Vec<_> = vertices.iter().map(|&vertex| vertex + random.point() * 0.5).collect();
    let mut wall = BvhSearch::from_triangles(&rough, &triangles).unwrap();
    let mut scene = Scene::new();
    scene.add("wall", wall.clone(), None).unwrap();
    let mut counts = Vec::new();
    for prominence in [0.0, 0.3, f64::INFINITY] {
        let (mut found, mut expected) = (Vec::new(), Vec::new());
        scene.contacts_within(&[(&robot, pose)], 6.0, prominence, &mut found).unwrap();
        wall.contacts_within(&robot, &pose, 6.0, prominence, &mut expected).unwrap();
        assert_eq!(found.iter().map(|found| found.contact).collect::<Vec<_>>(), expected);
        counts.push(found.len());
    }
    assert!(counts[0] > counts[1] && counts[1] >= counts[2] && counts[2] > 0, "{counts:?}");
}

/// `reach` is checked in an empty scene too, and no structure is blamed for it.
#[test]
fn a_bad_reach_is_an_error_in_every_scene() {
    let robot = Chain::from_centreline(&[Vector::ZERO, Vector::Z], &[0.5]).unwrap();
    let robots = [(&robot, Pose::IDENTITY)];
    let mut scene = Scene::new();
    for structures in 0..2 {
        for reach in [-1.0, f64::NAN, f64::NEG_INFINITY] {
            let error = scene.contacts_within(&robots, reach, 0.0, &mut Vec::new()).unwrap_err();
            assert!(matches!(error, SceneError::Query(_)), "{structures}: {error:?}");
            assert_eq!(error.kind(), "negative");
            assert!(error.to_string().contains("`reach`"), "{error}");
        }
        assert_eq!(scene.contacts_within(&robots, 0.0, 0.0, &mut Vec::new()), Ok(()));
        scene.add(format!("{structures}"), ball(Vector::ZERO, 1.0), None).unwrap();
    }
}

/// Without any margin `clears` tests nothing, so it is an error instead of "clear".
#[test]
fn a_scene_without_any_margin_has_nothing_to_clear() {
    let robot = Chain::from_centreline(&[Vector::ZERO, Vector::Z], &[0.5]).unwrap();
    let robots = [(&robot, Pose::IDENTITY)];
    let mut scene = Scene::new();
    let refused = |scene: &mut Scene| {
        let error = scene.clears(&robots).unwrap_err();
        assert_eq!(error, SceneError::NoMargin);
        assert_eq!(error.kind(), "no_margin");
        assert!(error.to_string().contains("`per_structure`"), "{error}");
        let mut answers = Vec::new();
        scene.clears_batch(&[&robots], &mut answers);
        assert_eq!(answers, [Err(SceneError::NoMargin)]);
        assert_eq!(scene.tightest(&robots), Ok(None));
    };
    refused(&mut scene);
    let target = scene.add("target", ball(Vector::ZERO, 1.0), None).unwrap();
    refused(&mut scene);
    scene.set_margin(target, Some(0.0)).unwrap();
    assert_eq!(scene.clears(&robots), Ok(false));
    scene.set_margin(target, None).unwrap();
    refused(&mut scene);
    // A margin between robots is one, even with a single robot.
    scene.set_robot_margin(Some(0.0)).unwrap();
    assert_eq!(scene.clears(&robots), Ok(true));
}

/// What must be infinitely far away never is.
#[test]
fn an_infinite_margin_is_kept_by_nobody() {
    let mut random = Random::new(4);
    let robot = robot(&mut random);
    let robots = [(&robot, Pose::IDENTITY), (&robot, Pose::translation(40.0, 0.0, 0.0))];
    let mut scene = Scene::new();
    scene.add("near", ball(Vector::X * 30.0, 1.0), Some(0.5)).unwrap();
    scene.add("forbidden", ball(Vector::X * -30.0, 1.0), Some(f64::INFINITY)).unwrap();
    scene.add("far", ball(Vector::X * 90.0, 1.0), Some(0.5)).unwrap();
    let tightest = scene.tightest(&robots).unwrap().unwrap();
    assert_eq!(tightest.slack, f64::NEG_INFINITY);
    assert!(
        matches!(tightest.between, Between::Structure(near) if near.structure == 1),
        "{tightest:?}"
    );
    assert!(!scene.clears(&robots).unwrap());
    let mut scene = Scene::new();
    scene.add("near", ball(Vector::X * 30.0, 1.0), Some(0.5)).unwrap();
    scene.set_robot_margin(Some(f64::INFINITY)).unwrap();
    let tightest = scene.tightest(&robots).unwrap().unwrap();
    assert!(
        tightest.slack == f64::NEG_INFINITY && matches!(tightest.between, Between::Robots { .. })
    );
    assert!(!scene.clears(&robots).unwrap());
}

/// A batch says of every set what the scene says of it alone, and one that is refused costs the
/// others nothing.
#[test]
fn many_sets_have_the_answers_of_each() {
    let mut random = Random::new(9);
    let mut scene = Scene::new();
    for number in 0..6 {
        let search = ball(random.point() * 10.0, random.between(0.5, 2.0));
        scene
            .add(format!("organ {number}"), search, [None, Some(0.2), Some(1.0)][number % 3])
            .unwrap();
    }
    scene.set_pose(1, &random.pose(1.0)).unwrap();
    scene.set_robot_margin(Some(0.1)).unwrap();
    let chains: Vec<_> = (0..60).map(|_| [robot(&mut random), robot(&mut random)]).collect();
    let mut sets: Vec<Vec<_>> =
        chains.iter().map(|[a, b]| vec![(a, random.pose(0.5)), (b, Pose::IDENTITY)]).collect();
    sets[7].clear();
    sets[11].truncate(1);
    sets[20][1].1 = Pose::from_translation(Vector::NAN);
    let slices: Vec<_> = sets.iter().map(Vec::as_slice).collect();
    let (mut clears, mut tightest) = (vec![Ok(false); 3], Vec::new());
    for _ in 0..2 {
        scene.clears_batch(&slices, &mut clears);
        scene.tightest_batch(&slices, &mut tightest);
        assert_eq!((clears.len(), tightest.len()), (60, 60));
        for (set, robots) in slices.iter().enumerate() {
            assert_eq!(clears[set], scene.clears(robots), "{set}");
            assert_eq!(tightest[set], scene.tightest(robots), "{set}");
        }
        // What has moved since has moved for the next batch.
        scene.set_pose(2, &random.pose(3.0)).unwrap();
    }
    assert_eq!(
        clears[20],
        Err(SceneError::Robot {
            robot: 1,
            structure: None,
            error: ProximityError::Pose(PlacementFault::PoseNotFinite)
        })
    );
    let count = |clear: bool| clears.iter().filter(|answer| **answer == Ok(clear)).count();
    assert!(count(true) > 5 && count(false) > 2, "{} {}", count(true), count(false));
}

/// The square of such a length is rounded up by a third and more.
#[test]
fn what_is_tiny_is_not_left_out() {
    let size = 1e-162;
    for away in (1..200).map(|k| size * (1.0 + 0.01 * f64::from(k))) {
        let corners = [Vector::ZERO, Vector::new(-size, size, 0.0), Vector::new(-size, -size, 0.0)];
        let mut scene = Scene::new();
        let wall = BvhSearch::from_triangles(&corners, &[[0, 1, 2]]).unwrap();
        scene.add("wall", wall, Some(away * 1.01)).unwrap();
        let at = Vector::X * away;
        let wire =
            Chain::capsules(&[at - Vector::Y * size, at + Vector::Y * size], &[0.0]).unwrap();
        assert_eq!(scene.clears(&[(&wire, Pose::IDENTITY)]), Ok(false), "{away:e}");
        let found = scene.tightest(&[(&wire, Pose::IDENTITY)]).unwrap().unwrap();
        assert!(found.slack < 0.0 && found.slack > -0.02 * away, "{away:e} {found:?}");
    }
}

#[test]
fn a_margin_counts_from_when_it_is_set() {
    let mut scene = Scene::new();
    scene.add("wall", ball(Vector::ZERO, 1.0), Some(0.1)).unwrap();
    scene.add("target", ball(Vector::X * 40.0, 1.0), None).unwrap();
    let robot = Chain::from_centreline(&[Vector::ZERO, Vector::Z], &[0.5]).unwrap();
    // Beside the box around both, and 27 from either.
    let robots = [(&robot, Pose::translation(20.0, 20.0, 0.0))];
    for (margin, clears) in [
        (Some(0.1), Ok(true)),
        (Some(30.0), Ok(false)),
        (Some(0.1), Ok(true)),
        (None, Err(SceneError::NoMargin)),
    ] {
        for structure in [0, 1] {
            scene.set_margin(structure, margin).unwrap();
            assert_eq!(scene.clears(&robots), clears);
            scene.set_margin(structure, None).unwrap();
        }
    }
}

/// Robots are checked in a scene without structures as in every other.
#[test]
fn a_robot_out_of_range_is_an_error_in_an_empty_scene() {
    let robot = Chain::from_centreline(&[Vector::ZERO, Vector::Z], &[0.1]).unwrap();
    let away = (&robot, Pose::translation(1e200, 0.0, 0.0));
    let mut scene = Scene::new();
    let mut each = Vec::new();
    let expected = scene.tightest(&[away]).unwrap_err();
    assert_eq!(scene.per_structure(&[away], &mut each).unwrap_err(), expected);
    scene.add("ball", ball(Vector::ZERO, 1.0), None).unwrap();
    assert_eq!(scene.per_structure(&[away], &mut each).unwrap_err(), expected);
}
