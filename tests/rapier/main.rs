//! Links and chains in rapier worlds.

mod beam;
mod chain;
mod drop;
mod fast;
#[path = "../../examples/scene/random.rs"]
#[allow(dead_code, reason = "other tests use more of it")]
mod random;
mod rest;
mod setup;
mod soft;
mod units;
