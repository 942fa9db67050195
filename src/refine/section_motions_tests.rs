//! Tests that a pair queried at one time is kept at another if it may be a local minimum then.

use super::section_motions::{SectionMotion, SectionMotions};
use super::tube_with_itself::{SelfPairQueue, TubeWithItself};
use crate::curve::{Tube, TubeTurns};
use crate::robot::Chain;
use continuum_testing::Random;
use parry3d_f64::math::{Real, Rotation, Vector};
use std::collections::BTreeSet;
use std::f64::consts::PI;

/// Two sections, and which of their ends are faces.
type Pair = ([u32; 2], [Option<usize>; 2]);

/// Returns the queried pairs of sections, or the kept pairs of a moving tube.
fn pairs(tube: &Tube, moves: Option<&SectionMotions>) -> BTreeSet<Pair> {
    let (mut turns, mut beginning, mut pairs) =
        (TubeTurns::default(), SelfPairQueue::default(), Vec::new());
    tube.measure_turns(&mut turns).unwrap();
    let own = moves.map_or_else(
        || TubeWithItself::new(tube, &turns),
        |moves| TubeWithItself::moving(tube, &turns, moves),
    );
    own.unwrap().begin(1.0, Real::INFINITY, usize::MAX, &mut beginning, &mut pairs).unwrap();
    pairs.iter().map(|pair| (pair.pieces.map(|piece| piece.section), pair.faces)).collect()
}

/// A random row of links, by directions and lengths.
struct Links {
    directions: Vec<Vector>,
    lengths: Vec<Real>,
}

impl Links {
    /// Each joint bends by at most `bend`.
    fn random(random: &mut Random, count: usize, bend: Real) -> Self {
        let mut direction = Vector::Z;
        let mut links = Self { directions: Vec::new(), lengths: Vec::new() };
        let axis = random.direction();
        for _ in 0..count {
            links.directions.push(direction);
            links.lengths.push(random.between(2.0, 6.0));
            // Half of the joints bend in one common plane.
            let axis = if random.below(2) == 0 { axis } else { random.direction() };
            direction = Rotation::from_axis_angle(axis, bend * random.unit()) * direction;
        }
        links
    }

    /// Turns each direction by at most `turn`, towards a common direction or its own, and scales
    /// each length by up to 1 ± `share`.
    fn moved(&self, random: &mut Random, turn: Real, share: Real) -> Self {
        let common = random.direction();
        let towards = |random: &mut Random, direction: Vector| {
            let to = if random.below(3) == 0 { random.direction() } else { common };
            let axis = direction.cross(to).normalize_or_zero();
            let angle = [turn, turn * random.unit(), 0.0][random.below(3) as usize];
            if axis == Vector::ZERO {
                direction
            } else {
                Rotation::from_axis_angle(axis, angle) * direction
            }
        };
        Self {
            directions: self
                .directions
                .iter()
                .map(|&direction| towards(random, direction))
                .collect(),
            lengths: self
                .lengths
                .iter()
                .map(|length| length * random.between(1.0 - share, 1.0 + share))
                .collect(),
        }
    }

    /// Returns an arc of links whose long first and last links determine the direction of the
    /// chord.
    fn arc(random: &mut Random, count: usize) -> Self {
        let (turn, last) = (random.between(2.0, PI), (count - 1) as Real);
        let direction = |k: usize| {
            let angle = turn * (k as Real / last - 0.5);
            Vector::new(angle.sin(), 0.0, angle.cos())
        };
        let length =
            |k: usize| if k == 0 || k + 1 == count { 10.0 } else { random.between(0.01, 0.1) };
        Self {
            directions: (0..count).map(direction).collect(),
            lengths: (0..count).map(length).collect(),
        }
    }

    /// Turns the first and the last link away from one another.
    fn opened(&self, turn: Real) -> Self {
        let (mut directions, last) = (self.directions.clone(), self.directions.len() - 1);
        for (place, turn) in [(0, -turn), (last, turn)] {
            directions[place] = Rotation::from_axis_angle(Vector::Y, turn) * directions[place];
        }
        Self { directions, lengths: self.lengths.clone() }
    }

    fn points(&self, from: Vector) -> Vec<Vector> {
        let mut points = vec![from];
        for (direction, length) in self.directions.iter().zip(&self.lengths) {
            points.push(points[points.len() - 1] + *direction * *length);
        }
        points
    }

