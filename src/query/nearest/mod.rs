//! The nearest triangle of every link, of the robot, and whether a margin is kept.

mod clears;
mod few_each;
mod joint;
mod keeps_away;
mod memory;
mod minimum;
mod per_link;
mod rough_sides;

pub(crate) use clears::{ClearsMemory, ClearsSearch};
pub(crate) use memory::{Odometer, Outline};
pub(crate) use minimum::{MinimumMemory, minimum_within};
pub(crate) use per_link::{PerLinkMemory, per_link};
pub(crate) use rough_sides::RoughSides;
