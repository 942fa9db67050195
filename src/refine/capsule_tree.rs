//! Which bodies along a tube are near those of another one: trees of capsules, made as far as a
//! query visits them.
//!
//! # Definitions
//! - **Capsule**: a ball of radius r that moves from c - a to c + a.
//! - **Node**: a run of consecutive bodies and a capsule that contains the parts of the tube in the
//!   run. A body contains its part. The capsule of a longer run is made from its two ends if the
//!   curve between them is nearly straight ([`PlacedTube::around_run`]), otherwise from the
//!   capsules of its halves. So the bodies of a run are made only if a query comes near it.
//! - Two lists may share a tree: its root then divides where the second one begins.
//!
//! # Claim
//! [`NearPairs`] visits all pairs whose parts of the tubes are at most `bound` apart and that
//! `may_ask` admits. The lower bound of a pair depends only on the tubes, and a pair is visited
//! only if its lower bound is at most `bound`.
//!
//! **Proof.** The lower bound of a pair is the largest distance of two nodes that contain it. A
//! node is divided in the same way in every query. A pair is skipped only if its lower bound
//! exceeds `bound` or `may_ask` excludes it. Two steps remain:
//! 1. **A node contains its halves.** Let c1, a1, r1 and c2, a2, r2 be their capsules, c the middle
//!    of c1 and c2, and d the direction from c1 to c2. The half axis is a = h d with h the largest
//!    `|ci - c| + |ai . d|`. So the ends ci +- ai are beside the axis, at the distance
//!    `|ai - d (ai . d)|`. r is the largest sum of this distance and ri. A capsule is convex, so it
//!    contains a half if it contains the balls at both ends. If c1 = c2, d is 0 and a too.
//! 2. **Two capsules** with `w = c2 - c1` are at least
//!    `|w| - (|w . a1| + |w . a2|) / |w| - r1 - r2` apart: that is the gap along w. If w = 0 the
//!    gap is NaN, and the lower bound stays as it was.
//!
//! **Rounding.** Each level adds to r the rounding of c, a and r: 16 u times the sum of r and the
//! largest coordinates of c and a. The gap errs by few u of the largest coordinate of all. `bound`
//! includes the slack of the tubes, which is 128 u of it, and covers lengths whose squares vanish.
//!
//! [`PlacedTube::around_run`]: super::placed_tube::PlacedTube::around_run

