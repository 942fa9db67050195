//! Bounds on the least clearance of a motion.
//!
//! # Definitions
//! - `upper`: the least upper bound of all tested shapes. `lower`: the lower bound so far.
//! - **Part**: a part of the motion's time ([`Motion::time_parts`]), with its own lower bound.
//! - **Round**: a search with a tolerance of its own. aim: the permitted gap between its bounds.
//! - wanted = upper - aim: pieces whose lower bound is at least this are **settled**.
//! - d: the distance of a piece's body in the middle shape. reach = tau V: how much nearer the
//!   piece may come in the interval (`motion_search`).
//! - direction gap: the gap between the bounds that the unknown direction of a face causes.
//!
//! # Algorithm
//! 1. **Begin** with `upper` of one shape and `lower` = 0.
//! 2. **Stop** if the bounds meet the tolerance, after [`MAX_SHAPES`] shapes, or if a round neither
//!    met its own tolerance nor halved the gap.
//! 3. **Round.** Its tolerance is [`SHARE`] of the gap. It takes over `upper` and the lower bounds
//!    of the parts. Repeat from 2.
//!
//! A round begins with one interval per part.
//! 1. **Take** the interval with the least lower bound. Stop if it is settled. So a path of many
//!    motions costs little more than its nearest parts; the parts farther away cost one shape each,
//!    or a few, in the first round only.
//! 2. **Seed** `upper` at the place of the nearest shape so far.
//! 3. **Refine** the middle shape. A piece is at least d - reach away in the whole interval. Unless
//!    that settles it, it is tested at other times or halved along the curve.
//! 4. **Displacements** settle pieces on one side of the middle shape, as for a margin.
//! 5. **Divide** the interval as for a margin. The margin is `wanted`, which falls as nearer shapes
//!    are found.
//!
//! **Termination.** A piece with reach <= aim / 4 is settled as soon as its body fits as closely.
//! If samples or stated errors leave a larger gap, intervals in which the piece moves less than
//! that gap are not divided.
//!
//! # Claim
//! A finer tolerance never gives looser bounds.
//!
//! **Proof.** A round depends only on the rounds before it. So the sequence of rounds is the same
//! for every tolerance, and a finer tolerance stops no earlier. From round to round `upper` never
//! rises, and the lower bound of no part falls.

use super::approach_bound::ApproachBound;
use super::motion_search::{Interval, MotionSearch};
use super::moving_tube::{Left, MovingTube};
use super::pending_piece::PendingPiece;
use super::progress::MAX_SHAPES;
use super::relative_motion::RelativeMotion;
use crate::answer::{MotionClearance, ProximityError};
use crate::motion::Motion;
use crate::refine::{
    BodyQuery, BoundedPiece, BoundingBody, MeshUpperBound, Piece, PlacedTube, RefineAction,
    RefinePolicy, TubeInMesh, refine,
};
use parry3d_f64::math::Real;

/// The most pieces processed per shape; after them no piece is halved.
const MAX_PIECES: u32 = 1 << 16;

/// The tolerance of a round, as a share of the gap before it. A smaller share takes fewer rounds,
/// but the last one may be that much finer than the query needs. Measured: twice the time of a
/// single round at the tolerance of the query.
const SHARE: Real = 0.25;

