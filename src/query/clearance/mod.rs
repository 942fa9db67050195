//! Bounds on the clearance of a tube, and whether it keeps a margin.

mod bounds;
mod decision;
mod memory;

pub(crate) use bounds::{BoundedClearance, BoundsSearch, Hint, clearance};
pub(crate) use decision::{Wanted, clears_pieces, clears_tube};
pub(crate) use memory::TubeMemory;
