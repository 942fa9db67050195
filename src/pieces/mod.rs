//! What a tube is to a mesh: convex bodies around its pieces, and points that are in it.

mod on_tube;
mod outer;
mod piece;
mod placed_tube;
#[cfg(test)]
mod tests;

pub(crate) use on_tube::OnTube;
pub(crate) use outer::Outer;
pub(crate) use piece::Piece;
pub(crate) use placed_tube::PlacedTube;
