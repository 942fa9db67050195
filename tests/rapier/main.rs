//! Links and chains in rapier worlds.

mod aligned;
mod beam;
mod chain;
mod drawn;
mod drop;
mod fast;
mod long;
mod rest;
mod robots;
mod setup;
mod soft;
mod throws;
mod units;
