//! Links that are dropped come to rest: at the right height, asleep, without rolling off, sinking,
//! trembling or gaining energy, and at least as well as parry's own shapes.

use crate::drop::{Drop, attitudes, box_ground, bump, field, links, mesh, world};
use parry_continuum::parry::math::{Pose, Real, Rot3, Vector};
use parry_continuum::parry::shape::TriMesh;
use parry_continuum::{Cap, ModifiedCylinder};
use rapier3d_f64::prelude::*;
use std::f64::consts::FRAC_PI_2;

type Ground = (&'static str, fn(Real) -> ColliderBuilder);

const FLAT: [Ground; 3] = [
    ("mesh", |size| mesh(size, |_, _| 0.0)),
    ("box", box_ground),
    ("field", |size| field(size, |_, _| 0.0)),
];
const BUMPY: [Ground; 2] =
    [("bumpy mesh", |size| mesh(size, bump)), ("bumpy field", |size| field(size, bump))];

/// A thousandth of a link's radius.
const EXACT: Real = 5e-4;

fn dropped(ground: Ground, shape: SharedShape, turn: Rot3) -> Drop {
    Drop::new(world(1.0), ground.1(1.0), shape, Pose::from_parts(Vector::new(0.1, 2.0, -0.2), turn))
}

/// Steps until the body sleeps. Returns the number of steps, and what happened on the way.
fn settle(drop: &mut Drop, most: usize) -> Option<Fall> {
    let mut fall = Fall { steps: 0, deepest: 0.0, gain: 0.0 };
    let mut before = drop.energy();
    let height = drop.world.bodies[drop.body].mass() * 9.81;
    while !drop.is_asleep() {
        if fall.steps == most {
            return None;
        }
        drop.world.step();
        fall.steps += 1;
        fall.deepest = fall.deepest.min(drop.gap(0.0));
        fall.gain = fall.gain.max((drop.energy() - before) / height);
        before = drop.energy();
    }
    Some(fall)
}

struct Fall {
    steps: usize,
    deepest: Real,
    /// The largest gain of energy in a step, as the height that it would lift the body by.
    gain: Real,
}

impl Fall {
    /// Asserts that it did not sink that deep and gained no energy.
    #[track_caller]
    fn assert_calm(&self, deepest: Real, context: &str) {
        assert!(
            self.deepest > deepest && self.gain < 1e-3,
            "{context}: {} {}",
            self.deepest,
            self.gain
        );
    }
}

#[test]
fn on_flat_ground_at_the_right_height() {
    for ground in FLAT {
        for link in links() {
            for (attitude, turn) in attitudes() {
                let mut drop = dropped(ground, SharedShape::new(link), turn);
                let fall = settle(&mut drop, 400);
                let context = format!("{:?} {attitude} on a {}", link.caps(), ground.0);
                let fall = fall.unwrap_or_else(|| panic!("{context} is awake"));
                let pose = drop.pose();
                let height = match (attitude, link.caps()[0]) {
                    ("upright", Cap::Flat) => 1.0,
                    ("upright", Cap::Round) => 1.5,
                    _ => 0.5,
                };
                assert!(
                    (pose.translation.y - height).abs() < EXACT,
                    "{context} at {}",
                    pose.translation.y
                );
                let lean = (pose.rotation * Vector::Y).y;
                let expected = if attitude == "upright" { 1.0 } else { 0.0 };
                assert!((lean - expected).abs() < 1e-4, "{context} leans {lean}");
                if attitude != "tilted" {
                    let way = (pose.translation - Vector::new(0.1, height, -0.2)).length();
                    assert!(way < 0.01, "{context} went {way}");
                }
                fall.assert_calm(-0.02, &context);
            }
        }
    }
}

/// rapier has no rolling friction: in a hollow, a round thing rocks for ever, parry's own as well.
/// So these bodies are damped.
#[test]
fn on_bumps_and_in_hollows_touching() {
    for ground in BUMPY {
        for link in links() {
            for (attitude, turn) in attitudes() {
                let mut drop = dropped(ground, SharedShape::new(link), turn);
                drop.world.bodies[drop.body].set_angular_damping(2.0);
                let context = format!("{:?} {attitude} on a {}", link.caps(), ground.0);
                let fall = settle(&mut drop, 1500).unwrap_or_else(|| panic!("{context} is awake"));
                assert!(drop.gap(0.1).abs() < EXACT, "{context}: {}", drop.gap(0.1));
                fall.assert_calm(-0.05, &context);
            }
        }
    }
}

#[test]
fn a_capsule_falls_like_parrys_capsule_and_a_cylinder_like_parrys_cylinder_or_better() {
    let pairs = [
        (links()[1], SharedShape::capsule_y(1.0, 0.5)),
        (links()[0], SharedShape::cylinder(1.0, 0.5)),
    ];
    for ground in FLAT {
        for (link, peer) in &pairs {
            for (attitude, turn) in attitudes() {
                let context = format!("{:?} {attitude} on a {}", link.caps(), ground.0);
                let mut ours = dropped(ground, SharedShape::new(*link), turn);
                let mut theirs = dropped(ground, peer.clone(), turn);
                let slept = [&mut ours, &mut theirs].map(|drop| settle_unseen(drop, 400));
                let slept_no_later =
                    slept[0].is_some_and(|ours| slept[1].is_none_or(|theirs| ours < theirs + 25));
                assert!(slept_no_later, "{context}: {slept:?}");
                let height = if attitude != "upright" {
                    0.5
                } else if link.caps()[0] == Cap::Flat {
                    1.0
                } else {
                    1.5
                };
                let error = |drop: &Drop| (drop.pose().translation.y - height).abs();
                assert!(error(&ours) < error(&theirs) + 0.2 * EXACT, "{context}");
                if attitude != "tilted" {
                    let apart = (ours.pose().translation - theirs.pose().translation).length();
                    assert!(apart < 5e-3, "{context}: {apart}");
                }
            }
        }
    }
}

/// At every place where it falls: a lying link is supported evenly, so it does not roll or slide.
#[test]
fn a_rod_that_falls_flat_stays_where_it_falls() {
    const STARTS: usize = 24;
    let flat = attitudes()[1].1;
    let fall = |shape: &SharedShape, ground: Ground, start: usize| {
        let shift =
            0.03 * Vector::new((1.7 * start as Real).sin(), 0.0, (2.3 * start as Real).cos());
        let from = Vector::new(0.1, 2.0, -0.2) + shift;
        let mut drop =
            Drop::new(world(1.0), ground.1(1.0), shape.clone(), Pose::from_parts(from, flat));
        let steps = settle_unseen(&mut drop, 400).unwrap_or(400);
        (steps, (drop.pose().translation - from.with_y(0.5)).length())
    };
    let peers = [SharedShape::capsule_y(1.0, 0.5), SharedShape::cylinder(1.0, 0.5)];
    for ground in [FLAT[0], FLAT[2]] {
        let latest =
            |shape: &SharedShape| (0..STARTS).map(|start| fall(shape, ground, start).0).max();
        let latest_of_peers = peers.iter().filter_map(latest).max().unwrap_or(0);
        for link in links() {
            for start in 0..STARTS {
                let (steps, way) = fall(&SharedShape::new(link), ground, start);
                let context = format!("{:?} on a {}, start {start}", link.caps(), ground.0);
                assert!(way < 5e-3, "{context} went {way}");
                assert!(steps < latest_of_peers + 10, "{context}: {steps}, {latest_of_peers}");
            }
        }
    }
}

/// As `settle`, for shapes that the crate does not measure.
fn settle_unseen(drop: &mut Drop, most: usize) -> Option<usize> {
    (0..most).find(|_| {
        drop.world.step();
        drop.is_asleep()
    })
}

/// A link that stands on a flat cap and is not allowed to sleep stays where it is, on the same
/// patch.
#[test]
fn standing_on_a_flat_cap_does_not_tremble() {
    for ground in FLAT {
        for caps in [[Cap::Flat; 2], [Cap::Flat, Cap::Round]] {
            let link = ModifiedCylinder::new(-Vector::Y, Vector::Y, 0.5, caps).unwrap();
            let mut drop = dropped(ground, SharedShape::new(link), Rot3::from_rotation_y(0.3));
            drop.world.bodies[drop.body].activation_mut().normalized_linear_threshold = -1.0;
            for _ in 0..200 {
                drop.world.step();
            }
            let patch = |drop: &Drop| {
                let points = drop.supports();
                assert!(points.len() >= 3, "{}: {points:?}", ground.0);
                points.iter().sum::<Vector>() / points.len() as Real
            };
            let (place, middle) = (drop.pose().translation, patch(&drop));
            for _ in 0..400 {
                drop.world.step();
                let moved = (patch(&drop) - middle).length();
                assert!(moved < 0.05 * 0.5, "{caps:?} on a {}: {moved}", ground.0);
            }
            assert!(
                (drop.pose().translation - place).length() < 1e-3,
                "{caps:?} on a {}",
                ground.0
            );
            let speed = drop.world.bodies[drop.body].linvel().length();
            assert!(speed < 1e-3, "{caps:?} on a {}: {speed}", ground.0);
        }
    }
}

/// A round link whose ends lie on grid lines of a mesh without flags rests, awake, as still as
/// elsewhere.
#[test]
fn a_round_link_whose_ends_lie_on_grid_lines_rests() {
    let grid = crate::drop::grid(1.0, |_, _| 0.0);
    let grid = TriMesh::new(grid.vertices().to_vec(), grid.indices().to_vec()).unwrap();
    // Cells are 0.8 wide, with lines at 0.4.
    for (half, radius) in [(0.4, 0.5), (0.8, 0.5), (1.2, 0.1)] {
        let half = half * Vector::Y;
        let link = ModifiedCylinder::capsule(-half, half, radius).unwrap();
        for turn in [Rot3::from_rotation_x(FRAC_PI_2), Rot3::from_rotation_z(FRAC_PI_2)] {
            for (x, z) in [(0.0, 0.0), (0.4, 0.0), (0.0, 0.4), (0.4, 0.4)] {
                let pose = Pose::from_parts(Vector::new(x, radius, z), turn);
                let ground = ColliderBuilder::new(SharedShape::new(grid.clone()));
                let mut drop = Drop::new(world(2.0 * radius), ground, SharedShape::new(link), pose);
                drop.world.bodies[drop.body].activation_mut().normalized_linear_threshold = -1.0;
                for _ in 0..200 {
                    drop.world.step();
                    let speed = drop.world.bodies[drop.body].linvel().length();
                    assert!(speed < 2e-3, "{half} {radius} {turn:?} {x} {z}: {speed}");
                }
            }
        }
    }
}
