//! Decides whether a robot keeps a margin.
//!
//! # The query
//! 1. **Reuse.** If every lower bound of the last query, less the displacement since, exceeds the
//!    margin: true.
//! 2. **Look ahead.** If it pays, search with `margin + look_ahead`. A robot that clears that
//!    radius yields lower bounds for later queries.
//! 3. **Search** with the margin itself. The first pair is the link that probably passes through
//!    the wall, if the side grid finds one.
//!
//! Each search runs in single precision, or in double precision if single does not resolve the
//! robot, or else link by link. The answer is the same.
//!
//! # The search: a dual traversal of the link tree and the mesh
//! **Definitions.**
//! - *run*: a node of the link tree, with the capsule around its links; a leaf is one link.
//! - *pair*: a run and a child of the mesh hierarchy.
//! - `limit`, `certain`: an axis distance below `limit` is possibly within the margin; one below
//!   `certain` is within it beyond rounding.
//!
//! **Algorithm** ([`DualTraversal`]).
//! 1. Pop a pair. If the run is larger than the child, replace the pair by the two halves of the
//!    run. So a run that is far from a part of the mesh prunes all its links at once.
//! 2. Otherwise visit the node: push a pair for each of its children that may be within `limit`.
//! 3. Otherwise visit the leaf. A run of several links is split if a triangle may be within
//!    `limit`. A single link ends the search if a triangle is within `certain`. A triangle between
//!    `certain` and `limit` makes a *doubtful* pair.
//! 4. At the end, measure the doubtful pairs in double precision.

use super::link_lower_bounds::{ClearedBy, LinkLowerBounds};
use super::side_grid::SideGrid;
use crate::answer::Work;
use crate::distance::lanes::{Lane, Pack};
use crate::distance::{Face, dispatch};
use crate::mesh::{BLOCK, Mesh, load_vertices};
use crate::pair::{BATCH, Best, LinkLanes, PlacedRobot, SearchLink};
use crate::robot::{LinkNode, place_of_leaf};
use crate::search::hierarchy::{Child, MeshSearch, Scratch, WIDTH, WideBvh};
use fearless_simd::Level;
use parry3d_f64::math::Real;

/// State that warm-starts the next query.
#[derive(Clone, Default)]
pub(crate) struct ClearsMemory {
    single: PairStack<f32>,
    double: PairStack<f64>,
    lower_bounds: LinkLowerBounds,
}

impl ClearsMemory {
    pub(crate) fn forget(&mut self) {
        self.single.forget();
        self.double.forget();
        self.forget_distances();
    }

    /// Forgets the lower bounds, which hold only while the mesh is at rest.
    pub(crate) fn forget_distances(&mut self) {
        self.lower_bounds.forget();
    }
}

/// A search for any triangle at most a margin from a robot.
pub(crate) struct ClearsSearch<'a> {
    pub search: MeshSearch<'a>,
    /// Predicts which link passes through the wall, so that this link is searched first.
    pub sides: Option<&'a SideGrid>,
    pub robot: PlacedRobot<'a>,
    pub memory: &'a mut ClearsMemory,
}