    /// Returns the displacements and turns from `self` to `to`.
    fn moves(&self, to: &Self, radii: &[Real], [here, there]: [&[Vector]; 2]) -> SectionMotions {
        let mut moves = SectionMotions::default();
        for (number, radius) in radii.iter().enumerate() {
            let turn =
                self.directions[number].angle_between(to.directions[number]) * (1.0 + 1e-9) + 1e-12;
            let point = [0, 1].map(|end| (here[number + end] - there[number + end]).length());
            moves.push(SectionMotion {
                points: (point[0].max(point[1]) + radius * turn) * (1.0 + 1e-9),
                turn,
            });
        }
        moves
    }
}

#[test]
fn what_is_asked_about_later_is_kept_now() {
    let mut random = Random::new(5);
    // How often a pair is queried later and not now: two links, a face and a link, two faces.
    let mut only_later = [0; 3];
    for _ in 0..20_000 {
        let links = Links::random(&mut random, 5, 1.3);
        let size = [0.01, 0.1, 0.4][random.below(3) as usize];
        let later = links.moved(&mut random, size, 0.3 * size);
        let base = random.point() * size;
        let (points, places) = (links.points(Vector::ZERO), later.points(base));
        let radii = [[0.2; 5], [1.0, 0.2, 0.2, 0.2, 0.6], [0.4, 0.9, 0.3, 0.7, 0.1]]
            [random.below(3) as usize];
        let [Ok(now), Ok(then)] =
            [&points, &places].map(|points| Chain::from_centreline(points, &radii))
        else {
            continue;
        };
        let [now, then] = [now, then].map(|chain| Tube::from(&chain));
        let moves = links.moves(&later, &radii, [&points, &places]);
        let mut turns = TubeTurns::default();
        if now.measure_turns(&mut turns).and_then(|()| then.measure_turns(&mut turns)).is_err() {
            continue;
        }
        let (kept, at_rest) = (pairs(&now, Some(&moves)), pairs(&now, None));
        for pair @ (sections, faces) in pairs(&then, None) {
            let joints = sections[1] - sections[0];
            // Three joints have six directions: the angles grow by at most 6 times the turn of
            // each. With more joints only local minima are kept.
            if joints > 3 && faces != [Some(1), Some(0)] {
                continue;
            }
            assert!(kept.contains(&pair), "{pair:?}");
            if !at_rest.contains(&pair) {
                only_later[faces.iter().flatten().count()] += 1;
            }
        }
    }
    assert!(only_later.iter().all(|count| *count > 50), "{only_later:?}");
}

#[test]
fn what_is_not_kept_is_no_local_minimum_later() {
    let mut random = Random::new(6);
    let (mut left_out, mut close) = (0, 0);
    for _ in 0..20_000 {
        let count = 3 + random.below(5) as usize;
        let is_arc = random.below(2) == 0;
        let links = if is_arc {
            Links::arc(&mut random, count)
        } else {
            Links::random(&mut random, count, 6.0 / count as Real)
        };
        let size = [0.02, 0.1, 0.3][random.below(3) as usize];
        let later = if is_arc {
            links.opened(size * random.unit())
        } else {
            links.moved(&mut random, size, 0.9)
        };
        let (points, places) = (links.points(Vector::ZERO), later.points(Vector::ZERO));
        let radii = vec![0.0; count];
        let now = Tube::from(&Chain::capsules(&points, &radii).unwrap());
        let kept = pairs(&now, Some(&links.moves(&later, &radii, [&points, &places])));
        for i in 0..count {
            for j in i + 2..count {
                if kept.contains(&([i as u32, j as u32], [None; 2])) {
                    continue;
                }
                left_out += 1;
                let [one, two] = [later.directions[i], later.directions[j]];
                // At a local minimum the distance does not decrease if either place moves along the
                // robot towards the other.
                for x in [places[i], places[i + 1]] {
                    for y in [places[j], places[j + 1]] {
                        let way = (y - x).normalize();
                        let descends = way.dot(one).max(way.dot(two));
                        assert!(descends > 0.0, "{i} {j}: {descends}");
                        close += usize::from(descends < 0.2);
                    }
                }
            }
        }
    }
    assert!(left_out > 100_000 && close > 20, "{left_out} {close}");
}
