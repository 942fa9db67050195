//! The tree that the device searches: two children a node, up to [`LEAF_SIZE`] triangles a leaf.
//!
//! The CPU decides the topology once. The device computes all boxes, at first and after each move
//! of the vertices.
//!
//! # Algorithm
//! 1. **Build.** Split the triangles of a node where the surface area heuristic is least: in
//!    [`BINS`] bins along each axis of the box of the centres. Split at the median where the
//!    heuristic finds no split, or where the depth would exceed [`MAX_DEPTH`].
//! 2. **Levels.** Sort the nodes by their height over the leaves, so that a refit can fit one level
//!    after the other.
//!
//! # Depth
//! **Claim.** No leaf is deeper than [`MAX_DEPTH`].
//! **Proof.** A node of n triangles splits at the median if `depth + ceil(log2 n) >= MAX_DEPTH`.
//! The median halves n, rounded up, so the sum does not grow below it. Above it, the sum is smaller
//! by at least 1, and a level adds 1 at most. At the root the sum is at most 32.

use crate::mesh::{Mesh, SearchFrame};
use crate::threads::{both, each};

/// Triangles per leaf: 1 visits more nodes, 4 test more triangles.
pub(super) const LEAF_SIZE: usize = 2;
/// Marks a child that is a leaf: LEAF + LEAF_SIZE * first triangle + number of triangles - 1.
pub(super) const LEAF: u32 = 1 << 31;
/// The most triangles that a leaf's number has room for.
pub(super) const MOST_TRIANGLES: usize = (LEAF as usize) / LEAF_SIZE;
/// The greatest depth of a leaf. A search's stack is that deep.
pub(super) const MAX_DEPTH: u32 = 48;
/// Bins of the surface area heuristic along an axis.
const BINS: usize = 16;
/// A smaller subtree is built by one thread.
const TASK_SIZE: usize = 1 << 13;

/// A node without its boxes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Topology {
    /// The number of a node, or of a leaf with [`LEAF`].
    pub children: [u32; 2],
    /// The lowest triangle below each child.
    pub lowest: [u32; 2],
}

/// The topology of a tree.
#[derive(Debug)]
pub(super) struct SearchTree {
    /// In preorder; the first is the root.
    pub nodes: Vec<Topology>,
    /// The triangles in the order of the leaves.
    pub triangles: Vec<u32>,
    /// The nodes by height over the leaves, the lowest first, and the end of each height's nodes.
    pub by_height: Vec<u32>,
    pub heights: Vec<usize>,
}

/// The triangles of a leaf, as a range of [`SearchTree::triangles`].
#[cfg(test)]
pub(super) fn leaf_range(child: u32) -> std::ops::Range<usize> {
    let (first, last) = ((child & !LEAF) as usize / LEAF_SIZE, child as usize % LEAF_SIZE);
    first..first + last + 1
}

impl SearchTree {
    /// The tree of a mesh with 1 to [`MOST_TRIANGLES`] triangles.
    pub(super) fn new(frame: &SearchFrame, mesh: &Mesh) -> Self {
        let mut items = items(frame, mesh);
        let mut nodes = Vec::with_capacity(mesh.len());
        let root = build(&mut items, 0, 0, &mut nodes);
        if nodes.is_empty() {
            // A single leaf, twice.
            let (leaf, lowest) = root;
            nodes.push(Topology { children: [leaf; 2], lowest: [lowest; 2] });
        }
        let triangles = items.iter().map(|item| item.triangle).collect();
        let (by_height, heights) = by_height(&nodes);
        Self { nodes, triangles, by_height, heights }
    }
}

/// A triangle with its box.
#[derive(Clone, Copy, Default)]
struct Item {
    triangle: u32,
    low: [f32; 3],
    high: [f32; 3],
}

impl Item {
    /// Twice the centre of the box.
    fn centre(&self, axis: usize) -> f32 {
        self.low[axis] + self.high[axis]
    }
}

fn items(frame: &SearchFrame, mesh: &Mesh) -> Vec<Item> {
    let mut items = vec![Item::default(); mesh.len()];
    each(&mut items.chunks_mut(Mesh::TASK_SIZE).collect::<Vec<_>>(), |share, items| {
        for (triangle, item) in (share * Mesh::TASK_SIZE..).zip(items.iter_mut()) {
            let mut around = NodeBox::NOTHING;
            for corner in mesh.corners(triangle as u32) {
                let point = <[f32; 3]>::from(frame.point::<f32>(corner));
                around.add(point, point);
            }
            *item = Item { triangle: triangle as u32, low: around.low, high: around.high };
        }
    });
    items
}

/// A box that grows.
#[derive(Clone, Copy)]
struct NodeBox {
    low: [f32; 3],
    high: [f32; 3],
}

impl NodeBox {
    const NOTHING: Self = Self { low: [f32::INFINITY; 3], high: [f32::NEG_INFINITY; 3] };

