//! How far the numbers hold: the kernels on seeded problems that are driven to an extreme.

pub mod measure;
pub mod problems;
