//! Piles and presses, beside the same scenes of parry's capsules: nothing gets lost, nothing blows
//! up, and what comes to rest falls asleep. The tests run for seconds; the ignored one for as many
//! steps as `STEPS` says.

use crate::drop::{Drop, mesh, world};
use continuum_testing::Random;
use parry_continuum::parry::math::{Pose, Real, Vector};
use parry_continuum::parry::query::QueryDispatcher;
use parry_continuum::parry::query::details::closest_points_segment_segment_with_locations;
use parry_continuum::parry::shape::{Compound, Segment};
use parry_continuum::{Cap, Chain, ContinuumDispatcher, ModifiedCylinder};
use rapier3d_f64::prelude::*;
use std::time::Instant;

/// The thickness of what is piled up.
const RADIUS: Real = 0.25;

/// Makes a body's shape, by its number.
type Make = fn(usize) -> SharedShape;

fn link(index: usize) -> SharedShape {
    let caps = [[Cap::Flat; 2], [Cap::Round; 2], [Cap::Flat, Cap::Round], [Cap::Round, Cap::Flat]]
        [index % 4];
    SharedShape::new(
        ModifiedCylinder::new(-0.5 * Vector::Y, 0.5 * Vector::Y, RADIUS, caps).unwrap(),
    )
}

fn round_link(_: usize) -> SharedShape {
    link(1)
}

fn capsule(_: usize) -> SharedShape {
    SharedShape::capsule_y(0.5, RADIUS)
}

fn cylinder(_: usize) -> SharedShape {
    SharedShape::cylinder(0.5, RADIUS)
}

fn centreline() -> Vec<Vector> {
    let bend = |k: usize| {
        Vector::new(0.5 * k as Real - 1.0, 0.05 * (k * k) as Real, 0.03 * (k * k * k) as Real)
    };
    (0..5).map(bend).collect()
}

fn chain(_: usize) -> SharedShape {
    SharedShape::new(Chain::from_centreline(&centreline(), &[RADIUS; 4]).unwrap())
}

/// The same shape as [`capsules`].
fn round_chain(_: usize) -> SharedShape {
    SharedShape::new(Chain::capsules(&centreline(), &[RADIUS; 4]).unwrap())
}

fn capsules(_: usize) -> SharedShape {
    let capsule =
        |ends: &[Vector]| (Pose::IDENTITY, SharedShape::capsule(ends[0], ends[1], RADIUS));
    SharedShape::new(Compound::new(centreline().windows(2).map(capsule).collect()))
}

/// Bodies above a bumpy mesh between four walls.
struct Pile {
    world: PhysicsWorld,
    bodies: Vec<RigidBodyHandle>,
    floor: ColliderHandle,
}

/// What became of a pile.
#[derive(Debug)]
struct Outcome {
    /// Of the deepest overlap with the floor in the second half of the steps, in radii.
    depth: Real,
    below: usize,
    awake: usize,
    milliseconds_a_step: f64,
}

impl Pile {
    fn new(count: usize, shape: impl Fn(usize) -> SharedShape) -> Self {
        let mut world = world(2.0 * RADIUS);
        world.gravity = Vector::Y * -9.81;
        world.integration_parameters.dt = 1.0 / 60.0;
        let (_, floor) =
            world.insert(RigidBodyBuilder::fixed(), mesh(1.0, |x, z| 0.05 * (x * z).sin()));
        for (x, z) in [(1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0)] {
            let half = Vector::new(
                if x == 0.0 { 4.0 } else { 0.5 },
                20.0,
                if z == 0.0 { 4.0 } else { 0.5 },
            );
            let wall = ColliderBuilder::cuboid(half.x, half.y, half.z);
            world.insert(
                RigidBodyBuilder::fixed().translation(Vector::new(4.0 * x, 0.0, 4.0 * z)),
                wall,
            );
        }
        let mut random = Random::new(151);
        let bodies = (0..count).map(|index| {
            let layer = (index / 4) as Real;
            let (x, z) =
                (Real::from(index as u32 % 2) - 0.5, Real::from(index as u32 / 2 % 2) - 0.5);
            let place = 3.0 * Vector::new(x, 0.0, z)
                + Vector::Y * (1.0 + 1.2 * layer)
                + random.point() * 0.2;
            let body = RigidBodyBuilder::dynamic()
                .pose(Pose::new(place, random.direction()))
                .ccd_enabled(true);
            world.insert(body, ColliderBuilder::new(shape(index))).0
        });
        let bodies = bodies.collect();
        Self { world, bodies, floor }
    }

