//! The hierarchy over a mesh's triangles: 16 children a node, 16 triangles a leaf, in the precision
//! of the search.
//!
//! A pack bounds all children of a node at once, and all triangles of a leaf at once. The leaves
//! below a node stand one behind the other in memory.

use super::bound::NodeBound;
use super::node::{Child, Leaf, Node, WIDTH};
use crate::distance::lanes::{Lane, Pack};
use crate::distance::{Scalar, dispatch};
use crate::mesh::{BLOCK, Mesh, SearchFrame};
use crate::threads::{both, each};
use fearless_simd::Level;
use std::cmp::Ordering;
use std::ops::Range;

/// How many leaves one thread works on at a time.
const TASK_SIZE: usize = 64;

/// The hierarchy of a mesh.
#[derive(Clone)]
pub(crate) struct WideBvh<E> {
    pub frame: SearchFrame,
    pub nodes: Vec<Node<E>>,
    pub leaves: Vec<Leaf<E>>,
    /// Where each triangle stands: its lane, and 16 times the number of its leaf.
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

    /// Gives a node its children, for triangles that stand in order: a leaf each for up to 16 of
    /// them, a node for more. Returns the lowest number of a triangle.
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

    /// The triangles below a child.
    pub(crate) fn triangles_below(&self, child: Child) -> impl Iterator<Item = u32> + Clone {
        self.leaves[child.leaves(|node| self.nodes[node].leaves.clone())]
            .iter()
            .flat_map(Leaf::triangles)
    }

    /// Fits all bounds to where the vertices are now; the division stays.
    pub(crate) fn refit(&mut self, level: Level, mesh: &Mesh) {
        self.frame = SearchFrame::new(mesh);
        let frame = &self.frame;
        each(&mut self.leaves.chunks_mut(TASK_SIZE).collect::<Vec<_>>(), |_, leaves| {
            leaves.iter_mut().for_each(|leaf| leaf.fill(frame, mesh));
        });
        // No bound waits for another.
        let leaves = &self.leaves;
        let below: Vec<_> = self.nodes.iter().map(|node| node.leaves.clone()).collect();
        each(&mut self.nodes.chunks_mut(TASK_SIZE / WIDTH).collect::<Vec<_>>(), |_, nodes| {
            dispatch!(level, simd => bound_children::<E::Pack<_>>(simd, leaves, &below, nodes));
        });
    }
}

/// Bounds the children of nodes. `below` says which leaves are below a node.
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

/// All triangles of a mesh.
fn items<E: Lane>(frame: &SearchFrame, mesh: &Mesh) -> Vec<Item<E>> {
    let mut items = vec![Item::default(); mesh.len()];
    each(&mut items.chunks_mut(Mesh::TASK_SIZE).collect::<Vec<_>>(), |share, items| {
        for (triangle, item) in (share * Mesh::TASK_SIZE..).zip(items.iter_mut()) {
            let [a, b, c] = mesh.corners(triangle as u32).map(|corner| frame.point(corner));
            *item = (triangle as u32, (a + b + c).into());
        }
    });
    items
}

/// How many triangles each child of a node with `count` triangles should hold, so that the nodes
/// near the leaves, which are nearly all, are full: 16, 256, 4096 ...
fn full_subtree(count: usize) -> usize {
    let mut unit = BLOCK;
    // A few children of two units each are better than another level.
    while unit * WIDTH * 3 / 2 < count {
        unit *= WIDTH;
    }
    unit
}

/// Where so many triangles are divided in two, a multiple of `unit`; None for those of one child.
/// `most` says how many children may come of them.
fn middle(count: usize, most: usize, unit: usize) -> Option<usize> {
    (most > 1 && count > unit).then(|| (count / 2).next_multiple_of(unit).min(count - 1))
}

/// Brings the triangles below a node into an order in which those of a child stand together, and so
/// on below: they are divided along the longest side of their centroids' box, again and again.
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

/// The parts of a node's triangles that [`arrange`] made of them.
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

/// The axis along which centroids are spread most.
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
