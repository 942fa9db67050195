//! Exhaustive search: every link against every triangle.

mod blocks;
mod pass;
mod scan;

pub(crate) use pass::{Pass, PassGoal, Triangles};
pub(crate) use scan::{Kernels, Visit};
