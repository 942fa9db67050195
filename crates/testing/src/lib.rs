//! Shared code of the tests and measurements of `parry-continuum`.
//!
//! - Inputs: [`problems`] that break distance code; [`Arcs`], curves of known curvature; [`Case`],
//!   references to 30 digits; [`placements`] that are aligned and touch; [`LevelLinks`] side by
//!   side; [`Random`], the same on every machine.
//! - The narrow phase: [`narrow_phase`], its functions compiled once; [`kernels`], every public
//!   function on one input; [`precision`], one text for `f32` and `f64`.
//! - Effort: [`rounds`], the number of rounds of a random test.
//! - Memory: [`WarmAndFresh`], one engine after earlier queries and one without.
//! - Checks: [`certificate`], proofs in double-double arithmetic; [`rotation`]s without rounding.
//! - The fuzzer: `fuzz`, bodies that accept any bytes (feature `fuzz`).
//! - In rapier: `throws`, bodies thrown onto walls (feature `rapier`).
//! - Environment: `gpu`, opened once (feature `gpu`).

mod arcs;
mod cases;
pub mod certificate;
pub mod disc_problems;
mod earlier;
mod effort;
#[cfg(feature = "fuzz")]
pub mod fuzz;
#[cfg(feature = "gpu")]
pub mod gpu;
pub mod kernels;
mod level;
pub mod narrow_phase;
pub mod placements;
pub mod precision;
pub mod problems;
mod random;
pub mod rotation;
#[cfg(feature = "rapier")]
pub mod throws;

pub use arcs::{Arcs, Stretch};
pub use cases::{Case, LinkCase, distance_cases, link_cases, read_lines};
pub use earlier::WarmAndFresh;
pub use effort::rounds;
pub use level::{LevelLinks, found_level_links};
pub use random::Random;

/// Returns the answers of a batch; all must be `Ok`.
pub fn answered<T: Clone, E: std::fmt::Debug>(batch: &[Result<T, E>]) -> Vec<T> {
    batch.iter().map(|answer| answer.as_ref().expect("an answer").clone()).collect()
}