impl<M: Motion> MotionSearch<'_, M> {
    /// Returns bounds on the least clearance that are at most `tolerance` apart if possible.
    pub(crate) fn clearance(&mut self, tolerance: Real) -> Result<MotionClearance, ProximityError> {
        let nothing = UnresolvedGap { lower: Real::INFINITY, direction_gap: 0.0 };
        let mut known = MinimumBounds {
            tolerance: Real::INFINITY,
            uncertainty: 0.0,
            best: None,
            lower: 0.0,
            unresolved: nothing,
        };
        self.begin();
        self.memory.part_bounds.clear();
        self.memory.part_bounds.resize(self.memory.intervals.len(), 0.0);
        if let Some(first) = self.memory.intervals.front().cloned() {
            let t = first.midpoint();
            self.with_middle_shape(&first, |tube, _, _, _| {
                known.seed(tube, t);
                Ok(())
            })?;
        }
        while known.gap() > tolerance && self.shapes < MAX_SHAPES {
            let before = known.gap();
            known.tolerance = SHARE * before;
            self.run_round(&mut known)?;
            if known.gap() > known.tolerance.max(0.5 * before) {
                break;
            }
        }
        known.answer(tolerance)
    }

    /// Runs one round. Raises the lower bounds of the parts.
    fn run_round(&mut self, known: &mut MinimumBounds) -> Result<(), ProximityError> {
        known.unresolved = UnresolvedGap { lower: Real::INFINITY, direction_gap: 0.0 };
        self.begin();
        let parts = self.memory.part_bounds.len();
        for (interval, lower) in self.memory.intervals.iter_mut().zip(&self.memory.part_bounds) {
            interval.lower = *lower;
        }
        // The least lower bound of all pieces of each part that this round settles.
        let mut settled = std::mem::take(&mut self.memory.settled);
        settled.clear();
        settled.resize(parts, Real::INFINITY);
        while let Some(interval) = self.pop_nearest() {
            // Step 1.
            if known.is_settled(interval.lower) || self.shapes >= MAX_SHAPES {
                // All other intervals have larger lower bounds.
                self.memory.intervals.push_back(interval);
                break;
            }
            let t = interval.midpoint();
            known.lower = Real::INFINITY;
            let ((nearest, hold, is_left), pieces) =
                self.with_middle_shape(&interval, |tube, turn, moving, approach_bound| {
                    // Step 2.
                    known.seed(tube, t);
                    // Step 3.
                    turn.begin(tube, known.upper().max(known.tolerance));
                    let mut approach = MinimumPolicy::new(moving, approach_bound, known, t, tube);
                    refine(tube, turn.pieces, &mut approach)?;
                    if approach.is_done() {
                        approach.settle(0.0);
                    }
                    // Step 4.
                    let is_left = if approach.is_done() {
                        [true; 2]
                    } else {
                        approach.clear_by_displacement(tube)
                    };
                    Ok((approach.nearest, approach.approach_bound.hold, is_left))
                })?;
            let part = interval.part(parts);
            settled[part] = settled[part].min(known.lower);
            // Step 5.
            let interval = interval.with_lower_bound(nearest);
            self.memory
                .intervals
                .extend(interval.halves(hold, is_left, &pieces).into_iter().flatten());
        }
        for interval in &self.memory.intervals {
            let part = interval.part(parts);
            settled[part] = settled[part].min(interval.lower);
        }
        known.lower = Real::INFINITY;
        for (bound, settled) in self.memory.part_bounds.iter_mut().zip(&settled) {
            *bound = bound.max(*settled);
            known.lower = known.lower.min(*bound);
        }
        self.memory.settled = settled;
        Ok(())
    }

    /// Removes the interval with the least lower bound.
    fn pop_nearest(&mut self) -> Option<Interval> {
        let intervals = &mut self.memory.intervals;
        let all = intervals.iter().enumerate();
        let (place, _) = all.min_by(|a, b| a.1.lower.total_cmp(&b.1.lower))?;
        intervals.swap_remove_back(place)
    }
}

/// The bounds on the least clearance so far.
struct MinimumBounds {
    /// The tolerance of the round.
    tolerance: Real,
    /// The gap that stated errors cause in the shapes so far.
    uncertainty: Real,
    /// The upper bound, with its place and time.
    best: Option<(MeshUpperBound, Real)>,
    /// During a round, the least lower bound of all settled pieces of the interval; otherwise the
    /// lower bound of the motion.
    lower: Real,
    /// The settled pieces with an unknown direction of a face.
    unresolved: UnresolvedGap,
}

/// Pieces settled with a larger gap because no more is known.
struct UnresolvedGap {
    lower: Real,
    /// The additional gap.
    direction_gap: Real,
}

impl MinimumBounds {
    fn upper(&self) -> Real {
        self.best.map_or(Real::INFINITY, |(found, _)| found.upper)
    }

