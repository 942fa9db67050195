//! `clears` and `minimum` in a loop answer as a fresh engine, for any sequence of queries.

use continuum_testing::Random;
use parry_continuum::Chain;
use parry_continuum::parry::math::{Pose, Vector};
use parry_continuum::parry::shape::{Ball, TriMesh};
use parry_continuum::proximity::*;

/// What may change from one query to the next.
struct Scene {
    points: Vec<Vector>,
    radii: Vec<f64>,
    caps: u32,
    pose: Pose,
    margin: f64,
    size: f64,
    links: u32,
}

impl Scene {
    /// A robot of this many links, five sizes long.
    fn new(size: f64, links: u32) -> Self {
        let points = (0..=links)
            .map(|k| Vector::Z * (5.0 / f64::from(links) * f64::from(k) * size))
            .collect();
        let radii = vec![0.4 * size; links as usize];
        Self { points, radii, caps: 0, pose: Pose::IDENTITY, margin: 0.5 * size, size, links }
    }

    fn robot(&self) -> Chain {
        let build = [Chain::from_centreline, Chain::cylinders, Chain::capsules][self.caps as usize];
        build(&self.points, &self.radii).unwrap()
    }

    /// Mostly a small motion, now and then something else altogether.
    fn step(&mut self, random: &mut Random) {
        let size = self.size;
        let small = size * 10.0_f64.powf(random.between(-6.0, -1.0));
        match random.below(60) {
            0 => self.pose = random.pose(3.0 * size),
            1 => self.caps = random.below(3),
            2 => {
                let link = random.below(self.radii.len() as u32) as usize;
                self.radii[link] = size * random.between(0.05, 0.8);
            }
            3 => self.margin = size * [0.0, 0.1, 0.5, 1.0, 2.0][random.below(5) as usize],
            4 => *self = Self::new(size, self.links),
            // Another number of links.
            5 if self.points.len() > 3 => {
                self.points.pop();
                self.radii.pop();
            }
            6..20 => self.pose.translation += random.direction() * small,
            20..40 => {
                let turn = random.direction() * (small / size);
                self.pose = Pose::new(random.direction() * small, turn) * self.pose;
            }
            40..50 => self
                .radii
                .iter_mut()
                .for_each(|radius| *radius *= 1.0 + small / size * random.between(-1.0, 1.0)),
            _ => self
                .points
                .iter_mut()
                .skip(1)
                .for_each(|point| *point += random.direction() * small),
        }
    }
}

#[test]
fn what_was_asked_before_changes_no_answer() {
    let (mut clear, mut touching, mut by_heart, mut near) = (0, 0, 0, 0);
    for (round, size) in [1.0, 1e-3, 2.0_f64.powi(200), 2.0_f64.powi(-560)].into_iter().enumerate()
    {
        let mut random = Random::new(round as u64);
        let (vertices, triangles) = Ball::new(6.0).to_trimesh(24, 12);
        let at_rest: Vec<_> = vertices.iter().map(|vertex| *vertex * size).collect();
        let mesh = TriMesh::new(at_rest.clone(), triangles).unwrap();
        let (mut kept, mut cold) = (BvhSearch::new(&mesh).unwrap(), BvhSearch::new(&mesh).unwrap());
        let mut scene = Scene::new(size, 5);
        for _ in 0..STEPS {
            scene.step(&mut random);
            if random.below(500) == 0 {
                let breath = random.between(0.6, 1.2);
                let moved: Vec<_> = at_rest.iter().map(|vertex| *vertex * breath).collect();
                kept.set_vertices(&moved).unwrap();
                cold.set_vertices(&moved).unwrap();
            }
            let robot = scene.robot();
            cold.forget();
            let distance = cold.minimum(&robot, &scene.pose).unwrap().distance;
            // Often just below or above what is true.
            let margin = match random.below(4) {
                0 => {
                    distance
                        * (1.0
                            + [-1e-15, 1e-15, -1e-9, 1e-9, -1e-3, 1e-3][random.below(6) as usize])
                }
                _ => scene.margin,
            };
            let before = kept.work().nodes;
            let keeps = kept.clears(&robot, &scene.pose, margin).unwrap();
            assert_eq!(keeps, distance > margin, "size {size:e}: {distance:e} and {margin:e}");
            by_heart += u32::from(kept.work().nodes == before);
            near += u32::from((distance - margin).abs() < 1e-2 * margin);
            *if keeps { &mut clear } else { &mut touching } += 1;
        }
    }
    let of = 4 * STEPS;
    assert!(clear > of / 5 && touching > of / 5, "{clear} clear, {touching} touching");
    assert!(
        by_heart > of / 20 && near > of / 20,
        "{by_heart} without a search, {near} near the margin of {of}"
    );
}

