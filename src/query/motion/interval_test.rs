//! The policy that tests whether pieces keep a margin during an interval of time, from the middle
//! shape.
//!
//! # Definitions
//! - d, upper: the lower and the upper bound on the clearance of a piece in the middle shape.
//! - approach: tau V, how much nearer the piece may come in the interval
//!   ([`Approach::distance`]).
//! - **Fine**: approach <= resolution / 2, and the extra turn is at most [`MIN_EXTRA_TURN`]. The
//!   middle shape then decides. (The extra turn is 0 beside a mesh: it matters in self contact.)
//!
//! # Algorithm
//! A body beyond margin + approach + slack is cleared. Otherwise:
//! 1. **Contact** if upper <= margin.
//! 2. **Unresolved** if the piece is not fine and the motion prevents the decision: `upper <=
//!    margin + approach + slack`, or the body's excess is at most approach / 4. Shorter intervals
//!    test the piece again.
//! 3. **Undecided** if the piece is fine and its bounds are at most resolution / 2 apart, beside
//!    stated uncertainty.
//! 4. **Halve** otherwise. A piece without halves that is fine is an error of the samples if only
//!    they prevent the decision. It is undecided if none of its ends may become round, or if those
//!    ends move by at most [`ROUND_END`] of the resolution. Otherwise it is unresolved.

use super::approach_bound::{Approach, ApproachBound, check_subdivision};
use super::refinement::{BodyQuery, BoundedPiece, RefineAction, RefinePolicy};
use super::relative_motion::RelativeMotion;
use crate::answer::{ProximityError, UndecidedReason};
use crate::refine::{Body, Refinable, UpperBound};
use parry3d_f64::math::Real;

/// The extra turn (rad) beyond the middle shape up to which that shape decides.
const MIN_EXTRA_TURN: Real = 1.0 / 64.0;

/// The share of the resolution by which an end that may become round moves in an interval that
/// shows the instant of the change well enough. Any small share would do.
const ROUND_END: Real = 1.0 / 128.0;

/// The margin to be kept, and the resolution of the answer.
#[derive(Clone, Copy)]
pub(crate) struct MarginQuery {
    pub margin: Real,
    pub resolution: Real,
}

/// The result of testing the middle shape of an interval.
pub(crate) struct IntervalResult<F> {
    /// A place whose distance is at most the margin.
    pub contact: Option<F>,
    /// Whether the place moves by at most half of the resolution in the interval.
    pub is_fine: bool,
    /// Why the interval stays undecided, if it does. `Near`: no shorter interval decides a piece.
    /// `Work`: a limit of work stopped the test, and with it the query.
    pub undecided: Option<UndecidedReason>,
    /// Whether the upper bound of this shape exceeds the margin by at most the resolution and
    /// stated uncertainty. It limits the number of further shapes.
    pub is_near: bool,
    /// Why the samples allow no decision for a piece. A contact elsewhere takes precedence.
    pub too_fine: Option<ProximityError>,
}

impl<F> IntervalResult<F> {
    /// The result before any test.
    pub(super) fn empty() -> Self {
        Self { contact: None, is_fine: false, undecided: None, is_near: false, too_fine: None }
    }
}

/// What moves during an interval, and the result of its middle shape.
pub(crate) struct IntervalTest<V, F> {
    pub moving: V,
    pub approach_bound: ApproachBound,
    pub wanted: MarginQuery,
    pub result: IntervalResult<F>,
}

impl<D: Refinable, P, V: RelativeMotion<D, P>> RefinePolicy<D, P> for IntervalTest<V, D::Upper> {
    const NEARER_HALF_FIRST: bool = false;

    fn is_done(&self) -> bool {
        self.moving.is_exhausted()
    }

    fn body_query(
        &mut self,
        tube: &D,
        part: &P,
        piece: &D::Piece,
        outer: &D::Body,
    ) -> Result<(BodyQuery, Approach), ProximityError> {
        let speeds = self.moving.speeds(part, piece, outer, tube)?;
        let approach = self.approach_bound.of_piece(speeds, self.moving.extra_turn(part, tube));
        let (approached, MarginQuery { margin, resolution }) = (approach.distance, self.wanted);
        let is_wide = outer.excess() > 2.0 * approached.max(resolution)
            && outer.excess() > 0.5 * tube.radius(piece).max(margin);
        let aim = approached.max(0.5 * resolution);
        let bound = self.bound(&approach, tube.slack());
        Ok((BodyQuery { bound, is_wide, aim, start: self.moving.seed_triangle() }, approach))
    }

