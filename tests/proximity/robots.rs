//! Two robots: the nearest of all pairs of links, however they are found.

use continuum_testing::narrow_phase::modified_cylinder_modified_cylinder;
use continuum_testing::{Random, rounds};
use parry_continuum::distance::Vec3;
use parry_continuum::parry::math::{Pose, Vector};
use parry_continuum::proximity::{ProximityError, RobotPair, RobotProximity, SelfQuery};
use parry_continuum::{Cap, Chain, ModifiedCylinder};

const UNIT: f64 = f64::EPSILON / 2.0;

/// A robot of up to `most` links that wanders, on a lattice every other time.
pub(super) fn robot(random: &mut Random, most: u32) -> Chain {
    let lattice = random.below(2) == 0;
    let count = 1 + random.below(most);
    let step = if lattice { 1.5 } else { random.between(0.2, 1.5) };
    let mut at = random.point();
    let mut points = vec![at];
    for _ in 0..count {
        at += random.point() * step;
        if lattice {
            at = at.round();
        }
        points.push(at);
    }
    let mut radius = [0.0, 0.1, 0.4, random.between(0.0, 1.5)][random.below(4) as usize];
    let radii: Vec<_> = (0..count)
        .map(|_| {
            if random.below(3) == 0 {
                radius *= 0.7;
            }
            radius
        })
        .collect();
    let made = match random.below(3) {
        0 => Chain::from_centreline(&points, &radii),
        1 => Chain::capsules(&points, &radii),
        _ => Chain::cylinders(&points, &radii),
    };
    made.unwrap_or_else(|_| Chain::from_centreline(&[Vector::ZERO, Vector::X], &[0.25]).unwrap())
}

/// A pose that brings a link of the second robot to one of the first, up to `off` away.
pub(super) fn beside(random: &mut Random, a: &Chain, pose_a: &Pose, b: &Chain, off: f64) -> Pose {
    let mut some =
        |robot: &Chain| robot.links()[random.below(robot.links().len() as u32) as usize].start();
    let (to, from) = (pose_a * some(a), some(b));
    let turn = random.pose(0.0);
    Pose::from_translation(to + random.point() * off) * turn * Pose::from_translation(-from)
}

fn links(robot: &Chain, pose: &Pose) -> Vec<ModifiedCylinder> {
    robot.links().iter().map(|link| link.transformed(pose)).collect()
}

fn apart(first: &ModifiedCylinder, second: &ModifiedCylinder) -> f64 {
    let axis =
        |link: &ModifiedCylinder| [link.start(), link.end()].map(|p| Vec3::from(p.to_array()));
    let flat = |link: &ModifiedCylinder| link.caps().map(|cap| cap == Cap::Flat);
    let (one, two) = (first, second);
    modified_cylinder_modified_cylinder(
        axis(one),
        one.radius(),
        flat(one),
        axis(two),
        two.radius(),
        flat(two),
    )
    .distance
}

/// All distances, link by link.
fn table(first: &[ModifiedCylinder], second: &[ModifiedCylinder]) -> Vec<Vec<f64>> {
    first.iter().map(|one| second.iter().map(|two| apart(one, two)).collect()).collect()
}

fn slack(first: &[ModifiedCylinder], second: &[ModifiedCylinder]) -> f64 {
    let reach = |link: &ModifiedCylinder| {
        link.start().abs().max(link.end().abs()).max_element().max(link.radius())
    };
    32.0 * UNIT * first.iter().chain(second).map(reach).fold(1.0, f64::max)
}

