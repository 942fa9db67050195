//! Robot against mesh: every engine, and the proofs of its answers.

mod agreement;
mod allocations;
mod certify;
mod chain_cases;
mod contacts;
mod derivatives;
mod far_parts;
mod fuzz;
mod large;
mod motion;
mod patches;
mod planner;
mod scenes;
mod thin_links;
mod ties;
mod tube;
