//! Exhaustive queries on the GPU, through `wgpu`: Vulkan, Metal or Direct3D 12 (feature `gpu`).
//!
//! [`GpuExhaustive`] is an engine like those of [`proximity`](crate::proximity), with the same
//! trait and the same distances. It pays if the mesh is large or moves, or if many robots are
//! queried at once: [`per_link_batch`](crate::proximity::Proximity::per_link_batch) answers them in
//! one submission. A single query waits some hundred microseconds for the GPU.
//!
//! The kernels repeat the narrow phase of [`distance`](crate::distance), function by function, in
//! WGSL. Each kernel is one text for both precisions.
//!
//! The files, in the order of a query:
//!
//! | file | contents |
//! |---|---|
//! | `engine` | the engine and its answers: [`GpuExhaustive`] |
//! | `answers`, `measure` | from robots to links, and from candidates to answers in `f64` |
//! | `query` | the four kernels; `plan` assigns pairs to threads, `candidates` reads the results |
//! | `mesh`, `link`, `buffers` | the contents of the device's memory |
//! | `opened`, `error` | the [`Gpu`] and its errors; its device is from the crate `gpu-batch` |
//! | `wgsl`, `shaders/` | the text of the kernels |
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