    /// Whether pieces with this lower bound do not matter.
    fn is_settled(&self, lower: Real) -> bool {
        let wanted = self.upper() - (self.tolerance + self.uncertainty);
        wanted <= 0.0 || lower >= wanted
    }

    /// Keeps a place of the shape at `t` if it is nearer.
    fn offer(&mut self, found: MeshUpperBound, t: Real) {
        if found.upper < self.upper() {
            self.best = Some((found, t));
        }
    }

    /// Tests the shape at the place where the nearest shape so far is nearest.
    fn seed(&mut self, tube: &mut TubeInMesh, t: Real) {
        self.uncertainty = self.uncertainty.max(tube.tube.position_uncertainty());
        let found = match self.best {
            Some((MeshUpperBound { section, witness, .. }, _)) => {
                tube.bound_at(section, witness.arc_length, witness.triangle)
            }
            None => tube.first_bound(),
        };
        self.offer(found, t);
    }

    /// The lower bound of the motion, between rounds.
    fn lower(&self) -> Real {
        self.lower.min(self.upper()).max(0.0)
    }

    /// The part of the gap that stated errors and unknown directions cause.
    fn all_uncertainty(&self) -> Real {
        // The direction gap matters only if nothing else is as near.
        let wanted = self.upper() - (self.tolerance + self.uncertainty);
        let matters = self.unresolved.lower < wanted;
        self.uncertainty + if matters { self.unresolved.direction_gap } else { 0.0 }
    }

    /// The rest of the gap between the bounds, which the tolerance limits.
    fn gap(&self) -> Real {
        self.upper() - self.lower() - self.all_uncertainty()
    }

    fn answer(self, tolerance: Real) -> Result<MotionClearance, ProximityError> {
        let (lower, uncertainty) = (self.lower(), self.all_uncertainty());
        // Every motion has a shape, and every shape a section.
        let Some((MeshUpperBound { upper, section, witness }, t)) = self.best else {
            return Err(ProximityError::EmptyTube);
        };
        let resolved = upper - lower <= tolerance + uncertainty;
        Ok(MotionClearance { lower, upper, resolved, uncertainty, t, section, witness })
    }
}

/// The policy for the middle shape of an interval.
struct MinimumPolicy<'a, 'b, M> {
    moving: MovingTube<'a, M>,
    approach_bound: ApproachBound,
    known: &'b mut MinimumBounds,
    t: Real,
    /// The permitted gap between the bounds of the answer.
    aim: Real,
    /// The least lower bound of the unresolved pieces.
    nearest: Real,
    /// How many pieces may still be halved.
    left: u32,
}

impl<'a, 'b, M: Motion> MinimumPolicy<'a, 'b, M> {
    fn new(
        moving: MovingTube<'a, M>,
        approach_bound: ApproachBound,
        known: &'b mut MinimumBounds,
        t: Real,
        tube: &TubeInMesh,
    ) -> Self {
        // The bounds of the answer must meet the tolerance after rounding.
        let aim = (known.tolerance + known.uncertainty - 4.0 * tube.tube.slack()).max(0.0);
        Self { moving, approach_bound, known, t, aim, nearest: Real::INFINITY, left: MAX_PIECES }
    }

    /// Pieces that may come nearer than this matter.
    fn wanted(&self) -> Real {
        self.known.upper() - self.aim
    }

    /// Returns a lower bound on the clearance of a piece in the interval, from the distance of its
    /// body.
    fn at_least(&self, distance: Real, tube: &PlacedTube) -> Real {
        distance - self.approach_bound.max_approach() - tube.slack()
    }

    fn settle(&mut self, lower: Real) {
        self.known.lower = self.known.lower.min(lower);
    }

    /// Tests the displacements of the unresolved pieces against `wanted`, and settles the pieces
    /// that pass at `wanted`. `wanted` may have fallen since a piece was recorded.
    fn clear_by_displacement(&mut self, tube: &mut TubeInMesh) -> [bool; 2] {
        let wanted = self.wanted();
        let Left { sides, is_any_settled } = self.moving.clear_by_displacement(tube, wanted);
        if is_any_settled {
            self.settle(wanted);
        }
        sides
    }

