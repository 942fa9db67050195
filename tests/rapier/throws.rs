//! Thrown robots fall, slide and come to rest as parry's compounds do: nothing hangs in the air,
//! and nothing gains energy. `docs/RAPIER.md` has the table of many more throws.
//!
//! rapier sweeps every fast body. An exact sweep of a link stops it at each step at which it slides
//! along a wall or leaves it, because the solver lets them overlap by its allowed error.

use continuum_testing::rounds;
use continuum_testing::throws::{Outcome, ThrownBody, Throws, Wall};
use parry_continuum::ContinuumDispatcher;
use parry_continuum::parry::math::{Pose, Real, Vector};
use parry_continuum::parry::query::{NonlinearRigidMotion, QueryDispatcher};
use parry_continuum::rapier::WorldDispatcher;

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
        let parrys = [ThrownBody::CompoundOfLinks, ThrownBody::CompoundOfCapsules].map(thrown);
        let most = |of: fn(&Outcome) -> Real| parrys.iter().map(of).fold(0.0, Real::max);
        for body in [ThrownBody::RoundLink, ThrownBody::FlatLink, ThrownBody::Chain] {
            let ours = thrown(body);
            let context = format!("{wall:?} {body:?} {ours:?} beside {parrys:?}");
            assert_eq!(ours.passed, 0, "{context}");
            assert!(ours.moving > 300, "{context}");
            assert!(ours.held_share() <= most(Outcome::held_share) + 1e-3, "{context}");
            assert!(ours.rise <= most(|outcome| outcome.rise) + 0.01, "{context}");
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

/// The dispatcher of a world answers like the exact one, except for the sweep of a fast body: that
/// one ends inside the link's skin.
#[test]
fn only_sweeps_of_fast_bodies_ignore_the_skin() {
    let [exact, world]: [&dyn QueryDispatcher; 2] =
        [&ContinuumDispatcher::default(), &WorldDispatcher::default()];
    let wall = continuum_testing::throws::roof(1.0);
    let link = parry_continuum::ModifiedCylinder::capsule(-Vector::Z, Vector::Z, 0.1).unwrap();
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
    // From a height of 1 onto a ridge, at 2 a second: 0.9 to the surface, 0.001 to the skin.
    for (dispatcher, stop, expected) in
        [(exact, true, 0.45), (exact, false, 0.45), (world, true, 0.45), (world, false, 0.4505)]
    {
        assert!((time(dispatcher, stop) - expected).abs() < 1e-8, "{stop} {expected}");
    }
}
