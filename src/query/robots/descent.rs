//! Two trees of links at once, the nearer pair of nodes first.
//!
//! A pair of nodes is left out when its capsules are farther apart than a limit; of the others the node with more links is
//! divided, until both have so few links that all are compared at once, in packs: the nodes of a coil are as near as its links,
//! and a pack costs no more than a pair of nodes. The nearest of these pairs is looked at first. Where the limit is a distance that
//! has been found, a pair that is as far may still hold lower links, so it is looked at, unless that distance is 0 and its
//! lowest links come after those that were found.

use super::outline_rows::Block;
use super::outlines::{Outlines, SearchFrame};
use crate::answer::RobotProximity;
use crate::pair::{PlacedRobot, TOGETHER};
use crate::robot::LinkNode;
use fearless_simd::Level;
use parry3d_f64::math::Real;
use std::ops::Range;

/// A node of a tree, and the first of its links.
#[derive(Clone, Copy, Debug)]
struct Place {
    node: usize,
    first: usize,
}

impl Place {
    const ROOT: Self = Self { node: 0, first: 0 };
}

#[derive(Clone, Copy, Debug)]
struct Entry {
    places: [Place; 2],
    at_least: Real,
}

/// What a pair of links must not exceed to be looked at.
#[derive(Clone, Copy, Debug)]
pub(super) struct Limit {
    pub distance: Real,
    /// The links that are that far, if some are.
    pub links: Option<[usize; 2]>,
}

impl Limit {
    /// Nothing is looked at any more.
    pub const NOTHING: Self = Self { distance: Real::NEG_INFINITY, links: None };

    pub fn of(distance: Real) -> Self {
        Self { distance, links: None }
    }

    /// That of what has been found.
    pub fn at(found: &RobotProximity) -> Self {
        Self { distance: found.distance, links: Some(found.links.map(|link| link as usize)) }
    }

    /// Whether what is at least so far apart needs no look, if these are its lowest links.
    fn leaves_out(&self, at_least: Real, firsts: [usize; 2]) -> bool {
        at_least > self.distance || (self.distance <= 0.0 && self.links.is_some_and(|links| firsts >= links))
    }
}

/// What a descent keeps from one to the next.
#[derive(Clone, Debug)]
pub(super) struct Descent {
    level: Level,
    stack: Vec<Entry>,
    outlines: [Outlines; 2],
    frame: SearchFrame,
    block: Block,
}

impl Default for Descent {
    fn default() -> Self {
        Self {
            level: Level::new(),
            stack: Vec::new(),
            outlines: Default::default(),
            frame: SearchFrame::default(),
            block: Block::default(),
        }
    }
}

impl Descent {
    /// Shows `visit` all pairs of links that are within the limit, which it returns anew each time. `asks` is given two ranges
    /// of links, and tells whether a pair of them is asked for.
    pub fn run(
        &mut self,
        robots: [&PlacedRobot; 2],
        limit: Limit,
        asks: impl Fn([Range<usize>; 2]) -> bool,
        visit: impl FnMut([usize; 2]) -> Limit,
    ) {
        self.begin(robots);
        if asks(robots.map(|robot| 0..robot.links().len())) {
            self.run_from([Place::ROOT; 2], robots, limit, asks, visit);
        }
    }

    /// Shows `visit` each link of the first robot, alone for a first limit, and then with all links of the second that are
    /// within the limit.
    pub fn run_per_link(
        &mut self,
        robots: [&PlacedRobot; 2],
        mut visit: impl FnMut(usize, Option<usize>) -> Limit,
    ) {
        self.begin(robots);
        let nodes = robots[0].link_tree().iter().enumerate();
        let leaves = nodes.filter(|(_, node)| node.links() == 1).map(|(node, _)| node);
        for (first, node) in leaves.enumerate() {
            let (limit, places) = (visit(first, None), [Place { node, first }, Place::ROOT]);
            self.run_from(places, robots, limit, |_| true, |[first, other]| visit(first, Some(other)));
        }
    }

    /// Forgets the last robots' outlines.
    fn begin(&mut self, robots: [&PlacedRobot; 2]) {
        for (outlines, robot) in self.outlines.iter_mut().zip(robots) {
            outlines.start(robot);
        }
        self.frame = SearchFrame::around(robots);
    }

