//! What moves, whatever it moves beside.

use super::approach_bound::ApproachBound;
use crate::answer::ProximityError;
use crate::pieces::{BoundedPiece, Refinable};
use parry3d_f64::math::Real;

/// Parts that move in an interval of time.
pub(crate) trait RelativeMotion<D: Refinable, P> {
    /// How fast a part and what it is beside move towards each other at most.
    ///
    /// # Errors
    /// A stated speed is not finite and at least 0.
    fn speed(
        &mut self,
        part: &P,
        piece: &D::Piece,
        body: &D::Body,
        divided: &D,
    ) -> Result<Real, ProximityError>;

    /// By how much more a part may turn than its middle shape shows, where that decides whether it
    /// is asked about.
    fn extra_turn(&self, _: &P, _: &D) -> Real {
        0.0
    }

    /// Whether no more parts are to be looked at, for want of an end.
    fn is_exhausted(&self) -> bool {
        false
    }

    /// A triangle that is likely to be near, where there are triangles.
    fn seed_triangle(&self) -> Option<u32> {
        None
    }

    /// Takes note of what was found.
    fn record(&mut self, _: &BoundedPiece<D, P>) {}

    /// Takes note of a part about which the middle shape decides nothing for the whole interval; if
    /// the pace, which knows for how long all the others keep the margin, is not enough.
    fn record_unresolved(&mut self, _: &BoundedPiece<D, P>, _: &ApproachBound) {}

    /// The section that is the fastest of a part which approaches so fast, and how fast it is.
    fn fastest_section(&self, near: &BoundedPiece<D, P>, speed: Real) -> (usize, Real);
}
