//! The search on the GPU: a tree of boxes, a workgroup for each robot, a thread for each link.
//!
//! | file | contents |
//! |---|---|
//! | `engine` | the engine: [`GpuSearch`] |
//! | `batch` | a batch: packing, the two passes, measuring, and the proof that no answer is lost |
//! | `robots` | the robots of a batch, and how chains are packed |
//! | `sections`, `bending` | robots of sections of constant curvature: the device computes points |
//! | `bounds` | the bounds in single precision, with their rounding; `twin` repeats the kernels |
//! | `tree` | the topology, built on the CPU |
//! | `device` | the tree in the device's memory, and its refit |
//! | `kernels` | the text of the kernels, from `shaders/search` |

mod batch;
mod bending;
#[cfg(test)]
mod bending_tests;
mod bounds;
mod device;
mod engine;
pub(super) mod kernels;
mod robots;
mod sections;
mod tree;
#[cfg(test)]
mod twin;

pub(super) use device::SearchKernels;
pub use engine::GpuSearch;
