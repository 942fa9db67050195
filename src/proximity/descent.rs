//! The nearest triangle of one link by the wide hierarchy: nearer patches first.
//!
//! All comparisons are of axis distances in single precision. A triangle whose axis distance F was computed is
//! nearer than F - r + e, with e the link's `error`; so another one can only win if its own F is below F + 2 e.
//! Such candidates are put off: at the end the few that are left are measured in double precision, most often
//! one. Only where a flat cap decides, and F says little, is a triangle measured at once.

use super::coarse::CoarseLink;
use super::packed::{BLOCK, PackedLink};
use super::probe::Probe;
use super::search::Found;
use super::soa::load_vertices;
use super::tree::{Child, Leaf, Tree, WIDTH};
use crate::distance::Face;
use crate::distance::lanes::Pack;
use parry3d_f64::math::{Real, Vector};

/// How much a search has computed since it was built.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct Visits {
    /// Nodes whose up to 16 patches were bounded, a pack at a time.
    pub nodes: u64,
    /// Leaves whose up to 16 triangles were bounded, a pack at a time.
    pub leaves: u64,
    /// Triangles that were measured in double precision.
    pub measured: u64,
}

/// The mesh, and memory that is used again.
pub(super) struct Descent {
    pub tree: Tree,
    pub vertices: Vec<Vector>,
    pub indices: Vec<[u32; 3]>,
    pub visits: Visits,
    /// Patches that wait for their turn, the nearest last.
    stack: Vec<(f32, u32)>,
    /// Triangles that may be the nearest, with their axis distances.
    candidates: Vec<(f32, u32)>,
}

/// A link on its way down.
struct Quest<'a> {
    probe: &'a Probe,
    link: &'a CoarseLink<f32>,
    /// What a triangle must be nearer than, in the probe's units.
    bound: Real,
    /// What its axis distance must be below.
    limit: f32,
    found: Option<Found>,
}

impl Quest<'_> {
    fn limit_squared(&self) -> f32 {
        self.limit * self.limit
    }
}

impl Descent {
    pub(super) fn new(vertices: &[Vector], indices: &[[u32; 3]]) -> Self {
        Self {
            tree: Tree::new(vertices, indices),
            vertices: vertices.to_vec(),
            indices: indices.to_vec(),
            visits: Visits::default(),
            stack: Vec::new(),
            candidates: Vec::new(),
        }
    }

    /// Takes over moved vertices.
    pub(super) fn set_vertices(&mut self, vertices: &[Vector]) {
        self.vertices.copy_from_slice(vertices);
        self.tree.refit(vertices, &self.indices);
    }

    /// The triangle nearest to a link among those strictly nearer than `bound`, which is in the probe's units.
    /// The leaves of the triangles to `start` with come first, for the bound they give.
    #[inline(always)]
    pub(super) fn nearest<L: Pack<Element = f32>>(
        &mut self,
        token: L::Token,
        probe: &Probe,
        link: Option<&CoarseLink<f32>>,
        bound: Real,
        start: [Option<u32>; 2],
    ) -> Option<Found> {
        let Some(link) = link else { return self.nearest_of_all(probe, bound) };
        let packed = PackedLink::<L>::new(token, link);
        let mut quest = Quest { probe, link, bound, limit: link.axis_limit(bound), found: None };
        self.candidates.clear();
        let start = [self.leaf_of(start[0]), self.leaf_of(start[1])];
        if let Some(leaf) = start[0] {
            self.visit_leaf(token, &packed, leaf, &mut quest);
        }
        if let Some(leaf) = start[1].filter(|_| start[1] != start[0]) {
            self.visit_leaf(token, &packed, leaf, &mut quest);
        }
        self.stack.clear();
        self.stack.push((0.0, 0));
        while let Some((squared, child)) = self.stack.pop() {
            if squared >= quest.limit_squared() || quest.bound <= 0.0 {
                continue;
            }
            match Child::unpack(child) {
                Child::Node(node) => self.visit_node(token, &packed, node, quest.limit),
                Child::Leaf(leaf) if start.contains(&Some(leaf)) => {}
                Child::Leaf(leaf) => self.visit_leaf(token, &packed, leaf, &mut quest),
            }
        }
        self.settle(&mut quest);
        quest.found
    }

    /// Whether some triangle may be nearer than `bound` to the link; false only if none is.
    #[inline(always)]
    pub(super) fn may_meet<L: Pack<Element = f32>>(
        &mut self,
        token: L::Token,
        link: &CoarseLink<f32>,
        bound: Real,
    ) -> bool {
        let packed = PackedLink::<L>::new(token, link);
        let limit = link.axis_limit(bound);
        self.stack.clear();
        self.stack.push((0.0, 0));
        while let Some((_, child)) = self.stack.pop() {
            match Child::unpack(child) {
                Child::Node(node) => self.visit_node(token, &packed, node, limit),
                Child::Leaf(leaf) => {
                    self.visits.leaves += 1;
                    let leaf = &self.tree.leaves[leaf as usize];
                    for lane in (0..BLOCK).step_by(L::LANES) {
                        let vertices = load_vertices::<L>(token, &leaf.rows, lane);
                        if packed.not_behind_plane(vertices, L::splat(token, limit)) != 0 {
                            return true;
                        }
                    }
                }
            }
        }
        false
    }

