//! Bounds on the clearance of a tube, and whether it keeps a margin.

mod bounds;
mod decision;

#[cfg(feature = "robots")]
pub(crate) use bounds::{BoundedClearance, BoundsSearch, Hint};
pub(crate) use bounds::{LastPlace, MeshPieces, TubeMemory, clearance};
pub(crate) use decision::clears_tube;
#[cfg(feature = "robots")]
pub(crate) use decision::{Wanted, clears_pieces};
