//! `clears`, `minimum` and `minimum_within` in a loop answer as a fresh engine, for any sequence of
//! queries.

use continuum_testing::{Random, WarmAndFresh, rounds};
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
    let mut both = WarmAndFresh::new(BvhSearch::new(&wall).unwrap());
    let (mut by_heart, mut touches) = (0, 0);
    for step in 0..600 {
        let pose = Pose::new(Vector::Z * size, Vector::X * (1e-3 * f64::from(step)));
        let before = both.warm.work().nodes;
        let clears = both.ask((size, step), |search| search.clears(&plate, &pose, 0.0)).unwrap();
        by_heart += u32::from(both.warm.work().nodes == before);
        touches += u32::from(!clears);
    }
    // It touches at sin(turn) = 1 / 3, or 0.34 rad.
    assert!(by_heart > 20 && touches > 100, "{by_heart} without a search, {touches} touch");
}

/// What a sequence of queries has met.
#[derive(Debug, Default)]
struct Met {
    clear: u32,
    touching: u32,
    /// More than one link is as near as the nearest.
    tied: u32,
    /// Less than a quarter of the nodes were visited that a fresh engine visits.
    quick: u32,
    /// The margin or the bound was decided without visiting a node.
    by_heart: [u32; 2],
    /// The minimum is within a share 1e-9 of the margin or the bound.
    near: [u32; 2],
    moved_meshes: u32,
}

fn in_a_row(size: f64, links: u32, steps: u32, seed: u64, met: &mut Met) {
    let mut random = Random::new(seed);
    let (vertices, triangles) = Ball::new(6.0).to_trimesh(24, 12);
    let at_rest: Vec<_> = vertices.iter().map(|vertex| *vertex * size).collect();
    let mesh = TriMesh::new(at_rest.clone(), triangles).unwrap();
    let mut both = WarmAndFresh::new(BvhSearch::new(&mesh).unwrap());
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
            both.change(|search| search.set_vertices(&moved).unwrap());
            met.moved_meshes += 1;
        }
        let (robot, pose) = (scene.robot(), scene.pose);
        let mut fresh = both.fresh.clone();
        let expected = fresh.minimum(&robot, &pose).unwrap();
        let fresh_nodes = fresh.work().nodes - both.fresh.work().nodes;
        if step % 8 == 0 {
            fresh.per_link(&robot, &pose, &mut links).unwrap();
            let as_near = links.iter().filter(|link| link.distance <= expected.distance).count();
            met.tied += u32::from(as_near > 1);
        }
        let before = both.warm.work().nodes;
        let share: f64 = [0.0, 0.5, 1.0 - 1e-9, 1.0 - 1e-15, 1.0, 1.0 + 1e-15, 1.0 + 1e-9, 2.0]
            [random.below(8) as usize];
        let is_near = u32::from((share - 1.0).abs() < 1e-8);
        let context = (size, step, share);
        match random.below(4) {
            0 | 1 => {
                both.ask(context, |search| search.minimum(&robot, &pose)).unwrap();
                met.quick += u32::from(4 * (both.warm.work().nodes - before) < fresh_nodes);
            }
            2 => {
                let bound = expected.distance * share;
                let found = both
                    .ask(context, |search| search.minimum_within(&robot, &pose, bound))
                    .unwrap();
                assert_eq!(found.is_some(), expected.distance <= bound, "{context:?}");
                met.by_heart[0] += u32::from(found.is_none() && both.warm.work().nodes == before);
                met.near[0] += is_near;
            }
            _ => {
                let is_own = random.below(4) > 0;
                let margin = if is_own { scene.margin } else { expected.distance * share };
                let clears =
                    both.ask(context, |search| search.clears(&robot, &pose, margin)).unwrap();
                assert_eq!(clears, expected.distance > margin, "{context:?}");
                met.by_heart[1] += u32::from(both.warm.work().nodes == before);
                met.near[1] += u32::from(!is_own) * is_near;
                *if clears { &mut met.clear } else { &mut met.touching } += 1;
            }
        }
    }
}

#[test]
fn queries_in_a_row_are_answered_as_by_a_fresh_engine() {
    let (steps, mut met) = (rounds(200_000), Met::default());
    let sizes = [1.0, 1e-3, 2.0_f64.powi(200), 2.0_f64.powi(-560)];
    for (round, size) in sizes.into_iter().enumerate() {
        in_a_row(size, 5, steps / 4, round as u64, &mut met);
        in_a_row(size, 16, steps / 8, round as u64, &mut met);
        in_a_row(size, 80, steps / 20, round as u64, &mut met);
    }
    let Met { clear, touching, tied, quick, by_heart, near, moved_meshes } = met;
    assert!(clear > steps / 20 && touching > steps / 20 && tied > steps / 200, "{met:?}");
    assert!(near.iter().all(|&near| near > steps / 100), "{met:?}");
    assert!(by_heart.iter().all(|&by_heart| by_heart > steps / 50), "{met:?}");
    assert!(quick > steps / 20 && moved_meshes > steps / 1000, "{met:?}");
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
