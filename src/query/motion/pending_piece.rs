//! The pieces of a moving robot that an interval has to test, independent of the shape; and those
//! that its middle shape does not decide by their speed.

use super::refinement::WorkItem;
use crate::pair::PlacedLink;
use crate::refine::{Piece, PlacedTube, TubeInMesh};
use parry3d_f64::math::{Real, Vector};

/// With more unresolved pieces in an interval, displacements are not tested: another shape is
/// cheaper.
pub(super) const MAX_DISPLACED_PIECES: usize = 8;

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

/// The unresolved pieces of the current interval.
pub(crate) struct UnresolvedPieces<'a> {
    /// The pieces of earlier intervals, then the pieces of this one.
    pub pieces: &'a mut Vec<PendingPiece>,
    /// The index of the first piece of this interval.
    pub first: usize,
    /// The bodies of the pieces of this interval, at most [`MAX_DISPLACED_PIECES`] + 1.
    pub bodies: &'a mut Vec<UnresolvedPiece>,
}

/// The body of an unresolved piece, while its interval is tested.
#[derive(Clone)]
pub(crate) struct UnresolvedPiece {
    pub body: PlacedLink,
    /// The distance of the body from the nearest triangle.
    pub away: Real,
    /// The direction from that triangle to the body. Zero if they touch; no plane test passes then.
    pub normal: Vector,
    /// How much nearer the piece may come in the interval.
    pub approach: Real,
    /// The part of `approach` that is not the centreline's: rim and mesh.
    pub beside: Real,
}
