//! A wide hierarchy over the mesh's triangles: 16 children a node, 16 triangles a leaf, in single precision.
//!
//! A pack bounds all children of a node at once, and all triangles of a leaf at once. Bounds reckon with rounding
//! (see [`CoarseLink`](super::coarse::CoarseLink)). Children stand behind their parents in memory, so walking the
//! nodes backwards refits them.

use super::coarse::CoarseFrame;
use super::packed::{BLOCK, Patches};
use super::patch::{PATCH_ROWS, Patch};
use super::share::each;
use super::soa::{load, place_triangle};
use crate::distance::Vec3;
use crate::distance::lanes::{Lane, Pack};
use fearless_simd::{Level, dispatch};
use parry3d_f64::math::Vector;

/// How many children a node has.
pub(super) const WIDTH: usize = 16;

/// How many leaves one thread takes over at a time.
const SHARE: usize = 64;

/// A child's number, and what it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Child {
    Node(u32),
    Leaf(u32),
}

impl Child {
    const LEAF: u32 = 1 << 31;

    pub(super) fn pack(self) -> u32 {
        match self {
            Self::Node(node) => node,
            Self::Leaf(leaf) => leaf | Self::LEAF,
        }
    }

    pub(super) fn unpack(packed: u32) -> Self {
        if packed & Self::LEAF == 0 { Self::Node(packed) } else { Self::Leaf(packed & !Self::LEAF) }
    }
}

/// Up to 16 patches of the mesh and what is in them.
#[derive(Clone)]
pub(super) struct Node {
    /// Rows of centre, half extents and normal (x, y, z each), thickness and radius; see [`Patches`].
    rows: [f32; PATCH_ROWS * WIDTH],
    pub children: [u32; WIDTH],
    count: usize,
}

/// Up to 16 triangles.
#[derive(Clone)]
pub(super) struct Leaf {
    /// Rows of the coordinates of three vertices; lanes without a triangle repeat the last one.
    pub rows: [f32; 9 * BLOCK],
    pub triangles: [u32; BLOCK],
}

/// The hierarchy of a mesh.
pub(super) struct Tree {
    pub frame: CoarseFrame,
    pub nodes: Vec<Node>,
    pub leaves: Vec<Leaf>,
    /// The leaf of each triangle.
    pub leaf_of: Vec<u32>,
}

impl Tree {
    /// The hierarchy of a mesh with at least one triangle.
    pub(super) fn new(level: Level, vertices: &[Vector], indices: &[[u32; 3]]) -> Self {
        let mut tree = Self {
            frame: CoarseFrame::new(vertices),
            nodes: Vec::new(),
            leaves: Vec::with_capacity(indices.len().div_ceil(BLOCK / 2)),
            leaf_of: vec![0; indices.len()],
        };
        let centroid = |triangle: &[u32; 3]| {
            let [a, b, c] = triangle.map(|index| vertices[index as usize]);
            // Halved first, lest the sum of three far corners overflow.
            (a * 0.5 + b * 0.5 + c * 0.5).to_array()
        };
        let mut items: Vec<_> = (0..).zip(indices).map(|(t, corners)| (t, centroid(corners))).collect();
        tree.nodes.push(Node::empty());
        tree.split(0, &mut items);
        tree.refit(level, vertices, indices);
        tree
    }

    /// Divides the triangles of a node among its children: the largest part in two, until there are 16 parts or
    /// all are of the size of a full subtree.
    fn split(&mut self, node: usize, items: &mut [Item]) {
        let unit = full_subtree(items.len());
        let mut parts = vec![items];
        while parts.len() < WIDTH {
            let Some(largest) = (0..parts.len()).max_by_key(|&part| parts[part].len()) else { break };
            if parts[largest].len() <= unit {
                break;
            }
            let part = parts.swap_remove(largest);
            let (low, high) = halve(part, unit);
            parts.extend([low, high]);
        }
        for part in parts {
            let child = if part.len() <= BLOCK {
                self.leaves.push(Leaf::of(part));
                let leaf = self.leaves.len() as u32 - 1;
                part.iter().for_each(|&(triangle, _)| self.leaf_of[triangle as usize] = leaf);
                Child::Leaf(leaf)
            } else {
                self.nodes.push(Node::empty());
                let child = self.nodes.len() - 1;
                self.split(child, part);
                Child::Node(child as u32)
            };
            let node = &mut self.nodes[node];
            node.children[node.count] = child.pack();
            node.count += 1;
        }
    }