impl ClearsSearch<'_> {
    /// Returns true if every link is farther than `margin` from the mesh.
    pub(crate) fn clears(&mut self, margin: Real) -> bool {
        let (robot, mesh_reach) = (self.robot, self.search.hierarchy.mesh_reach);
        if self.memory.lower_bounds.all_exceed(robot, margin) {
            return true;
        }
        if let Some(wider) =
            self.memory.lower_bounds.choose_look_ahead(robot, margin, Real::INFINITY, mesh_reach)
        {
            if let Some(known) = self.cleared_by(margin + wider) {
                self.memory.lower_bounds.set_all(robot, margin + wider, known, mesh_reach);
                return true;
            }
            self.memory.lower_bounds.record_miss();
        }
        self.cleared_by(margin).is_some()
    }

    /// Returns which part of the robot is proven farther than `margin` from the mesh. None if some
    /// link is not.
    pub(crate) fn cleared_by(&mut self, margin: Real) -> Option<ClearedBy> {
        let robot = self.robot;
        let MeshSearch { level, hierarchy, scratch, .. } = &mut self.search;
        let (level, mesh) = (*level, &hierarchy.mesh);
        let Scratch { work, .. } = &mut **scratch;
        let ClearsMemory { single, double, .. } = &mut *self.memory;
        let first = self.sides.and_then(|sides| sides.likely_crossing(robot));
        let search = DualTraversal {
            level,
            tree: hierarchy.single(),
            robot,
            margin,
            first,
            pairs: single,
            work,
        };
        let mut answer = search.clears_all(mesh);
        let mut is_capsule_clear = single.clears_capsule();
        if answer.is_none() {
            let tree = hierarchy.double(level);
            let search = DualTraversal { level, tree, robot, margin, first, pairs: double, work };
            answer = search.clears_all(mesh);
            is_capsule_clear = double.clears_capsule();
        }
        if let Some(is_clear) = answer {
            let known = if is_capsule_clear { ClearedBy::Capsule } else { ClearedBy::Links };
            return is_clear.then_some(known);
        }
        let mut is_clear =
            |link| self.search.nearest(&link, Best::within(margin), [None; 2]).nearest().is_none();
        robot.placed_links().all(&mut is_clear).then_some(ClearedBy::Links)
    }
}

/// A run is split before it meets a node this many times smaller, or such a leaf. Measured: a run
/// that is split late meets more of the mesh; a run that is split early meets it more often.
const NODE_SHARE: f64 = 1.0;
const LEAF_SHARE: f64 = 3.0;

/// The root of the hierarchy.
const WHOLE_MESH: u32 = Child::Node(0).pack();

/// State of a search, reused by later queries.
#[derive(Clone, Default)]
struct PairStack<E> {
    /// The nodes of the link tree in the frame of the search, placed on first use by a query.
    runs: Vec<PlacedNode<E>>,
    query: u64,
    waiting: Vec<NodePair<E>>,
    /// The pairs of link and triangle that the precision of the search cannot decide.
    doubtful: Vec<(u32, u32)>,
    /// The run and the leaf of the last triangle that was within the margin; a later query tests
    /// this pair first.
    last: Option<(u32, u32)>,
    /// True once the root of the link tree is split; true at once if it is a single link.
    has_parted_all: bool,
}

impl<E> PairStack<E> {
    /// Returns true if a search without a hit also proves that the capsule around all links is
    /// clear.
    fn clears_capsule(&self) -> bool {
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
    /// The length, tips included.
    size: E,
    /// An axis distance below this is possibly within the margin.
    limit: E,
    /// An axis distance below this is within the margin beyond rounding.
    certain: E,
}

/// A run and a part of the mesh that may be within the margin of each other.
#[derive(Clone, Copy)]
struct NodePair<E> {
    /// The run's index in the link tree.
    run: u32,
    child: u32,
    /// The largest side of the box around the part of the mesh.
    size: E,
    /// The squared distance of the centre of that box from the run's axis.
    squared_distance: E,
}

/// The outcome in the precision of the search.
enum SearchOutcome {
    /// Only doubtful pairs may be within the margin.
    NoHit,
    /// Some triangle is within the margin.
    Hit,
    /// The precision does not resolve the robot.
    Unresolved,
}

/// A search for any triangle at most `margin` from a robot.
struct DualTraversal<'a, E> {
    pub level: Level,
    pub tree: &'a WideBvh<E>,
    pub robot: PlacedRobot<'a>,
    pub margin: Real,
    /// The link that probably meets the mesh, if one does; its pair is searched early.
    pub first: Option<usize>,
    pub pairs: &'a mut PairStack<E>,
    pub work: &'a mut Work,
}

