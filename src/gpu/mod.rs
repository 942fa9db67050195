//! Exhaustive queries on the GPU, through `wgpu`: Vulkan, Metal or Direct3D 12 (feature `gpu`).
//!
//! [`GpuExhaustive`] is an engine like those of [`proximity`](crate::proximity), with the same trait and the same
//! distances. It pays where the mesh is large or moves, or where many robots are asked for at once
//! ([`per_link_batch`](crate::proximity::Proximity::per_link_batch) answers them in one go); a single query waits for
//! the GPU and back, some hundred microseconds.
//!
//! A [`Batch`] runs any kernel over many records of numbers on the same [`Gpu`], a thread each, with the texts of
//! [`wgsl`] to build on.
//!
//! The kernels are the narrow phase of [`distance`](crate::distance), function by function, in WGSL. Each is one text
//! for both precisions.
//!
//! The way of a query, from top to bottom:
//!
//! | file | what it knows |
//! |---|---|
//! | `engine` | what the engine is and answers: [`GpuExhaustive`] |
//! | `answers`, `measure` | from robots to links, and from candidates to answers in double precision |
//! | `query` | the four kernels of a query; `plan` deals the pairs to threads, `candidates` reads what comes back |
//! | `mesh`, `link`, `buffers` | what lies in the device's memory |
//! | `batch` | any kernel over many records: [`Batch`] |
//! | `open`, `opened`, `device`, `clock` | the [`Gpu`] itself |
//! | `failures`, `error` | what can go wrong, and who hears of it |
//! | `wgsl`, `shaders/` | the kernels' text |
//! | `layout`, `record` | the sizes and the records that host and shaders share |

mod answers;
mod batch;
mod buffers;
mod candidates;
mod clock;
mod device;
mod engine;
mod error;
mod failures;
mod layout;
mod link;
mod measure;
mod mesh;
mod open;
mod opened;
mod plan;
mod precision;
mod query;
mod record;
#[cfg(test)]
mod tests;
pub mod wgsl;

pub use batch::{Batch, BatchKernel};
pub use device::Adapter;
pub use engine::GpuExhaustive;
pub use error::GpuError;
pub use opened::Gpu;
pub use precision::Precision;
