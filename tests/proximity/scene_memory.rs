//! The memory of a scene changes no answer: at every step of robots that move in any way it answers
//! as a fresh scene.

use continuum_testing::{Random, WarmAndFresh, rounds};
use parry_continuum::Chain;
use parry_continuum::parry::math::{Pose, Vector};
use parry_continuum::parry::shape::Ball;
use parry_continuum::proximity::{Between, BvhSearch, Scene, SceneError, Tightest};

/// Where a problem lies and how large its unit is.
struct Place {
    origin: Vector,
    unit: f64,
}

impl Place {
    fn of(&self, point: Vector) -> Vector {
        self.origin + point * self.unit
    }

    /// The same motion about the place's origin.
    fn pose(&self, pose: &Pose) -> Pose {
        let there = Pose::from_translation(self.origin);
        there * Pose::from_parts(pose.translation * self.unit, pose.rotation) * there.inverse()
    }
}

/// A robot that changes a little from step to step.
struct Walker {
    points: Vec<Vector>,
    radii: Vec<f64>,
    /// Which constructor makes the links.
    model: u32,
    pose: Pose,
    /// What its steps are like: it shifts, turns, bends, grows, or all of that.
    way: u32,
    shift: Vector,
    turn: Vector,
    step: f64,
}

impl Walker {
    fn new(random: &mut Random) -> Self {
        let mut points = vec![random.point() * 2.0];
        let length = [0.05, 0.3, 1.0][random.below(3) as usize];
        let is_aligned = random.below(3) == 0;
        for _ in 0..1 + random.below(6) {
            let aligned = [Vector::X, Vector::Z][random.below(2) as usize];
            let direction = if is_aligned { aligned } else { random.direction() };
            points.push(points[points.len() - 1] + direction * length);
        }
        let radii = vec![[0.02, 0.3, 0.8][random.below(3) as usize]; points.len() - 1];
        let pose = if is_aligned { Pose::IDENTITY } else { random.pose(1.0) };
        let (shift, turn) = (random.direction(), random.direction());
        let step = 10.0_f64.powf(random.between(-4.0, -0.3));
        Self {
            points,
            radii,
            model: random.below(3),
            pose,
            way: random.below(5),
            shift,
            turn,
            step,
        }
    }

    fn walk(&mut self, random: &mut Random) {
        let is = |way: &u32, which: u32| *way == which || *way == 4;
        if is(&self.way, 0) {
            self.pose.translation += self.shift * self.step;
        }
        if is(&self.way, 1) {
            // About the middle of the robot, so that the nearest part turns most.
            let middle = self.pose * self.points[self.points.len() / 2];
            let about =
                Pose::from_translation(middle) * Pose::new(Vector::ZERO, self.turn * self.step);
            self.pose = about * Pose::from_translation(-middle) * self.pose;
        }
        if is(&self.way, 2) {
            let bend = random.point() * self.step;
            self.points.iter_mut().skip(1).for_each(|point| *point += bend);
        }
        if is(&self.way, 3) {
            self.radii.iter_mut().for_each(|radius| *radius += 0.3 * self.step);
        }
        match random.below(40) {
            0 => *self = Self::new(random),
            1 => self.model = random.below(3),
            2 => {
                let size = [2.0, 12.0][random.below(2) as usize];
                self.pose = random.pose(size);
            }
            3 => (self.shift, self.turn) = (random.direction(), random.direction()),
            4 => self.radii.iter_mut().for_each(|radius| *radius *= 1.5),
            _ => {}
        }
    }

    fn chain(&self, place: &Place) -> Chain {
        let points: Vec<_> = self.points.iter().map(|&point| place.of(point)).collect();
        let radii: Vec<_> = self.radii.iter().map(|radius| radius * place.unit).collect();
        let make = [Chain::capsules, Chain::cylinders, Chain::from_centreline][self.model as usize];
        make(&points, &radii).unwrap()
    }
}

