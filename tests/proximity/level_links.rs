//! Robots of one link, side by side with level ends: they overlap deeply, however rounding moves
//! their faces.

use continuum_testing::{LevelLinks, Random, found_level_links};
use parry_continuum::parry::math::Pose;
use parry_continuum::proximity::{Decision, RobotPair, Scene};
use parry_continuum::{Cap, Chain, RigidMotion, Tube};

/// How many pairs are drawn.
const ROUNDS: u32 = 400;

fn pairs(random: &mut Random) -> impl Iterator<Item = LevelLinks> {
    found_level_links().chain((0..ROUNDS).map(|_| random.level_links()))
}

/// A robot of this link: with two flat caps, or two round ones.
fn robot(pair: &LevelLinks, link: usize) -> Chain {
    let link = &pair.links[link];
    let ends = [link.start(), link.end()];
    match link.caps() {
        [Cap::Flat, Cap::Flat] => Chain::cylinders(&ends, &[link.radius()]).unwrap(),
        _ => Chain::capsules(&ends, &[link.radius()]).unwrap(),
    }
}

fn size(pair: &LevelLinks) -> f64 {
    pair.links.iter().fold(0.0, |most: f64, link| most.max(link.radius()))
}

#[test]
fn chains_meet() {
    let here = Pose::IDENTITY;
    let mut flat = 0;
    for pair in pairs(&mut Random::new(1)) {
        let [a, b] = [0, 1].map(|k| robot(&pair, k));
        flat += u32::from(pair.is_flat());
        for [a, b] in [[&a, &b], [&b, &a]] {
            let found = RobotPair::new().minimum(a, &here, b, &here).unwrap();
            assert_eq!(found.distance, 0.0, "{pair:?}");
            assert_eq!(found.witness.on_first, found.witness.on_second, "{pair:?}");
            assert!(found.certify(a, &here, b, &here).unwrap().lower <= 0.0, "{pair:?}");
            assert!(!RobotPair::new().clears(a, &here, b, &here, 0.0).unwrap(), "{pair:?}");
            let mut scene = Scene::new();
            scene.set_robot_margin(Some(0.0)).unwrap();
            assert!(!scene.clears(&[(a, here), (b, here)]).unwrap(), "{pair:?}");
        }
    }
    assert!(flat > ROUNDS / 2, "{flat}");
}

#[test]
fn tubes_and_motions_at_rest_touch() {
    let here = Pose::IDENTITY;
    let mut tubes = RobotPair::new();
    for pair in pairs(&mut Random::new(2)) {
        let [a, b] = [0, 1].map(|k| Tube::from(&robot(&pair, k)));
        for resolution in [1e-6, 1e-2].map(|share| share * size(&pair)) {
            tubes.forget();
            let decision = tubes.clears_tubes(&a, &here, &b, &here, 0.0, resolution).unwrap();
            assert_eq!(decision, Decision::Contact, "{resolution}: {pair:?}");
            let found = tubes.clearance(&a, &here, &b, &here, resolution).unwrap();
            assert_eq!(found.lower, 0.0, "{resolution}: {pair:?}");
            assert!(found.upper <= resolution, "{resolution}: {pair:?}");
            let [one, two] =
                [&a, &b].map(|tube| RigidMotion::new(tube.clone(), [here; 2]).unwrap());
            let answer = tubes.clears_motions(&one, &two, 0.0, resolution).unwrap();
            assert_eq!(answer.decision, Decision::Contact, "{resolution}: {pair:?}");
        }
    }
}
