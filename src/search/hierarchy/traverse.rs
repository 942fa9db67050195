//! The nearest triangle of one link: nearer children first. Where every triangle within a limit is
//! wanted, their order does not matter.
//!
//! All comparisons are in the precision of the search and of distances from the axis, the link's
//! own distance and its radius. Where no flat cap decides that is the axis distance F; beyond a
//! flat cap it lies between two bounds. A triangle whose upper bound was computed as u is nearer
//! than u - r + e, with e the link's `error`; so another one can only win if its own lower bound is
//! below u + 2 e. Such candidates are put off: at the end the few that are left are measured in
//! double precision.

use super::build::WideBvh;
use super::candidates::select_least;
use super::capped_gather::CappedGather;
use super::leaf_visitor::LeafVisitor;
use super::node::{Child, Node, WIDTH};
use crate::answer::Work;
use crate::distance::lanes::{Lane, Pack};
use crate::distance::{Face, dispatch};
use crate::mesh::{BLOCK, Mesh, load_vertices};
use crate::pair::{BATCH, Best, LinkLanes, PlacedLink, SearchLink};
use fearless_simd::Level;

/// A guess at the nearest is good enough after so many leaves: where many triangles are about as
/// near, one is as good as another.
const LEAVES_FOR_A_GUESS: u32 = 8;

/// So many triangles in question or fewer share their packs with those of other links. Measured:
/// more fill packs of their own well enough.
const FEW: usize = BATCH / 2;

/// Memory that is used again.
#[derive(Clone, Default)]
pub(crate) struct Stack<E> {
    /// Children that wait for their turn, the nearest last.
    waiting: Vec<(E, u32)>,
    /// Nodes that wait where their order does not matter.
    nodes: Vec<u32>,
    /// Triangles that may be the nearest, with their lower bounds.
    candidates: Vec<(E, u32)>,
}

/// A search through a mesh.
pub(crate) struct Traversal<'a, E> {
    pub level: Level,
    pub mesh: &'a Mesh,
    pub tree: &'a WideBvh<E>,
    pub stack: &'a mut Stack<E>,
    pub work: &'a mut Work,
}

/// What is searched for.
struct Target<'a, E> {
    searched: &'a SearchLink<E>,
    /// What a triangle's axis distance must be below.
    limit: E,
    /// What its number must be below.
    below: u32,
    aim: Goal<'a>,
}

enum Goal<'a> {
    /// The nearest triangle of a link that improves on the best so far.
    Nearest(&'a PlacedLink, Best),
    /// Some triangle that is about the nearest, and how many leaves may still be visited for it.
    About(Option<u32>, u32),
    /// Whether any triangle may be within the limit.
    Any(bool),
}

impl<E: Lane> Target<'_, E> {
    /// What the squared bound of a child must be below for it to hold a triangle within the limit.
    #[inline(always)]
    fn squared_limit_of_bounds(&self) -> E {
        self.searched.squared_limit_of_bounds(self.limit)
    }

    /// Whether nothing can change the answer any more.
    fn is_settled(&self) -> bool {
        match &self.aim {
            Goal::Nearest(..) => self.below == 0,
            // Once a triangle overlaps, the limit is 0 and nothing is below it.
            Goal::About(_, leaves) => *leaves == 0,
            Goal::Any(found) => *found,
        }
    }
}

