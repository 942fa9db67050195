//! Whether a robot keeps away from the mesh: its links and the triangles are parted together.
//!
//! A pair is a run of links, or one link, and a part of the mesh. A pair whose capsule and bound
//! keep apart is done with. Of any other the larger is parted, and each half meets the other. So
//! what a run of links is far from is never looked at again for one of its links. The first link
//! and triangle that are near enough for certain end the search: those whose distance in the
//! precision of the search is below the margin by more than rounding can do. Those of which it
//! cannot decide are measured in double precision.

use crate::answer::Work;
use crate::distance::lanes::{Lane, Pack};
use crate::distance::{Face, dispatch};
use crate::mesh::{BLOCK, Mesh, load_vertices};
use crate::pair::{BATCH, Best, LinkLanes, PlacedRobot, SearchLink};
use crate::robot::{LinkNode, place_of_leaf};
use crate::search::hierarchy::{Child, WIDTH, WideBvh};
use fearless_simd::Level;
use parry3d_f64::math::Real;

/// A run is parted before it meets a node this many times smaller, or a leaf. Measured: a run that
/// is parted late meets more of the mesh, one that is parted early meets it more often.
const NODE_SHARE: f64 = 1.0;
const LEAF_SHARE: f64 = 3.0;

/// The root of the hierarchy.
const WHOLE_MESH: u32 = Child::Node(0).pack();

/// Memory that is used again.
#[derive(Clone, Default)]
pub(crate) struct PairStack<E> {
    /// The nodes of the link tree in the frame of the search, those that this query has placed.
    runs: Vec<PlacedNode<E>>,
    query: u64,
    waiting: Vec<NodePair<E>>,
    /// The links and triangles that the precision of the search cannot decide.
    doubtful: Vec<(u32, u32)>,
    /// The link and the leaf of the last triangle that was near enough.
    last: Option<(u32, u32)>,
    /// Whether this query had to look at less than all links together.
    has_parted_all: bool,
}

impl<E> PairStack<E> {
    /// Whether, if all links keep away, the capsule around them is known to do so too.
    pub(crate) fn clears_capsule(&self) -> bool {
        !self.has_parted_all
    }

    pub(crate) fn forget(&mut self) {
        self.last = None;
    }
}

/// A node of the link tree in the frame of the search.
#[derive(Clone, Default)]
struct PlacedNode<E> {
    /// The query that placed it.
    query: u64,
    searched: SearchLink<E>,
    /// How long it is, tips included.
    size: E,
    /// What an axis distance must be below to be possibly within the margin.
    limit: E,
    /// What it must be below to be so for certain.
    certain: E,
}

/// A run of links and a part of the mesh that may be near each other.
#[derive(Clone, Copy)]
struct NodePair<E> {
    /// The run's place in the link tree.
    run: u32,
    child: u32,
    /// How large the part of the mesh is.
    size: E,
    /// How far its centre is from the run's axis, squared.
    apart: E,
}

/// What the precision of the search can decide.
enum SearchOutcome {
    /// Nothing is within the margin, unless it is doubtful.
    Doubtful,
    /// Some triangle is within the margin.
    Near,
    /// It does not resolve the robot.
    Unresolved,
}

/// A search for anything at most `margin` from a robot.
pub(crate) struct DualTraversal<'a, E> {
    pub level: Level,
    pub tree: &'a WideBvh<E>,
    pub robot: PlacedRobot<'a>,
    pub margin: Real,
    /// The link that is likely to meet the mesh, if one is.
    pub first: Option<usize>,
    pub pairs: &'a mut PairStack<E>,
    pub work: &'a mut Work,
}

