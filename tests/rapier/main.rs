//! Links and chains in rapier worlds.

mod beam;
mod chain;
mod drop;
mod fast;
mod long;
#[path = "../../examples/scene/random.rs"]
#[allow(dead_code, reason = "other tests use more of it")]
mod random;
mod rest;
#[path = "../../examples/rapier_ventricle/rod.rs"]
mod rod;
#[path = "../../examples/scene/mod.rs"]
mod scene;
mod setup;
mod soft;
mod units;
