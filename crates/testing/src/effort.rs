//! How much a random test does.

use std::env;

/// The share of its rounds that a random test runs by default, so that `cargo test` stays short.
const DEFAULT: f64 = 0.25;

/// The number of rounds to run of a random test that has `full` rounds: at least one.
///
/// `PARRY_CONTINUUM_EFFORT` is the share; it is 1 in `.ci/everything`. What a test asserts of its
/// sample scales alike.
///
/// # Panics
/// If the variable holds no positive number.
pub fn rounds(full: usize) -> usize {
    let share = env::var("PARRY_CONTINUUM_EFFORT").map_or(DEFAULT, |share| {
        let share = share.parse().ok().filter(|share: &f64| share.is_finite() && *share > 0.0);
        share.expect("PARRY_CONTINUUM_EFFORT is a positive number")
    });
    (full as f64 * share).ceil() as usize
}