impl<E: Lane> Traversal<'_, E> {
    /// The triangle nearest to a link that improves on `best`. The leaves of the triangles to
    /// `start` with come first, for the bound they give.
    pub(crate) fn nearest(
        &mut self,
        link: &PlacedLink,
        searched: &SearchLink<E>,
        best: Best,
        start: [Option<u32>; 2],
    ) -> Best {
        let limit = searched.axis_limit(best.bound());
        let below = best.triangle_limit();
        let mut target = Target { searched, limit, below, aim: Goal::Nearest(link, best) };
        self.search(&mut target, start);
        self.settle(&mut target);
        if let Goal::Nearest(_, best) = target.aim { best } else { best }
    }

    /// The same without a bound where many triangles are in question. Where they are few, none is
    /// measured: they are added to `few`, the likeliest first, for a pack that they share with
    /// those of other links.
    pub(crate) fn nearest_or_candidates(
        &mut self,
        link: &PlacedLink,
        searched: &SearchLink<E>,
        start: [Option<u32>; 2],
        few: &mut Vec<u32>,
    ) -> Option<Best> {
        let (limit, best) = (searched.axis_limit(f64::INFINITY), Best::within(f64::INFINITY));
        let mut target =
            Target { searched, limit, below: u32::MAX, aim: Goal::Nearest(link, best) };
        self.search(&mut target, start);
        self.drop_candidates(&target);
        let candidates = &mut self.stack.candidates;
        if matches!(target.aim, Goal::Nearest(_, best) if best.nearest().is_none())
            && (1..=FEW).contains(&candidates.len())
        {
            select_least(candidates, 1);
            few.extend(candidates.iter().map(|candidate| candidate.1));
            return None;
        }
        self.measure_candidates(&mut target);
        if let Goal::Nearest(_, best) = target.aim { Some(best) } else { None }
    }

    /// The same as [`Traversal::nearest`], and what the link keeps from all triangles at the least,
    /// with the triangle that seemed as near if one was met. Nothing is looked for that is
    /// farther than `far`, which is `best`'s bound or more.
    ///
    /// Whatever was left out on the way was no nearer than the limit was, which only ever falls. So
    /// nothing is nearer than the nearest candidate, the limit that is left, and what was
    /// measured: a triangle that overlaps is at once.
    pub(crate) fn nearest_with_lower_bound(
        &mut self,
        link: &PlacedLink,
        searched: &SearchLink<E>,
        best: Best,
        far: f64,
        start: [Option<u32>; 2],
    ) -> (Best, f64, Option<u32>) {
        let (limit, below) = (searched.axis_limit(far), best.triangle_limit());
        let mut target = Target { searched, limit, below, aim: Goal::Nearest(link, best) };
        self.search(&mut target, start);
        let mut least = (target.limit, None);
        for &(lower, triangle) in &self.stack.candidates {
            if lower < least.0 {
                least = (lower, Some(triangle));
            }
        }
        target.limit = target.limit.min(searched.axis_limit(best.bound()));
        self.settle(&mut target);
        let best = if let Goal::Nearest(_, best) = target.aim { best } else { best };
        let apart = searched.at_least(least.0.into());
        (best, best.nearest().map_or(apart, |nearest| apart.min(nearest.distance)), least.1)
    }

    /// A triangle nearly as near as the nearest, or any that overlaps the link.
    pub(crate) fn approximate_nearest(&mut self, searched: &SearchLink<E>) -> Option<u32> {
        let limit = searched.axis_limit(f64::INFINITY);
        let below = u32::MAX;
        let mut target =
            Target { searched, limit, below, aim: Goal::About(None, LEAVES_FOR_A_GUESS) };
        self.search(&mut target, [None; 2]);
        if let Goal::About(found, _) = target.aim { found } else { None }
    }

    /// Whether some triangle with a lower number than `below` may be at most `bound` from the link;
    /// false only if none is.
    pub(crate) fn may_meet(&mut self, searched: &SearchLink<E>, bound: f64, below: u32) -> bool {
        let limit = searched.axis_limit(bound);
        let mut target = Target { searched, limit, below, aim: Goal::Any(false) };
        self.search(&mut target, [None; 2]);
        matches!(target.aim, Goal::Any(true))
    }

    /// All triangles that may be at most `bound` from the link, in no order; false if they are more
    /// than `most`.
    pub(crate) fn gather(
        &mut self,
        searched: &SearchLink<E>,
        bound: f64,
        most: usize,
        found: &mut Vec<u32>,
    ) -> bool {
        let limit = searched.axis_limit(bound);
        let mut near = CappedGather { limit, most, found, is_overfull: false };
        dispatch!(self.level, simd => self.visit_leaves::<E::Pack<_>>(simd, searched, limit, &mut near));
        !near.is_overfull
    }

    /// Shows every leaf that may hold a triangle within the limit, in the order in which they come.
    #[inline(always)]
    pub(crate) fn visit_leaves<L: Pack<Element = E>>(
        &mut self,
        token: L::Token,
        searched: &SearchLink<E>,
        limit: E,
        visitor: &mut impl LeafVisitor<E>,
    ) {
        let lanes = LinkLanes::<L>::new(token, searched);
        let squared_limit = searched.squared_limit_of_bounds(limit);
        let waiting = &mut self.stack.nodes;
        waiting.clear();
        waiting.push(0);
        while let Some(node) = waiting.pop() {
            self.work.nodes += 1;
            let node = &self.tree.nodes[node as usize];
            let mut near = near_children(token, node, &lanes, searched, squared_limit).0;
            while near != 0 {
                let child = near.trailing_zeros() as usize;
                near &= near - 1;
                match Child::unpack(node.children[child]) {
                    Child::Node(node) => waiting.push(node),
                    Child::Leaf(leaf) => {
                        self.work.visited += BLOCK as u64;
                        visitor.visit(token, &lanes, self.tree, self.mesh, leaf);
                    }
                }
            }
        }
    }

    #[inline(never)] // compiled for each instruction set, not for each aim as well
    fn search(&mut self, target: &mut Target<E>, start: [Option<u32>; 2]) {
        dispatch!(self.level, simd => self.descend::<E::Pack<_>>(simd, target, start));
    }

    #[inline(always)]
    fn descend<L: Pack<Element = E>>(
        &mut self,
        token: L::Token,
        target: &mut Target<E>,
        start: [Option<u32>; 2],
    ) {
        let lanes = LinkLanes::<L>::new(token, target.searched);
        let zero = E::default();
        self.stack.candidates.clear();
        let mut start = [self.leaf_of(start[0]), self.leaf_of(start[1])];
        if start[0] == start[1] {
            start[1] = None;
        }
        self.stack.waiting.clear();
        self.stack.waiting.push((zero, Child::Node(0).pack()));
        // Below 0, to tell a leaf to start with from the same leaf met again.
        let first = zero - zero.one();
        self.stack
            .waiting
            .extend(start.iter().rev().flatten().map(|&leaf| (first, Child::Leaf(leaf).pack())));
        while let Some((squared, child)) = self.stack.waiting.pop() {
            if target.is_settled() {
                break;
            }
            if squared >= target.squared_limit_of_bounds() {
                continue;
            }
            match Child::unpack(child) {
                Child::Node(node) => self.visit_node(token, &lanes, node, target),
                Child::Leaf(leaf) if squared >= zero && start.contains(&Some(leaf)) => {}
                Child::Leaf(leaf) => self.visit_leaf(token, &lanes, leaf, target),
            }
        }
    }

    fn leaf_of(&self, triangle: Option<u32>) -> Option<u32> {
        self.tree.place_of.get(triangle? as usize).map(|place| place / BLOCK as u32)
    }

    /// Puts the children that may hold a nearer triangle on the stack, the nearest on top.
    #[inline(always)]
    fn visit_node<L: Pack<Element = E>>(
        &mut self,
        token: L::Token,
        lanes: &LinkLanes<L>,
        node: u32,
        target: &Target<E>,
    ) {
        self.work.nodes += 1;
        let node = &self.tree.nodes[node as usize];
        let squared_limit = target.squared_limit_of_bounds();
        let (mut near, bounds) = near_children(token, node, lanes, target.searched, squared_limit);
        let waiting = &mut self.stack.waiting;
        let bottom = waiting.len();
        while near != 0 {
            let child = near.trailing_zeros() as usize;
            near &= near - 1;
            if node.lowest[child] >= target.below {
                continue;
            }
            // Insertion keeps the few new entries in order.
            let entry = (bounds[child], node.children[child]);
            waiting.push(entry);
            let mut place = waiting.len() - 1;
            while place > bottom && waiting[place - 1].0 < entry.0 {
                waiting[place] = waiting[place - 1];
                place -= 1;
            }
            waiting[place] = entry;
        }
    }

    /// Makes candidates of the leaf's triangles that may be nearest.
    #[inline(always)]
    fn visit_leaf<L: Pack<Element = E>>(
        &mut self,
        token: L::Token,
        lanes: &LinkLanes<L>,
        leaf: u32,
        target: &mut Target<E>,
    ) {
        self.work.visited += BLOCK as u64;
        let leaf = &self.tree.leaves[leaf as usize];
        let (mut lower, mut upper) = ([E::default(); BLOCK], [E::default(); BLOCK]);
        let mut near = 0;
        let limit = L::splat(token, target.limit);
        for lane in (0..BLOCK).step_by(L::LANES) {
            let vertices = load_vertices::<L>(token, &leaf.rows, lane);
            if lanes.not_behind_plane(vertices, limit) == 0 {
                continue;
            }
            self.work.axis_distances += L::LANES as u64;
            let bounds = lanes.may_be_nearer(&Face::in_order(vertices), limit);
            bounds.lower.store(&mut lower[lane..]);
            bounds.upper.store(&mut upper[lane..]);
            near |= bounds.nearer << lane;
        }
        match &mut target.aim {
            Goal::Any(found) => {
                // A triangle whose number is too high does no harm.
                *found = near != 0;
                return;
            }
            Goal::About(_, leaves) => *leaves -= 1,
            Goal::Nearest(..) => {}
        }
        let (error, radius) = (target.searched.error, target.searched.radius);
        // The lowest of those that overlap for certain: of these no other is wanted.
        let mut overlapping = u32::MAX;
        while near != 0 {
            let lane = near.trailing_zeros() as usize;
            near &= near - 1;
            let triangle = leaf.triangles[lane];
            if lower[lane] >= target.limit || triangle >= target.below {
                continue;
            }
            if let Goal::About(found, _) = &mut target.aim {
                *found = Some(triangle);
                target.limit = upper[lane];
            } else if upper[lane] + error < radius {
                overlapping = overlapping.min(triangle);
            } else if self.stack.candidates.last().is_none_or(|last| last.1 != triangle) {
                // A leaf that is not full repeats its last triangle.
                self.stack.candidates.push((lower[lane], triangle));
                target.limit = target.limit.min(upper[lane] + error + error);
            }
        }
        if overlapping != u32::MAX {
            self.measure(target, overlapping);
        }
    }

    /// Measures the candidates that are still in question.
    fn settle(&mut self, target: &mut Target<E>) {
        self.drop_candidates(target);
        self.measure_candidates(target);
    }

    /// Drops the candidates that later ones have ruled out.
    fn drop_candidates(&mut self, target: &Target<E>) {
        self.stack
            .candidates
            .retain(|candidate| candidate.0 < target.limit && candidate.1 < target.below);
    }

    /// Measures the candidates, several at a time and first those that are likely to rule out
    /// others.
    #[inline(never)] // the same code whatever the instruction set
    fn measure_candidates(&mut self, target: &mut Target<E>) {
        let Goal::Nearest(link, best) = &mut target.aim else { return };
        let candidates = &mut self.stack.candidates;
        select_least(candidates, BATCH);
        let (mut limit, mut place) = (target.limit, 0);
        while place < candidates.len() {
            let (mut together, mut count) = ([0; BATCH], 0);
            while place < candidates.len() && count < BATCH {
                if candidates[place].0 < limit && candidates[place].1 < best.triangle_limit() {
                    together[count] = candidates[place].1;
                    count += 1;
                }
                place += 1;
            }
            self.work.measured += count as u64;
            if best.measure_batch(self.level, link, self.mesh, &together[..count]) {
                limit = limit.min(target.searched.axis_limit(best.bound()));
            }
        }
    }

    /// Measures one triangle in double precision.
    fn measure(&mut self, target: &mut Target<E>, triangle: u32) {
        let Goal::Nearest(link, best) = &mut target.aim else { return };
        self.work.measured += 1;
        if best.measure(link, triangle, self.mesh.corners(triangle)) {
            target.limit = target.limit.min(target.searched.axis_limit(best.bound()));
            target.below = best.triangle_limit();
        }
    }
}

/// Which children of a node have a squared bound below a limit, one bit each, and the squared
/// bounds.
#[inline(always)]
fn near_children<L: Pack>(
    token: L::Token,
    node: &Node<L::Element>,
    lanes: &LinkLanes<L>,
    searched: &SearchLink<L::Element>,
    squared_limit: L::Element,
) -> (u64, [L::Element; WIDTH])
where
    L::Element: Lane,
{
    let limit = L::splat(token, squared_limit);
    // A link that is shorter than the children does not pass beside them slantwise.
    let plane_tells = node.largest < searched.length;
    let mut bounds = [L::Element::default(); WIDTH];
    let mut near = 0;
    for lane in (0..WIDTH).step_by(L::LANES) {
        let squared = node.bounds::<L>(token, lane).squared_distances(lanes, plane_tells);
        squared.store(&mut bounds[lane..]);
        near |= L::bits(squared.lt(limit)) << lane;
    }
    (near & node.used(), bounds)
}
