//! Which bodies of two lists are near one another: trees of balls over both lists.
//!
//! # Definitions
//! - **Ball** of a body: the ball around the middle of its axis that contains the body.
//! - **Node**: a run of consecutive bodies and a ball around theirs. The lists follow the tube, so
//!   a run is compact. A tree over n bodies has 2 n - 1 nodes in preorder; the first half of a run
//!   comes first. Two lists may share a tree: its root then divides where the second one begins.
//!
//! # Claim
//! [`NearPairs`] visits all pairs whose bodies are at most `bound` apart and that `may_ask` admits.
//!
//! **Proof.** A node contains its bodies. So two nodes are no farther apart than any two bodies of
//! them, and a pair is skipped only if nodes that contain it are farther apart than `bound` or
//! have only pairs that `may_ask` excludes.
//!
//! **Rounding.** Centres and radii err by few u of the largest coordinate. `bound` includes the
//! slack of the tubes, which is 128 u of it.

use crate::distance::Scalar;
use crate::pair::PlacedLink;
use parry3d_f64::math::{Real, Vector};
use std::ops::Range;

/// Below this number of pairs two plain loops are cheaper.
const FEW: usize = 1 << 12;

#[derive(Clone, Copy, Debug, Default)]
struct Ball {
    centre: Vector,
    radius: Real,
}

impl Ball {
    fn around(body: &PlacedLink) -> Self {
        let half = body.along() * 0.5;
        Self { centre: body.start() + half, radius: half.length() + body.radius() }
    }

    fn around_both(&self, other: &Self) -> Self {
        let way = other.centre - self.centre;
        let away = way.length();
        if away + other.radius <= self.radius {
            return *self;
        }
        if away + self.radius <= other.radius {
            return *other;
        }
        let radius = 0.5 * (away + self.radius + other.radius);
        let centre = self.centre + way * ((radius - self.radius) / away);
        Self { centre, radius: radius * (1.0 + 16.0 * Real::UNIT_ROUNDOFF) }
    }

    fn apart(&self, other: &Self) -> Real {
        (other.centre - self.centre).length() - self.radius - other.radius
    }
}

/// A tree of balls over a list of bodies.
#[derive(Clone, Debug, Default)]
pub(super) struct BallTree {
    nodes: Vec<Ball>,
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

impl BallTree {
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
        self.nodes.resize((2 * self.count).saturating_sub(1), Ball::default());
        let mut bodies = bodies.map(Ball::around);
        if self.count > 0 {
            self.fill(self.root(), &mut bodies);
        }
    }

    fn fill(&mut self, run: Run, balls: &mut impl Iterator<Item = Ball>) -> Ball {
        let ball = if run.count == 1 {
            balls.next().unwrap_or_default()
        } else {
            let [low, high] = self.halves(run);
            let low = self.fill(low, balls);
            low.around_both(&self.fill(high, balls))
        };
        self.nodes[run.node] = ball;
        ball
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
    trees: [&'t BallTree; 2],
    waiting: &'t mut Vec<[Run; 2]>,
    pub bound: Real,
}

impl<'t> NearPairs<'t> {
    pub(super) fn new(
        trees: [&'t BallTree; 2],
        WaitingRuns(waiting): &'t mut WaitingRuns,
        bound: Real,
    ) -> Self {
        waiting.clear();
        if trees.iter().all(|tree| tree.count > 0) {
            waiting.push(trees.map(BallTree::root));
        }
        Self { trees, waiting, bound }
    }

    /// Returns the next pair. `may_ask(runs)`: whether any pair of bodies of the two runs is wanted.
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
