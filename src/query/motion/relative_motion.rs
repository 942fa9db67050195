//! The trait of moving parts beside an obstacle or each other.

use super::approach_bound::Approach;
use super::refinement::BoundedPiece;
use crate::answer::ProximityError;
use crate::refine::Refinable;
use parry3d_f64::math::Real;

/// Parts that move in an interval of time.
pub(crate) trait RelativeMotion<D: Refinable, P> {
    /// Returns two speeds whose sum bounds the speed at which a part and its obstacle approach each
    /// other: of both pieces; or of the centreline, and of the points beside it and the obstacle.
    ///
    /// # Errors
    /// A stated speed is negative or not finite.
    fn speeds(
        &mut self,
        part: &P,
        piece: &D::Piece,
        body: &D::Body,
        divided: &D,
    ) -> Result<[Real; 2], ProximityError>;

    /// Returns how much more a part may turn than its middle shape shows. 0 if turns do not matter:
    /// only self contact asks for them.
    fn extra_turn(&self, _: &P, _: &D) -> Real {
        0.0
    }

    /// Whether a limit of work is reached.
    fn is_exhausted(&self) -> bool {
        false
    }

    /// A triangle that is probably near, if there are triangles.
    fn seed_triangle(&self) -> Option<u32> {
        None
    }

    /// Records what was found.
    fn record(&mut self, _: &BoundedPiece<D, P>) {}

    /// Records a part that the middle shape does not decide for the whole interval. A motion that
    /// records none tests all its parts again, in the time that the `hold` of the approach bound
    /// leaves.
    fn record_unresolved(&mut self, _: &BoundedPiece<D, P>, _: &Approach) {}

    /// Returns the fastest section of a part, and the speed of that section.
    fn fastest_section(&self, bounded: &BoundedPiece<D, P>, approach: &Approach) -> (usize, Real);
}