    fn leaf_of(&self, triangle: Option<u32>) -> Option<u32> {
        self.tree.leaf_of.get(triangle? as usize).copied()
    }

    /// Puts the children that may hold a nearer triangle on the stack, the nearest on top.
    #[inline(always)]
    fn visit_node<L: Pack<Element = f32>>(
        &mut self,
        token: L::Token,
        packed: &PackedLink<L>,
        node: u32,
        limit: f32,
    ) {
        self.visits.nodes += 1;
        let node = &self.tree.nodes[node as usize];
        let limit = L::splat(token, limit * limit);
        let mut bounds = [0.0; WIDTH];
        let mut near = 0;
        for lane in (0..WIDTH).step_by(L::LANES) {
            let squared = packed.squared_distance_to_patches(&node.patches::<L>(token, lane));
            squared.store(&mut bounds[lane..]);
            near |= L::bits(squared.lt(limit)) << lane;
        }
        let bottom = self.stack.len();
        while near != 0 {
            let child = near.trailing_zeros() as usize;
            near &= near - 1;
            // Insertion keeps the few new entries in order.
            let entry = (bounds[child], node.children[child]);
            self.stack.push(entry);
            let mut place = self.stack.len() - 1;
            while place > bottom && self.stack[place - 1].0 < entry.0 {
                self.stack[place] = self.stack[place - 1];
                place -= 1;
            }
            self.stack[place] = entry;
        }
    }

    /// Makes candidates of the leaf's triangles that may be nearest.
    #[inline(always)]
    fn visit_leaf<L: Pack<Element = f32>>(
        &mut self,
        token: L::Token,
        packed: &PackedLink<L>,
        leaf: u32,
        quest: &mut Quest,
    ) {
        self.visits.leaves += 1;
        let leaf: &Leaf = &self.tree.leaves[leaf as usize];
        let triangles = leaf.triangles;
        let mut distances = [0.0; BLOCK];
        let (mut near, mut at_cap) = (0, 0);
        let limit = L::splat(token, quest.limit);
        for lane in (0..BLOCK).step_by(L::LANES) {
            let vertices = load_vertices::<L>(token, &leaf.rows, lane);
            if packed.not_behind_plane(vertices, limit) == 0 {
                continue;
            }
            let bounds = packed.may_be_nearer(&Face::new(vertices), limit);
            bounds.axis_squared.sqrt().store(&mut distances[lane..]);
            near |= bounds.nearer << lane;
            at_cap |= bounds.beyond_flat_cap << lane;
        }
        while near != 0 {
            let lane = near.trailing_zeros() as usize;
            near &= near - 1;
            let (distance, triangle) = (distances[lane], triangles[lane]);
            if distance >= quest.limit {
                continue;
            }
            let overlaps = distance + quest.link.error < quest.link.radius;
            if overlaps || at_cap >> lane & 1 == 1 {
                self.measure(quest, triangle);
            } else {
                self.candidates.push((distance, triangle));
                quest.limit = quest.limit.min(distance + 2.0 * quest.link.error);
            }
        }
    }

    /// Measures the candidates that are still in question, the nearest first.
    #[inline(never)] // the same code whatever the instruction set
    fn settle(&mut self, quest: &mut Quest) {
        let mut candidates = std::mem::take(&mut self.candidates);
        candidates.retain(|candidate| candidate.0 < quest.limit);
        candidates.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
        for &(distance, triangle) in &candidates {
            if distance >= quest.limit || quest.bound <= 0.0 {
                break;
            }
            self.measure(quest, triangle);
        }
        self.candidates = candidates;
    }

    /// Measures one triangle in double precision.
    #[inline(never)] // the same code whatever the instruction set
    fn measure(&mut self, quest: &mut Quest, triangle: u32) {
        self.visits.measured += 1;
        let vertices = self.indices[triangle as usize].map(|index| self.vertices[index as usize]);
        if let Some(closest) = quest.probe.nearer_than(quest.bound, vertices) {
            quest.bound = closest.distance;
            quest.limit = quest.limit.min(quest.link.axis_limit(quest.bound));
            quest.found = Some(Found { triangle, closest });
        }
    }

    /// Looks at every triangle: for a link that lies too far out for single precision.
    fn nearest_of_all(&mut self, probe: &Probe, mut bound: Real) -> Option<Found> {
        let mut found = None;
        for (triangle, corners) in (0..).zip(&self.indices) {
            let vertices = corners.map(|index| self.vertices[index as usize]);
            if let Some(closest) = probe.nearer_than(bound, vertices) {
                bound = closest.distance;
                found = Some(Found { triangle, closest });
            }
        }
        self.visits.measured += self.indices.len() as u64;
        found
    }
}