#[test]
fn the_nearest_of_all_pairs_is_found() {
    let mut random = Random::new(1);
    let (mut pair, mut touching, mut apart, mut many) = (RobotPair::new(), 0, 0, 0);
    for round in 0..rounds(1500) {
        // Sometimes enough links to descend the link trees.
        let most = if round % 30 == 0 { 200 } else { 20 };
        let (a, b) = (robot(&mut random, most), robot(&mut random, most));
        many += usize::from(a.links().len().min(b.links().len()) > 64);
        let pose_a = random.pose(1.0);
        let poses = [pose_a, beside(&mut random, &a, &pose_a, &b, [0.0, 1.0, 6.0][round % 3])];
        let (first, second) = (links(&a, &poses[0]), links(&b, &poses[1]));
        let (table, slack) = (table(&first, &second), slack(&first, &second));
        let least = table.iter().flatten().copied().fold(f64::INFINITY, f64::min);
        let found = pair.minimum(&a, &poses[0], &b, &poses[1]).unwrap();
        assert!(
            (found.distance - least).abs() <= slack,
            "{} of {least} in round {round}",
            found.distance
        );
        let [i, j] = found.links.map(|link| link as usize);
        assert!((table[i][j] - found.distance).abs() <= slack);
        assert!(
            ((found.witness.on_first - found.witness.on_second).length() - found.distance).abs()
                <= slack
        );
        let [before, after] =
            [a.links()[..i].iter().map(|l| l.length()).sum::<f64>(), a.links()[i].length()];
        assert!(
            before - slack <= found.witness.arc_lengths[0]
                && found.witness.arc_lengths[0] <= before + after + slack
        );

        // What is remembered changes no answer.
        assert_eq!(RobotPair::new().minimum(&a, &poses[0], &b, &poses[1]).unwrap(), found);
        assert_eq!(pair.minimum(&a, &poses[0], &b, &poses[1]).unwrap(), found);
        // Of equals the lowest links.
        let mut each = Vec::new();
        pair.per_link(&a, &poses[0], &b, &poses[1], &mut each).unwrap();
        assert_eq!(each.len(), first.len());
        let lowest = each
            .iter()
            .copied()
            .reduce(|best, next| if next.distance < best.distance { next } else { best });
        assert_eq!(lowest.unwrap(), found);
        for (link, nearest) in each.iter().enumerate() {
            let row = table[link].iter().copied().fold(f64::INFINITY, f64::min);
            assert_eq!(nearest.links[0] as usize, link);
            assert!((nearest.distance - row).abs() <= slack);
        }

        let swapped = pair.minimum(&b, &poses[1], &a, &poses[0]).unwrap();
        assert!((swapped.distance - found.distance).abs() <= slack);
        let d = found.distance;
        for margin in [0.0, 0.5 * d, d, d.next_up(), 2.0 * d + 0.1] {
            let clears = pair.clears(&a, &poses[0], &b, &poses[1], margin).unwrap();
            assert_eq!(clears, d > margin, "{margin} of {d} in round {round}");
            assert_eq!(
                RobotPair::new().clears(&a, &poses[0], &b, &poses[1], margin).unwrap(),
                clears
            );
        }
        if d == 0.0 { touching += 1 } else { apart += 1 }
    }
    assert!(
        touching > rounds(300) && apart > rounds(300) && many > rounds(10),
        "{touching} {apart} {many}"
    );
}

/// The definition, over the whole table: groups of equal neighbours without a nearer neighbour.
fn places(table: &[Vec<RobotProximity>], margin: f64) -> Vec<[u32; 2]> {
    let (rows, columns) = (table.len(), table[0].len());
    let neighbours = |[i, j]: [usize; 2]| {
        let rows = i.saturating_sub(1)..(i + 2).min(rows);
        rows.flat_map(move |k| (j.saturating_sub(1)..(j + 2).min(columns)).map(move |l| [k, l]))
            .filter(move |&other| other != [i, j])
    };
    let at = |[i, j]: [usize; 2]| table[i][j].distance;
    let mut seen = vec![vec![false; columns]; rows];
    let mut found = Vec::new();
    for i in 0..rows {
        for j in 0..columns {
            if seen[i][j] || at([i, j]) > margin {
                continue;
            }
            let (mut group, mut is_least) = (vec![[i, j]], true);
            seen[i][j] = true;
            while let Some(cell) = group.pop() {
                for other in neighbours(cell) {
                    is_least &= at(other) >= at(cell);
                    if at(other) == at(cell) && !seen[other[0]][other[1]] {
                        seen[other[0]][other[1]] = true;
                        group.push(other);
                    }
                }
            }
            if is_least {
                found.push([i as u32, j as u32]);
            }
        }
    }
    found
}