    fn decide(
        &mut self,
        tube: &D,
        bounded: &BoundedPiece<D, P>,
        approach: &Approach,
    ) -> Result<RefineAction, ProximityError> {
        self.moving.record(bounded);
        let upper = bounded.found.upper();
        // Step 1.
        if upper <= self.wanted.margin {
            self.result.contact = Some(*bounded.found);
            self.result.is_fine = self.is_fine(approach);
            self.approach_bound.limit_hold(approach, 0.0);
            self.moving.record_unresolved(bounded, approach);
            return Ok(RefineAction::Answered);
        }
        // Step 2.
        let is_motion_too_large = !self.is_fine(approach)
            && (upper <= self.bound(approach, tube.slack())
                || bounded.outer.excess() <= 0.25 * approach.distance);
        if is_motion_too_large {
            self.record_unresolved(tube, bounded, approach)?;
            return Ok(RefineAction::Settled);
        }
        // Step 3.
        let apart = upper - D::distance(bounded.nearest) - tube.uncertainty(bounded.piece);
        if self.is_fine(approach) && apart <= 0.5 * self.wanted.resolution {
            self.result.undecided = Some(UndecidedReason::Near);
            return Ok(RefineAction::Settled);
        }
        // Step 4.
        Ok(RefineAction::Halve(0.25 * bounded.outer.excess()))
    }

    fn decide_indivisible(
        &mut self,
        tube: &D,
        bounded: &BoundedPiece<D, P>,
        approach: &Approach,
    ) -> Result<(), ProximityError> {
        let (may_become_round, resolution) =
            (tube.may_become_round(bounded.piece), self.wanted.resolution);
        if self.is_fine(approach)
            && !may_become_round
            && tube.is_entirely_queried(bounded.piece, bounded.found)
        {
            let stated = tube.uncertainty(bounded.piece);
            let possible = bounded.found.upper() - D::distance(bounded.nearest) - stated;
            if let Err(error) = tube.check_resolved(possible, resolution) {
                self.result.too_fine.get_or_insert(error);
                self.result.undecided = Some(UndecidedReason::Near);
                self.result.is_near = true;
                return Ok(());
            }
        }
        let moved = approach.distance.max(self.approach_bound.cap_change);
        let is_round_end_decided =
            moved <= ROUND_END * resolution || self.approach_bound.caps_change_too_fast(resolution);
        if self.is_fine(approach) && (!may_become_round || is_round_end_decided) {
            self.result.undecided = Some(UndecidedReason::Near);
            return Ok(());
        }
        self.record_unresolved(tube, bounded, approach)
    }
}

impl<V, F> IntervalTest<V, F> {
    /// Returns the distance beyond which a body keeps the margin during the whole interval.
    fn bound(&self, approach: &Approach, slack: Real) -> Real {
        self.wanted.margin + approach.distance + slack
    }

    /// Whether the middle shape decides: the motion is smaller than the resolution allows.
    fn is_fine(&self, approach: &Approach) -> bool {
        approach.distance <= 0.5 * self.wanted.resolution && approach.extra_turn <= MIN_EXTRA_TURN
    }

    /// Records a piece that keeps the margin only for some time before and after the middle shape.
    ///
    /// # Errors
    /// The piece is too fast for the resolution.
    fn record_unresolved<D: Refinable, P>(
        &mut self,
        tube: &D,
        bounded: &BoundedPiece<D, P>,
        approach: &Approach,
    ) -> Result<(), ProximityError>
    where
        V: RelativeMotion<D, P>,
    {
        let MarginQuery { margin, resolution } = self.wanted;
        let fastest = || self.moving.fastest_section(bounded, approach);
        check_subdivision(approach.speed, resolution, fastest)?;
        self.result.is_near |=
            bounded.found.upper() <= margin + resolution + tube.uncertainty(bounded.piece);
        let free = D::distance(bounded.nearest) - margin - tube.slack();
        self.approach_bound.limit_hold(approach, free);
        self.moving.record_unresolved(bounded, approach);
        Ok(())
    }
}
