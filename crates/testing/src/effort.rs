//! The number of rounds of a random test.

use std::env;

/// The share of its rounds that a random test runs by default. It keeps `cargo test` short.
const DEFAULT: f64 = 0.1;

/// Returns the number of rounds to run of a random test that has `full` rounds: at least one.
///
/// The environment variable `PARRY_CONTINUUM_EFFORT` sets the share; `.ci/everything` sets it to 1.
/// Counts that a test requires of its sample scale by the same share.
///
/// # Panics
/// If the variable is not a positive number, or the result does not fit.
pub fn rounds<N: Copy + TryInto<u32> + TryFrom<u32>>(full: N) -> N {
    let share = env::var("PARRY_CONTINUUM_EFFORT").map_or(DEFAULT, |share| {
        let share = share.parse().ok().filter(|share: &f64| share.is_finite() && *share > 0.0);
        share.expect("PARRY_CONTINUUM_EFFORT is a positive number")
    });
    let full: u32 = full.try_into().ok().expect("a count");
    N::try_from((f64::from(full) * share).ceil() as u32).ok().expect("a count of the same type")
}
