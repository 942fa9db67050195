//! What compares with the paper on the GPU (feature `gpu`): the routes to a disc, single pairs of
//! the narrow phase, and branches against clamps.

mod discs;
pub mod forms;
pub mod pairs;

pub use discs::Discs;
pub use forms::{Form, GpuForms};
pub use pairs::{GpuPairs, Pair, PairProblem};
