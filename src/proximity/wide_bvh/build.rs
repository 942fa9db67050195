//! The hierarchy over a mesh's triangles: 16 children a node, 16 triangles a leaf, in the precision of the search.
//!
//! A pack bounds all children of a node at once, and all triangles of a leaf at once. The leaves below a node stand one
//! behind the other in memory.

use super::bound::NodeBound;
use super::node::{Child, Leaf, Node, WIDTH};
use crate::distance::lanes::{Lane, Pack};
use crate::distance::{Scalar, dispatch};
use crate::proximity::mesh::Mesh;
use crate::proximity::parallel::each;
use crate::proximity::search_frame::SearchFrame;
use crate::proximity::triangle_block::BLOCK;
use fearless_simd::Level;
use std::ops::Range;

/// How many leaves one thread takes over at a time.
const SHARE: usize = 64;

/// The hierarchy of a mesh.
#[derive(Clone)]
pub(super) struct WideBvh<E> {
    pub frame: SearchFrame,
    pub nodes: Vec<Node<E>>,
    pub leaves: Vec<Leaf<E>>,
    /// Where each triangle stands: its lane, and 16 times the number of its leaf.
    pub place_of: Vec<u32>,
}

impl<E: Lane> WideBvh<E> {
    /// The hierarchy of a mesh with at least one triangle.
    pub(super) fn new(level: Level, mesh: &Mesh) -> Self {
        let mut tree = Self {
            frame: SearchFrame::new(mesh),
            nodes: vec![Node::empty()],
            leaves: Vec::with_capacity(mesh.len().div_ceil(BLOCK / 2)),
            place_of: vec![0; mesh.len()],
        };
        let centroid = |triangle: u32| {
            let [a, b, c] = mesh.corners(triangle);
            // Halved first, lest the sum of three far corners overflow.
            (a * 0.5 + b * 0.5 + c * 0.5).to_array()
        };
        let mut items: Vec<_> =
            (0..mesh.len() as u32).map(|triangle| (triangle, centroid(triangle))).collect();
        tree.split(0, &mut items);
        tree.refit(level, mesh);
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
        let first = self.leaves.len();
        for part in parts {
            let lowest = part.iter().map(|&(triangle, _)| triangle).min().unwrap_or(u32::MAX);
            let child = if part.len() <= BLOCK {
                self.leaves.push(Leaf::of(|lane| part[lane].0, part.len()));
                let leaf = self.leaves.len() as u32 - 1;
                for (place, &(triangle, _)) in (leaf * BLOCK as u32..).zip(&*part) {
                    self.place_of[triangle as usize] = place;
                }
                Child::Leaf(leaf)
            } else {
                self.nodes.push(Node::empty());
                let child = self.nodes.len() - 1;
                self.split(child, part);
                Child::Node(child as u32)
            };
            self.nodes[node].push(child, lowest);
        }
        self.nodes[node].leaves = first..self.leaves.len();
    }

    /// The triangles below a child.
    pub(super) fn triangles_below(&self, child: Child) -> impl Iterator<Item = u32> + Clone {
        self.leaves[child.leaves(|node| self.nodes[node].leaves.clone())].iter().flat_map(Leaf::triangles)
    }

    /// Takes over the positions of the vertices; the division stays.
    pub(super) fn refit(&mut self, level: Level, mesh: &Mesh) {
        self.frame = SearchFrame::new(mesh);
        let frame = &self.frame;
        each(&mut self.leaves.chunks_mut(SHARE).collect::<Vec<_>>(), |_, leaves| {
            leaves.iter_mut().for_each(|leaf| leaf.fill(frame, mesh));
        });
        // No bound waits for another.
        let leaves = &self.leaves;
        let below: Vec<_> = self.nodes.iter().map(|node| node.leaves.clone()).collect();
        each(&mut self.nodes.chunks_mut(SHARE / WIDTH).collect::<Vec<_>>(), |_, nodes| {
            dispatch!(level, simd => bound_children::<E::Pack<_>>(simd, leaves, &below, nodes));
        });
    }
}

/// Bounds the children of nodes. `below` tells which leaves are below a node.
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