fn egg(random: &mut Random, place: &Place) -> (Vec<Vector>, Vec<[u32; 3]>) {
    let (vertices, triangles) = Ball::new(1.0).to_trimesh(12, 6);
    let (centre, axes) = (random.direction() * 3.0, random.point().abs() + 0.3);
    (vertices.iter().map(|vertex| place.of(centre + *vertex * axes)).collect(), triangles)
}

/// How often what a walk is to visit was met.
#[derive(Debug, Default)]
struct Visited {
    clear: u32,
    met: u32,
    /// The slack was smaller than 1e-8 of the unit.
    touching: u32,
    contacts: usize,
    moved: u32,
    deformed: u32,
    /// Two structures were tightest alike.
    tied: u32,
}

/// Asks all questions in some order.
fn ask_both(
    random: &mut Random,
    both: &mut WarmAndFresh<Scene>,
    robots: &[(&Chain, Pose)],
    unit: f64,
    visited: &mut Visited,
) -> Option<Tightest> {
    let mut tightest = None;
    for _ in 0..3 {
        match random.below(3) {
            0 => match both.ask("clears", |scene| scene.clears(robots)) {
                Ok(true) => visited.clear += 1,
                Ok(false) => visited.met += 1,
                Err(refused) => assert_eq!(refused, SceneError::NoMargin),
            },
            1 => {
                tightest = both.ask("tightest", |scene| scene.tightest(robots).unwrap());
                let touches = tightest.is_some_and(|found| found.slack.abs() < 1e-8 * unit);
                visited.touching += u32::from(touches);
            }
            _ => {
                let reach = unit * random.between(0.0, 1.0);
                visited.contacts += both
                    .ask("contacts", |scene| {
                        let mut found = Vec::new();
                        scene.contacts_within(robots, reach, 0.0, &mut found).unwrap();
                        found
                    })
                    .len();
            }
        }
    }
    tightest
}

fn walks(rounds: u32, place: &Place, visited: &mut Visited) {
    for round in 0..rounds {
        let random = &mut Random::new(round.into());
        let (mut scene, mut meshes) = (Scene::new(), Vec::new());
        for number in 0..6 {
            let (vertices, triangles) = egg(random, place);
            let search = BvhSearch::from_triangles(&vertices, &triangles).unwrap();
            let margin = [None, Some(0.0), Some(0.2 * place.unit)][random.below(3) as usize];
            scene.add(format!("organ {number}"), search, margin).unwrap();
            meshes.push(vertices);
        }
        scene.set_robot_margin([None, Some(0.1 * place.unit)][random.below(2) as usize]).unwrap();
        // The last is the first once more.
        let first = BvhSearch::from_triangles(&meshes[0], &egg(random, place).1).unwrap();
        scene.add("twin", first, scene.margin(0)).unwrap();
        meshes.push(meshes[0].clone());
        let mut are_twins = true;
        let mut both = WarmAndFresh::new(scene);
        let mut walkers = [Walker::new(random), Walker::new(random)];
        for _ in 0..50 {
            walkers.iter_mut().for_each(|walker| walker.walk(random));
            let number = random.below(7) as usize;
            let before = visited.moved + visited.deformed;
            match random.below(16) {
                0 => {
                    let size = [0.01, 1.0][random.below(2) as usize];
                    let pose = random.pose(size);
                    let pose = [place.pose(&pose), Pose::IDENTITY][random.below(2) as usize];
                    both.change(|scene| scene.set_pose(number, &pose).unwrap());
                    visited.moved += 1;
                }
                1 => {
                    let by =
                        random.direction() * (place.unit * [0.01, 1.0][random.below(2) as usize]);
                    meshes[number].iter_mut().for_each(|vertex| *vertex += by);
                    both.change(|scene| scene.set_vertices(number, &meshes[number]).unwrap());
                    visited.deformed += 1;
                }
                _ => {}
            }
            are_twins &= before == visited.moved + visited.deformed || (1..6).contains(&number);
            let chains = walkers.each_ref().map(|walker| walker.chain(place));
            let mut robots = vec![];
            for (walker, chain) in walkers.iter().zip(&chains) {
                robots.push((chain, place.pose(&walker.pose)));
            }
            robots.truncate([2, 2, 2, 1][random.below(4) as usize]);
            let found = ask_both(random, &mut both, &robots, place.unit, visited);
            if let Some(Tightest { between: Between::Structure(near), .. }) = found {
                assert!(!are_twins || near.structure != 6);
                visited.tied += u32::from(are_twins && near.structure == 0);
            }
            // A margin that is kept or missed by next to nothing.
            if let Some(Tightest { between: Between::Structure(near), .. }) = found
                && random.below(4) == 0
            {
                let by = [-1e-9, -1e-13, 0.0, 1e-13, 1e-9][random.below(5) as usize];
                let margin = Some((near.nearest.distance + by * place.unit).max(0.0));
                are_twins &= (1..6).contains(&near.structure);
                both.change(|scene| scene.set_margin(near.structure as usize, margin).unwrap());
                ask_both(random, &mut both, &robots, place.unit, visited);
            }
        }
    }
}

