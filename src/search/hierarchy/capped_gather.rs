//! The triangles that may be within a bound of a link, if they are not too many.

use super::{LeafVisitor, WideBvh};
use crate::distance::Face;
use crate::distance::lanes::{Lane, Pack};
use crate::mesh::{BLOCK, Mesh, load_vertices};
use crate::pair::LinkLanes;

/// Where triangles are gathered. What leaves them out is what leaves them out of a search for the
/// nearest (`traverse`).
pub(super) struct CappedGather<'a, E> {
    /// What a triangle's axis distance must be below.
    pub limit: E,
    /// How many there may be.
    pub most: usize,
    /// Those so far.
    pub found: &'a mut Vec<u32>,
    /// Whether there are more.
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
