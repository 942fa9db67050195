//! The policy that bounds the least clearance of pieces during an interval of time, from the middle
//! shape.
//!
//! # Definitions
//! See `minimum_rounds` for `upper`, aim, `wanted`, d, nearer and direction gap.
//!
//! # Algorithm
//! A body beyond `upper + nearer + slack` is settled. Otherwise its upper bound may lower `upper`,
//! and then:
//! 1. **Settled** if `d - nearer - slack >= wanted`.
//! 2. **Settled** with a larger gap if only the unknown direction of a face prevents the decision.
//! 3. **Unresolved** if the piece is not fine (`nearer > aim / 4`) and the motion prevents the
//!    decision. Shorter intervals test the piece again; around t it stays `wanted` away for the
//!    time `hold`.
//! 4. **Halve** otherwise.

use super::approach_bound::{Approach, ApproachBound};
use super::minimum_rounds::{MinimumBounds, UnresolvedGap};
use super::refinement::{BodyQuery, BoundedPiece, RefineAction, RefinePolicy};
use super::relative_motion::RelativeMotion;
use crate::answer::ProximityError;
use crate::refine::{Body, Refinable, UpperBound};
use parry3d_f64::math::Real;

/// The most pieces processed per shape; after them no piece is halved.
const MAX_PIECES_PER_INTERVAL: u32 = 1 << 16;

/// The policy for the middle shape of an interval.
pub(super) struct MinimumPolicy<'b, V, U> {
    pub moving: V,
    pub approach_bound: ApproachBound,
    pub known: &'b mut MinimumBounds<U>,
    t: Real,
    /// The permitted gap between the bounds of the answer.
    aim: Real,
    /// The least lower bound of the unresolved pieces.
    pub nearest: Real,
    /// How many pieces may still be halved.
    left: u32,
}

impl<'b, V, U: UpperBound> MinimumPolicy<'b, V, U> {
    /// `slack`: that of the shape at `t`.
    pub fn new(
        moving: V,
        approach_bound: ApproachBound,
        known: &'b mut MinimumBounds<U>,
        t: Real,
        slack: Real,
    ) -> Self {
        // The bounds of the answer must meet the tolerance after rounding.
        let aim = (known.tolerance + known.uncertainty - 4.0 * slack).max(0.0);
        Self {
            moving,
            approach_bound,
            known,
            t,
            aim,
            nearest: Real::INFINITY,
            left: MAX_PIECES_PER_INTERVAL,
        }
    }

    /// The permitted gap between the bounds.
    #[cfg(feature = "robots")]
    pub fn aim(&self) -> Real {
        self.aim
    }

    /// Pieces that may come nearer than this matter.
    pub fn wanted(&self) -> Real {
        self.known.upper() - self.aim
    }

    pub fn settle(&mut self, lower: Real) {
        self.known.lower = self.known.lower.min(lower);
    }

    /// Records a piece that must be tested at other times.
    fn record_unresolved<D: Refinable<Upper = U>, P>(
        &mut self,
        tube: &D,
        bounded: &BoundedPiece<D, P>,
        approach: &Approach,
    ) where
        V: RelativeMotion<D, P>,
    {
        let wanted = self.wanted();
        self.nearest = self.nearest.min(lower_bound(tube, bounded, approach));
        // During `hold` the piece stays at least this far away.
        self.settle(wanted);
        let room = D::distance(bounded.nearest) - wanted - tube.slack();
        self.approach_bound.limit_hold(approach, room);
        self.moving.record_unresolved(bounded, approach);
    }
}

/// Returns a lower bound on the clearance of a piece in the interval: `d - nearer - slack`.
fn lower_bound<D: Refinable, P>(
    tube: &D,
    bounded: &BoundedPiece<D, P>,
    approach: &Approach,
) -> Real {
    D::distance(bounded.nearest) - approach.distance - tube.slack()
}

impl<D: Refinable, P, V: RelativeMotion<D, P>> RefinePolicy<D, P>
    for MinimumPolicy<'_, V, D::Upper>
{
    const NEARER_HALF_FIRST: bool = true;

    /// A clearance below 0 does not exist.
    fn is_done(&self) -> bool {
        self.wanted() < 0.0 || self.moving.is_exhausted()
    }

    fn body_query(
        &mut self,
        tube: &D,
        part: &P,
        piece: &D::Piece,
        outer: &D::Body,
    ) -> Result<(BodyQuery, Approach), ProximityError> {
        self.left = self.left.saturating_sub(1);
        let approach =
            self.approach_bound.of_piece(self.moving.speeds(part, piece, outer, tube)?, 0.0);
        let (approached, upper) = (approach.distance, self.known.upper());
        let is_wide = self.left > 0
            && outer.excess() > 2.0 * self.aim.max(approached)
            && (outer.is_flat() || outer.excess() > 0.25 * upper);
        // Not `wanted`: a piece farther than `upper` is settled for all later rounds.
        let bound = upper + approached + tube.slack();
        let (aim, start) = (self.aim.max(approached), self.moving.seed_triangle());
        Ok((BodyQuery { bound, is_wide, aim, start }, approach))
    }

    fn on_cleared(&mut self) {
        self.settle(self.known.upper());
    }

    fn decide(
        &mut self,
        tube: &D,
        bounded: &BoundedPiece<D, P>,
        approach: &Approach,
    ) -> Result<RefineAction, ProximityError> {
        self.moving.record(bounded);
        self.known.offer(*bounded.found, self.t);
        if self.is_done() {
            return Ok(RefineAction::Answered);
        }
        let (lower, wanted) = (lower_bound(tube, bounded, approach), self.wanted());
        if lower >= wanted || self.left == 0 {
            self.settle(lower);
            return Ok(RefineAction::Settled);
        }
        let (approached, direction_gap) =
            (approach.distance, tube.direction_uncertainty(bounded.piece));
        if direction_gap > 0.0 && approached <= 0.25 * self.aim && lower >= wanted - direction_gap {
            let UnresolvedGap { lower: least, direction_gap: most } = self.known.unresolved;
            self.known.unresolved =
                UnresolvedGap { lower: least.min(lower), direction_gap: most.max(direction_gap) };
            self.settle(lower);
            return Ok(RefineAction::Settled);
        }
        if approached > 0.25 * self.aim
            && (bounded.found.upper() <= wanted + approached
                || bounded.outer.excess() <= 0.25 * approached)
        {
            self.record_unresolved(tube, bounded, approach);
            return Ok(RefineAction::Settled);
        }
        Ok(RefineAction::Halve(self.aim.max(0.25 * bounded.outer.excess())))
    }

    fn decide_indivisible(
        &mut self,
        tube: &D,
        bounded: &BoundedPiece<D, P>,
        approach: &Approach,
    ) -> Result<(), ProximityError> {
        let approached = approach.distance;
        let is_fine = if tube.may_become_round(bounded.piece) {
            approached.max(self.approach_bound.cap_change) <= self.aim / 128.0
        } else {
            approached
                <= (0.25 * self.aim).max(bounded.found.upper() - D::distance(bounded.nearest))
        };
        if is_fine {
            self.settle(lower_bound(tube, bounded, approach));
        } else {
            self.record_unresolved(tube, bounded, approach);
        }
        Ok(())
    }
}
