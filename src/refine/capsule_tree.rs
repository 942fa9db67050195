//! Which bodies of two lists are near one another: trees of capsules over both lists.
//!
//! # Definitions
//! - **Capsule**: a ball of radius r that moves from c - a to c + a.
//! - **Node**: a run of consecutive bodies and a capsule that contains theirs. The lists follow the
//!   tube, so a run is narrow. A tree over n bodies has 2 n - 1 nodes in preorder; the first half
//!   of a run comes first. Two lists may share a tree: its root then divides where the second one
//!   begins.
//!
//! # Claim
//! [`NearPairs`] visits all pairs whose bodies are at most `bound` apart and that `may_ask` admits.
//!
//! **Proof.** A pair is skipped only if nodes that contain it are farther apart than `bound` or
//! have only pairs that `may_ask` excludes. Two steps remain:
//! 1. **A node contains its halves.** Let c1, a1, r1 and c2, a2, r2 be their capsules, c the middle
//!    of c1 and c2, and d the direction from c1 to c2. The half axis is a = h d with h the largest
//!    `|ci - c| + |ai . d|`. So the ends ci +- ai are beside the axis, at the distance
//!    `|ai - d (ai . d)|`. r is the largest sum of this distance and ri. A capsule is convex, so it
//!    contains a half if it contains the balls at both ends. If c1 = c2, d is 0 and a too.
//! 2. **Two capsules** with `w = c2 - c1` are at least
//!    `|w| - (|w . a1| + |w . a2|) / |w| - r1 - r2` apart: that is the gap along w. If w = 0 the
//!    gap is NaN, and the pair is visited.
//!
//! **Rounding.** Each level adds to r the rounding of c, a and r: 16 u times the sum of r and the
//! largest coordinates of c and a. The gap errs by few u of the largest coordinate of all. `bound`
//! includes the slack of the tubes, which is 128 u of it, and covers lengths whose squares vanish.

use crate::distance::Scalar;
use crate::pair::PlacedLink;
use crate::robot::{length, length_and_direction};
use parry3d_f64::math::{Real, Vector};
use std::ops::Range;

/// Below this number of pairs two plain loops are cheaper.
const FEW: usize = 1 << 12;

#[derive(Clone, Copy, Debug, Default)]
struct Capsule {
    centre: Vector,
    half_axis: Vector,
    radius: Real,
}

impl Capsule {
    fn around(body: &PlacedLink) -> Self {
        let half_axis = body.along() * 0.5;
        Self::rounded(body.start() + half_axis, half_axis, body.radius())
    }

    /// Step 1 of the proof.
    fn around_both(&self, other: &Self) -> Self {
        let (away, direction) = length_and_direction(other.centre - self.centre);
        let (mut along, mut radius): (Real, Real) = (0.0, 0.0);
        for half in [self, other] {
            let part = half.half_axis.dot(direction);
            along = along.max(part.abs());
            radius = radius.max(length(half.half_axis - direction * part) + half.radius);
        }
        let along = 0.5 * away + along;
        Self::rounded(self.centre.midpoint(other.centre), direction * along, radius)
    }

    /// Adds the rounding of a level.
    fn rounded(centre: Vector, half_axis: Vector, radius: Real) -> Self {
        let size = centre.abs().max_element() + half_axis.abs().max_element() + radius;
        Self { centre, half_axis, radius: radius + 16.0 * Real::UNIT_ROUNDOFF * size }
    }

    /// Step 2 of the proof.
    fn apart(&self, other: &Self) -> Real {
        let way = other.centre - self.centre;
        let away = way.length();
        let along = way.dot(self.half_axis).abs() + way.dot(other.half_axis).abs();
        away - along / away - self.radius - other.radius
    }
}

/// A tree of capsules over a list of bodies.
#[derive(Clone, Debug, Default)]
pub(super) struct CapsuleTree {
    nodes: Vec<Capsule>,
    count: usize,
    /// Where the root divides.
    split: usize,
}

/// A node and its run of bodies.
#[derive(Clone, Copy, Debug)]
struct Run {
    node: usize,
    first: usize,
    count: usize,
}

impl Run {
    fn bodies(&self) -> Range<usize> {
        self.first..self.first + self.count
    }
}

impl CapsuleTree {
    /// Replaces the tree by one over these bodies. The first `split` of them are a list of their
    /// own.
    pub(super) fn build<'b>(
        &mut self,
        bodies: impl ExactSizeIterator<Item = &'b PlacedLink>,
        split: usize,
    ) {
        self.count = bodies.len();
        let is_within = (1..self.count).contains(&split);
        self.split = if is_within { split } else { self.count / 2 };
        self.nodes.clear();
        self.nodes.resize((2 * self.count).saturating_sub(1), Capsule::default());
        let mut bodies = bodies.map(Capsule::around);
        if self.count > 0 {
            self.fill(self.root(), &mut bodies);
        }
    }

    fn fill(&mut self, run: Run, capsules: &mut impl Iterator<Item = Capsule>) -> Capsule {
        let capsule = if run.count == 1 {
            capsules.next().unwrap_or_default()
        } else {
            let [low, high] = self.halves(run);
            let low = self.fill(low, capsules);
            low.around_both(&self.fill(high, capsules))
        };
        self.nodes[run.node] = capsule;
        capsule
    }

    fn root(&self) -> Run {
        Run { node: 0, first: 0, count: self.count }
    }

    fn halves(&self, Run { node, first, count }: Run) -> [Run; 2] {
        let half = if node == 0 { self.split } else { count / 2 };
        [
            Run { node: node + 1, first, count: half },
            Run { node: node + 2 * half, first: first + half, count: count - half },
        ]
    }
}

