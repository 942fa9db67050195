//! The parts that this project's own studies and tests build on (hidden feature `laboratory`):
//! other solvers, other kinds of numbers, other instruction sets. It is no part of the interface
//! and may change at any time.

pub use super::at_level::{Kernel, at_level};
pub use super::disc_solver::{Convex, DiscSolver};
pub use super::scalar::{Mask, Sealed};
pub use super::segment_disc::{LineDisc, segment_disc_by};
pub use super::triangle_disc::triangle_disc_by;
pub use super::triangle_modified_cylinder::triangle_modified_cylinder_by;