    fn add(&mut self, low: [f32; 3], high: [f32; 3]) {
        for axis in 0..3 {
            self.low[axis] = self.low[axis].min(low[axis]);
            self.high[axis] = self.high[axis].max(high[axis]);
        }
    }

    /// Half the area of the surface.
    fn area(&self) -> f32 {
        let [x, y, z] = [0, 1, 2].map(|axis| self.high[axis] - self.low[axis]);
        x * y + y * z + z * x
    }
}

/// Step 1: appends the nodes of a subtree, whose triangles begin at `first` in the order of the
/// leaves. Returns the child that stands for it, and its lowest triangle.
fn build(items: &mut [Item], first: usize, depth: u32, nodes: &mut Vec<Topology>) -> (u32, u32) {
    if items.len() <= LEAF_SIZE {
        let lowest = items.iter().map(|item| item.triangle).min().unwrap_or(0);
        let leaf = (first * LEAF_SIZE + items.len() - 1) as u32;
        return (LEAF | leaf, lowest);
    }
    let middle = split(items, depth);
    let (low, high) = items.split_at_mut(middle);
    let number = nodes.len();
    nodes.push(Topology { children: [0; 2], lowest: [0; 2] });
    let mut children = [(0, 0); 2];
    let [one, other] = &mut children;
    if low.len().min(high.len()) < TASK_SIZE {
        *one = build(low, first, depth + 1, nodes);
        *other = build(high, first + middle, depth + 1, nodes);
    } else {
        let [mut of_low, mut of_high] = [Vec::new(), Vec::new()];
        both(
            true,
            || *one = build(low, first, depth + 1, &mut of_low),
            || *other = build(high, first + middle, depth + 1, &mut of_high),
        );
        append(nodes, &of_low, one);
        append(nodes, &of_high, other);
    }
    nodes[number] =
        Topology { children: children.map(|child| child.0), lowest: children.map(|child| child.1) };
    (number as u32, children[0].1.min(children[1].1))
}

/// Appends a subtree whose nodes are numbered from 0.
fn append(nodes: &mut Vec<Topology>, subtree: &[Topology], root: &mut (u32, u32)) {
    let first = nodes.len() as u32;
    let moved = |child: u32| if child & LEAF == 0 { child + first } else { child };
    nodes.extend(
        subtree
            .iter()
            .map(|node| Topology { children: node.children.map(moved), lowest: node.lowest }),
    );
    root.0 = moved(root.0);
}

/// Orders more than one triangle by the best split, and returns where it is.
fn split(items: &mut [Item], depth: u32) -> usize {
    let mut centres = NodeBox::NOTHING;
    for item in items.iter() {
        let centre = [0, 1, 2].map(|axis| item.centre(axis));
        centres.add(centre, centre);
    }
    let sides = [0, 1, 2].map(|axis| centres.high[axis] - centres.low[axis]);
    let is_deep = depth + items.len().next_power_of_two().ilog2() >= MAX_DEPTH;
    let best = if is_deep { None } else { best_bin(items, &centres, sides) };
    if let Some((axis, bin)) = best {
        let middle = partition(items, |item| bin_of(item, axis, &centres, sides) < bin);
        if 0 < middle && middle < items.len() {
            return middle;
        }
    }
    let axis = (0..3).max_by(|&a, &b| sides[a].total_cmp(&sides[b])).unwrap_or(0);
    let middle = items.len() / 2;
    items.select_nth_unstable_by(middle, |a, b| a.centre(axis).total_cmp(&b.centre(axis)));
    middle
}

fn bin_of(item: &Item, axis: usize, centres: &NodeBox, sides: [f32; 3]) -> usize {
    let share = (item.centre(axis) - centres.low[axis]) / sides[axis];
    ((share * BINS as f32) as usize).min(BINS - 1)
}

/// The axis and the first bin of the higher part of the split with the least cost: area times
/// triangles, of both parts.
fn best_bin(items: &[Item], centres: &NodeBox, sides: [f32; 3]) -> Option<(usize, usize)> {
    let (mut least, mut best) = (f32::INFINITY, None);
    for axis in (0..3).filter(|&axis| sides[axis] > 0.0) {
        let mut bins = [(NodeBox::NOTHING, 0_usize); BINS];
        for item in items {
            let (around, count) = &mut bins[bin_of(item, axis, centres, sides)];
            around.add(item.low, item.high);
            *count += 1;
        }
        // The costs of the parts from the last bin down to each bin.
        let mut higher = [0.0; BINS];
        let (mut around, mut count) = (NodeBox::NOTHING, 0);
        for bin in (1..BINS).rev() {
            around.add(bins[bin].0.low, bins[bin].0.high);
            count += bins[bin].1;
            higher[bin] = if count == 0 { f32::INFINITY } else { around.area() * count as f32 };
        }
        let (mut around, mut count) = (NodeBox::NOTHING, 0);
        for bin in 1..BINS {
            around.add(bins[bin - 1].0.low, bins[bin - 1].0.high);
            count += bins[bin - 1].1;
            if count > 0 {
                let cost = around.area() * count as f32 + higher[bin];
                if cost < least {
                    (least, best) = (cost, Some((axis, bin)));
                }
            }
        }
    }
    best
}