use super::bounding_body::BoundingBody;
use crate::distance::Scalar;
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
    fn between([start, end]: [Vector; 2], radius: Real) -> Self {
        let half_axis = (end - start) * 0.5;
        Self::rounded(start + half_axis, half_axis, radius)
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

/// The parts along a tube, and the bodies of those that a query came near.
#[derive(Clone, Debug, Default)]
pub(super) struct Parts<P> {
    pub list: Vec<P>,
    /// For each part the place of its body in `bodies`.
    places: Vec<Option<u32>>,
    bodies: Vec<BoundingBody>,
}

impl<P> Parts<P> {
    /// Forgets the bodies of an earlier list.
    pub(super) fn forget_bodies(&mut self) {
        self.bodies.clear();
        self.places.clear();
        self.places.resize(self.list.len(), None);
    }

    /// Returns the body of a part. `body` makes it at the first visit.
    pub(super) fn body(
        &mut self,
        part: usize,
        body: impl FnOnce(&P) -> BoundingBody,
    ) -> &BoundingBody {
        let place = *self.places[part].get_or_insert_with(|| {
            self.bodies.push(body(&self.list[part]));
            self.bodies.len() as u32 - 1
        });
        &self.bodies[place as usize]
    }
}

/// Returns the ends and the radius of the capsule of a run of a tree; `None` if its halves are to
/// be made. A run of one body has a capsule.
pub(super) type CapsuleOfRun<'a> = dyn FnMut(Range<usize>) -> Option<([Vector; 2], Real)> + 'a;

/// A run of bodies, its capsule, and its halves if they are made.
#[derive(Clone, Copy, Debug)]
struct Node {
    first: u32,
    count: u32,
    capsule: Capsule,
    halves: Option<[u32; 2]>,
}

impl Node {
    fn run(&self) -> Range<usize> {
        self.first as usize..(self.first + self.count) as usize
    }
}

/// A tree of capsules over a list of bodies.
#[derive(Clone, Debug, Default)]
pub(super) struct CapsuleTree {
    nodes: Vec<Node>,
    /// Where the root divides.
    split: u32,
}

impl CapsuleTree {
    /// Replaces the tree by one over `count` bodies. The first `split` of them are a list of their
    /// own.
    pub(super) fn begin(&mut self, count: usize, split: usize, capsule: &mut CapsuleOfRun) {
        self.split = if (1..count).contains(&split) { split } else { count / 2 } as u32;
        self.nodes.clear();
        if count > 0 {
            self.push([0, count as u32], capsule);
        }
    }

    fn push(&mut self, [first, count]: [u32; 2], capsule: &mut CapsuleOfRun) -> u32 {
        let number = self.nodes.len();
        let mut node = Node { first, count, capsule: Capsule::default(), halves: None };
        self.nodes.push(node);
        node.capsule = match capsule(node.run()) {
            Some((ends, radius)) => Capsule::between(ends, radius),
            None => {
                let halves = self.halves(number as u32, capsule);
                node.halves = Some(halves);
                let [low, high] = halves.map(|half| self.nodes[half as usize].capsule);
                low.around_both(&high)
            }
        };
        self.nodes[number] = node;
        number as u32
    }

    fn halves(&mut self, number: u32, capsule: &mut CapsuleOfRun) -> [u32; 2] {
        let Node { first, count, halves, .. } = self.nodes[number as usize];
        halves.unwrap_or_else(|| {
            let half = if number == 0 { self.split } else { count / 2 };
            let halves =
                [[first, half], [first + half, count - half]].map(|half| self.push(half, capsule));
            self.nodes[number as usize].halves = Some(halves);
            halves
        })
    }
}

/// Whether two lists of these lengths have enough pairs for trees to pay.
pub(super) fn pays(counts: [usize; 2]) -> bool {
    counts[0].saturating_mul(counts[1]) > FEW
}

/// The pairs of nodes that wait, with their lower bounds. A later search reuses the memory.
#[derive(Clone, Debug, Default)]
pub(super) struct WaitingRuns(Vec<(Real, [u32; 2])>);

/// The pairs of bodies whose parts of the tubes may be at most `bound` apart, the nearer of two
/// pairs of nodes first. For one tree and itself the first index is at most the second.
pub(super) struct NearPairs<'t> {
    trees: &'t mut [CapsuleTree],
    waiting: &'t mut Vec<(Real, [u32; 2])>,
    pub bound: Real,
}

impl<'t> NearPairs<'t> {
    /// Begins with the roots of two trees, or of one tree and itself.
    pub(super) fn new(
        trees: &'t mut [CapsuleTree],
        WaitingRuns(waiting): &'t mut WaitingRuns,
        bound: Real,
    ) -> Self {
        waiting.clear();
        if trees.iter().all(|tree| !tree.nodes.is_empty()) {
            waiting.push((Real::NEG_INFINITY, [0; 2]));
        }
        Self { trees, waiting, bound }
    }

    fn node(&self, k: usize, nodes: [u32; 2]) -> &Node {
        &self.trees[k.min(self.trees.len() - 1)].nodes[nodes[k] as usize]
    }

