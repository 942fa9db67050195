//! What is asked about at one time is kept at another, as far as it may be a local minimum then.

use super::section_motions::{SectionMotion, SectionMotions};
use super::tube_with_itself::{SelfPairQueue, TubeWithItself};
use crate::robot::{Chain, Tube, TubeTurns};
use continuum_testing::Random;
use parry3d_f64::math::{Real, Rotation, Vector};
use std::collections::BTreeSet;
use std::f64::consts::PI;

/// Two sections and which of their ends are faces.
type Pair = ([u32; 2], [Option<usize>; 2]);

/// The pairs of sections that are asked about, or kept while the tube moves.
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

/// Links that turn as they like, with directions and lengths.
struct Links {
    directions: Vec<Vector>,
    lengths: Vec<Real>,
}

impl Links {
    /// Each joint bends by at most so much.
    fn random(random: &mut Random, count: usize, bend: Real) -> Self {
        let mut direction = Vector::Z;
        let mut links = Self { directions: Vec::new(), lengths: Vec::new() };
        let axis = random.direction();
        for _ in 0..count {
            links.directions.push(direction);
            links.lengths.push(random.between(2.0, 6.0));
            // In a plane as often as not.
            let axis = if random.below(2) == 0 { axis } else { random.direction() };
            direction = Rotation::from_axis_angle(axis, bend * random.unit()) * direction;
        }
        links
    }

    /// Each direction turned by at most `turn` towards a place of its own, each length by a share
    /// at most.
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

    /// An arc of links of which the first and the last are so long that they decide where the chord
    /// leads.
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

    /// The first and the last link turned away from one another.
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

    /// How far it is from here to there.
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
    // How often a pair of two links, a face and a link, and two faces is asked about then, and not
    // now.
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
            // Of three joints, six directions: the angles grow by no more than 6 times the turn of
            // each. Of more it is the local minima that are kept.
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
                // A local minimum comes no nearer if either place goes on towards the other one
                // along the robot.
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
