//! The search on the GPU: a tree of boxes, a workgroup for each robot, a thread for each link.
//!
//! | file | contents |
//! |---|---|
//! | `engine` | the engine: [`GpuSearch`] |
//! | `batch` | a batch: the two passes, measuring, and the proof that no answer is lost |
//! | `chunk` | a chunk of a batch: layout, upload and submission |
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
mod chunk;
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
