//! The search on the GPU: a tree of boxes; a workgroup for up to 32 links of a robot, a thread
//! for each link.
//!
//! | file | contents |
//! |---|---|
//! | `engine` | the engine: [`GpuSearch`] |
//! | `batch` | a batch: the two passes, measuring, and the proof that no answer is lost |
//! | `answer` | the questions, and their answers from candidates |
//! | `chunk` | a chunk of a batch: its submission; `chunk_upload`: its layout and upload |
//! | `robots` | the robots of a batch, and how chains are packed |
//! | `sections`, `bending` | robots of sections of constant curvature: the device computes points |
//! | `bounds` | the bounds in single precision, with their rounding; `twin` repeats the kernels |
//! | `tree` | the topology, built on the CPU |
//! | `device` | the tree in the device's memory, and its refit |
//! | `kernels` | the text of the kernels, from `shaders/search`; `compiled`: the kernels of a device |

mod answer;
mod batch;
mod bending;
#[cfg(test)]
mod bending_tests;
mod bounds;
mod chunk;
mod chunk_upload;
mod compiled;
mod device;
mod engine;
pub(super) mod kernels;
mod robots;
mod sections;
mod tree;
#[cfg(test)]
mod twin;

pub(super) use compiled::SearchKernels;
pub use engine::GpuSearch;
