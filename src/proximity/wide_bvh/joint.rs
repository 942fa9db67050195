//! Whether a robot keeps away from the mesh: its links and the triangles are parted together.
//!
//! A pair is a run of links, or one link, and a part of the mesh. A pair whose capsule and bound keep apart is done with.
//! Of any other the larger is parted, and each half meets the other. So what a run of links is far from is never looked
//! at again for one of its links. The first link and triangle that are near enough for certain end the search: those
//! whose distance in single precision is below the margin by more than rounding can do. Those of which it cannot tell
//! are left to double precision.

use super::build::WideBvh;
use super::node::{Child, WIDTH};
use crate::distance::Face;
use crate::distance::lanes::{Lane, Pack};
use crate::proximity::Work;
use crate::proximity::link_lanes::LinkLanes;
use crate::proximity::placed::PlacedRobot;
use crate::proximity::search_frame::SearchLink;
use crate::proximity::triangle_block::{BLOCK, load_vertices};
use crate::robot::LinkNode;
use fearless_simd::{Level, dispatch};
use parry3d_f64::math::Real;

/// A run is parted before it meets a node this many times smaller, or a leaf. Measured: a run that is parted late meets
/// more of the mesh, one that is parted early meets it more often.
const NODE_SHARE: f32 = 1.4;
const LEAF_SHARE: f32 = 3.0;

/// Memory that is used again.
#[derive(Clone, Default)]
pub(super) struct Pairs {
    /// The nodes of the link tree in the frame of the search, those that this query has placed.
    runs: Vec<Run>,
    query: u64,
    waiting: Vec<Pair>,
    doubtful: Vec<(u32, u32)>,
    /// The link and the leaf of the last triangle that was near enough.
    last: Option<(u32, u32)>,
}

impl Pairs {
    pub(super) fn forget(&mut self) {
        self.last = None;
    }

    /// The links and triangles of which single precision cannot tell.
    pub(super) fn doubtful(&self) -> &[(u32, u32)] {
        &self.doubtful
    }
}

/// A node of the link tree in the frame of the search.
#[derive(Clone, Default)]
struct Run {
    /// The query that placed it.
    query: u64,
    searched: SearchLink<f32>,
    /// How long it is, tips included.
    size: f32,
    /// What an axis distance must be below to be possibly within the margin.
    limit: f32,
    /// What it must be below to be so for certain.
    certain: f32,
}

/// A run of links and a part of the mesh that may be near each other.
#[derive(Clone, Copy)]
struct Pair {
    /// The run's place in the link tree.
    run: u32,
    child: u32,
    /// How large the part of the mesh is.
    size: f32,
    /// How far its centre is from the run's axis, squared.
    apart: f32,
}

/// What single precision tells.
pub(super) enum Verdict {
    /// Nothing is within the margin, unless it is doubtful.
    Doubtful,
    /// Some triangle is within the margin.
    Near,
    /// It does not resolve the robot.
    Unresolved,
}

/// A search for anything at most `margin` from a robot.
pub(super) struct JointSearch<'a> {
    pub level: Level,
    pub tree: &'a WideBvh<f32>,
    pub robot: PlacedRobot<'a>,
    pub margin: Real,
    pub pairs: &'a mut Pairs,
    pub work: &'a mut Work,
}

