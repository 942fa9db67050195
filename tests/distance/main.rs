//! The narrow phase: every pair of simple shapes, in every precision.

mod against_parry;
mod cases;
mod census;
mod certificate;
mod deep;
mod discs;
mod errata;
mod errata_links;
#[cfg(feature = "laboratory")]
mod lanes;
mod link_links;
mod metamorphic;
mod slivers;
