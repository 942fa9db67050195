//! Why a scene has no answer.

use super::ProximityError;
use thiserror::Error;

/// Why a scene has no answer, or a structure cannot be part of it.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum SceneError {
    /// What is wrong with a structure.
    #[error("structure `{name}`: {error}")]
    Structure {
        /// The structure's name.
        name: String,
        /// What is wrong, and what to change.
        error: ProximityError,
    },
    /// What is wrong with a robot.
    #[error("robot {robot}: {error}")]
    Robot {
        /// The robot's position among those that were given.
        robot: usize,
        /// What is wrong, and what to change.
        error: ProximityError,
    },
    /// The margin between robots cannot be kept.
    #[error("between robots: {0}")]
    BetweenRobots(ProximityError),
    /// There is no structure with this number.
    #[error(
        "there is no structure {structure} among {structures}; give the number that `add` returned"
    )]
    NoSuchStructure {
        /// The number that was given.
        structure: usize,
        /// How many structures there are.
        structures: usize,
    },
}

impl SceneError {
    /// What went wrong in one word, the same in Rust and Python: that of the error that it passes
    /// on.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Structure { error, .. }
            | Self::Robot { error, .. }
            | Self::BetweenRobots(error) => error.kind(),
            Self::NoSuchStructure { .. } => "no_such_structure",
        }
    }
}
