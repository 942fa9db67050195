//! The nearest triangle of one link by the wide hierarchy: nearer patches first.

use super::coarse::CoarseLink;
use super::packed::{BLOCK, PackedLink};
use super::probe::Probe;
use super::search::Found;
use super::soa::load_vertices;
use super::tree::{Child, Tree, WIDTH};
use crate::distance::Face;
use crate::distance::lanes::Pack;
use parry3d_f64::math::{Real, Vector};

/// What a descent has to go on.
pub(super) struct Descent<'a> {
    pub tree: &'a Tree,
    pub vertices: &'a [Vector],
    pub indices: &'a [[u32; 3]],
    pub probe: &'a Probe,
    pub link: &'a CoarseLink<f32>,
    /// What a triangle must be nearer than, in the probe's units; shrinks with every find.
    pub bound: Real,
    /// Any triangle nearer than the first bound will do.
    pub stop_at_first: bool,
    pub found: Option<Found>,
    pub visits: Visits,
}

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

/// Patches that wait for their turn, the nearest last.
pub(super) type Stack = Vec<(f32, u32)>;

impl Descent<'_> {
    /// Starts with the leaves of two triangles that may be near, then goes through the tree.
    #[inline(always)]
    pub(super) fn run<L: Pack<Element = f32>>(
        &mut self,
        token: L::Token,
        stack: &mut Stack,
        start: [Option<u32>; 2],
    ) {
        let packed = PackedLink::<L>::new(token, self.link);
        let leaf_of =
            |triangle: Option<u32>| triangle.and_then(|t| self.tree.leaf_of.get(t as usize).copied());
        let start = [leaf_of(start[0]), leaf_of(start[1])];
        if let Some(leaf) = start[0] {
            self.visit_leaf(token, &packed, leaf);
        }
        if let Some(leaf) = start[1] {
            if start[1] != start[0] {
                self.visit_leaf(token, &packed, leaf);
            }
        }
        stack.clear();
        stack.push((0.0, 0));
        while let Some((bound, child)) = stack.pop() {
            if self.bound <= 0.0 {
                break;
            }
            if bound >= self.limit() {
                continue;
            }
            match Child::unpack(child) {
                Child::Node(node) => self.visit_node(token, &packed, node, stack),
                Child::Leaf(leaf) if start.contains(&Some(leaf)) => {}
                Child::Leaf(leaf) => self.visit_leaf(token, &packed, leaf),
            }
        }
    }

    /// What an axis distance must be below, squared.
    #[inline(always)]
    fn limit(&self) -> f32 {
        let limit = self.link.axis_limit(self.bound);
        limit * limit
    }

    /// Puts the children that may hold a nearer triangle on the stack, the nearest on top.
    #[inline(always)]
    fn visit_node<L: Pack<Element = f32>>(
        &mut self,
        token: L::Token,
        packed: &PackedLink<L>,
        node: u32,
        stack: &mut Stack,
    ) {
        self.visits.nodes += 1;
        let node = &self.tree.nodes[node as usize];
        let limit = L::splat(token, self.limit());
        let mut bounds = [0.0; WIDTH];
        let mut near = 0;
        for lane in (0..WIDTH).step_by(L::LANES) {
            let squared = packed.squared_distance_to_patches(&node.patches::<L>(token, lane));
            squared.store(&mut bounds[lane..]);
            near |= L::bits(squared.lt(limit)) << lane;
        }
        let bottom = stack.len();
        while near != 0 {
            let child = near.trailing_zeros() as usize;
            near &= near - 1;
            // Insertion keeps the few new entries in order.
            let entry = (bounds[child], node.children[child]);
            stack.push(entry);
            let mut place = stack.len() - 1;
            while place > bottom && stack[place - 1].0 < entry.0 {
                stack[place] = stack[place - 1];
                place -= 1;
            }
            stack[place] = entry;
        }
    }

    /// Measures the leaf's triangles that may be nearer, the nearest first.
    #[inline(always)]
    fn visit_leaf<L: Pack<Element = f32>>(&mut self, token: L::Token, packed: &PackedLink<L>, leaf: u32) {
        self.visits.leaves += 1;
        let leaf = &self.tree.leaves[leaf as usize];
        let limit = L::splat(token, self.link.axis_limit(self.bound));
        let mut squares = [0.0; BLOCK];
        let mut near = 0;
        for lane in (0..BLOCK).step_by(L::LANES) {
            let vertices = load_vertices::<L>(token, &leaf.rows, lane);
            if packed.not_behind_plane(vertices, limit) == 0 {
                continue;
            }
            let (nearer, squared) = packed.may_be_nearer(&Face::new(vertices), limit);
            squared.store(&mut squares[lane..]);
            near |= nearer << lane;
        }
        while near != 0 {
            let mut nearest = near.trailing_zeros() as usize;
            let mut others = near & (near - 1);
            while others != 0 {
                let other = others.trailing_zeros() as usize;
                others &= others - 1;
                if squares[other] < squares[nearest] {
                    nearest = other;
                }
            }
            near &= !(1 << nearest);
            if squares[nearest] >= self.limit() {
                break;
            }
            self.measure(leaf.triangles[nearest]);
        }
    }

    /// Measures one triangle in double precision.
    #[inline(never)] // the same code whatever the instruction set
    fn measure(&mut self, triangle: u32) {
        self.visits.measured += 1;
        let vertices = self.indices[triangle as usize].map(|index| self.vertices[index as usize]);
        if let Some(closest) = self.probe.nearer_than(self.bound, vertices) {
            self.bound = if self.stop_at_first { 0.0 } else { closest.distance };
            self.found = Some(Found { triangle, closest });
        }
    }
}