/// Walks a share of `full` rounds.
fn check(full: u32, place: &Place) {
    let (mut visited, rounds) = (Visited::default(), rounds(full));
    walks(rounds, place, &mut visited);
    let Visited { clear, met, touching, contacts, moved, deformed, tied } = visited;
    let enough = clear > 15 * rounds && met > 10 * rounds && touching > rounds;
    assert!(enough && contacts > 50 * rounds as usize && moved > 2 * rounds, "{visited:?}");
    assert!(deformed >= 2 * rounds && tied > rounds / 10, "{visited:?}");
}

#[test]
fn a_scene_that_remembers_says_what_a_new_one_says() {
    check(1200, &Place { origin: Vector::ZERO, unit: 1.0 });
}

#[test]
fn so_it_does_far_out_and_where_all_is_tiny() {
    check(500, &Place { origin: Vector::new(1e6, -2e6, 5e5), unit: 1.0 });
    check(500, &Place { origin: Vector::ZERO, unit: 1e-12 });
}

/// A structure out of range is the same error, whatever an earlier query has met.
#[test]
fn a_structure_out_of_range_is_an_error_after_any_query() {
    let (vertices, triangles) = Ball::new(1.0).to_trimesh(12, 6);
    let robot = Chain::capsules(&[Vector::ZERO, Vector::Z * 2.0], &[0.2]).unwrap();
    let robots = [(&robot, Pose::IDENTITY)];
    let far = Pose::translation(1e151, 0.0, 0.0);
    // Which structure the robot touches, which ones are moved away, and which one is named.
    for (touched, moved, named) in [(0, &[1][..], "b"), (1, &[0], "a"), (1, &[0, 1], "a")] {
        let mut scene = Scene::new();
        for (number, name) in ["a", "b"].into_iter().enumerate() {
            let search = BvhSearch::from_triangles(&vertices, &triangles).unwrap();
            scene.add(name, search, Some(0.1)).unwrap();
            let x = if number == touched { 0.0 } else { 50.0 };
            scene.set_pose(number, &Pose::translation(x, 0.0, 0.0)).unwrap();
        }
        assert_eq!(scene.clears(&robots), Ok(false));
        assert!(scene.tightest(&robots).unwrap().is_some_and(|tightest| tightest.slack < 0.0));
        moved.iter().for_each(|number| scene.set_pose(*number, &far).unwrap());
        for error in [scene.clears(&robots).unwrap_err(), scene.tightest(&robots).unwrap_err()] {
            let SceneError::Robot { structure: Some(name), .. } = error else {
                panic!("{error:?}")
            };
            assert_eq!(name, named, "{touched} {moved:?}");
        }
    }
}
