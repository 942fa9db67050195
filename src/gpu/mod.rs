//! Queries on the GPU, through `wgpu`: Vulkan, Metal or Direct3D 12 (feature `gpu`).
//!
//! Both engines implement [`Proximity`](crate::proximity::Proximity), and return the same distances
//! as the engines of [`proximity`](crate::proximity).
//!
//! - [`GpuSearch`] searches a hierarchy: for batches of thousands of robots, and for large meshes
//!   that move. Small batches run on the CPU. Its files are in `search`.
//! - [`GpuExhaustive`] visits every triangle, as the paper does. A single query waits some hundred
//!   microseconds for the GPU. Its kernels repeat the narrow phase of
//!   [`distance`](crate::distance), function by function, in WGSL. Each kernel is one text for both
//!   precisions.
//!
//! The files of the exhaustive engine, in the order of a query:
//!
//! | file | contents |
//! |---|---|
//! | `engine` | the engine and its answers |
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
mod search;
#[cfg(test)]
mod tests;
mod wgsl;

pub use engine::GpuExhaustive;
pub use error::GpuError;
pub use gpu_batch::{Adapter, DeviceError, Precision};
pub use opened::Gpu;
pub use search::GpuSearch;
