//! A tube divided into pieces: bounding volumes, points inside the tube, and the order in which
//! pieces are divided (`best_first`).

mod best_first;
mod bounding_body;
#[cfg(feature = "robots")]
mod capsule_tree;
mod placed_tube;
mod refinable;
#[cfg(feature = "robots")]
mod section_motions;
#[cfg(test)]
mod section_motions_tests;
#[cfg(test)]
mod tests;
mod tube_in_mesh;
#[cfg(feature = "robots")]
mod tube_pair;
mod tube_point;
#[cfg(feature = "robots")]
mod tube_with_itself;

pub(crate) use best_first::{Examined, MOST_LEVELS, PendingPiece, PendingPieces, PieceState};
pub(crate) use bounding_body::{BoundingBody, SectionRange};
pub(crate) use placed_tube::{Piece, PlacedTube};
pub(crate) use refinable::{Body, Refinable, UpperBound};
#[cfg(feature = "robots")]
pub(crate) use section_motions::{MAX_EXTRA_TURN, SectionMotion, SectionMotions};
pub(crate) use tube_in_mesh::{MeshUpperBound, TubeInMesh};
#[cfg(feature = "robots")]
pub(crate) use tube_pair::{PairQueue, PairUpperBound, PiecePair, TubePair};
#[cfg(feature = "robots")]
pub(crate) use tube_with_itself::{SelfPair, SelfPairQueue, TubeWithItself};