#[test]
fn every_place_where_two_robots_are_near_is_found_once() {
    let mut random = Random::new(2);
    let (mut pair, mut several, mut merged) = (RobotPair::new(), 0, 0);
    for _ in 0..500 {
        let (a, b) = (robot(&mut random, 16), robot(&mut random, 16));
        let pose_a = random.pose(0.5);
        let poses = [pose_a, beside(&mut random, &a, &pose_a, &b, 0.5)];
        // Each cell by itself, as a pair of robots of one link.
        let alone = |robot: &Chain, link: usize| {
            let link = robot.links()[link];
            let ends = [link.start(), link.end()];
            match link.caps() {
                [Cap::Flat, Cap::Flat] => Chain::cylinders(&ends, &[link.radius()]).ok(),
                [Cap::Round, Cap::Round] => Chain::capsules(&ends, &[link.radius()]).ok(),
                _ => None,
            }
        };
        let ones: Option<Vec<_>> = (0..a.links().len()).map(|link| alone(&a, link)).collect();
        let twos: Option<Vec<_>> = (0..b.links().len()).map(|link| alone(&b, link)).collect();
        let (Some(ones), Some(twos)) = (ones, twos) else { continue };
        let row = |one| {
            twos.iter()
                .map(|two| RobotPair::new().minimum(one, &poses[0], two, &poses[1]).unwrap())
                .collect()
        };
        let table: Vec<Vec<_>> = ones.iter().map(row).collect();
        for margin in [0.0, 0.3, 3.0, f64::INFINITY] {
            let mut found = Vec::new();
            pair.contacts_within(&a, &poses[0], &b, &poses[1], margin, &mut found).unwrap();
            let expected = places(&table, margin);
            assert_eq!(
                found.iter().map(|place| place.links).collect::<Vec<_>>(),
                expected,
                "{margin}"
            );
            several += usize::from(expected.len() > 2);
        }
        merged +=
            usize::from(table.iter().flatten().filter(|cell| cell.distance == 0.0).count() > 3);
    }
    assert!(several > 50 && merged > 30, "{several} {merged}");
}

#[test]
fn a_scaled_scene_has_the_scaled_answer_bit_for_bit() {
    let mut random = Random::new(3);
    for _ in 0..200 {
        let (a, b) = (robot(&mut random, 12), robot(&mut random, 12));
        let poses = [random.pose(1.0), random.pose(2.0)];
        let plain = RobotPair::new().minimum(&a, &poses[0], &b, &poses[1]).unwrap();
        for power in [-300, -40, 40, 300] {
            let factor = 2.0_f64.powi(power);
            let scaled = |robot: &Chain| {
                let ends = robot.links().iter().map(|link| link.end() * factor);
                let points: Vec<_> =
                    std::iter::once(robot.links()[0].start() * factor).chain(ends).collect();
                let radii: Vec<_> =
                    robot.links().iter().map(|link| link.radius() * factor).collect();
                Chain::capsules(&points, &radii).unwrap()
            };
            let round = |robot: &Chain| {
                let points: Vec<_> = std::iter::once(robot.links()[0].start())
                    .chain(robot.links().iter().map(|link| link.end()))
                    .collect();
                let radii: Vec<_> = robot.links().iter().map(|link| link.radius()).collect();
                Chain::capsules(&points, &radii).unwrap()
            };
            let moved = poses.map(|pose| Pose { translation: pose.translation * factor, ..pose });
            let found =
                RobotPair::new().minimum(&scaled(&a), &moved[0], &scaled(&b), &moved[1]).unwrap();
            let expected =
                RobotPair::new().minimum(&round(&a), &poses[0], &round(&b), &poses[1]).unwrap();
            assert_eq!((found.links, found.distance), (expected.links, expected.distance * factor));
            assert_eq!(found.witness.on_first, expected.witness.on_first * factor);
        }
        assert!(plain.distance.is_finite());
    }
}

#[test]
fn what_is_at_fault_is_named() {
    let robot = Chain::from_centreline(&[Vector::ZERO, Vector::Z], &[0.1]).unwrap();
    let nowhere = Pose::from_translation(Vector::splat(f64::NAN));
    let far = Pose::from_translation(Vector::splat(1e151));
    let error = RobotPair::new().minimum(&robot, &Pose::IDENTITY, &robot, &nowhere).unwrap_err();
    assert_eq!(error.kind(), "pose_not_finite");
    assert!(error.to_string().contains("`pose_b`"), "{error}");
    let error = RobotPair::new().minimum(&robot, &far, &robot, &Pose::IDENTITY).unwrap_err();
    assert_eq!(error.kind(), "out_of_range");
    assert!(error.to_string().contains("`pose_a`"), "{error}");
    for margin in [-1.0, f64::NAN] {
        let error = RobotPair::new()
            .clears(&robot, &Pose::IDENTITY, &robot, &Pose::IDENTITY, margin)
            .unwrap_err();
        assert!(matches!(error, ProximityError::Negative { parameter: "margin", .. }), "{error}");
        assert!(SelfQuery::new().clears(&robot, margin).is_err());
    }
}
