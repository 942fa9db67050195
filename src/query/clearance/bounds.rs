//! The clearance of a tube, between bounds: best first.
//!
//! # Algorithm
//! 1. Begin with pieces that turn by 1 rad at most, and measure them.
//! 2. Take the measured piece of least rank (`pieces::best_first`). What was found from it improves
//!    the upper bound.
//! 3. Stop if its `lower` + `doubt` is not below the upper bound by more than `aim`. Otherwise
//!    divide it, and measure its halves. Repeat from 2.
//! 4. The lower bound is the least `lower` of all pieces.
//!
//! # What an earlier query leaves
//! A place that was near bounds the clearance from above, which is the `hint`. Bodies are searched
//! for within the hint. What was not found there is searched for again, farther away, before its
//! rank is reached. So the hint only spares searches. The upper bound of the answer comes from step
//! 2 alone.
//!
//! # Claim
//! The answer depends neither on the hint nor on where searches start. The bounds of a finer
//! tolerance are never looser.
//!
//! **Proof.** Steps 2 to 4 depend on the sequence of divisions, the same whatever is hinted
//! (`pieces::best_first`). A tolerance only decides when step 3 stops. A piece that cannot be
//! divided keeps its `lower`, and never stops the sequence. Along the sequence no `lower` falls and
//! the upper bound never rises.

use super::memory::TubeMemory;
use crate::answer::{Clearance, ProximityError};
use crate::pieces::{
    Examined, MeshUpperBound, PendingPiece, PendingPieces, PieceState, Refinable, TubeInMesh,
    UpperBound,
};
use parry3d_f64::math::Real;

/// After so many divisions the bounds are what they are: a limit on the time that a query takes,
/// far above what any tolerance needs that the samples allow. Each makes two pieces.
pub(super) const MOST_DIVISIONS: u32 = 1 << 15;

/// The clearance, with bounds no farther apart than the tolerance where the tube allows that.
///
/// Its pieces are left in the memory, each with a lower bound on its clearance.
///
/// # Errors
/// The curve of the tube is not finite.
pub(crate) fn clearance(
    tube: &mut TubeInMesh,
    memory: &mut TubeMemory,
    tolerance: Real,
) -> Result<Clearance, ProximityError> {
    let mut hint = Hint { upper: Real::INFINITY, triangle: memory.last.map(|last| last.triangle) };
    // Where the mesh is much larger than the tube, rounding is the less the nearer the mesh is
    // known to be. The bound for that must not depend on earlier queries.
    if tube.gains_from_sharpening() {
        let first = tube.first_bound();
        tube.tighten_slack(first.upper);
        hint.take(&tube.bound_at(first.section, first.witness.arc_length, first.witness.triangle));
    }
    if let Some(last) =
        memory.last.filter(|last| (last.section as usize) < tube.tube.sections().len())
    {
        hint.take(&tube.bound_at(last.section, last.arc, last.triangle));
    }
    tube.begin_coarse(&mut memory.begun);
    memory.pieces.clear();
    let mut bounds = BoundsSearch::new(tube, &mut memory.pieces, hint, tolerance);
    while let Some(piece) = memory.begun.pop() {
        bounds.begin(piece);
    }
    bounds.run(Real::INFINITY)?;
    let best = bounds.best;
    let best = best.unwrap_or_else(|| bounds.tube.first_bound());
    let BoundedClearance { lower, resolved, uncertainty } = bounds.answer(best.upper);
    memory.last = Some((&best).into());
    let MeshUpperBound { upper, section, witness } = best;
    Ok(Clearance { lower, upper, resolved, uncertainty, section, witness })
}

/// What bounds the clearance from above, wherever it comes from, and a triangle that is likely to
/// be near.
#[derive(Clone, Copy)]
pub(crate) struct Hint {
    pub upper: Real,
    pub triangle: Option<u32>,
}

impl Hint {
    pub(crate) fn take(&mut self, found: &impl UpperBound) {
        if found.upper() < self.upper {
            *self = Self { upper: found.upper(), triangle: found.triangle() };
        }
    }
}

/// A clearance between bounds.
pub(crate) struct BoundedClearance {
    pub lower: Real,
    pub resolved: bool,
    pub uncertainty: Real,
}

