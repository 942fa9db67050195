//! Several structures and robots at once.

mod structure;
mod whole;

pub use whole::Scene;
