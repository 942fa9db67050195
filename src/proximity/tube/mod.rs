//! What a tube is to a mesh: convex bodies around its pieces, and points that are in it.

mod outer;
mod piece;
mod placed;
mod report;
#[cfg(feature = "serde-serialize")]
mod serialised;
#[cfg(test)]
mod tests;
mod witness;

pub(super) use outer::Outer;
pub(super) use piece::Piece;
pub(super) use placed::PlacedTube;
pub use report::{Clearance, Decision, TubePiece};
#[cfg(feature = "serde-serialize")]
pub(super) use serialised::check_place;
pub(super) use witness::Witness;
