//! A pending piece of a moving robot, independent of the shape.

use super::refinement::WorkItem;
use crate::refine::{Piece, PlacedTube, TubeInMesh};
use parry3d_f64::math::Real;

/// A range of shares of a section.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PendingPiece {
    pub section: u32,
    pub shares: [Real; 2],
    /// Whether the piece is left before and after the middle shape in which it was unresolved.
    pub is_left: [bool; 2],
}

impl PendingPiece {
    /// Returns a piece of a shape as a range of shares.
    pub(crate) fn of(piece: &Piece, tube: &PlacedTube) -> Self {
        Self { section: piece.section, shares: tube.shares(piece), is_left: [true; 2] }
    }
}

impl WorkItem<TubeInMesh<'_>> for PendingPiece {
    fn piece(&self, tube: &TubeInMesh) -> Piece {
        tube.tube.between(self.section, self.shares)
    }

    fn halves(self, tube: &TubeInMesh, halves: [Piece; 2]) -> [Self; 2] {
        let [_, between] = tube.tube.shares(&halves[0]);
        let [from, to] = self.shares;
        [
            Self { shares: [from, between.min(to)], ..self },
            Self { shares: [between.max(from), to], ..self },
        ]
    }
}
