//! Traversal of the hierarchy for one link: the nearest triangle, a guess at it, or all within a
//! bound.
//!
//! The nearest triangle is searched nearest child first. For all triangles within a bound the order
//! does not matter.
//!
//! # Definitions
//! - F: the axis distance of a triangle from the link; r: the radius; e: the link's `error`.
//! - `lower`, `upper`: the computed bounds of a triangle. Both are F, unless a flat cap decides.
//!   The distance d of the triangle satisfies `lower - r - e < d < upper - r + e`; if the right
//!   side is not positive, d is 0.
//! - `limit`: an axis distance; no triangle with `lower >= limit` is wanted. It never grows.
//! - `triangle_limit`: no triangle with this number or a higher one can win.
//!
//! All comparisons are in the precision of the search.
//!
//! # Algorithm
//! 1. Push the root, and on top of it the leaves of the start triangles.
//! 2. **Node.** Push the children whose bound is below `limit`, the nearest on top.
//! 3. **Leaf.** A triangle with `lower < limit` becomes a candidate: `limit` falls to `upper + 2 e`
//!    at most. A triangle that certainly overlaps (`upper + e < r`) is measured at once. Then
//!    `limit` falls to that of distance 0, and only lower triangles are wanted.
//! 4. **Settle.** Measure the candidates with `lower < limit` in double precision, least bounds
//!    first.
//!
//! # Correctness
//! **Claim.** The answer is the least (distance, triangle) within the bound, for every start.
//!
//! **Proof.** A triangle that does not certainly overlap has `upper' + e >= r`, so its distance is
//! `d' <= upper' - r + e`. Let another triangle have `lower >= upper' + 2 e`. Then `d > lower - r -
//! e >= upper' - r + e >= d'`. So such a triangle is strictly farther, and all ties are measured. A
//! triangle at the initial `limit` or beyond is farther than the bound. A triangle numbered
//! `triangle_limit` or higher loses the tie at distance 0. A node's bound is compared
//! conservatively: see [`SearchLink::limit_of_bounds`].

use super::build::WideBvh;
use super::node::{Child, Node, WIDTH};
use crate::answer::Work;
use crate::distance::lanes::{Lane, Pack};
use crate::distance::{Face, dispatch};
use crate::mesh::{BLOCK, Mesh, load_vertices};
use crate::pair::{BATCH, Best, LinkLanes, PlacedLink, SearchLink};
use fearless_simd::Level;

/// Leaves that a guess at the nearest triangle visits. Where more triangles are about as near, any
/// of them serves.
const LEAVES_FOR_A_GUESS: u32 = 8;

/// Up to this many candidates share their packs with other links. Measured: more candidates fill
/// packs of their own well enough.
const FEW: usize = BATCH / 2;

/// Stacks of a traversal, reused by later queries.
#[derive(Clone, Default)]
pub(crate) struct Stack<E> {
    /// Children to visit with their squared bounds, the nearest last.
    waiting: Vec<(E, u32)>,
    /// Nodes to visit where the order does not matter.
    nodes: Vec<u32>,
    /// Candidates for the nearest triangle, with their lower bounds.
    candidates: Vec<(E, u32)>,
}

/// A search through a mesh at rest.
pub(crate) struct Traversal<'a, E> {
    pub level: Level,
    pub mesh: &'a Mesh,
    pub tree: &'a WideBvh<E>,
    pub stack: &'a mut Stack<E>,
    pub work: &'a mut Work,
}

/// What a search wants.
struct Target<'a, E> {
    searched: &'a SearchLink<E>,
    /// A wanted triangle has an axis distance below this.
    limit: E,
    /// A wanted triangle has a number below this.
    triangle_limit: u32,
    goal: Goal<'a>,
}

enum Goal<'a> {
    /// The nearest triangle of a link, if it improves on the best so far.
    Nearest(&'a PlacedLink, Best),
    /// A triangle about nearest, and how many leaves may still be visited.
    Guess(Option<u32>, u32),
    /// Whether any triangle may be within the limit.
    Any(bool),
}