    fn run(mut self, steps: usize) -> Outcome {
        let start = Instant::now();
        let mut depth: Real = 0.0;
        for step in 0..steps {
            self.world.step();
            if step >= steps / 2 && (step + 1) % 50 == 0 {
                depth = depth.max(self.depth());
            }
        }
        let milliseconds_a_step = start.elapsed().as_secs_f64() * 1e3 / steps as f64;
        let bodies = || self.bodies.iter().map(|&handle| &self.world.bodies[handle]);
        let below = bodies().filter(|body| body.translation().y < -0.5).count();
        let awake = bodies().filter(|body| !body.is_sleeping()).count();
        Outcome { depth, below, awake, milliseconds_a_step }
    }

    /// The deepest overlap with the floor, in radii.
    fn depth(&self) -> Real {
        let floor = &self.world.colliders[self.floor];
        let depth = |&handle: &RigidBodyHandle| {
            let body = &self.world.bodies[handle];
            assert!(body.position().is_finite() && body.linvel().is_finite(), "{body:?}");
            let shape = self.world.colliders[body.colliders()[0]].shape();
            let pos12 = floor.position().inv_mul(body.position());
            let contact =
                ContinuumDispatcher::default().contact(&pos12, floor.shape(), shape, 0.0).unwrap();
            contact.map_or(0.0, |contact| -contact.dist / RADIUS)
        };
        self.bodies.iter().map(depth).fold(0.0, Real::max)
    }

    /// For each body along [`centreline`] with round links its deepest overlap with another one, in
    /// radii.
    fn depths_between(&self) -> Vec<Real> {
        let places: Vec<Pose> =
            self.bodies.iter().map(|&handle| *self.world.bodies[handle].position()).collect();
        let line = centreline();
        let segments = |place: &Pose| -> Vec<Segment> {
            line.windows(2).map(|ends| Segment::new(place * ends[0], place * ends[1])).collect()
        };
        let bodies: Vec<Vec<Segment>> = places.iter().map(segments).collect();
        let mut least = vec![2.0 * RADIUS; bodies.len()];
        for (index, first) in bodies.iter().enumerate() {
            for (number, second) in bodies[..index].iter().enumerate() {
                for (one, other) in
                    first.iter().flat_map(|one| second.iter().map(move |o| (one, o)))
                {
                    let at =
                        closest_points_segment_segment_with_locations(&Pose::IDENTITY, one, other);
                    let apart = (one.point_at(&at.0) - other.point_at(&at.1)).length();
                    for body in [index, number] {
                        least[body] = least[body].min(apart);
                    }
                }
            }
        }
        least.into_iter().map(|least| 2.0 - least / RADIUS).collect()
    }

    /// What a step costs where nothing may fall asleep, in milliseconds: the median, which other
    /// work on the machine disturbs least.
    fn cost_awake(mut self, steps: usize) -> f64 {
        for &handle in &self.bodies {
            *self.world.bodies[handle].activation_mut() = RigidBodyActivation::cannot_sleep();
        }
        // First they fall.
        for _ in 0..600 {
            self.world.step();
        }
        let times = (0..steps).map(|_| {
            let start = Instant::now();
            self.world.step();
            start.elapsed().as_secs_f64() * 1e3
        });
        let mut times: Vec<f64> = times.collect();
        times.sort_by(f64::total_cmp);
        times[steps / 2]
    }
}

#[test]
fn piles_stay_above_the_floor_as_parrys_do() {
    let scenes: [(usize, Make, Make); 2] = [(20, link, capsule), (12, chain, capsules)];
    for (count, ours, parrys) in scenes {
        let [ours, parrys] = [ours, parrys].map(|shape| Pile::new(count, shape).run(900));
        assert_eq!((ours.below, parrys.below), (0, 0));
        // A hundredth of the radius, or what parry's own shapes sink in.
        assert!(ours.depth < (1.5 * parrys.depth).max(0.01), "{ours:?} {parrys:?}");
        assert!(ours.awake <= parrys.awake + count / 4, "{ours:?} {parrys:?}");
    }
}

