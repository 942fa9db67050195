//! Robot against mesh: every engine, and the proofs of its answers.

mod agreement;
mod allocations;
mod certify;
mod chain_cases;
mod coherence;
mod contacts;
mod derivatives;
mod discs;
mod far_parts;
mod fuzz;
mod large;
mod motion;
mod moved;
mod parity;
mod patches;
mod pieces;
mod planner;
mod rings;
mod scenes;
mod side;
mod thin_links;
mod threads;
mod ties;
mod tube;
mod tube_jumps;
mod visits;
