//! Bounds on the clearance of a tube: best first.
//!
//! # Definitions
//! - `lower`, `direction_gap`, `found` and rank of a piece: see `refine::best_first`.
//! - `upper`: the least `found` of all pieces that step 4 took.
//! - `aim`: the permitted gap between the bounds.
//! - `hint`: an upper bound on the clearance, from a place of an earlier query or from any measured
//!   piece.
//!
//! # Algorithm
//! 1. **Begin** with pieces that turn by about 1 rad on average, or less.
//! 2. **Measure** the first piece, if it is unmeasured, and begin step 2 again.
//! 3. **Stop** if its `lower` + `direction_gap` is at least `upper - aim`. Its `found` is then not
//!    used.
//! 4. **Take** it: its `found` may improve `upper`. Stop if step 3 now holds. Otherwise divide it,
//!    and go back to step 2.
//! 5. **Answer.** The lower bound is the least `lower` of all pieces, at most `upper`.
//!
//! **Warm start.** Bodies are first searched within `hint`. A body without a result is *distant*:
//! its `lower` becomes the bound of that search, and when it is first it is searched again, within
//! `upper`. So the hint only saves work: the upper bound of the answer comes from step 4 alone.
//!
//! # Claim
//! The answer depends neither on the hint nor on start triangles. A finer tolerance never gives
//! looser bounds.
//!
//! **Proof.** Steps 2 to 5 depend only on the sequence of divisions, which is the same for every
//! hint (`refine::best_first`). The tolerance decides only when the query stops. A piece that
//! cannot be divided keeps its `lower` and never stops the sequence. Along the sequence no `lower`
//! falls and `upper` never rises.

use crate::answer::{Clearance, ProximityError};
use crate::refine::{
    BoundingBody, Examined, MeshUpperBound, PendingPiece, PendingPieces, Piece, PieceState,
    Refinable, TubeInMesh, UpperBound,
};
use parry3d_f64::math::Real;

/// The most divisions of a query; each adds one piece. After them the query returns the bounds
/// found so far. Limits the time, far above the need of any tolerance that the samples allow.
pub(super) const MOST_DIVISIONS: u32 = 1 << 15;

/// Returns bounds on the clearance that are at most `tolerance` apart if the tube allows it, and
/// the pieces of the tube, each with a lower bound on its clearance.
///
/// # Errors
/// The curve of the tube is not finite.
pub(crate) fn clearance<'m>(
    tube: &mut TubeInMesh,
    memory: &'m mut TubeMemory,
    last: &mut Option<LastPlace>,
    tolerance: Real,
) -> Result<(Clearance, &'m MeshPieces), ProximityError> {
    let mut hint = Hint { upper: Real::INFINITY, triangle: last.map(|last| last.triangle) };
    // If the mesh is much larger than the tube, a near mesh allows a smaller `slack`. The bound for
    // it must not depend on earlier queries.
    if tube.gains_from_tightening() {
        let first = tube.first_bound();
        tube.tighten_slack(first.upper);
        hint.take(&tube.bound_at(first.section, first.witness.arc_length, first.witness.triangle));
    }
    if let Some(last) = last.filter(|last| (last.section as usize) < tube.tube.sections().len()) {
        hint.take(&tube.bound_at(last.section, last.arc, last.triangle));
    }
    tube.begin_coarse(&mut memory.begun);
    memory.pieces.clear();
    let mut bounds = BoundsSearch::new(tube, &mut memory.pieces, hint, tolerance);
    while let Some(piece) = memory.begun.pop() {
        bounds.begin(piece, 0.0);
    }
    bounds.run(Real::INFINITY)?;
    let best = bounds.best;
    let best = best.unwrap_or_else(|| bounds.tube.first_bound());
    let BoundedClearance { lower, resolved, uncertainty } = bounds.answer(best.upper);
    *last = Some((&best).into());
    let MeshUpperBound { upper, section, witness } = best;
    let answer = Clearance { lower, upper, resolved, uncertainty, section, witness };
    Ok((answer, &memory.pieces))
}

/// The undivided pieces of a tube in a mesh.
pub(crate) type MeshPieces = PendingPieces<Piece, BoundingBody, MeshUpperBound>;

