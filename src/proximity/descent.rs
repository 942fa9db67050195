//! The nearest triangle of one link by the wide hierarchy: nearer patches first.
//!
//! All comparisons are in single precision and of distances from the axis, the link's own distance and its radius.
//! Where no flat cap decides that is the axis distance F; beyond a flat cap it lies between two bounds. A triangle
//! whose upper bound was computed as u is nearer than u - r + e, with e the link's `error`; so another one can only
//! win if its own lower bound is below u + 2 e. Such candidates are put off: at the end the few that are left are
//! measured in double precision.

use super::coarse::CoarseLink;
use super::packed::{BLOCK, PackedLink};
use super::probe::Found;
use super::probe::Probe;
use super::soa::load_vertices;
use super::tree::{Child, Leaf, Tree, WIDTH};
use crate::distance::Face;
use crate::distance::lanes::{Lane, Pack};
use fearless_simd::{Level, Simd};
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

/// A mesh and its hierarchy.
pub(super) struct SearchMesh {
    pub tree: Tree,
    pub vertices: Vec<Vector>,
    pub indices: Vec<[u32; 3]>,
}

impl SearchMesh {
    pub(super) fn new(level: Level, vertices: &[Vector], indices: &[[u32; 3]]) -> Self {
        Self {
            tree: Tree::new(level, vertices, indices),
            vertices: vertices.to_vec(),
            indices: indices.to_vec(),
        }
    }

    /// Takes over moved vertices.
    pub(super) fn set_vertices(&mut self, level: Level, vertices: &[Vector]) {
        self.vertices.copy_from_slice(vertices);
        self.tree.refit(level, vertices, &self.indices);
    }

    /// The corners of a triangle.
    pub(super) fn corners(&self, triangle: u32) -> [Vector; 3] {
        self.indices[triangle as usize].map(|vertex| self.vertices[vertex as usize])
    }
}

/// Memory that is used again.
#[derive(Default)]
pub(super) struct Scratch {
    pub visits: Visits,
    /// Patches that wait for their turn, the nearest last.
    stack: Vec<(f32, u32)>,
    /// Triangles that may be the nearest, with their lower bounds.
    candidates: Vec<(f32, u32)>,
}

/// A search through a mesh.
pub(super) struct Descent<'a> {
    pub mesh: &'a SearchMesh,
    pub scratch: &'a mut Scratch,
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

