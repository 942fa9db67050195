//! Exhaustive search: every link against every triangle.

mod blocks;
mod kernels;
mod pass;
mod scan;

pub(crate) use kernels::Kernels;
pub(crate) use pass::{Pass, PassGoal, Triangles};
