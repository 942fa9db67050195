//! The nearest triangle of one link: nearer children first.
//!
//! All comparisons are in the precision of the search and of distances from the axis, the link's own distance and its
//! radius. Where no flat cap decides that is the axis distance F; beyond a flat cap it lies between two bounds. A
//! triangle whose upper bound was computed as u is nearer than u - r + e, with e the link's `error`; so another one can
//! only win if its own lower bound is below u + 2 e. Such candidates are put off: at the end the few that are left are
//! measured in double precision.

use super::build::WideBvh;
use super::node::{Child, WIDTH};
use crate::distance::Face;
use crate::distance::lanes::{Lane, Pack};
use crate::proximity::Work;
use crate::proximity::link_lanes::LinkLanes;
use crate::proximity::mesh::Mesh;
use crate::proximity::placed::{Best, PlacedLink};
use crate::proximity::search_frame::SearchLink;
use crate::proximity::triangle_block::{BLOCK, load_vertices};
use fearless_simd::{Level, dispatch};

/// Memory that is used again.
#[derive(Clone, Default)]
pub(super) struct Stack<E> {
    /// Children that wait for their turn, the nearest last.
    waiting: Vec<(E, u32)>,
    /// Triangles that may be the nearest, with their lower bounds.
    candidates: Vec<(E, u32)>,
}

/// A search through a mesh.
pub(super) struct Traversal<'a, E> {
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
    aim: Aim<'a>,
}

enum Aim<'a> {
    /// The nearest triangle of a link that improves on the best so far.
    Nearest(&'a PlacedLink, Best),
    /// Whether any triangle may be within the limit.
    Any(bool),
}

impl<E: Lane> Target<'_, E> {
    /// Whether nothing can change the answer any more.
    fn is_settled(&self) -> bool {
        match &self.aim {
            Aim::Nearest(_, best) => best.touches(),
            Aim::Any(found) => *found,
        }
    }
}

impl<E: Lane> Traversal<'_, E> {
    /// The triangle nearest to a link that improves on `best`. The leaves of the triangles to `start` with come first,
    /// for the bound they give.
    pub(super) fn nearest(
        &mut self,
        link: &PlacedLink,
        searched: &SearchLink<E>,
        best: Best,
        start: [Option<u32>; 2],
    ) -> Best {
        let limit = searched.axis_limit(best.bound());
        let mut target = Target { searched, limit, aim: Aim::Nearest(link, best) };
        dispatch!(self.level, simd => self.descend::<E::Pack<_>>(simd, &mut target, start));
        self.settle(&mut target);
        if let Aim::Nearest(_, best) = target.aim { best } else { best }
    }

    /// Whether some triangle may be at most `bound` from the link; false only if none is.
    pub(super) fn may_meet(&mut self, searched: &SearchLink<E>, bound: f64) -> bool {
        let mut target = Target { searched, limit: searched.axis_limit(bound), aim: Aim::Any(false) };
        dispatch!(self.level, simd => self.descend::<E::Pack<_>>(simd, &mut target, [None; 2]));
        target.is_settled()
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
            if squared >= target.limit * target.limit {
                continue;
            }
            match Child::unpack(child) {
                Child::Node(node) => self.visit_node(token, &lanes, node, target.limit),
                Child::Leaf(leaf) if squared >= zero && start.contains(&Some(leaf)) => {}
                Child::Leaf(leaf) => self.visit_leaf(token, &lanes, leaf, target),
            }
        }
    }

    fn leaf_of(&self, triangle: Option<u32>) -> Option<u32> {
        self.tree.leaf_of.get(triangle? as usize).copied()
    }

    /// Puts the children that may hold a nearer triangle on the stack, the nearest on top.
    #[inline(always)]
    fn visit_node<L: Pack<Element = E>>(
        &mut self,
        token: L::Token,
        lanes: &LinkLanes<L>,
        node: u32,
        limit: E,
    ) {
        self.work.nodes += 1;
        let node = &self.tree.nodes[node as usize];
        let limit = L::splat(token, limit * limit);
        let mut bounds = [E::default(); WIDTH];
        let mut near = 0;
        for lane in (0..WIDTH).step_by(L::LANES) {
            let squared = node.bounds::<L>(token, lane).squared_distances(lanes);
            squared.store(&mut bounds[lane..]);
            near |= L::bits(squared.lt(limit)) << lane;
        }
        let waiting = &mut self.stack.waiting;
        let bottom = waiting.len();
        while near != 0 {
            let child = near.trailing_zeros() as usize;
            near &= near - 1;
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
            let bounds = lanes.may_be_nearer(&Face::new(vertices), limit);
            bounds.lower.store(&mut lower[lane..]);
            bounds.upper.store(&mut upper[lane..]);
            near |= bounds.nearer << lane;
        }
        if let Aim::Any(found) = &mut target.aim {
            *found = near != 0;
            return;
        }
        let (error, radius) = (target.searched.error, target.searched.radius);
        while near != 0 {
            let lane = near.trailing_zeros() as usize;
            near &= near - 1;
            if lower[lane] >= target.limit {
                continue;
            }
            if upper[lane] + error < radius {
                // They overlap: the distance is 0, and the search is at its end.
                self.measure(target, leaf.triangles[lane]);
            } else {
                self.stack.candidates.push((lower[lane], leaf.triangles[lane]));
                target.limit = target.limit.min(upper[lane] + error + error);
            }
        }
    }

    /// Measures the candidates that are still in question, the nearest first.
    #[inline(never)] // the same code whatever the instruction set
    fn settle(&mut self, target: &mut Target<E>) {
        let mut candidates = std::mem::take(&mut self.stack.candidates);
        candidates.retain(|candidate| candidate.0 < target.limit);
        let lower = |candidate: &(E, u32)| -> f64 { candidate.0.into() };
        candidates.sort_unstable_by(|a, b| lower(a).total_cmp(&lower(b)));
        // A leaf that is not full repeats its last triangle.
        candidates.dedup_by_key(|candidate| candidate.1);
        for &(distance, triangle) in &candidates {
            if distance >= target.limit || target.is_settled() {
                break;
            }
            self.measure(target, triangle);
        }
        self.stack.candidates = candidates;
    }

    /// Measures one triangle in double precision.
    fn measure(&mut self, target: &mut Target<E>, triangle: u32) {
        let Aim::Nearest(link, best) = &mut target.aim else { return };
        self.work.measured += 1;
        if best.measure(link, triangle, self.mesh.corners(triangle)) {
            target.limit = target.limit.min(target.searched.axis_limit(best.bound()));
        }
    }
}
