use crate::answer::{DeviceFailure, MeshError};
use thiserror::Error;

/// Why there is no engine on a GPU.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum GpuError {
    /// No driver offers a GPU.
    #[error(
        "no GPU was found ({reason}); install a driver for Vulkan, Metal or Direct3D 12, or use an engine on the CPU"
    )]
    NoAdapter {
        /// What was looked for.
        reason: String,
    },
    /// The driver did not open the GPU.
    #[error("{adapter} cannot be opened ({reason}); update its driver, or use an engine on the CPU")]
    NotOpened {
        /// The GPU.
        adapter: String,
        /// What the driver says.
        reason: String,
    },
    /// The GPU or its interface has no double precision.
    #[error("{adapter} has no double precision; use Precision::F32, which finds the same distances")]
    NoDoublePrecision {
        /// The GPU.
        adapter: String,
    },
    /// The GPU claims double precision but computes with less.
    #[error(
        "{adapter} computes {operation} as {got:e} instead of {expected:e}: that is no double precision; \
         use Precision::F32, which finds the same distances"
    )]
    WrongArithmetic {
        /// The GPU.
        adapter: String,
        /// What was computed.
        operation: String,
        /// What the GPU made of it.
        got: f64,
        /// What it is.
        expected: f64,
    },
    /// The driver does not compile a kernel.
    #[error(
        "{adapter} does not compile the kernel `{kernel}` ({message}); update its driver, or use an engine on the CPU"
    )]
    Shader {
        /// The GPU.
        adapter: String,
        /// The kernel's name.
        kernel: String,
        /// What the compiler says.
        message: String,
    },
    /// The GPU's memory does not hold the mesh.
    #[error(
        "{triangles} triangles do not fit into the memory of {adapter}; take a coarser mesh, or an engine on the CPU"
    )]
    MeshTooLarge {
        /// The GPU.
        adapter: String,
        /// How many triangles the mesh has.
        triangles: usize,
    },
    /// The mesh cannot be queried on any engine.
    #[error(transparent)]
    Mesh(#[from] MeshError),
    /// The GPU failed while the engine was built.
    #[error(transparent)]
    Device(#[from] DeviceFailure),
}
