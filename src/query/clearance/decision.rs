//! Whether a tube keeps a margin.

use super::memory::{Start, TubeMemory};
use crate::answer::{Decision, ProximityError};
use crate::pieces::{Look, Near, Outer, Piece, PlacedTube, Question, TubeInMesh, Verdict, refine};
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
    let mut question = Keeps { margin, resolution, decision: Decision::Clear, last: &mut memory.last };
    refine(tube, &mut memory.pieces, &mut question)?;
    Ok(question.decision)
}

struct Keeps<'a> {
    margin: Real,
    resolution: Real,
    decision: Decision,
    /// Where the last query ended; where this one does if the margin is not kept.
    last: &'a mut Option<Start>,
}

impl Question<Piece> for Keeps<'_> {
    const NEARER_FIRST: bool = true;

    fn is_answered(&self) -> bool {
        false
    }

    fn look(
        &mut self,
        tube: &PlacedTube,
        _: &Piece,
        piece: &Piece,
        outer: &Outer,
    ) -> Result<Look, ProximityError> {
        let Self { margin, resolution, .. } = *self;
        let is_wide = outer.over > 2.0 * resolution && outer.over > 0.5 * tube.radius(piece).max(margin);
        let start = self.last.map(|last| last.triangle);
        Ok(Look { bound: margin, is_wide, aim: resolution, start })
    }

    fn keeps_away(&mut self, _: &Piece, _: &Outer, _: Real) {}

    fn judge(&mut self, tube: &TubeInMesh, near: &Near<Piece>) -> Result<Verdict, ProximityError> {
        let upper = near.found.upper;
        if upper <= self.margin {
            self.decision = Decision::Contact;
            *self.last = Some(near.found.into());
            return Ok(Verdict::Answered);
        }
        if upper - near.nearest.distance <= self.resolution + tube.tube.stated(near.piece) {
            self.decision = Decision::Undecided;
            return Ok(Verdict::Settled);
        }
        Ok(Verdict::Halve(0.25 * near.outer.over))
    }

    fn judge_whole(&mut self, tube: &TubeInMesh, near: &Near<Piece>) -> Result<(), ProximityError> {
        let stated = tube.tube.stated(near.piece);
        tube.check_resolved(near.found.upper - near.nearest.distance - stated, self.resolution)?;
        self.decision = Decision::Undecided;
        Ok(())
    }
}
