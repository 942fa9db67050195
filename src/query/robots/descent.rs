//! Branch and bound over two link trees at once, the nearer pair of nodes first.
//!
//! # Algorithm
//! 1. **Prune** a pair of nodes whose capsules are farther apart than the limit.
//! 2. **Divide** the node with more links, until both have at most [`SWEPT`] links. A robot of some
//!    dozen links does not need its tree.
//! 3. **Sweep** such a pair of nodes: compare the balls around all their links at once ([`Sweep`]).
//! 4. **Seed.** If more than [`MANY`] pairs are left, or there is no limit yet, first measure the
//!    pair with the nearest centres. Its [neighbours](Sweep::beside) are measured in the same
//!    batch. One of them is often the closest of all, which lowers the limit most.
//! 5. **Measure** the remaining pairs in batches of [`AT_ONCE`].
//!
//! **Ties.** If the limit is a distance already found, an equally distant pair may have lower
//! links, so it is searched. The exception is a distance of 0 if the lowest links of the pair
//! follow the links found.

use super::balls::{Balls, SWEPT, Sweep};
use super::pair_frame::PairFrame;
use crate::answer::RobotProximity;
use crate::distance::lanes::set_bits;
use crate::pair::{BATCH, LinkPairBatch, PlacedRobot};
use crate::robot::{LinkNode, place_of_leaf};
use fearless_simd::Level;
use parry3d_f64::math::Real;
use std::ops::Range;

/// With more pairs than this, step 4 pays: seeding costs about as much as measuring this many
/// pairs.
const MANY: u32 = 16 * BATCH as u32;

/// How many pairs are measured before the limit is lowered.
const AT_ONCE: usize = 4 * BATCH;

/// A node of a tree, and its first link.
#[derive(Clone, Copy, Debug)]
struct TreePlace {
    node: usize,
    first: usize,
}

impl TreePlace {
    const ROOT: Self = Self { node: 0, first: 0 };
}

#[derive(Clone, Copy, Debug)]
struct QueuedPair {
    places: [TreePlace; 2],
    at_least: Real,
}

/// The limit up to which pairs of links are searched.
#[derive(Clone, Copy, Debug)]
pub(super) struct PairLimit {
    distance: Real,
    /// The links found at that distance, if any.
    links: Option<[usize; 2]>,
}

impl PairLimit {
    /// Ends the search.
    pub const NOTHING: Self = Self { distance: Real::NEG_INFINITY, links: None };

    pub fn of(distance: Real) -> Self {
        Self { distance, links: None }
    }

    pub fn distance(&self) -> Real {
        self.distance
    }

    /// Returns the limit at a pair that was found.
    pub fn at(found: &RobotProximity) -> Self {
        Self { distance: found.distance, links: Some(found.links.map(|link| link as usize)) }
    }

    /// Returns the limit at the best pair so far, or no limit.
    pub fn at_best(found: &Option<RobotProximity>) -> Self {
        found.as_ref().map_or(Self::of(Real::INFINITY), Self::at)
    }

    /// Whether all pairs can be skipped that are at least `at_least` apart and whose lowest links
    /// are `firsts`.
    pub fn excludes(&self, at_least: Real, firsts: [usize; 2]) -> bool {
        at_least > self.distance
            || (self.distance <= 0.0 && self.links.is_some_and(|links| firsts >= links))
    }

    /// Whether a pair is better than the best so far: nearer, or equally near with lower links.
    pub fn admits(&self, distance: Real, links: [usize; 2]) -> bool {
        distance < self.distance
            || (distance == self.distance && self.links.is_none_or(|found| links < found))
    }
}

/// State of a descent; its memory is reused.
#[derive(Clone, Debug)]
pub(super) struct Descent {
    level: Level,
    stack: Vec<QueuedPair>,
    /// Nodes of the first robot that [`run_in_groups`](Self::run_in_groups) has not visited.
    waiting: Vec<TreePlace>,
    frame: PairFrame,
    /// The balls of both robots; for self contact only the first are used.
    balls: [Balls; 2],
    queried_from: Vec<usize>,
    together: LinkPairBatch,
}

impl Default for Descent {
    fn default() -> Self {
        Self {
            level: Level::new(),
            stack: Vec::new(),
            waiting: Vec::new(),
            frame: PairFrame::default(),
            balls: Default::default(),
            queried_from: Vec::new(),
            together: LinkPairBatch::default(),
        }
    }
}

