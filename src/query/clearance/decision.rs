//! Whether a tube keeps a margin: best first, as for its clearance (`bounds`).
//!
//! Bodies that are farther away than the margin are settled. The bounds of all that is left decide:
//!
//! - **Contact**: the upper bound is not above the margin.
//! - **Clear**: nothing is left.
//! - **Undecided**: the bounds are no farther apart than the resolution, beside what was stated. So
//!   the clearance is within that of the margin.
//!
//! A piece that cannot be divided, and whose `lower` is below the upper bound by more than the
//! resolution, is an error. Before it is reported, all other pieces are looked at for a contact.
//!
//! The order of the divisions does not depend on the resolution. So a finer resolution never takes
//! back a decision.

use super::bounds::MOST_DIVISIONS;
use super::memory::TubeMemory;
use crate::answer::{Decision, ProximityError};
use crate::pieces::{
    Body, Examined, MOST_LEVELS, PendingPiece, PendingPieces, PieceState, Refinable, TubeInMesh,
    UpperBound,
};
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
    tube.tighten_slack(margin);
    let TubeMemory { pieces, begun, last } = memory;
    tube.begin_coarse(begun);
    let start = last.map(|last| last.triangle);
    let (decision, found) =
        clears_pieces(tube, pieces, begun.drain(..), None, Wanted { margin, resolution, start })?;
    if let Some(found) = &found {
        *last = Some(found.into());
    }
    Ok(decision)
}

/// What a tube is asked.
#[derive(Clone, Copy)]
pub(crate) struct Wanted {
    pub margin: Real,
    pub resolution: Real,
    /// A triangle that is likely to be near.
    pub start: Option<u32>,
}

/// Whether all pieces keep more than the margin away; and where they do not. `best` is an upper
/// bound that is known.
///
/// # Errors
/// The curve is not finite, or its samples do not allow a decision at that resolution.
pub(crate) fn clears_pieces<T: Refinable>(
    tube: &mut T,
    pieces: &mut PendingPieces<T::Piece, T::Body, T::Upper>,
    begun: impl Iterator<Item = T::Piece>,
    best: Option<T::Upper>,
    wanted: Wanted,
) -> Result<(Decision, Option<T::Upper>), ProximityError> {
    pieces.clear();
    for piece in begun {
        let narrow = 0.5 * tube.radius(&piece).max(wanted.margin);
        let state = PieceState::Open;
        pieces.push(tube, PendingPiece { piece, lower: 0.0, state, narrow, levels: MOST_LEVELS });
    }
    let search = DecisionSearch {
        tube,
        pieces,
        wanted,
        best,
        stuck: Real::INFINITY,
        is_undecided: false,
        left: MOST_DIVISIONS,
    };
    search.run()
}

struct DecisionSearch<'a, T: Refinable> {
    tube: &'a mut T,
    pieces: &'a mut PendingPieces<T::Piece, T::Body, T::Upper>,
    wanted: Wanted,
    best: Option<T::Upper>,
    /// The least lower bound of a piece that cannot be divided, beside what was stated of it.
    stuck: Real,
    /// Whether a piece stays undecided of which it is not known whether it is asked about.
    is_undecided: bool,
    /// How many pieces may still be divided.
    left: u32,
}

impl<T: Refinable> DecisionSearch<'_, T> {
    fn run(mut self) -> Result<(Decision, Option<T::Upper>), ProximityError> {
        let Wanted { margin, resolution, .. } = self.wanted;
        let apart = resolution + self.tube.position_uncertainty();
        while self.upper() > margin {
            let Some(first) = self.pieces.first() else { break };
            let is_near = first.is_measured && first.least >= self.upper() - apart;
            if is_near && !self.is_stuck() {
                self.is_undecided = true;
                break;
            }
            let Some(piece) = self.pieces.pop() else { break };
            let PieceState::Measured(body, found) = &piece.state else {
                self.examine(&piece)?;
                continue;
            };
            if is_near
                && found.upper() - piece.lower <= resolution + self.tube.uncertainty(&piece.piece)
            {
                // A contact could not be told from the margin here.
                continue;
            }
            if self.left == 0 {
                self.is_undecided = true;
                break;
            }
            self.left -= 1;
            let narrow = 0.5 * self.tube.radius(&piece.piece).max(margin);
            if !self.pieces.divide(self.tube, &piece, body, narrow) {
                self.settle_whole(&piece, found);
            }
        }
        let upper = self.upper();
        if let Some(best) = self.best.filter(|_| upper <= margin) {
            return Ok((Decision::Contact, Some(best)));
        }
        if self.stuck < Real::INFINITY {
            self.tube.check_resolved(upper - self.stuck, resolution)?;
            self.is_undecided = true;
        }
        Ok((if self.is_undecided { Decision::Undecided } else { Decision::Clear }, None))
    }

    fn upper(&self) -> Real {
        self.best.as_ref().map_or(Real::INFINITY, UpperBound::upper)
    }

    /// Whether a piece that cannot be divided keeps the bounds apart.
    fn is_stuck(&self) -> bool {
        let Self { tube, stuck, wanted, .. } = self;
        *stuck < Real::INFINITY
            && tube.check_resolved(self.upper() - stuck, wanted.resolution).is_err()
    }

    /// What an open piece shows; if it is farther away than the margin, it is dropped.
    fn examine(
        &mut self,
        open: &PendingPiece<T::Piece, T::Body, T::Upper>,
    ) -> Result<(), ProximityError> {
        let Wanted { margin, start, .. } = self.wanted;
        let examined = self.pieces.examine(self.tube, open, margin, start, Body::excess)?;
        if let Examined::Measured(found) = examined
            && found.upper() < self.upper()
        {
            self.best = Some(found);
        }
        Ok(())
    }

    fn settle_whole(
        &mut self,
        piece: &PendingPiece<T::Piece, T::Body, T::Upper>,
        found: &T::Upper,
    ) {
        if self.tube.is_entirely_queried(&piece.piece, found) {
            self.stuck = self.stuck.min(piece.lower + self.tube.uncertainty(&piece.piece));
        } else {
            self.is_undecided = true;
        }
    }
}