/// As many as a debug build answers in a second or two.
const STEPS: u32 = 25_000;

/// The disc of a flat cap turns with its axis: the rim moves far although both ends stay.
#[test]
fn a_turning_cap_is_not_taken_for_a_still_one() {
    // In the smaller unit the square of a length vanishes.
    [1.0, 2.0_f64.powi(-560)].into_iter().for_each(turn_a_cap);
}

fn turn_a_cap(size: f64) {
    let corners =
        [[-9.0, -9.0], [9.0, -9.0], [0.0, 9.0]].map(|[x, y]| Vector::new(x, y, 0.0) * size);
    let wall = TriMesh::new(corners.to_vec(), vec![[0, 1, 2]]).unwrap();
    let plate = [Vector::Z * (-0.01 * size), Vector::Z * (0.01 * size)];
    let plate = Chain::cylinders(&plate, &[3.0 * size]).unwrap();
    let (mut kept, mut cold) = (BvhSearch::new(&wall).unwrap(), BvhSearch::new(&wall).unwrap());
    let (mut by_heart, mut touches) = (0, 0);
    for step in 0..600 {
        let pose = Pose::new(Vector::Z * size, Vector::X * (1e-3 * f64::from(step)));
        cold.forget();
        let expected = cold.clears(&plate, &pose, 0.0).unwrap();
        let before = kept.work().nodes;
        assert_eq!(
            kept.clears(&plate, &pose, 0.0).unwrap(),
            expected,
            "size {size:e}, step {step}"
        );
        by_heart += u32::from(kept.work().nodes == before);
        touches += u32::from(!expected);
    }
    // It touches at sin(turn) = 1 / 3, or 0.34 rad.
    assert!(by_heart > 20 && touches > 100, "{by_heart} without a search, {touches} touch");
}

/// All that an answer tells.
fn bits(answer: &LinkProximity) -> (u32, u32, u64, [[u64; 3]; 2]) {
    let points = [answer.witness.on_robot, answer.witness.on_mesh]
        .map(|point| point.to_array().map(f64::to_bits));
    (answer.link, answer.witness.triangle, answer.distance.to_bits(), points)
}

/// What a sequence of queries for the minimum has met.
#[derive(Debug, Default)]
struct Met {
    touching: u32,
    /// More than one link is as near as the nearest.
    tied: u32,
    /// Less than a quarter of the nodes were visited that a cold engine visits.
    quick: u32,
    /// Nothing is within the bound, and no node was visited to tell.
    by_heart: u32,
    /// The minimum is within a share 1e-9 of the bound.
    near: u32,
    moved_meshes: u32,
}

fn minima_in_a_row(size: f64, links: u32, steps: u32, seed: u64, met: &mut Met) {
    let mut random = Random::new(seed);
    let (vertices, triangles) = Ball::new(6.0).to_trimesh(24, 12);
    let at_rest: Vec<_> = vertices.iter().map(|vertex| *vertex * size).collect();
    let mesh = TriMesh::new(at_rest.clone(), triangles).unwrap();
    let (mut kept, mut cold) = (BvhSearch::new(&mesh).unwrap(), BvhSearch::new(&mesh).unwrap());
    let (mut scene, mut links) = (Scene::new(size, links), Vec::new());
    for step in 0..steps {
        // Most robots stay for a while; each comes to the wall. Three of four stretches are calm.
        if step % 400 >= 100 {
            scene.pose.translation += random.direction() * (1e-3 * size);
        } else if step % 16 < 12 {
            scene.step(&mut random);
        } else {
            scene.pose.translation += Vector::X * (size * random.between(-0.5, 0.5) * 0.02);
        }
        if random.below(300) == 0 {
            scene.pose.translation = random.direction() * (random.between(0.0, 4.0) * size);
        }
        if random.below(500) == 0 {
            let breath = random.between(0.6, 1.2);
            let moved: Vec<_> = at_rest.iter().map(|vertex| *vertex * breath).collect();
            kept.set_vertices(&moved).unwrap();
            cold.set_vertices(&moved).unwrap();
            met.moved_meshes += 1;
        }
        let (robot, pose) = (scene.robot(), scene.pose);
        cold.forget();
        let before = cold.work().nodes;
        let expected = cold.minimum(&robot, &pose).unwrap();
        let cold_nodes = cold.work().nodes - before;
        met.touching += u32::from(expected.distance <= 0.0);
        if step % 8 == 0 {
            cold.per_link(&robot, &pose, &mut links).unwrap();
            let as_near = links.iter().filter(|link| link.distance <= expected.distance).count();
            met.tied += u32::from(as_near > 1);
        }
        let before = kept.work().nodes;
        if random.below(3) > 0 {
            let found = kept.minimum(&robot, &pose).unwrap();
            assert_eq!(bits(&found), bits(&expected), "size {size:e}, step {step}");
            met.quick += u32::from(4 * (kept.work().nodes - before) < cold_nodes);
        } else {
            let share = [0.0, 0.5, 1.0 - 1e-9, 1.0 - 1e-15, 1.0, 1.0 + 1e-15, 2.0]
                [random.below(7) as usize];
            let bound = expected.distance * share;
            let found = kept.minimum_within(&robot, &pose, bound).unwrap();
            let wanted = (expected.distance <= bound).then_some(expected);
            assert_eq!(
                found.as_ref().map(bits),
                wanted.as_ref().map(bits),
                "size {size:e}, step {step}"
            );
            met.by_heart += u32::from(found.is_none() && kept.work().nodes == before);
            met.near += u32::from((share - 1.0).abs() < 1e-8);
        }
    }
}