impl Descent {
    /// Calls `visit` with all pairs of links within the limit; each call returns the next limit.
    ///
    /// `queried_from` returns, for a link of the first robot, the first link of the second that is
    /// queried with it. It must be monotone.
    pub fn run(
        &mut self,
        robots: [&PlacedRobot; 2],
        limit: PairLimit,
        queried_from: impl Fn(usize) -> usize,
        mut visit: impl FnMut(RobotProximity) -> PairLimit,
    ) {
        self.begin(robots);
        self.run_from(TreePlace::ROOT, robots, limit, queried_from, |found| visit(found.answer()));
    }

    /// Calls `visit` with all pairs of links that are at most `limit` apart, and their distances.
    ///
    /// The links of the first robot come in consecutive groups; the pairs of a group come in any
    /// order. `end_group` is called after each group that may have pairs. A group has at most
    /// `most` pairs, or one link.
    pub fn run_in_groups<V>(
        &mut self,
        robots: [&PlacedRobot; 2],
        limit: Real,
        most: usize,
        visitor: &mut V,
        mut visit: impl FnMut(&mut V, [usize; 2], Real),
        mut end_group: impl FnMut(&mut V),
    ) {
        self.begin(robots);
        let most_links = (most / robots[1].links().len()).max(1);
        let all = self.frame.outline(robots[1], 0);
        self.waiting.clear();
        self.waiting.push(TreePlace::ROOT);
        while let Some(place) = self.waiting.pop() {
            let outline = self.frame.outline(robots[0], place.node);
            if self.frame.outside(outline.at_least(&all)) > limit {
                continue;
            }
            if robots[0].link_tree()[place.node].links() > most_links {
                let [low, high] = halves(robots[0].link_tree(), place);
                self.waiting.extend([high, low]);
                continue;
            }
            self.run_from(
                place,
                robots,
                PairLimit::of(limit),
                |_| 0,
                |found| {
                    visit(visitor, found.links, found.distance);
                    PairLimit::of(limit)
                },
            );
            end_group(visitor);
        }
    }

    /// Prepares for two robots. Valid for all following queries until the next call.
    pub fn begin(&mut self, robots: [&PlacedRobot; 2]) {
        // A robot beside itself is placed once.
        let apart = if std::ptr::eq(robots[0], robots[1]) { 1 } else { 2 };
        for (balls, robot) in self.balls.iter_mut().zip(robots).take(apart) {
            balls.start(robot.links().len());
        }
        self.frame = PairFrame::around(robots);
    }

    /// Calls `visit` with the pairs of one link of the first robot, as [`run`](Self::run).
    pub fn run_of_link(
        &mut self,
        robots: [&PlacedRobot; 2],
        link: usize,
        mut visit: impl FnMut(RobotProximity) -> PairLimit,
    ) {
        let leaf = TreePlace { node: place_of_leaf(link, robots[0].links().len()), first: link };
        self.run_from(
            leaf,
            robots,
            PairLimit::of(Real::INFINITY),
            |_| 0,
            |found| visit(found.answer()),
        );
    }

    /// Searches a node of the first tree against the whole second tree.
    fn run_from(
        &mut self,
        place: TreePlace,
        robots: [&PlacedRobot; 2],
        mut limit: PairLimit,
        queried_from: impl Fn(usize) -> usize,
        mut visit: impl FnMut(&Measured) -> PairLimit,
    ) {
        self.stack.clear();
        self.stack.push(QueuedPair { places: [place, TreePlace::ROOT], at_least: 0.0 });
        while let Some(entry) = self.stack.pop() {
            let firsts = entry.places.map(|place| place.first);
            let links = [0, 1].map(|robot: usize| {
                let TreePlace { node, first, .. } = entry.places[robot];
                first..first + robots[robot].link_tree()[node].links()
            });
            // Step 1.
            if limit.excludes(entry.at_least, firsts) || queried_from(firsts[0]) >= links[1].end {
                continue;
            }
            // Steps 3 to 5.
            if links.iter().all(|links| links.len() <= SWEPT) {
                self.queried_from.clear();
                self.queried_from.extend(links[0].clone().map(&queried_from));
                limit = self.sweep(robots, links, limit, &mut visit);
                continue;
            }
            // Step 2.
            let divided = usize::from(links[1].len() > links[0].len());
            let frame = &self.frame;
            let kept = frame.outline(robots[1 - divided], entry.places[1 - divided].node);
            let halves = halves(robots[divided].link_tree(), entry.places[divided]).map(|half| {
                let mut places = entry.places;
                places[divided] = half;
                let outline = frame.outline(robots[divided], half.node);
                QueuedPair { places, at_least: frame.outside(outline.at_least(&kept)) }
            });
            // The nearer half is popped first; ties pop the lower links first.
            let [low, high] = halves;
            let nearer_last = if high.at_least < low.at_least { [low, high] } else { [high, low] };
            self.stack.extend(nearer_last);
        }
    }