    /// Returns the next pair and its lower bound. `may_ask(runs)`: whether any pair of bodies of
    /// two runs is wanted. `capsule(k, run)`: the capsule of a run of tree k.
    pub(super) fn next(
        &mut self,
        may_ask: &dyn Fn([Range<usize>; 2]) -> bool,
        capsule: &mut dyn FnMut(usize, Range<usize>) -> Option<([Vector; 2], Real)>,
    ) -> Option<(Real, [usize; 2])> {
        let is_same = self.trees.len() == 1;
        while let Some((least, nodes)) = self.waiting.pop() {
            let runs = [0, 1].map(|k| self.node(k, nodes).run());
            let [one, two] = runs.each_ref().map(Range::len);
            let places = runs.each_ref().map(|run| run.start);
            if least > self.bound || !may_ask(runs) {
                continue;
            }
            if one == 1 && two == 1 {
                return Some((least, places));
            }
            let k = usize::from(two > one);
            let tree = if is_same { 0 } else { k };
            let halves = self.trees[tree].halves(nodes[k], &mut |run| capsule(tree, run));
            let apart = |pair: [u32; 2]| {
                let [one, two] = [0, 1].map(|k| &self.node(k, pair).capsule);
                one.apart(two)
            };
            if is_same && nodes[0] == nodes[1] {
                let [low, high] = halves;
                let between = (least.max(apart(halves)), halves);
                self.waiting.extend([(least, [low; 2]), (least, [high; 2]), between]);
                continue;
            }
            let pairs = halves.map(|half| if k == 0 { [half, nodes[1]] } else { [nodes[0], half] });
            let [low, high] = pairs.map(apart);
            // A distance that is NaN leaves the bound as it was.
            let mut pairs = [(least.max(low), pairs[0]), (least.max(high), pairs[1])];
            if low <= high {
                pairs.reverse();
            }
            self.waiting.extend(pairs);
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pair::PlacedLink;
    use continuum_testing::Random;

    /// All pairs of capsules within the bound are visited, and few others: on lines, coils and
    /// random walks, of links and balls, far from the origin, at every scale. A list may follow its
    /// tube from the tip to the base, and its bodies point to the tip, as those of a query may.
    #[test]
    fn all_near_pairs_are_visited() {
        let mut random = Random::new(31);
        let (mut count, mut far) = (0, 0);
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
                let mut list: Vec<_> = (0..count).map(next).collect();
                if random.below(2) == 0 {
                    list.reverse();
                }
                list
            });
            let mut trees = [CapsuleTree::default(), CapsuleTree::default()];
            let of_one = |k: usize, run: Range<usize>| {
                let body: &PlacedLink = &lists[k][run.start];
                (run.len() == 1).then(|| ([body.start(), body.end()], body.radius()))
            };
            for (k, tree) in trees.iter_mut().enumerate() {
                tree.begin(lists[k].len(), 0, &mut |run| of_one(k, run));
            }
            let apart = |[i, j]: [usize; 2]| {
                let (one, two) = (&lists[0][i], &lists[1][j]);
                one.nearest_on_axes(two).1 - one.radius() - two.radius()
            };
            let all = (0..lists[0].len()).flat_map(|i| (0..lists[1].len()).map(move |j| [i, j]));
            let least = all.clone().map(apart).fold(Real::INFINITY, Real::min);
            let bound = least + random.between(0.0, 5.0) * scale;
            let mut waiting = WaitingRuns::default();
            let mut near = NearPairs::new(&mut trees, &mut waiting, bound);
            let next = || near.next(&|_| true, &mut |k, run| of_one(k, run));
            let mut visited: Vec<_> = std::iter::from_fn(next).map(|(_, pair)| pair).collect();
            visited.sort_unstable();
            let wanted: Vec<_> = all.filter(|pair| apart(*pair) <= bound).collect();
            for pair in &wanted {
                assert!(visited.binary_search(pair).is_ok(), "round {round}: {pair:?}");
            }
            count += lists[0].len() * lists[1].len() - wanted.len();
            far += visited.len() - wanted.len();
        }
        assert!(0 < far && 20 * far < count, "{far} of {count}");
    }
}
