//! A node of the hierarchy with up to 16 children, and a leaf with up to 16 triangles.

use super::bound::{BOUND_ROWS, NodeBound, NodeBounds};
#[cfg(test)]
use crate::distance::Vec3;
use crate::distance::lanes::{Lane, Pack};
use crate::mesh::{BLOCK, Mesh, SearchFrame, load, place_face};
use std::ops::Range;

/// Children per node: as many as a leaf has triangles, so that both are loaded alike.
pub(crate) const WIDTH: usize = BLOCK;

/// The number of a child, and its kind.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Child {
    Node(u32),
    Leaf(u32),
}

impl Child {
    const LEAF: u32 = 1 << 31;

    pub(crate) const fn pack(self) -> u32 {
        match self {
            Self::Node(node) => node,
            Self::Leaf(leaf) => leaf | Self::LEAF,
        }
    }

    pub(crate) fn unpack(packed: u32) -> Self {
        if packed & Self::LEAF == 0 { Self::Node(packed) } else { Self::Leaf(packed & !Self::LEAF) }
    }

    /// Returns the leaves below the child, or the child itself. `of_node` gives the leaves of a
    /// node.
    pub(crate) fn leaves(self, of_node: impl Fn(usize) -> Range<usize>) -> Range<usize> {
        match self {
            Self::Node(node) => of_node(node as usize),
            Self::Leaf(leaf) => leaf as usize..leaf as usize + 1,
        }
    }
}

/// Up to 16 children and their bounds. Aligned, so that no row of a pack straddles two cache lines.
#[derive(Clone)]
#[repr(align(64))]
pub(crate) struct Node<E> {
    /// Rows of centre, half extents, normal and tangent, three numbers each; see [`NodeBounds`].
    rows: [E; BOUND_ROWS * WIDTH],
    pub children: [u32; WIDTH],
    /// The lowest triangle number below each child.
    pub lowest: [u32; WIDTH],
    /// The size of the largest child.
    pub largest: E,
    /// The leaves below the node.
    pub leaves: Range<usize>,
    count: usize,
}

/// Up to 16 triangles. Aligned like a node.
#[derive(Clone)]
#[repr(align(64))]
pub(crate) struct Leaf<E> {
    /// Rows of the coordinates of three vertices, in the order of a
    /// [`Face`](crate::distance::Face). Lanes without a triangle repeat the last triangle.
    pub rows: [E; 9 * BLOCK],
    pub triangles: [u32; BLOCK],
}

impl<E: Lane> Node<E> {
    /// A node without children. The bounds of unused children lie far beyond the mesh. They pass
    /// only a limit that excludes nothing; [`Node::used`] drops them there.
    pub(crate) fn empty() -> Self {
        let far = E::round(1.0e9 * E::FARTHEST);
        let (zero, one) = (E::default(), E::default().one());
        let row = |row| match row {
            0..3 => far,
            6 | 10 => one,
            _ => zero,
        };
        Self {
            rows: std::array::from_fn(|slot| row(slot / WIDTH)),
            children: [0; WIDTH],
            lowest: [u32::MAX; WIDTH],
            largest: zero,
            leaves: 0..0,
            count: 0,
        }
    }

    pub(crate) fn push(&mut self, child: Child, lowest: u32) {
        self.children[self.count] = child.pack();
        self.lowest[self.count] = lowest;
        self.count += 1;
    }

    pub(crate) fn set_bound(&mut self, child: usize, bound: &NodeBound<E>) {
        let rows = [bound.centre, bound.half, bound.normal, bound.tangent].map(<[E; 3]>::from);
        for (row, value) in rows.into_iter().flatten().enumerate() {
            self.rows[row * WIDTH + child] = value;
        }
    }

    /// The children in use, one bit each.
    #[inline(always)]
    pub(crate) fn used(&self) -> u64 {
        (1 << self.count) - 1
    }

    #[cfg(test)]
    fn bound(&self, child: usize) -> NodeBound<E> {
        let at = |row: usize| self.rows[row * WIDTH + child];
        let point = |row: usize| Vec3::new(at(row), at(row + 1), at(row + 2));
        NodeBound { centre: point(0), half: point(3), normal: point(6), tangent: point(9) }
    }

    /// The longest side of a child's box.
    #[inline(always)]
    pub(crate) fn size(&self, child: usize) -> E {
        let half = |axis: usize| self.rows[(3 + axis) * WIDTH + child];
        let largest = half(0).max(half(1)).max(half(2));
        largest + largest
    }

    /// The children in use.
    pub(crate) fn children(&self) -> impl Iterator<Item = Child> + Clone + use<E> {
        let children = self.children;
        (0..self.count).map(move |child| Child::unpack(children[child]))
    }

    /// The bounds of the children in use, one by one.
    #[cfg(test)]
    pub(crate) fn bounds_in_use(&self) -> impl Iterator<Item = NodeBound<E>> + Clone + '_ {
        (0..self.count).map(|child| self.bound(child))
    }

    /// The bounds of the children from `lane` on.
    #[inline(always)]
    pub(crate) fn bounds<L: Pack<Element = E>>(
        &self,
        token: L::Token,
        lane: usize,
    ) -> NodeBounds<L> {
        NodeBounds {
            centre: load(token, &self.rows, 0, lane),
            half: load(token, &self.rows, 3, lane),
            normal: load(token, &self.rows, 6, lane),
            tangent: load(token, &self.rows, 9, lane),
        }
    }
}

impl<E: Lane> Leaf<E> {
    /// A leaf of 1 to 16 triangles. The last triangle is repeated in the remaining lanes.
    pub(crate) fn of(triangles: impl Fn(usize) -> u32, count: usize) -> Self {
        let triangles = std::array::from_fn(|lane| triangles(lane.min(count - 1)));
        Self { rows: [E::default(); 9 * BLOCK], triangles }
    }

    /// The triangles, each once.
    pub(crate) fn triangles(&self) -> impl Iterator<Item = u32> + Clone {
        let is_first =
            |&lane: &usize| lane == 0 || self.triangles[lane] != self.triangles[lane - 1];
        (0..BLOCK).filter(is_first).map(|lane| self.triangles[lane])
    }

    /// Fills the leaf with the current vertices of its triangles.
    pub(crate) fn fill(&mut self, frame: &SearchFrame, mesh: &Mesh) {
        for lane in 0..BLOCK {
            place_face(frame, mesh, self.triangles[lane], &mut self.rows, lane);
        }
    }
}
