//! A tube in pieces: convex bodies around them, points that are in them, and the two loops that divide them.

mod best_first;
mod divided;
mod nearest_pairs;
mod on_loose_tube;
mod on_tube;
mod outer;
mod own_moves;
#[cfg(test)]
mod own_moves_tests;
mod own_tube;
mod piece;
mod placed_tube;
mod refine;
#[cfg(test)]
mod tests;
mod tube_in_mesh;
mod two_tubes;

pub(crate) use best_first::{Examined, MOST_LEVELS, PendingPiece, PendingPieces, PieceState};
pub(crate) use divided::{Body, Bound, Divided};
pub(crate) use outer::Outer;
pub(crate) use own_moves::{MOST_GROWTH, Moved, OwnMoves};
pub(crate) use own_tube::{OwnBeginning, OwnPair, OwnTube};
pub(crate) use piece::Piece;
pub(crate) use placed_tube::PlacedTube;
pub(crate) use refine::{Look, Near, Part, Question, Verdict, refine};
pub(crate) use tube_in_mesh::{Found, TubeInMesh};
pub(crate) use two_tubes::{Beginning, FoundBetween, PiecePair, Stretch, TwoTubes};