/// Thrown on a heap they hold one another as parry's do: their overlaps are as deep in the mean,
/// and no axis passes through another. (The deepest overlap of a heap is chance.)
#[test]
fn a_hundred_chains_are_as_thick_in_a_heap_as_parrys() {
    let [ours, parrys] = [round_chain as Make, capsules].map(|shape| {
        let mut pile = Pile::new(100, shape);
        let mut depths = Vec::new();
        for step in 0..300 {
            pile.world.step();
            if step >= 150 && step % 30 == 0 {
                depths.extend(pile.depths_between());
            }
        }
        let (mean, most) = (
            depths.iter().sum::<Real>() / depths.len() as Real,
            depths.iter().copied().fold(0.0, Real::max),
        );
        let bodies = || pile.bodies.iter().map(|&handle| pile.world.bodies[handle].translation());
        assert!(bodies().all(|place| place.is_finite() && place.y > -0.5));
        let is_of_bodies = |pair: &ContactPair| {
            [pair.collider1, pair.collider2].into_iter().all(|handle| {
                let body = pile.world.colliders[handle].parent();
                body.is_some_and(|body| pile.world.bodies[body].is_dynamic())
            })
        };
        let pairs = pile.world.narrow_phase.contact_pairs();
        println!("{:.2} % of the radius deep, {:.0} % at most", 100.0 * mean, 100.0 * most);
        (
            mean,
            most,
            pairs.filter(|pair| pair.has_any_active_contact() && is_of_bodies(pair)).count(),
        )
    });
    assert!(ours.2 > 100 && parrys.2 > 100, "{ours:?} {parrys:?}");
    assert!(ours.0 < 1.5 * parrys.0 && ours.1.max(parrys.1) < 1.9, "{ours:?} {parrys:?}");
}

/// Pressed into a wall for ten seconds with a hundred times its weight: how deep it gets, in radii,
/// and how deep it is in the end.
fn pressed(shape: SharedShape) -> [Real; 2] {
    let pose = Pose::from_translation(Vector::new(0.1, 0.76, 0.2));
    let mut drop = Drop::new(world(2.0 * RADIUS), mesh(1.0, |_, _| 0.0), shape, pose);
    // From as far above for all.
    let height = pose.translation - Vector::Y * (drop.gap(1.0) - 0.01);
    drop.world.bodies[drop.body].set_translation(height, true);
    let force = drop.world.bodies[drop.body].mass() * 100.0 * drop.world.gravity;
    drop.world.bodies[drop.body].set_angular_damping(5.0);
    drop.world.bodies[drop.body].add_force(force, true);
    let (mut deepest, mut now) = (0.0, 0.0);
    for step in 0..1200 {
        drop.world.step();
        now = -drop.gap(0.1) / RADIUS;
        deepest = Real::max(deepest, now);
        assert!(step < 240 || !drop.supports().is_empty(), "no contact in step {step}");
    }
    [deepest, now]
}

#[test]
fn a_robot_pressed_into_a_wall_stays_on_its_side() {
    let parrys = [capsule(0), cylinder(0)].map(pressed);
    let single = [0, 1].map(|k| parrys[0][k].max(parrys[1][k]));
    let compound = pressed(capsules(0));
    for (shape, theirs) in
        [(link(0), single), (link(1), single), (link(2), single), (chain(0), compound)]
    {
        let ours = pressed(shape);
        println!("{ours:?} deep; parry's {theirs:?}");
        assert!(
            (0..2).all(|k| ours[k] < (1.1 * theirs[k]).max(0.01)),
            "{ours:?}, parry's {theirs:?}"
        );
    }
}

#[test]
#[ignore = "as long as STEPS says"]
fn piles_for_long() {
    let steps =
        std::env::var("STEPS").map_or(100_000, |steps| steps.parse().expect("a number of steps"));
    let which = std::env::var("SCENE").unwrap_or_default();
    let scenes: [(&str, usize, Make); 6] = [
        ("links of all caps", 60, link),
        ("links with round caps", 60, round_link),
        ("parry's capsules", 60, capsule),
        ("parry's cylinders", 60, cylinder),
        ("chains", 100, chain),
        ("compounds of parry's capsules", 100, capsules),
    ];
    for (name, count, shape) in scenes {
        if name.contains(&which) {
            let awake = Pile::new(count, shape).cost_awake(600);
            let end = Pile::new(count, shape).run(steps);
            println!(
                "{count} {name}, {steps} steps: {:.4} radii deep, {} below, {} awake, {:.2} ms a step; all awake {awake:.2} ms",
                end.depth, end.below, end.awake, end.milliseconds_a_step
            );
        }
    }
}