impl<E: Lane> Target<'_, E> {
    /// A child whose squared bound is not below this holds no triangle within the limit.
    #[inline(always)]
    fn squared_limit_of_bounds(&self) -> E {
        self.searched.squared_limit_of_bounds(self.limit)
    }

    /// Returns true if nothing can change the answer any more.
    fn is_settled(&self) -> bool {
        match &self.goal {
            Goal::Nearest(..) => self.triangle_limit == 0,
            // Even a triangle that meets the axis leaves a limit: three errors of the bounds.
            Goal::Guess(_, leaves) => *leaves == 0,
            Goal::Any(found) => *found,
        }
    }
}

impl<E: Lane> Traversal<'_, E> {
    /// Returns the nearest triangle of a link, or `best` if no triangle improves on it. The leaves
    /// of the `start` triangles are visited first, because their distances lower the limit.
    pub(crate) fn nearest(
        &mut self,
        link: &PlacedLink,
        searched: &SearchLink<E>,
        best: Best,
        start: [Option<u32>; 2],
    ) -> Best {
        let limit = searched.axis_limit(best.bound());
        let triangle_limit = best.triangle_limit();
        let mut target =
            Target { searched, limit, triangle_limit, goal: Goal::Nearest(link, best) };
        self.search(&mut target, start);
        self.settle(&mut target);
        if let Goal::Nearest(_, best) = target.goal { best } else { best }
    }

    /// Returns the nearest triangle at any distance, if a triangle overlaps or many candidates
    /// remain.
    ///
    /// Otherwise returns none and adds the candidates to `few`, unmeasured, the least bound first.
    /// Their caller measures them in a pack with the candidates of other links.
    pub(crate) fn nearest_or_candidates(
        &mut self,
        link: &PlacedLink,
        searched: &SearchLink<E>,
        start: [Option<u32>; 2],
        few: &mut Vec<u32>,
    ) -> Option<Best> {
        let (limit, best) = (searched.axis_limit(f64::INFINITY), Best::within(f64::INFINITY));
        let mut target =
            Target { searched, limit, triangle_limit: u32::MAX, goal: Goal::Nearest(link, best) };
        self.search(&mut target, start);
        self.drop_candidates(&target);
        let candidates = &mut self.stack.candidates;
        if matches!(target.goal, Goal::Nearest(_, best) if best.nearest().is_none())
            && (1..=FEW).contains(&candidates.len())
        {
            select_least(candidates, 1);
            few.extend(candidates.iter().map(|candidate| candidate.1));
            return None;
        }
        self.measure_candidates(&mut target);
        if let Goal::Nearest(_, best) = target.goal { Some(best) } else { None }
    }

    /// Returns the nearest triangle as [`Traversal::nearest`] does, and a lower bound on the
    /// distance of all triangles. Also returns a triangle at about that bound, if one was met.
    ///
    /// No triangle farther than `far` is searched; `far` is at least the bound of `best`.
    ///
    /// **Proof of the lower bound.** A pruned triangle had a lower bound of at least `limit` at
    /// that time. The final `limit` is not larger. The other triangles are candidates, or were
    /// measured, or have the number `below` or a higher one. The last happens only once a triangle
    /// overlaps, at distance 0. So no triangle is nearer than the least of three: the final
    /// `limit`, the candidates' bounds and the measured distance.
    pub(crate) fn nearest_with_lower_bound(
        &mut self,
        link: &PlacedLink,
        searched: &SearchLink<E>,
        best: Best,
        far: f64,
        start: [Option<u32>; 2],
    ) -> (Best, f64, Option<u32>) {
        let (limit, triangle_limit) = (searched.axis_limit(far), best.triangle_limit());
        let mut target =
            Target { searched, limit, triangle_limit, goal: Goal::Nearest(link, best) };
        self.search(&mut target, start);
        let mut least = (target.limit, None);
        for &(lower, triangle) in &self.stack.candidates {
            if lower < least.0 {
                least = (lower, Some(triangle));
            }
        }
        target.limit = target.limit.min(searched.axis_limit(best.bound()));
        self.settle(&mut target);
        let best = if let Goal::Nearest(_, best) = target.goal { best } else { best };
        let at_least = searched.at_least(least.0.into());
        let lower = best.nearest().map_or(at_least, |nearest| at_least.min(nearest.distance));
        (best, lower, least.1)
    }

    /// Returns a triangle about as near as the nearest, or any that overlaps the link.
    pub(crate) fn search_guess(&mut self, searched: &SearchLink<E>) -> Option<u32> {
        let limit = searched.axis_limit(f64::INFINITY);
        let triangle_limit = u32::MAX;
        let mut target =
            Target { searched, limit, triangle_limit, goal: Goal::Guess(None, LEAVES_FOR_A_GUESS) };
        self.search(&mut target, [None; 2]);
        if let Goal::Guess(found, _) = target.goal { found } else { None }
    }

    /// Returns true if a triangle with a number less than `triangle_limit` may be at most `bound`
    /// from the link. False is a proof, true is not: leaves do not compare the numbers.
    pub(crate) fn may_meet(
        &mut self,
        searched: &SearchLink<E>,
        bound: f64,
        triangle_limit: u32,
    ) -> bool {
        let limit = searched.axis_limit(bound);
        let mut target = Target { searched, limit, triangle_limit, goal: Goal::Any(false) };
        self.search(&mut target, [None; 2]);
        matches!(target.goal, Goal::Any(true))
    }

    /// Calls `visitor` for every leaf that may hold a triangle within the limit, in the order of
    /// the traversal.
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
            let mut within = children_within(token, node, &lanes, searched, squared_limit).0;
            while within != 0 {
                let child = within.trailing_zeros() as usize;
                within &= within - 1;
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

    #[inline(never)] // compiled once per instruction set, not per goal
    fn search(&mut self, target: &mut Target<E>, start: [Option<u32>; 2]) {
        dispatch!(E::WIDEST_SEARCH, self.level, simd => self.descend::<E::Pack<_>>(simd, target, start));
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
        // Marks the start leaves with a negative bound, so that they are skipped when met again.
        let start_mark = zero - zero.one();
        self.stack.waiting.extend(
            start.iter().rev().flatten().map(|&leaf| (start_mark, Child::Leaf(leaf).pack())),
        );
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

    /// Pushes the children that may hold a nearer triangle, the nearest on top (step 2).
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
        let (mut within, bounds) =
            children_within(token, node, lanes, target.searched, squared_limit);
        let waiting = &mut self.stack.waiting;
        let bottom = waiting.len();
        while within != 0 {
            let child = within.trailing_zeros() as usize;
            within &= within - 1;
            if node.lowest[child] >= target.triangle_limit {
                continue;
            }
            // Insertion sort: there are few new entries.
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

    /// Adds the triangles of a leaf that may be nearest to the candidates (step 3).
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
        let mut nearer = 0;
        let limit = L::splat(token, target.limit);
        for lane in (0..BLOCK).step_by(L::LANES) {
            let vertices = load_vertices::<L>(token, &leaf.rows, lane);
            if lanes.not_excluded_by_plane(vertices, limit) == 0 {
                continue;
            }
            self.work.axis_distances += L::LANES as u64;
            let bounds = lanes.may_be_nearer(&Face::in_order(vertices), limit);
            bounds.lower.store(&mut lower[lane..]);
            bounds.upper.store(&mut upper[lane..]);
            nearer |= bounds.nearer << lane;
        }
        match &mut target.goal {
            Goal::Any(found) => {
                // `triangle_limit` is ignored here.
                *found = nearer != 0;
                return;
            }
            Goal::Guess(_, leaves) => *leaves -= 1,
            Goal::Nearest(..) => {}
        }
        let (error, radius) = (target.searched.error, target.searched.radius);
        // The lowest triangle that certainly overlaps: no higher one is wanted.
        let mut overlapping = u32::MAX;
        while nearer != 0 {
            let lane = nearer.trailing_zeros() as usize;
            nearer &= nearer - 1;
            let triangle = leaf.triangles[lane];
            if lower[lane] >= target.limit || triangle >= target.triangle_limit {
                continue;
            }
            if let Goal::Guess(found, _) = &mut target.goal {
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

    /// Measures the candidates that are still within the limit (step 4).
    fn settle(&mut self, target: &mut Target<E>) {
        self.drop_candidates(target);
        self.measure_candidates(target);
    }

    /// Drops the candidates that later ones have excluded.
    fn drop_candidates(&mut self, target: &Target<E>) {
        self.stack
            .candidates
            .retain(|candidate| candidate.0 < target.limit && candidate.1 < target.triangle_limit);
    }

    /// Measures the candidates in batches. Those with the least bounds come first, because they
    /// most probably exclude others.
    #[inline(never)] // the same code on every instruction set
    fn measure_candidates(&mut self, target: &mut Target<E>) {
        let Goal::Nearest(link, best) = &mut target.goal else { return };
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
        let Goal::Nearest(link, best) = &mut target.goal else { return };
        self.work.measured += 1;
        if best.measure(link, triangle, self.mesh.corners(triangle)) {
            target.limit = target.limit.min(target.searched.axis_limit(best.bound()));
            target.triangle_limit = best.triangle_limit();
        }
    }
}

/// Returns the children of a node whose squared bound is below a limit, one bit each, and the
/// squared bounds.
#[inline(always)]
fn children_within<L: Pack>(
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
    // The plane test gains nothing for a link that is shorter than the children.
    let plane_may_exclude = node.largest < searched.length;
    let mut bounds = [L::Element::default(); WIDTH];
    let mut within = 0;
    for lane in (0..WIDTH).step_by(L::LANES) {
        let squared = node.bounds::<L>(token, lane).squared_distances(lanes, plane_may_exclude);
        squared.store(&mut bounds[lane..]);
        within |= L::bits(squared.lt(limit)) << lane;
    }
    (within & node.used(), bounds)
}

/// Moves the candidates with the least bounds to the first `count` places.
///
/// The others keep their places, except where they make room. They are in the order of the leaves,
/// so triangles that are near each other are often near in memory too.
fn select_least<E: Copy + PartialOrd>(candidates: &mut [(E, u32)], count: usize) {
    let Some((first, others)) = candidates.split_at_mut_checked(count) else { return };
    let mut farthest = farthest_of(first);
    for other in others {
        if first.get(farthest).is_some_and(|first| other.0 < first.0) {
            std::mem::swap(&mut first[farthest], other);
            farthest = farthest_of(first);
        }
    }
}

fn farthest_of<E: PartialOrd>(candidates: &[(E, u32)]) -> usize {
    (1..candidates.len())
        .fold(0, |far, place| if candidates[far].0 < candidates[place].0 { place } else { far })
}

/// Receives the leaves of a [`Traversal`](super::Traversal), one after another.
///
/// A closure would be too slow: it is not inlined into the loop for each instruction set, so every
/// operation on a pack would be a function call.
pub(crate) trait LeafVisitor<E: Lane> {
    /// Processes one leaf. Implementations must be `#[inline(always)]`.
    fn visit<L: Pack<Element = E>>(
        &mut self,
        token: L::Token,
        lanes: &LinkLanes<L>,
        tree: &WideBvh<E>,
        mesh: &Mesh,
        leaf: u32,
    );
}

#[cfg(test)]
mod tests {
    use super::*;
    use continuum_testing::Random;

    #[test]
    fn the_least_come_first_and_the_others_stay() {
        let random = &mut Random::new(5);
        let mut moved = 0;
        for _ in 0..1000 {
            // Many bounds are equal; each triangle occurs once.
            let length = random.below(40);
            let before: Vec<_> = (0..length).map(|triangle| (random.below(12), triangle)).collect();
            let count = random.below(10) as usize;
            let mut after = before.clone();
            select_least(&mut after, count);
            let (mut sorted, mut kept) = (before.clone(), after.clone());
            sorted.sort_unstable();
            kept.sort_unstable();
            assert_eq!(kept, sorted);
            if let Some((first, others)) = after.split_at_checked(count) {
                let largest = first.iter().map(|candidate| candidate.0).max();
                assert!(
                    others
                        .iter()
                        .all(|candidate| largest.is_none_or(|largest| largest <= candidate.0))
                );
                let strays =
                    after.iter().zip(&before).skip(count).filter(|(after, before)| after != before);
                // Each candidate that moved to the front swapped places with another.
                let came = first.iter().filter(|candidate| candidate.1 as usize >= count).count();
                assert!(strays.clone().count() >= came);
                moved += came;
            }
        }
        assert!(moved > 1000, "{moved}");
    }
}
