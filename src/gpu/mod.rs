//! Exhaustive queries on the GPU, through `wgpu`: Vulkan, Metal or Direct3D 12 (feature `gpu`).
//!
//! [`GpuExhaustive`] is an engine like those of [`proximity`](crate::proximity), with the same
//! trait and the same distances. It pays where the mesh is large or moves, or where many robots are
//! asked for at once ([`per_link_batch`](crate::proximity::Proximity::per_link_batch) answers them
//! in one go); a single query waits for the GPU and back, some hundred microseconds.
//!
//! The kernels are the narrow phase of [`distance`](crate::distance), function by function, in
//! WGSL. Each is one text for both precisions.
//!
//! The way of a query, from top to bottom:
//!
//! | file | what it knows |
//! |---|---|
//! | `engine` | what the engine is and answers: [`GpuExhaustive`] |
//! | `answers`, `measure` | from robots to links, and from candidates to answers in double precision |
//! | `query` | the four kernels of a query; `plan` deals the pairs to threads, `candidates` reads what comes back |
//! | `mesh`, `link`, `buffers` | what lies in the device's memory |
//! | `opened`, `error` | the [`Gpu`], and what can go wrong; its device is that of the crate `gpu-batch` |
//! | `wgsl`, `shaders/` | the kernels' text |
//! | `layout` | the sizes and the records that host and shaders share |

mod answers;
mod buffers;
mod candidates;
mod engine;
mod error;
#[cfg(feature = "laboratory")]
#[doc(hidden)] // for this project's own studies and tests
pub mod laboratory;
mod layout;
mod link;
mod measure;
mod mesh;
mod opened;
mod plan;
mod query;
#[cfg(test)]
mod tests;
mod wgsl;

pub use engine::GpuExhaustive;
pub use error::GpuError;
pub use gpu_batch::{Adapter, DeviceError, Precision};
pub use opened::Gpu;
