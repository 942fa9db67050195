//! The clearance of a tube, between bounds.

use super::memory::TubeMemory;
use crate::answer::{Clearance, ProximityError};
use crate::pieces::{
    Body, Bound, Divided, Found, Look, Near, Outer, Part, Piece, Question, TubeInMesh, Verdict, refine,
};
use parry3d_f64::math::Real;

/// After so many pieces none is halved any more, and the bounds are what they are, or a margin stays undecided: a limit on the
/// time that a query takes, far above what any tolerance needs that the samples allow.
pub(super) const MOST_PIECES: u32 = 1 << 16;

/// The clearance, with bounds no farther apart than the tolerance where the tube allows that.
///
/// Each piece that is settled is handed over, with its body and how far away that is at least. Those that were not
/// needed, because the tube touches the mesh, are left in the memory.
///
/// # Errors
/// The curve of the tube is not finite.
pub(crate) fn clearance(
    tube: &mut TubeInMesh,
    memory: &mut TubeMemory,
    tolerance: Real,
    settled: impl FnMut(&Piece, &Outer, Real),
) -> Result<Clearance, ProximityError> {
    let last = memory.last.filter(|last| (last.section as usize) < tube.tube.sections().len());
    let mut best = match last {
        Some(last) => tube.bound_at(last.section, last.arc, last.triangle),
        None => tube.first_bound(),
    };
    // Rounding is the less the nearer the mesh is known to be.
    if tube.sharpen(best.upper) {
        let again = tube.bound_at(best.section, best.witness.arc_length, best.witness.triangle);
        best = if again.upper < best.upper { again } else { best };
    }
    tube.begin(best.upper.max(tolerance), &mut memory.pieces);
    let found = between_bounds(tube, &mut memory.pieces, best, tolerance, settled)?;
    let BetweenBounds { lower, best: Found { upper, section, witness }, resolved, uncertainty } = found;
    memory.last = Some((&found.best).into());
    Ok(Clearance { lower, upper, resolved, uncertainty, section, witness })
}

/// A clearance between bounds, and what realises the upper one.
pub(crate) struct BetweenBounds<F> {
    pub lower: Real,
    pub best: F,
    pub resolved: bool,
    pub uncertainty: Real,
}

/// The clearance of all pieces, from a first upper bound on. Each piece that is settled is handed over, with its body and how far
/// away that is at least. Those that were not needed are left in `pieces`.
///
/// # Errors
/// The curve is not finite.
pub(crate) fn between_bounds<T: Divided<Piece: Part<T>>>(
    tube: &mut T,
    pieces: &mut Vec<T::Piece>,
    best: T::Found,
    tolerance: Real,
    settled: impl FnMut(&T::Piece, &T::Body, Real),
) -> Result<BetweenBounds<T::Found>, ProximityError> {
    let uncertainty = tube.uncertainty();
    // So that the bounds of the answer are no farther apart than asked for after they are rounded.
    let aim = (tolerance + uncertainty - 4.0 * tube.slack()).max(0.0);
    let doubtful = Doubtful { lower: Real::INFINITY, doubt: 0.0 };
    let mut bounds = Bounds { aim, best, lower: Real::INFINITY, doubtful, left: MOST_PIECES, settled };
    refine(tube, pieces, &mut bounds)?;
    let Bounds { best, lower, doubtful, .. } = bounds;
    let upper = best.upper();
    let lower = if pieces.is_empty() { lower.min(upper) } else { 0.0 };
    let doubt = if doubtful.lower < upper - aim { doubtful.doubt } else { 0.0 };
    let uncertainty = uncertainty + doubt;
    let resolved = upper - lower <= tolerance + uncertainty;
    Ok(BetweenBounds { lower, best, resolved, uncertainty })
}

/// How near the tube is at the least and at the most, as far as its pieces have been looked at.
struct Bounds<F, S> {
    /// How far apart the bounds may stay.
    aim: Real,
    best: F,
    lower: Real,
    /// The part of that where it is not known which way a face stands.
    doubtful: Doubtful,
    /// How many pieces may still be halved.
    left: u32,
    settled: S,
}

/// What is settled although its bounds are farther apart, because more is not known.
struct Doubtful {
    lower: Real,
    /// How much farther.
    doubt: Real,
}

impl<F, S> Bounds<F, S> {
    fn settle<P, B>(&mut self, piece: &P, outer: &B, apart: Real)
    where
        S: FnMut(&P, &B, Real),
    {
        self.lower = self.lower.min(apart);
        (self.settled)(piece, outer, apart);
    }
}

impl<T, S> Question<T, T::Piece> for Bounds<T::Found, S>
where
    T: Divided,
    S: FnMut(&T::Piece, &T::Body, Real),
{
    const NEARER_FIRST: bool = true;

    /// Nothing below 0 is left to be found.
    fn is_answered(&self) -> bool {
        let upper = self.best.upper();
        upper - self.aim < 0.0 || upper <= 0.0
    }

    fn look(&mut self, _: &T, _: &T::Piece, _: &T::Piece, outer: &T::Body) -> Result<Look, ProximityError> {
        let Self { aim, best, left, .. } = self;
        *left = left.saturating_sub(1);
        // How far it reaches ahead of its flat ends tells little: behind a face that is mostly into what is before it.
        let is_wide = *left > 0 && outer.aside() > 2.0 * *aim && outer.aside() > 0.25 * best.upper();
        Ok(Look { bound: best.upper() - *aim, is_wide, aim: *aim, start: best.triangle() })
    }

    fn keeps_away(&mut self, piece: &T::Piece, outer: &T::Body, bound: Real) {
        self.settle(piece, outer, bound);
    }

    fn judge(&mut self, tube: &T, near: &Near<T, T::Piece>) -> Result<Verdict, ProximityError> {
        if near.found.upper() < self.best.upper() {
            self.best = *near.found;
        }
        let (apart, wanted) = (T::distance(near.nearest), self.best.upper() - self.aim);
        let doubt = tube.doubt(near.piece);
        if doubt > 0.0 && apart >= wanted - doubt {
            let Doubtful { lower, doubt: most } = self.doubtful;
            self.doubtful = Doubtful { lower: lower.min(apart), doubt: most.max(doubt) };
            self.settle(near.piece, near.outer, apart);
            return Ok(Verdict::Settled);
        }
        if apart >= wanted || self.left == 0 {
            self.settle(near.piece, near.outer, apart);
            return Ok(Verdict::Settled);
        }
        Ok(Verdict::Halve(self.aim))
    }

    fn judge_whole(&mut self, _: &T, near: &Near<T, T::Piece>) -> Result<(), ProximityError> {
        self.settle(near.piece, near.outer, T::distance(near.nearest));
        Ok(())
    }
}
