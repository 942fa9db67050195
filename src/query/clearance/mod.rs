//! Bounds on the clearance of a tube, and whether it keeps a margin.

mod bounds;
mod decision;

pub(crate) use bounds::{BoundedClearance, BoundsSearch, Hint, MeshPieces, TubeMemory, clearance};
pub(crate) use decision::{Wanted, clears_pieces, clears_tube};