impl<E: Lane> DualTraversal<'_, E> {
    /// Returns true if every link is farther than `margin` from the mesh. None if the precision of
    /// the search does not resolve the robot.
    fn clears_all(mut self, mesh: &Mesh) -> Option<bool> {
        match self.search() {
            SearchOutcome::Unresolved => None,
            SearchOutcome::Hit => Some(false),
            SearchOutcome::NoHit => {
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
        // In the frame of the search the mesh has a length between one and two.
        let whole =
            NodePair { run: 0, child: WHOLE_MESH, size: zero.one(), squared_distance: zero };
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
                squared_distance: zero,
            });
        }
        dispatch!(E::WIDEST_SEARCH, self.level, simd => self.descend::<E::Pack<_>>(simd))
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
                        return SearchOutcome::Hit;
                    }
                }
            }
        }
        SearchOutcome::NoHit
    }

    /// Brings a node of the link tree into the frame of the search. None if the precision does not
    /// resolve the node.
    #[inline(never)] // compiled once, not for each instruction set
    fn place(&mut self, run: u32) -> Option<()> {
        let (ends, radius, flat) = self.robot.outline(&self.robot.link_tree()[run as usize]);
        let frame = &self.tree.frame;
        let searched = SearchLink::between(ends, radius, flat, frame)
            .filter(|link| link.is_resolved(frame))?;
        self.pairs.runs[run as usize] = PlacedNode {
            query: self.pairs.query,
            size: searched.length + searched.radius + searched.radius,
            limit: searched.axis_limit(self.margin),
            certain: searched.certain_limit(self.margin),
            searched,
        };
        Some(())
    }

    /// Replaces the run of a pair by both halves of the run (step 1). Returns false for a single
    /// link.
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
        // A robot that collides does so most often with its tip. Near a part of the mesh both
        // halves are equally likely.
        let last_and_first = if pair.child == WHOLE_MESH { [low, high] } else { [high, low] };
        self.pairs.waiting.extend(last_and_first.map(|run| NodePair { run, ..pair }));
        true
    }

    /// Pairs a run with the children of a node that may be within its limit, the nearest centre on
    /// top (step 2).
    #[inline(always)]
    fn visit_node<L: Pack<Element = E>>(&mut self, token: L::Token, node: u32, run: u32) {
        self.work.nodes += 1;
        let node = &self.tree.nodes[node as usize];
        let PairStack { runs, waiting, .. } = &mut *self.pairs;
        let placed = &runs[run as usize];
        let lanes = LinkLanes::<L>::new(token, &placed.searched);
        let limit = L::splat(token, placed.searched.limit_of_bounds(placed.limit));
        let mut squared_distances = [E::default(); WIDTH];
        let mut within = 0;
        for lane in (0..WIDTH).step_by(L::LANES) {
            let (may_meet, squared) = node.bounds::<L>(token, lane).may_meet(&lanes, limit);
            squared.store(&mut squared_distances[lane..]);
            within |= may_meet << lane;
        }
        within &= node.used();
        let bottom = waiting.len();
        while within != 0 {
            let child = within.trailing_zeros() as usize;
            within &= within - 1;
            let pair = NodePair {
                run,
                child: node.children[child],
                size: node.size(child),
                squared_distance: squared_distances[child],
            };
            // Insertion sort: there are few new pairs.
            waiting.push(pair);
            let mut top = waiting.len() - 1;
            while top > bottom && waiting[top - 1].squared_distance < pair.squared_distance {
                waiting[top] = waiting[top - 1];
                top -= 1;
            }
            waiting[top] = pair;
        }
    }

    /// Step 3. Returns true if a triangle of the leaf is certainly within the margin of a link.
    ///
    /// A run of several links is split unless all triangles are too far: their planes, and for a
    /// run no longer than the leaf the triangles themselves. (A longer run is about as wide as the
    /// triangles are large, so the test of their planes is as sharp.)
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
            if lanes.not_excluded_by_plane(vertices, limit) == 0 {
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
            let mut nearer = bounds.nearer;
            while nearer != 0 {
                let triangle = leaf.triangles[lane + nearer.trailing_zeros() as usize];
                nearer &= nearer - 1;
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
