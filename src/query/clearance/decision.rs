//! Whether a tube keeps a margin.

use super::bounds::MOST_PIECES;
use super::memory::TubeMemory;
use crate::answer::{Decision, ProximityError};
use crate::pieces::{Body, Bound, Divided, Look, Near, Part, Question, TubeInMesh, Verdict, refine};
use parry3d_f64::math::Real;

/// Whether the tube keeps more than the margin away.
///
/// # Errors
/// The curve of the tube is not finite, or its samples do not allow a decision at that resolution.
pub(crate) fn tube_clears(
    tube: &mut TubeInMesh,
    memory: &mut TubeMemory,
    margin: Real,
    resolution: Real,
) -> Result<Decision, ProximityError> {
    // Nothing matters that is farther away than the margin.
    tube.sharpen(margin);
    tube.begin(margin.max(resolution), &mut memory.pieces);
    let (decision, found) =
        keeps(tube, &mut memory.pieces, margin, resolution, memory.last.map(|last| last.triangle))?;
    if let Some(found) = &found {
        memory.last = Some(found.into());
    }
    Ok(decision)
}

/// Whether all pieces keep more than the margin away; and where they do not. `start` is a triangle that is likely to be near.
///
/// # Errors
/// The curve is not finite, or its samples do not allow a decision at that resolution.
pub(crate) fn keeps<T: Divided<Piece: Part<T>>>(
    tube: &mut T,
    pieces: &mut Vec<T::Piece>,
    margin: Real,
    resolution: Real,
    start: Option<u32>,
) -> Result<(Decision, Option<T::Found>), ProximityError> {
    let mut question =
        Keeps { margin, resolution, decision: Decision::Clear, start, contact: None, left: MOST_PIECES };
    refine(tube, pieces, &mut question)?;
    Ok((question.decision, question.contact))
}

struct Keeps<F> {
    margin: Real,
    resolution: Real,
    decision: Decision,
    start: Option<u32>,
    /// Where the margin is not kept.
    contact: Option<F>,
    /// How many pieces may still be halved.
    left: u32,
}

impl<T: Divided> Question<T, T::Piece> for Keeps<T::Found> {
    const NEARER_FIRST: bool = true;

    fn is_answered(&self) -> bool {
        false
    }

    fn look(
        &mut self,
        tube: &T,
        _: &T::Piece,
        piece: &T::Piece,
        outer: &T::Body,
    ) -> Result<Look, ProximityError> {
        let Self { margin, resolution, start, .. } = *self;
        self.left = self.left.saturating_sub(1);
        let is_wide = self.left > 0
            && outer.over() > 2.0 * resolution
            && outer.over() > 0.5 * tube.radius(piece).max(margin);
        Ok(Look { bound: margin, is_wide, aim: resolution, start })
    }

    fn keeps_away(&mut self, _: &T::Piece, _: &T::Body, _: Real) {}

    fn judge(&mut self, tube: &T, near: &Near<T, T::Piece>) -> Result<Verdict, ProximityError> {
        let upper = near.found.upper();
        if upper <= self.margin {
            self.decision = Decision::Contact;
            self.contact = Some(*near.found);
            return Ok(Verdict::Answered);
        }
        if self.left == 0 || upper - T::distance(near.nearest) <= self.resolution + tube.stated(near.piece) {
            self.decision = Decision::Undecided;
            return Ok(Verdict::Settled);
        }
        Ok(Verdict::Halve(0.25 * near.outer.over()))
    }

    fn judge_whole(&mut self, tube: &T, near: &Near<T, T::Piece>) -> Result<(), ProximityError> {
        let apart = near.found.upper() - T::distance(near.nearest);
        if tube.is_surely_asked(near.piece, near.found) {
            tube.check_resolved(apart - tube.stated(near.piece), self.resolution)?;
        }
        self.decision = Decision::Undecided;
        Ok(())
    }
}
