use crate::DeviceFailure;
use strum::IntoStaticStr;
use thiserror::Error;

/// Why a GPU cannot be opened, or a kernel not be run on it.
#[derive(Clone, Debug, PartialEq, Error, IntoStaticStr)]
#[strum(serialize_all = "snake_case")]
#[non_exhaustive]
pub enum DeviceError {
    /// No driver offers a GPU.
    #[error(
        "no GPU was found ({reason}); install a driver for Vulkan, Metal or Direct3D 12, or compute on the CPU"
    )]
    NoAdapter {
        /// What was looked for.
        reason: String,
    },
    /// The driver did not open the GPU.
    #[error("{adapter} cannot be opened ({reason}); update its driver, or compute on the CPU")]
    NotOpened {
        /// The GPU.
        adapter: String,
        /// What the driver says.
        reason: String,
    },
    /// The GPU or its interface has no double precision.
    #[error("{adapter} has no double precision; use Precision::F32")]
    NoDoublePrecision {
        /// The GPU.
        adapter: String,
    },
    /// The GPU claims double precision but computes with less.
    #[error(
        "{adapter} computes {operation} as {got:e} instead of {expected:e}: that is no double precision; \
         use Precision::F32"
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
        "{adapter} does not compile the kernel `{kernel}` ({message}); update its driver, or compute on the CPU"
    )]
    Shader {
        /// The GPU.
        adapter: String,
        /// The kernel's name.
        kernel: String,
        /// What the compiler says.
        message: String,
    },
    /// The GPU failed during the work.
    #[error(transparent)]
    Failed(#[from] DeviceFailure),
}

impl DeviceError {
    /// Returns the kind in one word: the variant in snake case, or the kind of the failure that it
    /// contains.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Failed(failure) => failure.kind(),
            other => other.into(),
        }
    }
}