    /// Records a piece that must be tested at other times.
    fn record_unresolved(
        &mut self,
        near: &BoundedPiece<TubeInMesh, PendingPiece>,
        tube: &PlacedTube,
    ) {
        let wanted = self.wanted();
        self.nearest = self.nearest.min(self.at_least(near.nearest.distance, tube));
        // During `hold` the piece stays at least this far away.
        self.settle(wanted);
        self.approach_bound.limit_hold(near.nearest.distance - wanted - tube.slack());
        self.moving.record_unresolved(near, &self.approach_bound);
    }
}

impl<'m, M: Motion> RefinePolicy<TubeInMesh<'m>, PendingPiece> for MinimumPolicy<'_, '_, M> {
    const NEARER_HALF_FIRST: bool = true;

    /// A clearance below 0 does not exist.
    fn is_done(&self) -> bool {
        self.wanted() < 0.0
    }

    fn body_query(
        &mut self,
        tube: &TubeInMesh<'m>,
        part: &PendingPiece,
        piece: &Piece,
        outer: &BoundingBody,
    ) -> Result<BodyQuery, ProximityError> {
        self.left = self.left.saturating_sub(1);
        self.approach_bound.speed = self.moving.speed(part, piece, outer, tube)?;
        let (reach, upper) = (self.approach_bound.max_approach(), self.known.upper());
        let is_wide = self.left > 0
            && outer.excess > 2.0 * self.aim.max(reach)
            && (outer.is_flat() || outer.excess > 0.25 * upper);
        // Not `wanted`: a piece farther than `upper` is settled for all later rounds.
        let bound = upper + reach + tube.tube.slack();
        Ok(BodyQuery { bound, is_wide, aim: self.aim.max(reach), start: *self.moving.last })
    }

    fn on_cleared(&mut self, _: &Piece, _: &BoundingBody, _: Real) {
        self.settle(self.known.upper());
    }

    fn decide(
        &mut self,
        tube: &TubeInMesh<'m>,
        near: &BoundedPiece<TubeInMesh<'m>, PendingPiece>,
    ) -> Result<RefineAction, ProximityError> {
        *self.moving.last = Some(near.nearest.triangle);
        self.known.offer(*near.found, self.t);
        if self.is_done() {
            return Ok(RefineAction::Answered);
        }
        let (lower, wanted) = (self.at_least(near.nearest.distance, &tube.tube), self.wanted());
        if lower >= wanted || self.left == 0 {
            self.settle(lower);
            return Ok(RefineAction::Settled);
        }
        let (reach, direction_gap) =
            (self.approach_bound.max_approach(), tube.tube.direction_uncertainty(near.piece));
        if direction_gap > 0.0 && reach <= 0.25 * self.aim && lower >= wanted - direction_gap {
            let UnresolvedGap { lower: least, direction_gap: most } = self.known.unresolved;
            self.known.unresolved =
                UnresolvedGap { lower: least.min(lower), direction_gap: most.max(direction_gap) };
            self.settle(lower);
            return Ok(RefineAction::Settled);
        }
        if reach > 0.25 * self.aim
            && (near.found.upper <= wanted + reach || near.outer.excess <= 0.25 * reach)
        {
            self.record_unresolved(near, &tube.tube);
            return Ok(RefineAction::Settled);
        }
        Ok(RefineAction::Halve(self.aim.max(0.25 * near.outer.excess)))
    }

    fn decide_indivisible(
        &mut self,
        tube: &TubeInMesh<'m>,
        near: &BoundedPiece<TubeInMesh<'m>, PendingPiece>,
    ) -> Result<(), ProximityError> {
        let reach = self.approach_bound.max_approach();
        let is_fine = if tube.tube.may_become_round(near.piece) {
            reach.max(self.approach_bound.cap_change) <= self.aim / 128.0
        } else {
            reach <= (0.25 * self.aim).max(near.found.upper - near.nearest.distance)
        };
        if is_fine {
            self.settle(self.at_least(near.nearest.distance, &tube.tube));
        } else {
            self.record_unresolved(near, &tube.tube);
        }
        Ok(())
    }
}
