//! Several structures and robots at once.

mod batch;
mod structure;
mod whole;

pub use whole::Scene;