    /// Takes over the positions of the vertices; the division stays.
    pub(super) fn refit(&mut self, level: Level, vertices: &[Vector], indices: &[[u32; 3]]) {
        self.frame = CoarseFrame::new(vertices);
        let frame = &self.frame;
        each(&mut self.leaves.chunks_mut(SHARE).collect::<Vec<_>>(), |_, leaves| {
            leaves.iter_mut().for_each(|leaf| leaf.fill(frame, vertices, indices));
        });
        // Nearly all patches are those of leaves, and these do not wait for one another.
        let leaves = &self.leaves;
        each(&mut self.nodes.chunks_mut(SHARE / WIDTH).collect::<Vec<_>>(), |_, nodes| {
            dispatch!(level, simd => enclose_leaves::<<f32 as Lane>::Pack<_>>(simd, leaves, nodes));
        });
        for node in (0..self.nodes.len()).rev() {
            for child in 0..self.nodes[node].count {
                if let Child::Node(below) = Child::unpack(self.nodes[node].children[child]) {
                    let patch = Patch::of_node(&self.nodes[below as usize]);
                    self.nodes[node].set(child, &patch);
                }
            }
        }
    }
}

/// Sets the patches of those children that are leaves.
#[inline(always)]
fn enclose_leaves<L: Pack<Element = f32>>(token: L::Token, leaves: &[Leaf], nodes: &mut [Node]) {
    for node in nodes {
        for child in 0..node.count {
            if let Child::Leaf(leaf) = Child::unpack(node.children[child]) {
                node.set(child, &Patch::of_leaf::<L>(token, &leaves[leaf as usize].rows));
            }
        }
    }
}

/// A triangle and (one and a half times) its centroid.
type Item = (u32, [f64; 3]);

/// How many triangles each child of a node with `count` triangles should hold, so that the nodes near the leaves,
/// which are nearly all, are full: 16, 256, 4096 ...
fn full_subtree(count: usize) -> usize {
    let mut unit = BLOCK;
    // A few children of two units each are better than another level.
    while unit * WIDTH * 3 / 2 < count {
        unit *= WIDTH;
    }
    unit
}

/// Two halves along the longest side of the centroids' box; the lower one is a multiple of `unit`.
fn halve(items: &mut [Item], unit: usize) -> (&mut [Item], &mut [Item]) {
    let side = |axis: usize| {
        let (low, high) = items.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), item| {
            (low.min(item.1[axis]), high.max(item.1[axis]))
        });
        high - low
    };
    let sides = [side(0), side(1), side(2)];
    let axis = (0..3).max_by(|&a, &b| sides[a].total_cmp(&sides[b])).unwrap_or(0);
    let middle = (items.len() / 2).next_multiple_of(unit).min(items.len() - 1);
    items.select_nth_unstable_by(middle, |a, b| a.1[axis].total_cmp(&b.1[axis]));
    items.split_at_mut(middle)
}

impl Leaf {
    /// With the last triangle repeated in the lanes that are left.
    fn of(items: &[Item]) -> Self {
        let triangles = std::array::from_fn(|lane| items[lane.min(items.len() - 1)].0);
        Self { rows: [0.0; 9 * BLOCK], triangles }
    }

    fn fill(&mut self, frame: &CoarseFrame, vertices: &[Vector], indices: &[[u32; 3]]) {
        for lane in 0..BLOCK {
            let triangle = indices[self.triangles[lane] as usize];
            place_triangle(frame, vertices, triangle, &mut self.rows, lane);
        }
    }
}

impl Node {
    /// Patches far beyond anything, so that unused children are never near.
    fn empty() -> Self {
        let rows = std::array::from_fn(|slot| if slot < 3 * WIDTH { 1.0e15 } else { 0.0 });
        Self { rows, children: [0; WIDTH], count: 0 }
    }

    fn set(&mut self, child: usize, patch: &Patch) {
        let rows = [patch.centre, patch.half, patch.normal].map(<[f32; 3]>::from);
        let rows = rows.into_iter().flatten().chain([patch.thickness, patch.radius]);
        for (row, value) in rows.enumerate() {
            self.rows[row * WIDTH + child] = value;
        }
    }

    fn get(&self, child: usize) -> Patch {
        let at = |row: usize| self.rows[row * WIDTH + child];
        let point = |row: usize| Vec3::new(at(row), at(row + 1), at(row + 2));
        Patch { centre: point(0), half: point(3), normal: point(6), thickness: at(9), radius: at(10) }
    }

    /// The patches of the children, one by one.
    pub(super) fn patches_in_use(&self) -> impl Iterator<Item = Patch> + '_ {
        (0..self.count).map(|child| self.get(child))
    }

    /// The children from `lane` on.
    #[inline(always)]
    pub(super) fn patches<L: Pack<Element = f32>>(&self, token: L::Token, lane: usize) -> Patches<L> {
        Patches {
            centre: load(token, &self.rows, 0, lane),
            half: load(token, &self.rows, 3, lane),
            normal: load(token, &self.rows, 6, lane),
            thickness: L::load(token, &self.rows[9 * WIDTH + lane..]),
            radius: L::load(token, &self.rows[10 * WIDTH + lane..]),
        }
    }
}