/// An upper bound on the clearance from any source, and a triangle that is probably near.
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

/// The bounds of the answer, without its place.
pub(crate) struct BoundedClearance {
    pub lower: Real,
    pub resolved: bool,
    pub uncertainty: Real,
}

/// The search for bounds on the clearance (module head).
pub(crate) struct BoundsSearch<'a, T: Refinable> {
    pub tube: &'a mut T,
    pieces: &'a mut PendingPieces<T::Piece, T::Body, T::Upper>,
    hint: Hint,
    tolerance: Real,
    /// The permitted gap between the bounds.
    aim: Real,
    /// The upper bound of step 4.
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
        // The bounds of the answer must meet the tolerance after rounding.
        let aim = (tolerance + tube.position_uncertainty() - 4.0 * tube.slack()).max(0.0);
        Self { tube, pieces, hint, tolerance, aim, best: None, left: MOST_DIVISIONS }
    }

    /// Adds an initial piece, whose clearance is at least `lower`.
    pub(crate) fn begin(&mut self, piece: T::Piece, lower: Real) {
        let (state, narrow) = (PieceState::Open, Real::INFINITY);
        self.pieces.push(self.tube, PendingPiece { piece, lower, state, narrow, levels: 0 });
    }

    fn upper(&self) -> Real {
        self.best.as_ref().map_or(Real::INFINITY, UpperBound::upper)
    }

    /// Divides pieces until the gap between the bounds is at most `aim`.
    ///
    /// Returns false if that needs pieces whose lower bound exceeds `limit`.
    ///
    /// # Errors
    /// The curve is not finite.
    pub(crate) fn run(&mut self, limit: Real) -> Result<bool, ProximityError> {
        while let Some(first) = self.pieces.first() {
            let upper = self.upper();
            // Measuring a piece may raise its rank. An unmeasured piece ends the loop only if even
            // its `lower` is at least `upper`.
            let is_final = first.is_measured || first.least >= upper;
            if is_final && first.least >= upper - self.aim {
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
            // Step 4.
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
        // No piece is left that can be divided. Pairs beyond `limit` were never begun.
        Ok(limit >= self.upper() - self.aim)
    }

    fn improves(&self, found: &T::Upper) -> bool {
        self.best.as_ref().is_none_or(|best| {
            let is_equal = found.upper() <= best.upper();
            found.upper() < best.upper() || is_equal && found.tie() < best.tie()
        })
    }

    /// Measures an open piece within the hint. A piece that is distant, or whose `lower` exceeds
    /// the hint, is measured within `upper`.
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
            // This query divides no piece before it is measured.
            Examined::Divided => {}
            Examined::Measured(found) => self.hint.take(&found),
        }
        Ok(())
    }

    /// Returns the answer, given the upper bound.
    pub(crate) fn answer(&self, upper: Real) -> BoundedClearance {
        let mut lower = upper;
        let mut direction_gap: Real = 0.0;
        for piece in self.pieces.all() {
            if piece.lower > lower {
                continue;
            }
            let of_piece = self.tube.direction_uncertainty(&piece.piece);
            direction_gap =
                if piece.lower < lower { of_piece } else { direction_gap.max(of_piece) };
            lower = piece.lower;
        }
        // `direction_gap` matters only if it causes the gap.
        let direction_gap = if lower < upper - self.aim { direction_gap } else { 0.0 };
        let uncertainty = self.tube.position_uncertainty() + direction_gap;
        BoundedClearance {
            lower,
            resolved: upper - lower <= self.tolerance + uncertainty,
            uncertainty,
        }
    }
}

/// The place that realised the last answer: it warm-starts the next query.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LastPlace {
    pub triangle: u32,
    pub section: u32,
    pub arc: Real,
}

impl From<&MeshUpperBound> for LastPlace {
    fn from(found: &MeshUpperBound) -> Self {
        let witness = found.witness;
        Self { triangle: witness.triangle, section: found.section, arc: witness.arc_length }
    }
}

/// Memory that the next query about a tube reuses.
#[derive(Clone, Default)]
pub(crate) struct TubeMemory {
    pub pieces: MeshPieces,
    /// The initial pieces of a query.
    pub begun: Vec<Piece>,
}
