//! Builds and refits the hierarchy over a mesh: 16 children per node, 16 triangles per leaf.
//!
//! One pack bounds all children of a node, or all triangles of a leaf. The leaves below a node are
//! contiguous in memory.
//!
//! # Algorithm
//! 1. **Arrange.** Split the triangles near the median of their centroids along the longest side of
//!    the centroids' box. Repeat until each node has 16 parts, and recursively below each part.
//! 2. **Split.** Create the nodes and leaves from that order.
//! 3. **Refit.** Fill the leaves with vertices, then bound each child by the leaves below it.

use super::bound::NodeBound;
use super::node::{Child, Leaf, Node, WIDTH};
use crate::distance::lanes::{Lane, Pack};
use crate::distance::{Scalar, Widest, dispatch};
use crate::mesh::{BLOCK, Mesh, SearchFrame, points_in};
use crate::threads::{both, each};
use fearless_simd::Level;
use std::cmp::Ordering;
use std::ops::Range;

/// Leaves that one task takes.
const TASK_SIZE: usize = 64;

/// The hierarchy of a mesh, in the precision of the search.
#[derive(Clone)]
pub(crate) struct WideBvh<E> {
    pub frame: SearchFrame,
    pub nodes: Vec<Node<E>>,
    pub leaves: Vec<Leaf<E>>,
    /// For each triangle 16 times the number of its leaf, plus its lane.
    pub place_of: Vec<u32>,
}

impl<E: Lane> WideBvh<E> {
    /// The hierarchy of a mesh with at least one triangle.
    pub(crate) fn new(level: Level, mesh: &Mesh) -> Self {
        let mut tree = Self {
            frame: SearchFrame::new(mesh),
            nodes: vec![Node::empty()],
            leaves: Vec::with_capacity(mesh.len().div_ceil(BLOCK / 2)),
            place_of: vec![0; mesh.len()],
        };
        let mut items = items(&tree.frame, mesh);
        arrange(&mut items, WIDTH, full_subtree(mesh.len()));
        tree.split(0, &items);
        tree.refit(level, mesh);
        tree
    }

    /// Step 2: gives a node its children. Each part of up to 16 triangles becomes a leaf, a larger
    /// part a node. Returns the lowest triangle number.
    fn split(&mut self, node: usize, items: &[Item<E>]) -> u32 {
        let first = self.leaves.len();
        let mut lowest = u32::MAX;
        for part in parts(items) {
            let (child, lowest_of_part) = if part.len() <= BLOCK {
                self.leaves.push(Leaf::of(|lane| part[lane].0, part.len()));
                let leaf = self.leaves.len() as u32 - 1;
                let mut lowest = u32::MAX;
                for (place, &(triangle, _)) in (leaf * BLOCK as u32..).zip(part) {
                    self.place_of[triangle as usize] = place;
                    lowest = lowest.min(triangle);
                }
                (Child::Leaf(leaf), lowest)
            } else {
                self.nodes.push(Node::empty());
                let child = self.nodes.len() - 1;
                (Child::Node(child as u32), self.split(child, part))
            };
            self.nodes[node].push(child, lowest_of_part);
            lowest = lowest.min(lowest_of_part);
        }
        self.nodes[node].leaves = first..self.leaves.len();
        lowest
    }

    /// Returns the triangles below a child.
    pub(crate) fn triangles_below(&self, child: Child) -> impl Iterator<Item = u32> + Clone {
        self.leaves[child.leaves(|node| self.nodes[node].leaves.clone())]
            .iter()
            .flat_map(Leaf::triangles)
    }

    /// Step 3: fits all bounds to the current vertices. The tree itself stays the same.
    pub(crate) fn refit(&mut self, level: Level, mesh: &Mesh) {
        self.frame = SearchFrame::new(mesh);
        let frame = &self.frame;
        each(&mut self.leaves.chunks_mut(TASK_SIZE).collect::<Vec<_>>(), |_, leaves| {
            leaves.iter_mut().for_each(|leaf| leaf.fill(frame, mesh));
        });
        // Each bound is computed from the leaves, so all nodes are independent.
        let leaves = &self.leaves;
        let below: Vec<_> = self.nodes.iter().map(|node| node.leaves.clone()).collect();
        each(&mut self.nodes.chunks_mut(TASK_SIZE / WIDTH).collect::<Vec<_>>(), |_, nodes| {
            dispatch!(Widest::Sse2, level, simd => bound_children::<E::Pack<_>>(simd, leaves, &below, nodes));
        });
    }
}

