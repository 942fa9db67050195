//! Gathers the triangles that may be within a bound of a link, up to a number.

use super::{LeafVisitor, WideBvh};
use crate::distance::Face;
use crate::distance::lanes::{Lane, Pack};
use crate::mesh::{BLOCK, Mesh, load_vertices};
use crate::pair::LinkLanes;

/// The triangles gathered so far. The tests are the same as in a search for the nearest triangle
/// (`traverse`).
pub(super) struct CappedGather<'a, E> {
    /// A gathered triangle has an axis distance below this.
    pub limit: E,
    /// The most triangles to gather.
    pub most: usize,
    /// The triangles so far.
    pub found: &'a mut Vec<u32>,
    /// Whether there are more than `most`.
    pub is_overfull: bool,
}

impl<E: Lane> LeafVisitor<E> for CappedGather<'_, E> {
    #[inline(always)]
    fn visit<L: Pack<Element = E>>(
        &mut self,
        token: L::Token,
        lanes: &LinkLanes<L>,
        tree: &WideBvh<E>,
        _: &Mesh,
        number: u32,
    ) {
        if self.is_overfull {
            return;
        }
        let leaf = &tree.leaves[number as usize];
        let limit = L::splat(token, self.limit);
        for lane in (0..BLOCK).step_by(L::LANES) {
            let vertices = load_vertices::<L>(token, &leaf.rows, lane);
            if lanes.not_behind_plane(vertices, limit) == 0 {
                continue;
            }
            let mut near = lanes.may_be_nearer(&Face::in_order(vertices), limit).nearer;
            while near != 0 {
                let triangle = leaf.triangles[lane + near.trailing_zeros() as usize];
                near &= near - 1;
                // A leaf that is not full repeats its last triangle.
                if self.found.last() == Some(&triangle) {
                    continue;
                }
                if self.found.len() == self.most {
                    self.is_overfull = true;
                    return;
                }
                self.found.push(triangle);
            }
        }
    }
}
