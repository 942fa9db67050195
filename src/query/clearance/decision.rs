//! Whether a tube keeps a margin: best first, as `bounds`.
//!
//! # Algorithm
//! A body farther away than the margin is dropped. The bounds of the remaining pieces decide:
//! - **Contact**: the upper bound is at most the margin.
//! - **Clear**: no piece remains.
//! - **Undecided**: the gap between the bounds is at most the resolution, apart from stated
//!   uncertainty. So the clearance is within the resolution of the margin.
//!
//! A piece is **stuck** if it cannot be divided and its `lower` is below the upper bound by more
//! than the resolution. A stuck piece is an error. Before the error is reported, all other pieces
//! are searched for a contact, and then all pieces as `bounds` does: it also measures bodies that
//! are halved or dropped here, and the point nearest to such a body may lie elsewhere on the tube.
//! So there is no error where `clearance` finds a contact at that resolution.
//!
//! # Claim
//! A finer resolution never revokes a decision.
//!
//! **Proof.** The sequence of divisions does not depend on the resolution (`refine::best_first`).

use super::bounds::{BoundsSearch, Hint, LastPlace, MOST_DIVISIONS, TubeMemory};
use crate::answer::{Decision, ProximityError};
use crate::refine::{
    Body, Examined, MOST_LEVELS, PendingPiece, PendingPieces, PieceState, Refinable, TubeInMesh,
    UpperBound,
};
use parry3d_f64::math::Real;

/// Decides whether the tube stays farther away than `margin`.
///
/// # Errors
/// The curve of the tube is not finite, or its samples allow no decision at that resolution.
pub(crate) fn clears_tube(
    tube: &mut TubeInMesh,
    memory: &mut TubeMemory,
    last: &mut Option<LastPlace>,
    margin: Real,
    resolution: Real,
) -> Result<Decision, ProximityError> {
    // Farther triangles do not matter.
    tube.tighten_slack(margin);
    let TubeMemory { pieces, begun } = memory;
    tube.begin_coarse(begun);
    let start = last.map(|last| last.triangle);
    let (decision, found) = clears_pieces(
        tube,
        pieces,
        begun.drain(..).rev(),
        None,
        Wanted { margin, resolution, start },
    )?;
    if let Some(found) = &found {
        *last = Some(found.into());
    }
    Ok(decision)
}

/// The margin and resolution of a query.
#[derive(Clone, Copy)]
pub(crate) struct Wanted {
    pub margin: Real,
    pub resolution: Real,
    /// A triangle that is probably near.
    pub start: Option<u32>,
}

/// Decides whether all pieces stay farther away than the margin; a contact comes with its place.
/// `begun`: the initial pieces, preferably the nearest first. A contact ends the search, so later
/// ones are not computed. `best`: a known upper bound.
///
/// # Errors
/// The curve is not finite, or its samples allow no decision at that resolution.
pub(crate) fn clears_pieces<T: Refinable>(
    tube: &mut T,
    pieces: &mut PendingPieces<T::Piece, T::Body, T::Upper>,
    begun: impl Iterator<Item = T::Piece>,
    best: Option<T::Upper>,
    wanted: Wanted,
) -> Result<(Decision, Option<T::Upper>), ProximityError> {
    pieces.clear();
    pieces.begun.clear();
    let mut search = DecisionSearch {
        tube,
        pieces,
        wanted,
        best,
        stuck: Real::INFINITY,
        is_undecided: false,
        left: MOST_DIVISIONS,
    };
    for piece in begun {
        if search.is_contact() {
            break;
        }
        let narrow = 0.5 * search.tube.radius(&piece).max(wanted.margin);
        let state = PieceState::Open;
        search.examine(&PendingPiece { piece, lower: 0.0, state, narrow, levels: MOST_LEVELS })?;
        search.pieces.begun.push(piece);
    }
    search.run()
}

struct DecisionSearch<'a, T: Refinable> {
    tube: &'a mut T,
    pieces: &'a mut PendingPieces<T::Piece, T::Body, T::Upper>,
    wanted: Wanted,
    best: Option<T::Upper>,
    /// The least `lower` of a stuck piece, plus its stated uncertainty.
    stuck: Real,
    /// Whether some piece stays undecided, because its bounds are close or it may not be queried.
    is_undecided: bool,
    /// How many pieces may still be divided.
    left: u32,
}

impl<T: Refinable> DecisionSearch<'_, T> {
    fn run(mut self) -> Result<(Decision, Option<T::Upper>), ProximityError> {
        let Wanted { margin, resolution, .. } = self.wanted;
        let apart = resolution + self.tube.position_uncertainty();
        while !self.is_contact() {
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
                // Within the resolution: contact and margin are indistinguishable here.
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
            if let Err(error) = self.tube.check_resolved(upper - self.stuck, resolution) {
                let found = self.find_by_bounds()?.ok_or(error)?;
                return Ok((Decision::Contact, Some(found)));
            }
            self.is_undecided = true;
        }
        Ok((if self.is_undecided { Decision::Undecided } else { Decision::Clear }, None))
    }

    /// Whether some upper bound is within the margin. An infinite margin is kept only if nothing is
    /// found.
    fn is_contact(&self) -> bool {
        self.best.is_some_and(|best| best.upper() <= self.wanted.margin)
    }

    /// Returns the contact that bounds on the clearance find.
    fn find_by_bounds(self) -> Result<Option<T::Upper>, ProximityError> {
        let Wanted { margin, resolution, start } = self.wanted;
        let hint = Hint { upper: self.upper(), triangle: start };
        self.pieces.clear();
        let begun = std::mem::take(&mut self.pieces.begun);
        let mut bounds = BoundsSearch::new(self.tube, self.pieces, hint, resolution);
        begun.into_iter().for_each(|piece| bounds.begin(piece, 0.0));
        bounds.run(Real::INFINITY)?;
        Ok(bounds.best.filter(|best| best.upper() <= margin))
    }

    fn upper(&self) -> Real {
        self.best.as_ref().map_or(Real::INFINITY, UpperBound::upper)
    }

    /// Whether a stuck piece keeps the bounds apart.
    fn is_stuck(&self) -> bool {
        let Self { tube, stuck, wanted, .. } = self;
        *stuck < Real::INFINITY
            && tube.check_resolved(self.upper() - stuck, wanted.resolution).is_err()
    }

    /// Examines an open piece. A piece farther away than the margin is dropped.
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
