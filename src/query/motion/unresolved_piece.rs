//! The pieces that the middle shape of an interval does not decide by their speed.

use super::pending_piece::PendingPiece;
use crate::pair::PlacedLink;
use parry3d_f64::math::{Real, Vector};

/// With more unresolved pieces in an interval, displacements are not tested: another shape is
/// cheaper.
pub(super) const MAX_DISPLACED_PIECES: usize = 8;

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
