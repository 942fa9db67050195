//! What the tests and measurements of `parry-continuum` share, so that all of them ask and judge
//! alike.
//!
//! | what | modules |
//! |---|---|
//! | questions | [`problems`] that break distance code; [`Arcs`], curves of known curvature; [`Case`], references known to 30 digits; [`placements`] aligned and touching; [`LevelLinks`] side by side; [`Random`], the same anywhere |
//! | the narrow phase | [`narrow_phase`], its functions compiled once; [`kernels`], every public one on one input; [`precision`], one text for `f32` and `f64` |
//! | effort | [`rounds`], how many rounds a random test runs |
//! | judges | [`certificate`], proofs in double-double arithmetic; [`rotation`]s that round nothing |
//! | the fuzzer | `fuzz`, bodies that take any bytes (feature `fuzz`) |
//! | around | `programs`, run as a user does (feature `programs`); `gpu`, opened once (feature `gpu`) |

mod arcs;
mod cases;
pub mod certificate;
pub mod disc_problems;
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
#[cfg(feature = "programs")]
pub mod programs;
mod random;
pub mod rotation;

pub use arcs::{Arcs, Stretch};
pub use cases::{Case, LinkCase, distance_cases, link_cases, read_lines};
pub use effort::rounds;
pub use level::{LevelLinks, found_level_links};
pub use random::Random;

/// The answers of a batch, each of which there has to be.
pub fn answered<T: Clone, E: std::fmt::Debug>(batch: &[Result<T, E>]) -> Vec<T> {
    batch.iter().map(|answer| answer.as_ref().expect("an answer").clone()).collect()
}