impl Descent<'_> {
    /// The triangle nearest to a link among those strictly nearer than `bound`, which is in the probe's units.
    /// The leaves of the triangles to `start` with come first, for the bound they give.
    #[inline(never)] // compiled once for each instruction set
    pub(super) fn nearest<S: Simd>(
        &mut self,
        simd: S,
        probe: &Probe,
        link: Option<&CoarseLink<f32>>,
        bound: Real,
        start: [Option<u32>; 2],
    ) -> Option<Found> {
        let Some(link) = link else { return self.nearest_of_all(probe, bound) };
        let mut quest = Quest { probe, link, bound, limit: link.axis_limit(bound), found: None };
        simd.vectorize(
            #[inline(always)]
            || self.descend::<<f32 as Lane>::Pack<S>>(simd, &mut quest, start),
        );
        self.settle(&mut quest);
        quest.found
    }

    #[inline(always)]
    fn descend<L: Pack<Element = f32>>(
        &mut self,
        token: L::Token,
        quest: &mut Quest,
        start: [Option<u32>; 2],
    ) {
        let packed = PackedLink::<L>::new(token, quest.link);
        self.scratch.candidates.clear();
        let mut start = [self.leaf_of(start[0]), self.leaf_of(start[1])];
        if start[0] == start[1] {
            start[1] = None;
        }
        self.scratch.stack.clear();
        self.scratch.stack.push((0.0, Child::Node(0).pack()));
        // Below 0, to tell a leaf to start with from the same leaf met again.
        self.scratch.stack.extend(start.iter().rev().flatten().map(|&leaf| (-1.0, Child::Leaf(leaf).pack())));
        while let Some((squared, child)) = self.scratch.stack.pop() {
            if squared >= quest.limit * quest.limit || quest.bound <= 0.0 {
                continue;
            }
            match Child::unpack(child) {
                Child::Node(node) => self.visit_node(token, &packed, node, quest.limit),
                Child::Leaf(leaf) if squared >= 0.0 && start.contains(&Some(leaf)) => {}
                Child::Leaf(leaf) => self.visit_leaf(token, &packed, leaf, quest),
            }
        }
    }

    /// Whether some triangle may be nearer than `bound` to the link; false only if none is.
    #[inline(never)] // compiled once for each instruction set
    pub(super) fn may_meet<S: Simd>(&mut self, simd: S, link: &CoarseLink<f32>, bound: Real) -> bool {
        let limit = link.axis_limit(bound);
        simd.vectorize(
            #[inline(always)]
            || self.meets::<<f32 as Lane>::Pack<S>>(simd, link, limit),
        )
    }

    #[inline(always)]
    fn meets<L: Pack<Element = f32>>(&mut self, token: L::Token, link: &CoarseLink<f32>, limit: f32) -> bool {
        let packed = PackedLink::<L>::new(token, link);
        self.scratch.stack.clear();
        self.scratch.stack.push((0.0, Child::Node(0).pack()));
        while let Some((_, child)) = self.scratch.stack.pop() {
            match Child::unpack(child) {
                Child::Node(node) => self.visit_node(token, &packed, node, limit),
                Child::Leaf(leaf) => {
                    self.scratch.visits.leaves += 1;
                    let leaf = &self.mesh.tree.leaves[leaf as usize];
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
        self.mesh.tree.leaf_of.get(triangle? as usize).copied()
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
        self.scratch.visits.nodes += 1;
        let node = &self.mesh.tree.nodes[node as usize];
        let limit = L::splat(token, limit * limit);
        let mut bounds = [0.0; WIDTH];
        let mut near = 0;
        for lane in (0..WIDTH).step_by(L::LANES) {
            let squared = packed.squared_distance_to_patches(&node.patches::<L>(token, lane));
            squared.store(&mut bounds[lane..]);
            near |= L::bits(squared.lt(limit)) << lane;
        }
        let bottom = self.scratch.stack.len();
        while near != 0 {
            let child = near.trailing_zeros() as usize;
            near &= near - 1;
            // Insertion keeps the few new entries in order.
            let entry = (bounds[child], node.children[child]);
            self.scratch.stack.push(entry);
            let mut place = self.scratch.stack.len() - 1;
            while place > bottom && self.scratch.stack[place - 1].0 < entry.0 {
                self.scratch.stack[place] = self.scratch.stack[place - 1];
                place -= 1;
            }
            self.scratch.stack[place] = entry;
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
        self.scratch.visits.leaves += 1;
        let leaf: &Leaf = &self.mesh.tree.leaves[leaf as usize];
        let triangles = leaf.triangles;
        let (mut lower, mut upper) = ([0.0; BLOCK], [0.0; BLOCK]);
        let mut near = 0;
        let limit = L::splat(token, quest.limit);
        for lane in (0..BLOCK).step_by(L::LANES) {
            let vertices = load_vertices::<L>(token, &leaf.rows, lane);
            if packed.not_behind_plane(vertices, limit) == 0 {
                continue;
            }
            let bounds = packed.may_be_nearer(&Face::new(vertices), limit);
            bounds.lower.store(&mut lower[lane..]);
            bounds.upper.store(&mut upper[lane..]);
            near |= bounds.nearer << lane;
        }
        while near != 0 {
            let lane = near.trailing_zeros() as usize;
            near &= near - 1;
            if lower[lane] >= quest.limit {
                continue;
            }
            if upper[lane] + quest.link.error < quest.link.radius {
                // They overlap: the distance is 0, and the search is at its end.
                self.measure(quest, triangles[lane]);
            } else {
                self.scratch.candidates.push((lower[lane], triangles[lane]));
                quest.limit = quest.limit.min(upper[lane] + 2.0 * quest.link.error);
            }
        }
    }

    /// Measures the candidates that are still in question, the nearest first.
    #[inline(never)] // the same code whatever the instruction set
    fn settle(&mut self, quest: &mut Quest) {
        let mut candidates = std::mem::take(&mut self.scratch.candidates);
        candidates.retain(|candidate| candidate.0 < quest.limit);
        candidates.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
        // A leaf that is not full repeats its last triangle.
        candidates.dedup_by_key(|candidate| candidate.1);
        for &(distance, triangle) in &candidates {
            if distance >= quest.limit || quest.bound <= 0.0 {
                break;
            }
            self.measure(quest, triangle);
        }
        self.scratch.candidates = candidates;
    }

    /// Measures one triangle in double precision.
    #[inline(never)] // the same code whatever the instruction set
    fn measure(&mut self, quest: &mut Quest, triangle: u32) {
        self.scratch.visits.measured += 1;
        if let Some(closest) = quest.probe.nearer_than(quest.bound, self.mesh.corners(triangle)) {
            quest.bound = closest.distance;
            quest.limit = quest.limit.min(quest.link.axis_limit(quest.bound));
            quest.found = Some(Found { triangle, closest });
        }
    }

    /// Looks at every triangle: for a link that lies too far out for single precision.
    fn nearest_of_all(&mut self, probe: &Probe, mut bound: Real) -> Option<Found> {
        let mut found = None;
        for triangle in 0..self.mesh.indices.len() as u32 {
            if let Some(closest) = probe.nearer_than(bound, self.mesh.corners(triangle)) {
                bound = closest.distance;
                found = Some(Found { triangle, closest });
            }
        }
        self.scratch.visits.measured += self.mesh.indices.len() as u64;
        found
    }
}
