//! What a refinement divides: a tube in a mesh, two tubes, or one tube beside itself, at rest or in
//! the shape at one instant of a motion.

use crate::answer::ProximityError;
use parry3d_f64::math::Real;

/// A shape that is divided into pieces, each with a convex body.
///
/// The distance of a body is a lower bound on the clearance of its piece. The bound improves as
/// pieces become shorter.
pub(crate) trait Refinable {
    /// One piece of one tube, or one piece of each of two tubes.
    type Piece: Copy;
    /// The bounding volume of a piece.
    type Body: Body;
    /// The nearest triangle or link to a body.
    type Nearest;
    /// An upper bound on the clearance, with the place that realises it.
    type Upper: UpperBound;

    fn body(&self, piece: &Self::Piece) -> Self::Body;

    /// The place of a piece along the tube: an order of pieces that do not overlap.
    fn place(&self, piece: &Self::Piece) -> [u32; 4];

    /// Checks the body of a piece. ([`body`](Self::body) returns no `Result`: the body is large,
    /// and the `Result` would copy it once more per piece.)
    ///
    /// # Errors
    /// The curve of the piece, and so its body, is not finite.
    fn check_finite(&self, piece: &Self::Piece, body: &Self::Body) -> Result<(), ProximityError>;

    /// Returns the halves of a piece; `None` if halving does not make its body narrower.
    ///
    /// At a face the short half is chosen so that its body exceeds the tube by at most about `aim`.
    fn halves(&self, piece: &Self::Piece, body: &Self::Body, aim: Real)
    -> Option<[Self::Piece; 2]>;

    /// Whether the obstacle may be at most `bound` away from a body (conservative).
    fn may_meet(&mut self, body: &Self::Body, bound: Real) -> bool;

    /// Returns what is nearest to a body, if it is at most `bound` away. `start`: a triangle that
    /// is probably near; ignored without triangles.
    fn nearest(
        &mut self,
        body: &Self::Body,
        bound: Real,
        start: Option<u32>,
    ) -> Option<Self::Nearest>;

    /// Returns the distance of `nearest`: a lower bound on the clearance of the piece.
    fn distance(nearest: &Self::Nearest) -> Real;

    /// Returns the upper bound on the clearance that `nearest` yields.
    fn found(&self, piece: &Self::Piece, body: &Self::Body, nearest: &Self::Nearest)
    -> Self::Upper;

    /// Whether the place of the upper bound lies in the first of two halves.
    fn is_in_first_half(&self, found: &Self::Upper, halves: &[Self::Piece; 2]) -> bool;

    /// Returns the larger radius of a piece.
    fn radius(&self, piece: &Self::Piece) -> Real;

    /// Returns the gap between the bounds of a piece that unknown or uncertain directions of nearby
    /// faces cause.
    fn direction_uncertainty(&self, piece: &Self::Piece) -> Real;

    /// Whether the whole piece belongs to the queried set, given its upper bound.
    fn is_entirely_queried(&self, _: &Self::Piece, _: &Self::Upper) -> bool {
        true
    }

    /// Whether bodies treat a flat end of the piece as round because it may become round in the
    /// motion.
    fn may_become_round(&self, _: &Self::Piece) -> bool {
        false
    }

    /// Returns the gap between the bounds that the stated position errors cause.
    fn position_uncertainty(&self) -> Real;

    /// A bound on the rounding error of any length.
    fn slack(&self) -> Real;

    /// Returns the gap between the bounds of a piece that all stated or missing information causes.
    fn uncertainty(&self, piece: &Self::Piece) -> Real {
        self.position_uncertainty() + self.direction_uncertainty(piece)
    }

    /// Checks that bounds that are `possible` apart meet the resolution, up to rounding.
    ///
    /// # Errors
    /// `possible > resolution`: the samples allow no finer resolution.
    fn check_resolved(&self, possible: Real, resolution: Real) -> Result<(), ProximityError> {
        // This form makes NaN an error.
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

/// The bounding volume of a piece, or of a pair of pieces.
pub(crate) trait Body: Copy {
    /// By about how much the body is larger than the piece.
    fn excess(&self) -> Real;

    /// Whether an end of the body is flat.
    fn is_flat(&self) -> bool;
}

/// An upper bound on a clearance.
pub(crate) trait UpperBound: Copy {
    fn upper(&self) -> Real;

    /// The triangle that realises the bound, if there is one.
    fn triangle(&self) -> Option<u32>;

    /// The tie order: of equal bounds the least `tie` is the answer (triangle and section, or two
    /// sections).
    fn tie(&self) -> [u32; 2];
}
