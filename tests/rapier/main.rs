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
mod seams;
mod setup;
mod soft;
mod throws;
mod units;
