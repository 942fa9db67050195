//! Several structures and robots at once.

mod around;
mod batch;
mod structure;
mod surroundings;
mod watch;
mod whole;

pub use whole::Scene;
