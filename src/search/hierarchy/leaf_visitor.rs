//! What looks at the leaves that a link comes near to.

use super::WideBvh;
use crate::distance::lanes::{Lane, Pack};
use crate::mesh::Mesh;
use crate::pair::LinkLanes;

/// Is shown the leaves of a [`Traversal`](super::Traversal), one after another. (A closure would
/// not do: it is not compiled into the loop for each instruction set, and would call a function for
/// every operation on a pack.)
pub(crate) trait LeafVisitor<E: Lane> {
    /// Implementations are to be inlined always.
    fn visit<L: Pack<Element = E>>(
        &mut self,
        token: L::Token,
        lanes: &LinkLanes<L>,
        tree: &WideBvh<E>,
        mesh: &Mesh,
        leaf: u32,
    );
}
