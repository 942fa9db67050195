//! What a tube is to a mesh: convex bodies around its pieces, and points that are in it.

mod outer;
mod piece;
mod placed_tube;
#[cfg(test)]
mod tests;
mod witness;

pub(crate) use outer::Outer;
pub(crate) use piece::Piece;
pub(crate) use placed_tube::PlacedTube;
pub(crate) use witness::Witness;
