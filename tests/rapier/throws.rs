//! Thrown robots fall, slide and come to rest as parry's compounds do: nothing hangs in the air,
//! and nothing gains energy. `docs/RAPIER.md` has the table of many more throws.
//!
//! rapier sweeps every fast body. An exact sweep of a link stops it at each step at which it slides
//! along a wall or leaves it, because the solver lets them overlap by its allowed error.

use crate::drop::{Drop, world};
use continuum_testing::throws::{Outcome, ThrownBody, Throws, Wall};
use continuum_testing::{Random, rounds};
use parry_continuum::parry::math::{Pose, Real, Vector};
use parry_continuum::parry::query::{NonlinearRigidMotion, QueryDispatcher};
use parry_continuum::rapier::WorldDispatcher;
use parry_continuum::{Cap, ContinuumDispatcher, ModifiedCylinder};
use rapier3d_f64::prelude::{ColliderBuilder, SharedShape};

const UNITS: [Real; 3] = [1e-3, 1.0, 1e3];

#[test]
fn nothing_hangs_and_nothing_gains_energy() {
    for wall in Wall::ALL {
        let thrown = |body| {
            let mut all = Outcome::default();
            for seed in 0..rounds(12) {
                let unit = UNITS[seed as usize % 3];
                let ccd = seed % 2 == 0;
                let throws = Throws { wall, unit, ccd, steps: 360, rate: 240.0 };
                all.add(&throws.of(body, seed..seed + 1));
            }
            all
        };
        for body in [ThrownBody::RoundLink, ThrownBody::FlatLink, ThrownBody::Chain] {
            let ours = thrown(body);
            let parrys = body.compounds().iter().map(|body| thrown(*body)).collect::<Vec<_>>();
            let context = format!("{wall:?} {body:?} {ours:?} beside {parrys:?}");
            assert_eq!(ours.passed, 0, "{context}");
            assert!(ours.moving > 300, "{context}");
            assert!(ours.is_no_worse_than(&parrys), "{context}");
        }
    }
}

/// The smallest scene in which a link hung: for 55 of these steps, and it gained 9.6 m g u.
#[test]
fn a_link_leaves_the_ridge_that_it_touches() {
    let pose = Pose::new(Vector::new(0.125, 1.625, -0.25), Vector::new(1.75, 1.0, -1.125));
    let velocity = (Vector::new(-0.125, -0.375, 0.125), Vector::new(-1.625, 0.125, 0.75));
    for ccd in [false, true] {
        let throws = Throws { wall: Wall::Mesh, unit: 1.0, ccd, steps: 300, rate: 60.0 };
        let outcome = throws.throw(ThrownBody::RoundLink, pose, velocity);
        assert!(outcome.held == 0 && outcome.rise < 0.01 && outcome.depth < 0.5, "{outcome:?}");
    }
}

/// rapier disables a body whose numbers are not finite. Links of any length fall on the rim of a
/// cylinder without height.
#[test]
fn links_stay_in_the_world_at_the_rim_of_a_disc() {
    let mut random = Random::new(70);
    let mut met = 0;
    for throw in 0..rounds(200_usize) {
        let half = 0.5 * random.unit() * Vector::Y;
        let caps = [[Cap::Flat; 2], [Cap::Round; 2]][throw % 2];
        let link = ModifiedCylinder::new(-half, half, 0.3, caps).unwrap();
        let disc = ColliderBuilder::new(SharedShape::cylinder(0.0, 0.5));
        let turn = random.direction() * random.between(0.0, 3.1);
        let beside = random.direction() * Vector::new(1.0, 0.0, 1.0);
        let pose = Pose::new(0.5 * beside.normalize() + 0.9 * Vector::Y, turn);
        let mut drop = Drop::new(world(1.0), disc, SharedShape::new(link), pose);
        for _ in 0..90 {
            drop.world.step();
            let body = &drop.world.bodies[drop.body];
            let is_finite = drop.pose().is_finite() && body.linvel().is_finite();
            assert!(is_finite && body.is_enabled(), "{link:?} {pose:?}: {:?}", drop.pose());
        }
        met += usize::from(drop.world.bodies[drop.body].linvel().y > -4.0);
    }
    assert!(met > rounds(50), "{met}");
}

/// The dispatcher of a world answers like the exact one, except for the sweep of a fast body: that
/// one ends inside the link's skin.
#[test]
fn only_sweeps_of_fast_bodies_ignore_the_skin() {
    let [exact, world]: [&dyn QueryDispatcher; 2] =
        [&ContinuumDispatcher::default(), &WorldDispatcher::default()];
    let wall = continuum_testing::throws::roof(1.0);
    let link = ModifiedCylinder::capsule(-Vector::Z, Vector::Z, 0.1).unwrap();
    let falls = NonlinearRigidMotion {
        start: Pose::from_translation(Vector::Y),
        linvel: -2.0 * Vector::Y,
        ..NonlinearRigidMotion::identity()
    };
    let still = NonlinearRigidMotion::identity();
    let time = |dispatcher: &dyn QueryDispatcher, stop| {
        let hit = dispatcher.cast_shapes_nonlinear(&falls, &link, &still, &wall, 0.0, 1.0, stop);
        hit.unwrap().unwrap().time_of_impact
    };
    // From a height of 1 onto a ridge, at 2 a second: 0.9 to the surface, 0.005 through the skin.
    for (dispatcher, stop, expected) in
        [(exact, true, 0.45), (exact, false, 0.45), (world, true, 0.45), (world, false, 0.4525)]
    {
        assert!((time(dispatcher, stop) - expected).abs() < 1e-8, "{stop} {expected}");
    }
}

/// A link deep in a wall that nothing pushes out is stopped by six sweeps at most, however slowly
/// it sinks in. Then it falls on, as parry's capsules do.
#[test]
fn sweeps_do_not_hold_a_link_for_long() {
    let dispatcher = WorldDispatcher::default();
    let wall = continuum_testing::throws::roof(1.0);
    let still = NonlinearRigidMotion::identity();
    for caps in [[Cap::Flat; 2], [Cap::Round; 2]] {
        let link = ModifiedCylinder::new(-Vector::Z, Vector::Z, 0.1, caps).unwrap();
        // The ridge is along z at the height 0.
        for (height, speed) in [(0.2, 1.0), (0.11, 1.0), (0.1, 0.3), (0.05, 0.1), (0.01, 10.0)] {
            let mut falls = NonlinearRigidMotion {
                start: Pose::from_translation(height * Vector::Y),
                linvel: -speed * Vector::Y,
                ..NonlinearRigidMotion::identity()
            };
            let mut stops = 0;
            for _ in 0..60 {
                let hit = dispatcher
                    .cast_shapes_nonlinear(&falls, &link, &still, &wall, 0.0, 1.0, false)
                    .unwrap();
                stops += usize::from(hit.is_some());
                let share = hit.map_or(1.0, |hit| hit.time_of_impact);
                falls.start.translation += falls.linvel * share;
            }
            assert!((1..=6).contains(&stops) || height < 0.05, "{height}: {stops}");
            assert!(stops <= 6 && falls.start.translation.y < -1.0, "{height}: {stops}");
        }
    }
}
