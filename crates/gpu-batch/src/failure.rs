use strum::IntoStaticStr;
use thiserror::Error;

/// How a GPU failed. The next call of every user returns the failure; later calls may succeed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error, IntoStaticStr)]
#[strum(serialize_all = "snake_case")]
#[non_exhaustive]
pub enum DeviceFailure {
    /// The device was reset or removed. It answers nothing more.
    #[error(
        "the GPU was lost (reset, removed, or out of time); open it anew, or compute on the CPU"
    )]
    Lost,
    /// The GPU's memory is too small for the request. A smaller one may succeed.
    #[error("the GPU is out of memory; ask for less at once, or compute on the CPU")]
    OutOfMemory,
    /// Its driver refused a command.
    #[error("the GPU's driver refused a command; update the driver, or compute on the CPU")]
    Refused,
    /// The device did not write its answer.
    #[error("the GPU did not answer; update its driver, or compute on the CPU")]
    Unanswered,
}

impl DeviceFailure {
    /// Returns the kind in one word: the variant in snake case.
    pub fn kind(&self) -> &'static str {
        self.into()
    }
}
