//! The nearest triangle of every link and of the whole robot, and whether a robot keeps a margin.

mod clears;
mod link_lower_bounds;
mod look_ahead;
mod minimum;
mod outline;
mod per_link;
mod side_grid;

pub(crate) use clears::{ClearsMemory, ClearsSearch};
pub(crate) use minimum::{WarmStart, minimum_within};
#[cfg(feature = "robots")]
pub(crate) use outline::{MOVED_ROUNDING, PlacedOutline};
pub(crate) use per_link::{PerLinkMemory, per_link};
pub(crate) use side_grid::SideGrid;