/// How near the tube is at the least and at the most, as far as its pieces have been looked at.
pub(crate) struct BoundsSearch<'a, T: Refinable> {
    pub tube: &'a mut T,
    pieces: &'a mut PendingPieces<T::Piece, T::Body, T::Upper>,
    hint: Hint,
    tolerance: Real,
    /// How far apart the bounds may stay.
    aim: Real,
    /// What bounds the clearance from above: of the pieces that had their turn.
    pub best: Option<T::Upper>,
    /// How many pieces may still be divided.
    left: u32,
}

impl<'a, T: Refinable> BoundsSearch<'a, T> {
    pub(crate) fn new(
        tube: &'a mut T,
        pieces: &'a mut PendingPieces<T::Piece, T::Body, T::Upper>,
        hint: Hint,
        tolerance: Real,
    ) -> Self {
        // So that the bounds of the answer are no farther apart than asked for after they are
        // rounded.
        let aim = (tolerance + tube.position_uncertainty() - 4.0 * tube.slack()).max(0.0);
        Self { tube, pieces, hint, tolerance, aim, best: None, left: MOST_DIVISIONS }
    }

    /// Adds a piece of the tube.
    pub(crate) fn begin(&mut self, piece: T::Piece) {
        let (state, narrow) = (PieceState::Open, Real::INFINITY);
        self.pieces.push(self.tube, PendingPiece { piece, lower: 0.0, state, narrow, levels: 0 });
    }

    fn upper(&self) -> Real {
        self.best.as_ref().map_or(Real::INFINITY, UpperBound::upper)
    }

    /// Divides pieces until the bounds are as near one another as wanted. False if that needs
    /// pieces whose lower bound is larger than `limit`.
    ///
    /// # Errors
    /// The curve is not finite.
    pub(crate) fn run(&mut self, limit: Real) -> Result<bool, ProximityError> {
        while let Some(first) = self.pieces.first() {
            let upper = self.upper();
            // A piece that is not measured may still have the least lower bound.
            let can_wait = first.is_measured || first.least >= upper;
            if can_wait && first.least >= upper - self.aim {
                return Ok(true);
            }
            if first.least > limit {
                return Ok(false);
            }
            let Some(piece) = self.pieces.pop() else { break };
            let PieceState::Measured(body, found) = &piece.state else {
                self.measure(piece)?;
                continue;
            };
            if self.improves(found) {
                self.best = Some(*found);
            }
            if first.least >= self.upper() - self.aim || self.left == 0 {
                self.pieces.push(self.tube, piece);
                return Ok(true);
            }
            self.left -= 1;
            if !self.pieces.divide(self.tube, &piece, body, Real::INFINITY) {
                self.pieces.push_whole(piece);
            }
        }
        Ok(limit >= self.upper() - self.aim)
    }

    fn improves(&self, found: &T::Upper) -> bool {
        self.best.as_ref().is_none_or(|best| {
            let is_equal = found.upper() <= best.upper();
            found.upper() < best.upper() || is_equal && found.tie() < best.tie()
        })
    }

    /// Measures a piece within the hint; or, if it is known to be farther away, within the upper
    /// bound.
    fn measure(
        &mut self,
        piece: PendingPiece<T::Piece, T::Body, T::Upper>,
    ) -> Result<(), ProximityError> {
        let (hint, upper) = (self.hint.upper, self.upper());
        let is_open = matches!(piece.state, PieceState::Open);
        let bound = if is_open && piece.lower <= hint { hint.min(upper) } else { upper };
        match self.pieces.examine(self.tube, &piece, bound, self.hint.triangle, |_| 0.0)? {
            Examined::Away => {
                let (lower, state) = (piece.lower.max(bound), PieceState::Distant);
                self.pieces.push(self.tube, PendingPiece { lower, state, ..piece });
            }
            Examined::Divided => {}
            Examined::Measured(found) => self.hint.take(&found),
        }
        Ok(())
    }

    /// The answer, with this upper bound.
    pub(crate) fn answer(&self, upper: Real) -> BoundedClearance {
        let mut lower = upper;
        let mut doubt: Real = 0.0;
        for piece in self.pieces.all() {
            if piece.lower > lower {
                continue;
            }
            let of_piece = self.tube.direction_uncertainty(&piece.piece);
            doubt = if piece.lower < lower { of_piece } else { doubt.max(of_piece) };
            lower = piece.lower;
        }
        // Doubt matters only where it keeps the bounds apart.
        let doubt = if lower < upper - self.aim { doubt } else { 0.0 };
        let uncertainty = self.tube.position_uncertainty() + doubt;
        BoundedClearance {
            lower,
            resolved: upper - lower <= self.tolerance + uncertainty,
            uncertainty,
        }
    }
}