fn many_minima_in_a_row(steps: u32) {
    let (mut met, sizes) = (Met::default(), [1.0, 1e-3, 2.0_f64.powi(200), 2.0_f64.powi(-560)]);
    for (round, size) in sizes.into_iter().enumerate() {
        minima_in_a_row(size, 16, steps / 4, round as u64, &mut met);
        minima_in_a_row(size, 80, steps / 20, round as u64, &mut met);
    }
    let Met { touching, tied, quick, by_heart, near, moved_meshes } = met;
    assert!(touching > steps / 20 && tied > steps / 200 && near > steps / 20, "{met:?}");
    assert!(quick > steps / 20 && by_heart > steps / 50 && moved_meshes > steps / 1000, "{met:?}");
}

#[test]
fn minima_in_a_row_are_those_of_a_cold_engine() {
    many_minima_in_a_row(12_000);
}

#[test]
#[ignore = "the same for a minute"]
fn a_hundred_thousand_minima_in_a_row_are_those_of_a_cold_engine() {
    many_minima_in_a_row(100_000);
}

/// A touching robot that rests gets the same answer again, with links that stick out of the mesh,
/// whose distances are bounded less closely.
#[test]
fn a_touch_is_not_forgotten() {
    let corners =
        [[-1.0, -1.0], [1.0, -1.0], [-1.0, 1.0], [1.0, 1.0]].map(|[x, y]| Vector::new(x, y, 0.0));
    let mesh = TriMesh::new(corners.to_vec(), vec![[0, 1, 2], [1, 3, 2]]).unwrap();
    for size in [1.0, 1e-3, 37.0] {
        let (mut touched, mesh) = (0, mesh.clone().scaled(Vector::splat(size)));
        for far in (0..60).map(|k| 2.0 + 0.025 * f64::from(k)) {
            for radius in [0.15, 0.2, 0.25, 0.3] {
                let robot = |z: f64| {
                    let points = [
                        Vector::new(-0.5, 0.0, radius + 0.02),
                        Vector::Z * far,
                        Vector::new(0.5, 0.0, z),
                    ];
                    Chain::capsules(&points.map(|point| point * size), &[radius * size; 2]).unwrap()
                };
                let (before, now) = (robot(radius + 0.06), robot(radius - 0.03));
                let mut search = BvhSearch::new(&mesh).unwrap();
                search.minimum(&before, &Pose::IDENTITY).unwrap();
                search.minimum(&now, &Pose::IDENTITY).unwrap();
                for bound in [0.0, 1e-12 * size, 1e-3 * size] {
                    let found = search.minimum_within(&now, &Pose::IDENTITY, bound).unwrap();
                    assert_eq!(
                        found.map(|found| (found.link, found.distance)),
                        Some((1, 0.0)),
                        "{far} {radius}"
                    );
                    assert!(!search.clears(&now, &Pose::IDENTITY, bound).unwrap());
                    touched += 1;
                }
            }
        }
        assert_eq!(touched, 720);
    }
}
