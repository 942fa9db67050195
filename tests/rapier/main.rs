//! Links and chains in rapier worlds.

mod beam;
mod chain;
mod drop;
mod fast;
mod long;
mod rest;
mod setup;
mod soft;
mod units;
