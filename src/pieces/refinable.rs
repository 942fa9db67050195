//! What a question divides: a tube on its way through a mesh, or two tubes beside one another.

use crate::answer::ProximityError;
use parry3d_f64::math::Real;

/// What can be divided into pieces, each in a convex body, and is the nearer to something else the
/// better it is known.
pub(crate) trait Refinable {
    /// A piece: of one tube, or one of each.
    type Piece: Copy;
    /// What holds a piece.
    type Body: Body;
    /// What is nearest to a body.
    type Nearest;
    /// An upper bound on the clearance, and what realises it.
    type Upper: UpperBound;

    fn body(&self, piece: &Self::Piece) -> Self::Body;

    /// Where a piece is: an order of pieces that do not overlap.
    fn place(&self, piece: &Self::Piece) -> [u32; 4];

    /// (Apart from [`body`](Self::body), whose answer is large: a `Result` of it would be copied
    /// once more for each piece.)
    ///
    /// # Errors
    /// The curve is not finite there, and so the body.
    fn check_finite(&self, piece: &Self::Piece, body: &Self::Body) -> Result<(), ProximityError>;

    /// The halves of a piece whose body can become narrower, and at a face as near to the tube as
    /// `aim`.
    fn halves(&self, piece: &Self::Piece, body: &Self::Body, aim: Real)
    -> Option<[Self::Piece; 2]>;

    /// Whether anything may be at most `bound` away from a body.
    fn may_meet(&mut self, body: &Self::Body, bound: Real) -> bool;

    /// What is nearest to a body, if it is at most `bound` away; `start` is a triangle that is
    /// likely to be near, where there are triangles.
    fn nearest(
        &mut self,
        body: &Self::Body,
        bound: Real,
        start: Option<u32>,
    ) -> Option<Self::Nearest>;

    /// How far away that is, which bounds the clearance of the piece from below.
    fn distance(nearest: &Self::Nearest) -> Real;

    /// What bounds the clearance from above, as seen from there.
    fn found(&self, piece: &Self::Piece, body: &Self::Body, nearest: &Self::Nearest)
    -> Self::Upper;

    /// Whether that is in the first of two halves.
    fn is_in_first_half(&self, found: &Self::Upper, halves: &[Self::Piece; 2]) -> bool;

    /// The larger radius of a piece.
    fn radius(&self, piece: &Self::Piece) -> Real;

    /// How far apart the bounds of a piece have to be because of what was stated of the direction
    /// of a face nearby, or was not.
    fn direction_uncertainty(&self, piece: &Self::Piece) -> Real;

    /// Whether all of a piece is known to be what is asked about, of which something was found.
    fn is_entirely_queried(&self, _: &Self::Piece, _: &Self::Upper) -> bool {
        true
    }

    /// Whether a piece has a flat end that bodies take for round, since it may become so while it
    /// moves.
    fn may_become_round(&self, _: &Self::Piece) -> bool {
        false
    }

    /// What stated errors cost a clearance: they count in both bounds.
    fn position_uncertainty(&self) -> Real;

    /// What rounding can do to any length.
    fn slack(&self) -> Real;

    /// How far apart the bounds of a piece have to be because of all that was stated, or was not.
    fn uncertainty(&self, piece: &Self::Piece) -> Real {
        self.position_uncertainty() + self.direction_uncertainty(piece)
    }

    /// # Errors
    /// The bounds are farther apart than the resolution, but for rounding: the samples allow no
    /// more.
    fn check_resolved(&self, possible: Real, resolution: Real) -> Result<(), ProximityError> {
        // Written so that NaN is an error.
        if possible <= resolution + 16.0 * self.slack() {
            Ok(())
        } else {
            Err(ProximityError::ToleranceTooFine {
                parameter: "resolution",
                tolerance: resolution,
                possible,
            })
        }
    }
}

/// What holds a piece, seen as what it holds too much.
pub(crate) trait Body: Copy {
    /// By how much, about, it is larger than the piece.
    fn excess(&self) -> Real;
}

/// An upper bound on a clearance.
pub(crate) trait UpperBound: Copy {
    fn upper(&self) -> Real;

    /// The triangle that realises it, if one does.
    fn triangle(&self) -> Option<u32>;

    /// Of equal bounds the one with the least of these is the answer: triangle and section, or two
    /// sections.
    fn tie(&self) -> [u32; 2];
}