    fn run_from(
        &mut self,
        places: [Place; 2],
        robots: [&PlacedRobot; 2],
        mut limit: Limit,
        asks: impl Fn([Range<usize>; 2]) -> bool,
        mut visit: impl FnMut([usize; 2]) -> Limit,
    ) {
        let Self { level, stack, outlines, frame, block } = self;
        stack.clear();
        stack.push(Entry { places, at_least: 0.0 });
        while let Some(entry) = stack.pop() {
            let firsts = entry.places.map(|place| place.first);
            if limit.leaves_out(entry.at_least, firsts) {
                continue;
            }
            let nodes = [0, 1].map(|robot: usize| robots[robot].link_tree()[entry.places[robot].node]);
            let counts = nodes.map(|node| node.links());
            if counts.iter().all(|&count| count <= TOGETHER) {
                let [first, second] = &mut *outlines;
                let rows = [
                    first.of_links(frame, robots[0], entry.places[0].node),
                    second.of_links(frame, robots[1], entry.places[1].node),
                ];
                block.compare(*level, rows, firsts, counts, [frame.unit(), limit.distance]);
                limit = visit_block(block, firsts, limit, &asks, &mut visit);
                continue;
            }
            let divided = usize::from(counts[1] > counts[0]);
            let kept = 1 - divided;
            let other = outlines[kept].get(frame, robots[kept], entry.places[kept].node);
            let halves = halves(robots[divided].link_tree(), entry.places[divided]).map(|half| {
                let mut places = entry.places;
                places[divided] = half;
                let links = [0, 1].map(|robot: usize| {
                    let Place { node, first } = places[robot];
                    first..first + robots[robot].link_tree()[node].links()
                });
                asks(links).then(|| {
                    let outline = outlines[divided].get(frame, robots[divided], half.node);
                    Entry { places, at_least: outline.at_least(&other) * frame.unit() }
                })
            });
            // The nearer one is taken first, and of equals that with the lower links.
            let [low, high] = halves;
            let is_high_nearer =
                matches!((low, high), (Some(low), Some(high)) if high.at_least < low.at_least);
            let nearer_last = if is_high_nearer { [low, high] } else { [high, low] };
            let is_left =
                |entry: &Entry| !limit.leaves_out(entry.at_least, entry.places.map(|place| place.first));
            stack.extend(nearer_last.into_iter().flatten().filter(is_left));
        }
    }
}

/// Shows `visit` the pairs of a block that are asked for and within the limit, the nearest first. Returns the last limit.
fn visit_block(
    block: &Block,
    firsts: [usize; 2],
    mut limit: Limit,
    asks: &impl Fn([Range<usize>; 2]) -> bool,
    visit: &mut impl FnMut([usize; 2]) -> Limit,
) -> Limit {
    let asked = |limit: Limit, [i, j]: [usize; 2]| {
        let links = [firsts[0] + i, firsts[1] + j];
        let is_left_out = limit.leaves_out(block.at_least[i][j], links);
        (!is_left_out && asks(links.map(|link| link..link + 1))).then_some(links)
    };
    let near = block.near().filter_map(|pair| Some((pair, asked(limit, pair)?)));
    let at_least = |[i, j]: [usize; 2]| block.at_least[i][j];
    let nearest = near.min_by(|(one, _), (other, _)| at_least(*one).total_cmp(&at_least(*other)));
    let Some((nearest, links)) = nearest else { return limit };
    limit = visit(links);
    for pair in block.near().filter(|pair| *pair != nearest) {
        if let Some(links) = asked(limit, pair) {
            limit = visit(links);
        }
    }
    limit
}

/// The two children of a node.
fn halves(tree: &[LinkNode], Place { node, first }: Place) -> [Place; 2] {
    let low = Place { node: node + 1, first };
    let below = match tree[low.node] {
        LinkNode::Inner { below, .. } => below,
        LinkNode::Leaf(_) => 0,
    };
    [low, Place { node: low.node + 1 + below, first: first + tree[low.node].links() }]
}
