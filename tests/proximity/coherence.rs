//! `clears` asked again and again in a loop answers as an engine that knows nothing of the queries before, whatever comes.

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
}

impl Scene {
    fn new(size: f64) -> Self {
        let points = (0..6).map(|k| Vector::Z * (f64::from(k) * size)).collect();
        Self { points, radii: vec![0.4 * size; 5], caps: 0, pose: Pose::IDENTITY, margin: 0.5 * size, size }
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
            4 => *self = Self::new(size),
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
            _ => self.points.iter_mut().skip(1).for_each(|point| *point += random.direction() * small),
        }
    }
}

#[test]
fn what_was_asked_before_changes_no_answer() {
    let (mut clear, mut touching, mut by_heart, mut near) = (0, 0, 0, 0);
    for (round, size) in [1.0, 1e-3, 2.0_f64.powi(200), 2.0_f64.powi(-560)].into_iter().enumerate() {
        let mut random = Random::new(round as u64);
        let (vertices, triangles) = Ball::new(6.0).to_trimesh(24, 12);
        let at_rest: Vec<_> = vertices.iter().map(|vertex| *vertex * size).collect();
        let mesh = TriMesh::new(at_rest.clone(), triangles).unwrap();
        let (mut kept, mut cold) = (BvhSearch::new(&mesh).unwrap(), BvhSearch::new(&mesh).unwrap());
        let mut scene = Scene::new(size);
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
                0 => distance * (1.0 + [-1e-15, 1e-15, -1e-9, 1e-9, -1e-3, 1e-3][random.below(6) as usize]),
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

/// As many as a debug build asks in a second or two.
const STEPS: u32 = 25_000;

/// The disc of a flat cap turns with its axis: the rim moves far although both ends stay.
#[test]
fn a_turning_cap_is_not_taken_for_a_still_one() {
    let corners = [[-9.0, -9.0], [9.0, -9.0], [0.0, 9.0]].map(|[x, y]| Vector::new(x, y, 0.0));
    let wall = TriMesh::new(corners.to_vec(), vec![[0, 1, 2]]).unwrap();
    let plate = Chain::cylinders(&[Vector::Z * -0.01, Vector::Z * 0.01], &[3.0]).unwrap();
    let (mut kept, mut cold) = (BvhSearch::new(&wall).unwrap(), BvhSearch::new(&wall).unwrap());
    let (mut by_heart, mut touches) = (0, 0);
    for step in 0..600 {
        let pose = Pose::new(Vector::Z, Vector::X * (1e-3 * f64::from(step)));
        cold.forget();
        let expected = cold.clears(&plate, &pose, 0.0).unwrap();
        let before = kept.work().nodes;
        assert_eq!(kept.clears(&plate, &pose, 0.0).unwrap(), expected, "{step}");
        by_heart += u32::from(kept.work().nodes == before);
        touches += u32::from(!expected);
    }
    // It touches at sin(turn) = 1 / 3, or 0.34 rad.
    assert!(by_heart > 20 && touches > 100, "{by_heart} without a search, {touches} touch");
}