impl JointSearch<'_> {
    pub(super) fn verdict(&mut self) -> Verdict {
        let Pairs { runs, query, waiting, doubtful, last } = &mut *self.pairs;
        let links = self.robot.link_tree();
        *query += 1;
        if runs.len() < links.len() {
            runs.resize_with(links.len(), Run::default);
        }
        doubtful.clear();
        waiting.clear();
        // The mesh is between one and two long.
        waiting.push(Pair { run: 0, child: Child::Node(0).pack(), size: 1.0, apart: 0.0 });
        if let Some((run, leaf)) = *last
            && let Some(LinkNode::Leaf(_)) = links.get(run as usize)
        {
            waiting.push(Pair { run, child: Child::Leaf(leaf).pack(), size: 0.0, apart: 0.0 });
        }
        dispatch!(self.level, simd => self.descend::<<f32 as Lane>::Pack<_>>(simd))
    }

    #[inline(always)]
    fn descend<L: Pack<Element = f32>>(&mut self, token: L::Token) -> Verdict {
        while let Some(pair) = self.pairs.waiting.pop() {
            if self.pairs.runs[pair.run as usize].query != self.pairs.query && self.place(pair.run).is_none()
            {
                return Verdict::Unresolved;
            }
            let size = self.pairs.runs[pair.run as usize].size;
            match Child::unpack(pair.child) {
                Child::Node(node) => {
                    if !(NODE_SHARE * pair.size < size && self.part(pair)) {
                        self.visit_node::<L>(token, node, pair.run);
                    }
                }
                Child::Leaf(leaf) => {
                    if !(LEAF_SHARE * pair.size < size && self.part(pair))
                        && self.visit_leaf::<L>(token, leaf, pair)
                    {
                        self.pairs.last = Some((pair.run, leaf));
                        return Verdict::Near;
                    }
                }
            }
        }
        Verdict::Doubtful
    }

    /// Brings a node of the link tree into the frame of the search. None where single precision does not resolve it.
    #[inline(never)] // not compiled anew for each instruction set
    fn place(&mut self, place: u32) -> Option<()> {
        let (ends, radius, flat) = self.robot.outline(&self.robot.link_tree()[place as usize]);
        let frame = &self.tree.frame;
        let searched = SearchLink::between(ends, radius, flat, frame).filter(|link| frame.resolves(link))?;
        self.pairs.runs[place as usize] = Run {
            query: self.pairs.query,
            size: searched.length + 2.0 * searched.radius,
            limit: searched.axis_limit(self.margin),
            certain: searched.certain_limit(self.margin),
            searched,
        };
        Some(())
    }

    /// Puts both halves of a pair's run in its place; false if it is one link.
    #[inline(always)]
    fn part(&mut self, pair: Pair) -> bool {
        let tree = self.robot.link_tree();
        if let LinkNode::Leaf(_) = tree[pair.run as usize] {
            return false;
        }
        let low = pair.run + 1;
        let below = if let LinkNode::Inner { below, .. } = tree[low as usize] { below as u32 } else { 0 };
        // The half nearer to the base comes first.
        self.pairs.waiting.extend([low + 1 + below, low].map(|run| Pair { run, ..pair }));
        true
    }

    /// Pairs a run with those children of a node that it may be near, the one with the nearest centre on top.
    #[inline(always)]
    fn visit_node<L: Pack<Element = f32>>(&mut self, token: L::Token, node: u32, run: u32) {
        self.work.nodes += 1;
        let node = &self.tree.nodes[node as usize];
        let Pairs { runs, waiting, .. } = &mut *self.pairs;
        let placed = &runs[run as usize];
        let lanes = LinkLanes::<L>::new(token, &placed.searched);
        let limit = L::splat(token, placed.limit);
        let mut apart = [0.0; WIDTH];
        let mut near = 0;
        for lane in (0..WIDTH).step_by(L::LANES) {
            let (may_meet, squared) = node.bounds::<L>(token, lane).may_meet(&lanes, limit);
            squared.store(&mut apart[lane..]);
            near |= may_meet << lane;
        }
        let bottom = waiting.len();
        while near != 0 {
            let child = near.trailing_zeros() as usize;
            near &= near - 1;
            let pair = Pair { run, child: node.children[child], size: node.size(child), apart: apart[child] };
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

    /// Whether a triangle of a leaf is within the margin of a link for certain. A run is parted, unless it is too far
    /// from all of them.
    #[inline(always)]
    fn visit_leaf<L: Pack<Element = f32>>(&mut self, token: L::Token, leaf: u32, pair: Pair) -> bool {
        self.work.visited += BLOCK as u64;
        let leaf = &self.tree.leaves[leaf as usize];
        let placed = &self.pairs.runs[pair.run as usize];
        let lanes = LinkLanes::<L>::new(token, &placed.searched);
        let (limit, certain) = (L::splat(token, placed.limit), L::splat(token, placed.certain));
        let LinkNode::Leaf(link) = self.robot.link_tree()[pair.run as usize] else {
            for lane in (0..BLOCK).step_by(L::LANES) {
                if lanes.not_behind_plane(load_vertices::<L>(token, &leaf.rows, lane), limit) != 0 {
                    self.part(pair);
                    break;
                }
            }
            return false;
        };
        for lane in (0..BLOCK).step_by(L::LANES) {
            let vertices = load_vertices::<L>(token, &leaf.rows, lane);
            if lanes.not_behind_plane(vertices, limit) == 0 {
                continue;
            }
            self.work.axis_distances += L::LANES as u64;
            let bounds = lanes.may_be_nearer(&Face::new(vertices), limit);
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