/// Moves the items for which `is_low` holds to the front, and returns their number.
fn partition(items: &mut [Item], is_low: impl Fn(&Item) -> bool) -> usize {
    let mut low = 0;
    for place in 0..items.len() {
        if is_low(&items[place]) {
            items.swap(low, place);
            low += 1;
        }
    }
    low
}

/// Step 2.
fn by_height(nodes: &[Topology]) -> (Vec<u32>, Vec<usize>) {
    let mut height = vec![0_u32; nodes.len()];
    // Children come after their parent.
    for (number, node) in nodes.iter().enumerate().rev() {
        let above = |&child: &u32| if child & LEAF == 0 { height[child as usize] + 1 } else { 0 };
        height[number] = node.children.iter().map(above).max().unwrap_or(0);
    }
    let mut order: Vec<u32> = (0..nodes.len() as u32).collect();
    order.sort_by_key(|&node| height[node as usize]);
    let mut heights = vec![0; height[0] as usize + 1];
    height.iter().for_each(|&of| heights[of as usize] += 1);
    let mut end = 0;
    for nodes in &mut heights {
        end += *nodes;
        *nodes = end;
    }
    (order, heights)
}

#[cfg(test)]
mod tests {
    use super::*;
    use continuum_testing::Random;
    use parry3d_f64::math::Vector;

    /// The depth of the deepest leaf, having checked that each triangle is in one leaf and that
    /// `lowest` is right.
    fn check(tree: &SearchTree, count: usize) -> u32 {
        let mut seen = vec![false; count];
        let mut deepest = 0;
        let mut waiting = vec![(0_u32, 0_u32, None)];
        while let Some((child, depth, lowest)) = waiting.pop() {
            if child & LEAF != 0 {
                let triangles = &tree.triangles[leaf_range(child)];
                assert_eq!(lowest, triangles.iter().min().copied());
                triangles.iter().for_each(|&triangle| seen[triangle as usize] = true);
                deepest = deepest.max(depth);
                continue;
            }
            let node = &tree.nodes[child as usize];
            assert!(lowest.is_none_or(|lowest| lowest == node.lowest[0].min(node.lowest[1])));
            for (child, lowest) in node.children.into_iter().zip(node.lowest) {
                waiting.push((child, depth + 1, Some(lowest)));
            }
        }
        assert!(seen.into_iter().all(|seen| seen));
        assert_eq!(tree.by_height.len(), tree.nodes.len());
        assert_eq!(tree.heights.last(), Some(&tree.nodes.len()));
        let place = |node: u32| tree.by_height.iter().position(|&other| other == node);
        if tree.nodes.len() < 1000 {
            for (number, node) in (0..).zip(&tree.nodes) {
                for child in node.children.into_iter().filter(|child| child & LEAF == 0) {
                    assert!(place(child) < place(number));
                }
            }
        }
        deepest
    }

    fn tree_of(corners: Vec<Vector>) -> (SearchTree, usize) {
        let count = corners.len() as u32 / 3;
        let indices = (0..count).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]).collect();
        let mesh = Mesh::of(corners, indices);
        (SearchTree::new(&SearchFrame::new(&mesh), &mesh), count as usize)
    }

    #[test]
    fn every_triangle_is_in_one_leaf_and_no_leaf_too_deep() {
        let mut random = Random::new(3);
        for count in [1, 2, 3, 5, 17, 1000, 70_000] {
            let corners = (0..3 * count).map(|_| random.point()).collect();
            let (tree, count) = tree_of(corners);
            let deepest = check(&tree, count);
            assert!(deepest <= MAX_DEPTH && (count < 1000 || deepest > 8), "{count}: {deepest}");
        }
        // All alike, so that no split tells them apart.
        let (tree, count) = tree_of(vec![Vector::X; 3000]);
        assert_eq!(check(&tree, count), 9);
        // Ever smaller and nearer to the centre: each split takes off the largest alone. Without
        // the limit the leaves of the many in the centre would be too deep.
        let at = |triangle: u32| match triangle {
            0 => -1.0,
            1..38 => 17.0_f64.powi(1 - triangle as i32),
            _ => 0.0,
        };
        let (tree, count) = tree_of((0..30_000).map(|k| Vector::splat(at(k / 3))).collect());
        let deepest = check(&tree, count);
        assert!(40 < deepest && deepest <= MAX_DEPTH, "{deepest}");
    }
}