/// Whether two lists of these lengths have enough pairs for trees to pay.
pub(super) fn pays(counts: [usize; 2]) -> bool {
    counts[0].saturating_mul(counts[1]) > FEW
}

/// The pairs of nodes that wait. A later search reuses the memory.
#[derive(Clone, Debug, Default)]
pub(super) struct WaitingRuns(Vec<[Run; 2]>);

/// The pairs of bodies that may be at most `bound` apart, the nearer of two pairs of nodes first.
/// For a tree and itself the first index is at most the second.
pub(super) struct NearPairs<'t> {
    trees: [&'t CapsuleTree; 2],
    waiting: &'t mut Vec<[Run; 2]>,
    pub bound: Real,
}

impl<'t> NearPairs<'t> {
    pub(super) fn new(
        trees: [&'t CapsuleTree; 2],
        WaitingRuns(waiting): &'t mut WaitingRuns,
        bound: Real,
    ) -> Self {
        waiting.clear();
        if trees.iter().all(|tree| tree.count > 0) {
            waiting.push(trees.map(CapsuleTree::root));
        }
        Self { trees, waiting, bound }
    }

    /// Returns the next pair. `may_ask(runs)`: whether any pair of bodies of two runs is wanted.
    pub(super) fn next(
        &mut self,
        may_ask: impl Fn([Range<usize>; 2]) -> bool,
    ) -> Option<[usize; 2]> {
        let Self { trees, waiting, bound } = self;
        let is_same = std::ptr::eq(trees[0], trees[1]);
        let apart = |runs: &[Run; 2]| {
            let [one, two] = [0, 1].map(|k: usize| &trees[k].nodes[runs[k].node]);
            one.apart(two)
        };
        while let Some(runs) = waiting.pop() {
            let [one, two] = runs;
            // This form keeps pairs whose distance is NaN.
            if apart(&runs) > *bound || !may_ask(runs.map(|run| run.bodies())) {
                continue;
            }
            if one.count == 1 && two.count == 1 {
                return Some([one.first, two.first]);
            }
            if is_same && one.node == two.node {
                let [low, high] = trees[0].halves(one);
                waiting.extend([[low, low], [high, high], [low, high]]);
                continue;
            }
            let k = usize::from(two.count > one.count);
            let mut halves = trees[k].halves(runs[k]).map(|half| {
                let mut runs = runs;
                runs[k] = half;
                runs
            });
            if apart(&halves[0]) <= apart(&halves[1]) {
                halves.reverse();
            }
            waiting.extend(halves);
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use continuum_testing::Random;

    /// All pairs of capsules within the bound are visited, and few others: on lines, coils and
    /// random walks, of links and balls, far from the origin, at every scale.
    #[test]
    fn all_near_pairs_are_visited() {
        let mut random = Random::new(31);
        for round in 0..300 {
            let scale = [1.0, 1e-150, 1e150][round % 3];
            let offset = random.point() * [0.0, 1e6][random.below(2) as usize];
            let kind = random.below(4);
            let lists = [0, 1].map(|_| {
                let count = 1 + random.below(60) as usize;
                let (mut at, axis) = (offset + random.point() * 20.0, random.direction());
                let mut way = random.direction();
                let next = |_| {
                    way = match kind {
                        0 => way,
                        1 => (way + axis.cross(way) * 0.3).normalize_or(axis),
                        _ => (way + random.point()).normalize_or(axis),
                    };
                    let start = at;
                    at += way * if kind == 3 { 0.0 } else { random.between(0.0, 1.0) };
                    let radius = random.between(0.0, 0.5) * scale;
                    PlacedLink::between(start * scale, at * scale, radius, [false; 2])
                };
                (0..count).map(next).collect::<Vec<_>>()
            });
            let mut trees = [CapsuleTree::default(), CapsuleTree::default()];
            for (tree, bodies) in trees.iter_mut().zip(&lists) {
                tree.build(bodies.iter(), 0);
            }
            let apart = |[i, j]: [usize; 2]| {
                let (one, two) = (&lists[0][i], &lists[1][j]);
                one.nearest_on_axes(two).1 - one.radius() - two.radius()
            };
            let all = (0..lists[0].len()).flat_map(|i| (0..lists[1].len()).map(move |j| [i, j]));
            let least = all.clone().map(apart).fold(Real::INFINITY, Real::min);
            let bound = least + random.between(0.0, 5.0) * scale;
            let mut waiting = WaitingRuns::default();
            let mut near = NearPairs::new(trees.each_ref(), &mut waiting, bound);
            let mut visited: Vec<_> = std::iter::from_fn(|| near.next(|_| true)).collect();
            visited.sort_unstable();
            let wanted: Vec<_> = all.filter(|pair| apart(*pair) <= bound).collect();
            for pair in &wanted {
                assert!(visited.binary_search(pair).is_ok(), "round {round}: {pair:?}");
            }
        }
    }
}
