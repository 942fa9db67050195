//! The number of rounds of a random test.

use std::env;

/// The share of its rounds that a random test runs by default. It keeps `cargo test` short.
const DEFAULT: f64 = 0.25;

/// Returns the number of rounds to run of a random test that has `full` rounds: at least one.
///
/// The environment variable `PARRY_CONTINUUM_EFFORT` sets the share; `.ci/everything` sets it to 1.
/// Counts that a test requires of its sample scale by the same share.
///
/// # Panics
/// If the variable is not a positive number.
pub fn rounds(full: usize) -> usize {
    let share = env::var("PARRY_CONTINUUM_EFFORT").map_or(DEFAULT, |share| {
        let share = share.parse().ok().filter(|share: &f64| share.is_finite() && *share > 0.0);
        share.expect("PARRY_CONTINUUM_EFFORT is a positive number")
    });
    (full as f64 * share).ceil() as usize
}