impl<E: Lane> DualTraversal<'_, E> {
    /// Whether every link keeps more than the margin away; None where the precision of the search
    /// does not resolve the robot.
    pub(crate) fn clears_all(mut self, mesh: &Mesh) -> Option<bool> {
        match self.search() {
            SearchOutcome::Unresolved => None,
            SearchOutcome::Near => Some(false),
            SearchOutcome::Doubtful => {
                let Self { level, robot, margin, pairs, work, .. } = self;
                let is_within = |pairs: &[(u32, u32)]| {
                    let (mut together, link) = ([0; BATCH], robot.link(pairs[0].0 as usize));
                    together.iter_mut().zip(pairs).for_each(|(triangle, pair)| *triangle = pair.1);
                    work.measured += pairs.len() as u64;
                    Best::within(margin).measure_batch(level, &link, mesh, &together[..pairs.len()])
                };
                let of_one_link = pairs.doubtful.chunk_by(|one, other| one.0 == other.0);
                Some(!of_one_link.flat_map(|pairs| pairs.chunks(BATCH)).any(is_within))
            }
        }
    }

    fn search(&mut self) -> SearchOutcome {
        let PairStack { runs, query, waiting, doubtful, last, has_parted_all } = &mut *self.pairs;
        let links = self.robot.link_tree();
        let zero = E::default();
        *query += 1;
        if runs.len() < links.len() {
            runs.resize_with(links.len(), PlacedNode::default);
        }
        *has_parted_all = matches!(links[0], LinkNode::Leaf(_));
        doubtful.clear();
        waiting.clear();
        // The mesh is between one and two long.
        let whole = NodePair { run: 0, child: WHOLE_MESH, size: zero.one(), apart: zero };
        waiting.push(whole);
        if let Some(first) = self.first {
            waiting.push(NodePair {
                run: place_of_leaf(first, links.len().div_ceil(2)) as u32,
                ..whole
            });
        }
        if let Some((run, leaf)) = *last
            && let Some(LinkNode::Leaf(_)) = links.get(run as usize)
        {
            waiting.push(NodePair {
                run,
                child: Child::Leaf(leaf).pack(),
                size: zero,
                apart: zero,
            });
        }
        dispatch!(self.level, simd => self.descend::<E::Pack<_>>(simd))
    }

    #[inline(always)]
    fn descend<L: Pack<Element = E>>(&mut self, token: L::Token) -> SearchOutcome {
        while let Some(pair) = self.pairs.waiting.pop() {
            if self.pairs.runs[pair.run as usize].query != self.pairs.query
                && self.place(pair.run).is_none()
            {
                return SearchOutcome::Unresolved;
            }
            let size = self.pairs.runs[pair.run as usize].size;
            match Child::unpack(pair.child) {
                Child::Node(node) => {
                    if !(pair.size.lit(NODE_SHARE) * pair.size < size && self.split_links(pair)) {
                        self.visit_node::<L>(token, node, pair.run);
                    }
                }
                Child::Leaf(leaf) => {
                    if !(pair.size.lit(LEAF_SHARE) * pair.size < size && self.split_links(pair))
                        && self.visit_leaf::<L>(token, leaf, pair)
                    {
                        self.pairs.last = Some((pair.run, leaf));
                        return SearchOutcome::Near;
                    }
                }
            }
        }
        SearchOutcome::Doubtful
    }

    /// Brings a node of the link tree into the frame of the search. None where the precision does
    /// not resolve it.
    #[inline(never)] // not compiled anew for each instruction set
    fn place(&mut self, place: u32) -> Option<()> {
        let (ends, radius, flat) = self.robot.outline(&self.robot.link_tree()[place as usize]);
        let frame = &self.tree.frame;
        let searched = SearchLink::between(ends, radius, flat, frame)
            .filter(|link| link.is_resolved(frame))?;
        self.pairs.runs[place as usize] = PlacedNode {
            query: self.pairs.query,
            size: searched.length + searched.radius + searched.radius,
            limit: searched.axis_limit(self.margin),
            certain: searched.certain_limit(self.margin),
            searched,
        };
        Some(())
    }

    /// Puts both halves of a pair's run in its place; false if it is one link.
    #[inline(always)]
    fn split_links(&mut self, pair: NodePair<E>) -> bool {
        let tree = self.robot.link_tree();
        if let LinkNode::Leaf(_) = tree[pair.run as usize] {
            return false;
        }
        self.pairs.has_parted_all |= pair.run == 0;
        let low = pair.run + 1;
        let below =
            if let LinkNode::Inner { below, .. } = tree[low as usize] { below as u32 } else { 0 };
        let high = low + 1 + below;
        // Whatever collides has most often got there with its tip; near a part of the mesh no half
        // is the likelier one.
        let last_and_first = if pair.child == WHOLE_MESH { [low, high] } else { [high, low] };
        self.pairs.waiting.extend(last_and_first.map(|run| NodePair { run, ..pair }));
        true
    }

    /// Pairs a run with those children of a node that it may be near, the one with the nearest
    /// centre on top.
    #[inline(always)]
    fn visit_node<L: Pack<Element = E>>(&mut self, token: L::Token, node: u32, run: u32) {
        self.work.nodes += 1;
        let node = &self.tree.nodes[node as usize];
        let PairStack { runs, waiting, .. } = &mut *self.pairs;
        let placed = &runs[run as usize];
        let lanes = LinkLanes::<L>::new(token, &placed.searched);
        let limit = L::splat(token, placed.searched.limit_of_bounds(placed.limit));
        let mut apart = [E::default(); WIDTH];
        let mut near = 0;
        for lane in (0..WIDTH).step_by(L::LANES) {
            let (may_meet, squared) = node.bounds::<L>(token, lane).may_meet(&lanes, limit);
            squared.store(&mut apart[lane..]);
            near |= may_meet << lane;
        }
        near &= node.used();
        let bottom = waiting.len();
        while near != 0 {
            let child = near.trailing_zeros() as usize;
            near &= near - 1;
            let pair = NodePair {
                run,
                child: node.children[child],
                size: node.size(child),
                apart: apart[child],
            };
            // Insertion keeps the few new pairs in order.
            waiting.push(pair);
            let mut place = waiting.len() - 1;
            while place > bottom && waiting[place - 1].apart < pair.apart {
                waiting[place] = waiting[place - 1];
                place -= 1;
            }
            waiting[place] = pair;
        }
    }

    /// Whether a triangle of a leaf is within the margin of a link for certain. A run is parted,
    /// unless it is too far from all of them: from their planes, and if it is no longer than
    /// the leaf, from the triangles themselves. (A long one is about as wide as the triangles
    /// are large, so that their planes tell as much.)
    #[inline(always)]
    fn visit_leaf<L: Pack<Element = E>>(
        &mut self,
        token: L::Token,
        leaf: u32,
        pair: NodePair<E>,
    ) -> bool {
        self.work.visited += BLOCK as u64;
        let leaf = &self.tree.leaves[leaf as usize];
        let placed = &self.pairs.runs[pair.run as usize];
        let lanes = LinkLanes::<L>::new(token, &placed.searched);
        let (limit, certain) = (L::splat(token, placed.limit), L::splat(token, placed.certain));
        let link = match self.robot.link_tree()[pair.run as usize] {
            LinkNode::Leaf(link) => Some(link),
            LinkNode::Inner { .. } => None,
        };
        let is_long = link.is_none() && pair.size <= placed.size;
        for lane in (0..BLOCK).step_by(L::LANES) {
            let vertices = load_vertices::<L>(token, &leaf.rows, lane);
            if link.is_some() && lanes.has_centre_within(vertices, certain) {
                return true;
            }
            if lanes.not_behind_plane(vertices, limit) == 0 {
                continue;
            }
            if is_long {
                self.split_links(pair);
                return false;
            }
            self.work.axis_distances += L::LANES as u64;
            let bounds = lanes.may_be_nearer(&Face::in_order(vertices), limit);
            let Some(link) = link else {
                if bounds.nearer != 0 {
                    self.split_links(pair);
                    return false;
                }
                continue;
            };
            if L::bits(bounds.upper.lt(certain)) != 0 {
                return true;
            }
            let mut near = bounds.nearer;
            while near != 0 {
                let triangle = leaf.triangles[lane + near.trailing_zeros() as usize];
                near &= near - 1;
                let pair = (link as u32, triangle);
                // A leaf that is not full repeats its last triangle.
                if self.pairs.doubtful.last() != Some(&pair) {
                    self.pairs.doubtful.push(pair);
                }
            }
        }
        false
    }
}