/// Bounds the children of nodes. `below` gives the leaves below each node.
#[inline(always)]
fn bound_children<L: Pack>(
    token: L::Token,
    leaves: &[Leaf<L::Element>],
    below: &[Range<usize>],
    nodes: &mut [Node<L::Element>],
) where
    L::Element: Lane,
{
    for node in nodes {
        node.largest = L::Element::default();
        for (place, child) in node.children().enumerate() {
            let below = child.leaves(|node| below[node].clone());
            node.set_bound(place, &NodeBound::around::<L>(token, &leaves[below]));
            node.largest = node.largest.max(node.size(place));
        }
    }
}

/// A triangle and three times its centroid.
type Item<E> = (u32, [E; 3]);

/// The triangles of a mesh with their centroids.
fn items<E: Lane>(frame: &SearchFrame, mesh: &Mesh) -> Vec<Item<E>> {
    let mut items = vec![Item::default(); mesh.len()];
    each(&mut items.chunks_mut(Mesh::TASK_SIZE).collect::<Vec<_>>(), |share, items| {
        for (triangle, item) in (share * Mesh::TASK_SIZE..).zip(items.iter_mut()) {
            let [a, b, c] = points_in(frame, mesh.corners(triangle as u32));
            *item = (triangle as u32, (a + b + c).into());
        }
    });
    items
}

/// Returns how many triangles each child of a node with `count` triangles should hold: 16, 256,
/// 4096, ... Then the nodes near the leaves, which are nearly all nodes, are full.
fn full_subtree(count: usize) -> usize {
    let mut unit = BLOCK;
    // A few children of two units each are better than another level.
    while unit * WIDTH * 3 / 2 < count {
        unit *= WIDTH;
    }
    unit
}

/// Returns where `count` triangles are split in two, a multiple of `unit`. None if they belong to
/// one child. `most` is the number of children that may result.
fn middle(count: usize, most: usize, unit: usize) -> Option<usize> {
    (most > 1 && count > unit).then(|| (count / 2).next_multiple_of(unit).min(count - 1))
}

/// Step 1: orders the triangles below a node so that the triangles of each child are contiguous,
/// recursively.
fn arrange<E: Lane>(items: &mut [Item<E>], most: usize, unit: usize) {
    let Some(middle) = middle(items.len(), most, unit) else {
        if items.len() > BLOCK {
            arrange(items, WIDTH, full_subtree(items.len()));
        }
        return;
    };
    let axis = longest_side(items);
    items.select_nth_unstable_by(middle, |a, b| {
        // Every coordinate in this frame is a number.
        a.1[axis].partial_cmp(&b.1[axis]).unwrap_or(Ordering::Equal)
    });
    let is_worth_it = items.len() >= Mesh::TASK_SIZE;
    let (low, high) = items.split_at_mut(middle);
    both(is_worth_it, || arrange(low, most / 2, unit), || arrange(high, most / 2, unit));
}

/// The parts of a node's triangles in the order of [`arrange`].
fn parts<E>(items: &[Item<E>]) -> Vec<&[Item<E>]> {
    fn divide<'a, E>(
        items: &'a [Item<E>],
        most: usize,
        unit: usize,
        parts: &mut Vec<&'a [Item<E>]>,
    ) {
        let Some(middle) = middle(items.len(), most, unit) else { return parts.push(items) };
        let (low, high) = items.split_at(middle);
        divide(low, most / 2, unit, parts);
        divide(high, most / 2, unit, parts);
    }
    let mut parts = Vec::with_capacity(WIDTH);
    divide(items, WIDTH, full_subtree(items.len()), &mut parts);
    parts
}

/// The axis along which the centroids spread most.
fn longest_side<E: Lane>(items: &[Item<E>]) -> usize {
    let first = items[0].1;
    let (low, high) = items.iter().fold((first, first), |(low, high), (_, centroid)| {
        let axes = [0, 1, 2];
        (
            axes.map(|axis| low[axis].min(centroid[axis])),
            axes.map(|axis| high[axis].max(centroid[axis])),
        )
    });
    let [x, y, z] = [0, 1, 2].map(|axis| high[axis] - low[axis]);
    if z >= x && z >= y { 2 } else { usize::from(y >= x) }
}
