//! The action at each leaf that a traversal reaches.

use super::WideBvh;
use crate::distance::lanes::{Lane, Pack};
use crate::mesh::Mesh;
use crate::pair::LinkLanes;

/// Receives the leaves of a [`Traversal`](super::Traversal), one after another.
///
/// A closure would be too slow: it is not inlined into the loop for each instruction set, so every
/// operation on a pack would be a function call.
pub(crate) trait LeafVisitor<E: Lane> {
    /// Processes one leaf. Implementations must be `#[inline(always)]`.
    fn visit<L: Pack<Element = E>>(
        &mut self,
        token: L::Token,
        lanes: &LinkLanes<L>,
        tree: &WideBvh<E>,
        mesh: &Mesh,
        leaf: u32,
    );
}
