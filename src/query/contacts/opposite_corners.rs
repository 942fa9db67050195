//! For each edge of each triangle the opposite corner of a neighbour, in the memory layout of the
//! leaves.

use crate::distance::lanes::Lane;
use crate::mesh::{BLOCK, Mesh, first_of_face, place_points, rotated};
use crate::search::hierarchy::WideBvh;
use crate::threads::Lazy;

/// The opposite corners beyond the edges of a leaf's triangles.
#[derive(Clone)]
pub(crate) struct LeafCorners<E> {
    /// Rows in the layout of the triangles' own corners; NaN if an edge has no second triangle.
    pub rows: [E; 9 * BLOCK],
    /// The corner that each triangle has first in its leaf, two bits per triangle.
    firsts: u32,
}

/// The opposite corners of all triangles. Each leaf is filled on first use.
#[derive(Clone)]
pub(crate) struct OppositeCorners<E>(Vec<Lazy<LeafCorners<E>>>);

impl<E: Lane> OppositeCorners<E> {
    pub(crate) fn new(tree: &WideBvh<E>) -> Self {
        Self(tree.leaves.iter().map(|_| Lazy::new()).collect())
    }

    /// Empties all leaves, after the vertices moved.
    pub(crate) fn forget(&mut self) {
        self.0.iter_mut().for_each(|leaf| *leaf = Lazy::new());
    }

    /// Fills all leaves.
    pub(crate) fn prepare(&self, tree: &WideBvh<E>, mesh: &Mesh) {
        for leaf in 0..self.0.len() as u32 {
            self.of(leaf, tree, mesh);
        }
    }

    /// Returns the opposite corners of a leaf, in the frame of the search.
    pub(crate) fn of(&self, leaf: u32, tree: &WideBvh<E>, mesh: &Mesh) -> &LeafCorners<E> {
        self.0[leaf as usize].get_or_build(|| {
            let mut corners = LeafCorners { rows: [E::round(f64::NAN); 9 * BLOCK], firsts: 0 };
            for (lane, &triangle) in tree.leaves[leaf as usize].triangles.iter().enumerate() {
                let first = first_of_face::<E>(&tree.frame, mesh, triangle);
                let across = rotated(mesh.corners_across(triangle), first);
                place_points(&tree.frame, across, &mut corners.rows, lane);
                corners.firsts |= (first as u32) << (2 * lane);
            }
            corners
        })
    }
}

impl<E> LeafCorners<E> {
    /// Returns the corner that the triangle in a lane has first.
    #[inline(always)]
    pub(crate) fn first(&self, lane: usize) -> usize {
        (self.firsts >> (2 * lane) & 3) as usize
    }
}
