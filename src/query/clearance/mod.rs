//! How near a tube is, between bounds, and whether it keeps a margin.

mod bounds;
mod decision;
mod memory;

pub(crate) use bounds::{BetweenBounds, between_bounds, clearance};
pub(crate) use decision::{keeps, tube_clears};
pub(crate) use memory::TubeMemory;
