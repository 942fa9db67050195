//! How much a random test does.

use std::env;

/// The share of its rounds that a random test runs by default, so that `cargo test` stays short.
const DEFAULT: f64 = 0.25;

/// The number of rounds to run of a random test that has `full` rounds: at least one.
///
/// `PARRY_CONTINUUM_EFFORT` is the share; it is 1 in `.ci/everything`. Counts that a test asserts
/// of its sample scale alike.
///
/// # Panics
/// If the variable holds no positive number, or the result does not fit.
pub fn rounds<N: Copy + TryInto<u32> + TryFrom<u32>>(full: N) -> N {
    let share = env::var("PARRY_CONTINUUM_EFFORT").map_or(DEFAULT, |share| {
        let share = share.parse().ok().filter(|share: &f64| share.is_finite() && *share > 0.0);
        share.expect("PARRY_CONTINUUM_EFFORT is a positive number")
    });
    let full: u32 = full.try_into().ok().expect("a count");
    N::try_from((f64::from(full) * share).ceil() as u32).ok().expect("a count of the same type")
}
