//! The laboratory beside `parry-continuum`: what its programs measure with, and what exists only to
//! compare it with the paper (Leibrandt and Yang, "Efficient Proximity Queries for Continuum Robots
//! on Parallel Computing Hardware").
//!
//! | what | modules |
//! |---|---|
//! | accuracy | [`accuracy`]: the errors on reference cases and at the extremes, and the tables that tests enforce |
//! | the paper's routes | [`quartic`]: segment to disc by roots; [`every_pair`]: an engine by any route |
//! | the same on the GPU | `gpu` (feature `gpu`) |
//! | scenes | [`models`]: the robot of the paper's comparisons |
//! | costs | [`counted`] numbers; [`machine`] |
//! | pages | [`quote`]: what a program writes between marks; [`long_table`]: rows for the page, the rest for a file |

pub mod accuracy;
pub mod counted;
pub mod every_pair;
#[cfg(feature = "gpu")]
pub mod gpu;
pub mod long_table;
pub mod machine;
pub mod models;
mod number;
pub mod quartic;
pub mod quote;

pub use number::Number;
