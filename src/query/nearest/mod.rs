//! The nearest triangle of every link and of the whole robot, and whether a robot keeps a margin.

mod candidate_batch;
mod cleared_by;
mod clears;
mod dual_traversal;
mod memory;
mod minimum;
mod per_link;
mod side_grid;

pub(crate) use clears::{ClearsMemory, ClearsSearch};
pub(crate) use memory::{Odometer, PlacedOutline};
pub(crate) use minimum::{WarmStart, minimum_within};
pub(crate) use per_link::{PerLinkMemory, per_link};
pub(crate) use side_grid::SideGrid;