    /// Calls `visit` with the queried pairs of two small nodes within the limit (steps 3 to 5).
    /// Returns the last limit.
    fn sweep(
        &mut self,
        robots: [&PlacedRobot; 2],
        links: [Range<usize>; 2],
        mut limit: PairLimit,
        visit: &mut impl FnMut(&Measured) -> PairLimit,
    ) -> PairLimit {
        let Self { level, frame, balls: [first, second], queried_from, together, .. } = self;
        first.place(robots[0], frame, links[0].clone());
        let second = if std::ptr::eq(robots[0], robots[1]) {
            first.place(robots[1], frame, links[1].clone());
            &*first
        } else {
            second.place(robots[1], frame, links[1].clone());
            &*second
        };
        let sweep = Sweep { balls: [first, second], links, queried_from };
        let mut near = [0; SWEPT];
        let find_near = |limit: Real, near: &mut [u64; SWEPT]| sweep.near(*level, limit, near);
        let is_bounded = limit.distance < Real::INFINITY;
        let mut looked_at = None;
        // Step 4.
        if !is_bounded || find_near(frame.length(limit.distance), &mut near) > MANY {
            let before = limit.distance;
            looked_at = sweep.nearest(*level);
            let pairs = looked_at.into_iter().flat_map(|pair| sweep.beside(pair));
            limit = measure(*level, robots, &sweep, together, pairs, limit, visit);
            if limit.excludes(0.0, sweep.links.each_ref().map(|links| links.start)) {
                return limit;
            }
            if !is_bounded || limit.distance < before {
                find_near(frame.length(limit.distance), &mut near);
            }
        }
        let [first, second] = &sweep.links;
        for [link, other] in looked_at.into_iter().flat_map(|pair| sweep.beside(pair)) {
            near[link - first.start] &= !(1 << (other - second.start));
        }
        // Step 5.
        let pairs = near[..first.len()].iter().zip(first.clone());
        let pairs = pairs
            .flat_map(|(&row, link)| set_bits(row).map(move |lane| [link, second.start + lane]));
        measure(*level, robots, &sweep, together, pairs, limit, visit)
    }
}

/// Measures pairs in batches and calls `visit` with those within the limit. Returns the last limit.
fn measure(
    level: Level,
    robots: [&PlacedRobot; 2],
    sweep: &Sweep,
    together: &mut LinkPairBatch,
    mut pairs: impl Iterator<Item = [usize; 2]>,
    mut limit: PairLimit,
    visit: &mut impl FnMut(&Measured) -> PairLimit,
) -> PairLimit {
    let mut links = [[0; 2]; AT_ONCE];
    loop {
        together.clear();
        let mut count = 0;
        while count < AT_ONCE {
            let Some(pair) = pairs.next() else { break };
            if let Some(first) = sweep.balls[0].link(pair[0])
                && let Some(second) = sweep.balls[1].link(pair[1])
                && !limit.excludes(0.0, pair)
                && limit.links != Some(pair)
            {
                together.push(first, second);
                links[count] = pair;
                count += 1;
            }
        }
        if count == 0 {
            return limit;
        }
        together.measure(level, limit.distance);
        for (pair, distance) in together.near() {
            let links = links[pair];
            if limit.admits(distance, links) {
                limit = visit(&Measured { robots, links, distance, together, pair });
            }
        }
    }
}

/// A pair of links within the limit.
struct Measured<'a, 'r> {
    robots: [&'a PlacedRobot<'r>; 2],
    links: [usize; 2],
    distance: Real,
    together: &'a LinkPairBatch,
    pair: usize,
}

impl Measured<'_, '_> {
    fn answer(&self) -> RobotProximity {
        let [first, second] = [0, 1].map(|robot: usize| self.robots[robot].link(self.links[robot]));
        self.together.nearest(self.pair).answer(self.links, [&first, &second])
    }
}

/// Returns the closest points of two links, one of each robot.
pub(super) fn measure_pair(robots: [&PlacedRobot; 2], links: [usize; 2]) -> RobotProximity {
    let [first, second] = [robots[0].link(links[0]), robots[1].link(links[1])];
    first.measure_link(&second).answer(links, [&first, &second])
}

/// Returns the two children of a node.
fn halves(tree: &[LinkNode], TreePlace { node, first }: TreePlace) -> [TreePlace; 2] {
    let low = TreePlace { node: node + 1, first };
    let below = match tree[low.node] {
        LinkNode::Inner { below, .. } => below,
        LinkNode::Leaf(_) => 0,
    };
    [low, TreePlace { node: low.node + 1 + below, first: first + tree[low.node].links() }]
}
