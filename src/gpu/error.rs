use crate::answer::MeshError;
use gpu_batch::{DeviceError, DeviceFailure};
use strum::IntoStaticStr;
use thiserror::Error;

/// The reason why an engine on a GPU cannot be built.
#[derive(Clone, Debug, PartialEq, Error, IntoStaticStr)]
#[strum(serialize_all = "snake_case")]
#[non_exhaustive]
pub enum GpuError {
    /// The GPU cannot be opened, or failed while the engine was built. More GPUs support single
    /// precision than double; the distances are the same.
    #[error(transparent)]
    Device(#[from] DeviceError),
    /// The GPU's memory does not hold the mesh.
    #[error(
        "{triangles} triangles do not fit into the memory of {adapter}; take a coarser mesh, or an engine on the CPU"
    )]
    MeshTooLarge {
        /// The GPU.
        adapter: String,
        /// The number of triangles of the mesh.
        triangles: usize,
    },
    /// The mesh cannot be queried on any engine.
    #[error(transparent)]
    Mesh(#[from] MeshError),
}

impl GpuError {
    /// The error in one word, the same in Rust and Python: the variant in snake case; for a wrapped
    /// error, the word of that error.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Device(error) => error.kind(),
            Self::Mesh(error) => error.kind(),
            other => other.into(),
        }
    }
}

impl From<DeviceFailure> for GpuError {
    fn from(failure: DeviceFailure) -> Self {
        Self::Device(failure.into())
    }
}
