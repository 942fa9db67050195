//! The pieces of a tube that a query has not settled, best first.
//!
//! # Definitions
//! - `lower` of a piece: a lower bound on its clearance. It is the distance of its body, or the
//!   `lower` of the piece that it is a half of, whichever is larger.
//! - `doubt` of a piece: how far apart its bounds stay because a face's direction is not known
//!   ([`Refinable::direction_uncertainty`]).
//! - `found` of a piece: the upper bound on the clearance that shows from it.
//! - A **measured** piece has its distance and its `found`. An **open** piece has the `lower` of
//!   its parent. A **distant** piece is one within whose `lower` nothing was found: its distance is
//!   larger.
//! - The **rank** of a measured piece: (`lower` + `doubt`, upper bound of `found`, place along the
//!   tube). The others rank by their `lower`: open pieces as if their upper bound was 0, distant
//!   ones after all others with the same `lower`.
//!
//! # Claim
//! Let a query only ever divide the measured piece of least rank, and only if it is the first of
//! all pieces. Then the sequence of its divisions depends on the tube and on what it is beside. It
//! depends neither on the bounds within which pieces were searched for, nor on where a search
//! started, nor on a tolerance.
//!
//! **Proof.** Distance, `found`, `doubt` and place are functions of the piece, and so is the
//! `lower` of a measured piece, by induction over its parents. No piece ranks lower once it is
//! measured. So if a measured piece is the first of all, it would be the first if all pieces were
//! measured.
//!
//! So an upper bound that an earlier query left can spare searches, and never enters a result. And
//! a finer tolerance only goes on with the same sequence: since no `lower` falls and no upper bound
//! rises, its bounds are never looser.

use super::refinable::{Body, Refinable, UpperBound};
use crate::answer::ProximityError;
use parry3d_f64::math::Real;
use std::cmp::Ordering;
use std::collections::BinaryHeap;

/// The part at a face is as short as a body needs that exceeds the tube by this part of what its
/// parent's does.
const AIM_OF_HALVES: Real = 1.0 / 8.0;

/// How often a piece may be divided before it is measured. Each time its body becomes narrower by a
/// factor of four.
pub(crate) const MOST_LEVELS: u8 = 2;

/// How a piece has been examined.
#[derive(Clone, Copy, Debug)]
pub(crate) enum PieceState<B, F> {
    /// Not at all.
    Open,
    /// Nothing is as near as its `lower`.
    Distant,
    /// It is measured: its body, and what was found from it.
    Measured(B, F),
}

/// A piece and what is known of it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PendingPiece<P, B, F> {
    pub piece: P,
    pub lower: Real,
    pub state: PieceState<B, F>,
    /// If its body is wider than this, it is divided before it is measured.
    pub narrow: Real,
    /// How often that may still be.
    pub levels: u8,
}

/// When a piece comes, and where it is kept.
#[derive(Clone, Copy, Debug)]
struct Rank {
    /// Its lower bound, the doubt of a measured piece included.
    least: Real,
    /// Infinity if the piece is distant, 0 if it is open: no bound is less.
    upper: Real,
    is_measured: bool,
    place: [u32; 4],
    slot: u32,
}

impl Ord for Rank {
    /// The first one is the greatest, as the heap has it.
    fn cmp(&self, other: &Self) -> Ordering {
        let bounds = other.least.total_cmp(&self.least).then(other.upper.total_cmp(&self.upper));
        bounds.then(other.place.cmp(&self.place)).then(other.slot.cmp(&self.slot))
    }
}

impl PartialOrd for Rank {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Rank {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Rank {}

/// The first piece in the order of ranks.
#[derive(Clone, Copy, Debug)]
pub(crate) struct First {
    /// Its lower bound, the doubt of a measured piece included.
    pub least: Real,
    pub is_measured: bool,
}

/// What an open piece has become.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Examined<F> {
    /// Nothing is within the bound of its body.
    Away,
    /// It was divided, since its body is too wide.
    Divided,
    /// It is measured.
    Measured(F),
}

/// The pieces of a query that are not divided, in memory that is used again.
#[derive(Clone, Debug)]
pub(crate) struct PendingPieces<P, B, F> {
    pieces: Vec<PendingPiece<P, B, F>>,
    /// Places in `pieces` that are free.
    free: Vec<u32>,
    queue: BinaryHeap<Rank>,
    /// Measured pieces that cannot be divided.
    whole: Vec<PendingPiece<P, B, F>>,
}

impl<P, B, F> Default for PendingPieces<P, B, F> {
    fn default() -> Self {
        let (pieces, free, whole) = (Vec::new(), Vec::new(), Vec::new());
        Self { pieces, free, queue: BinaryHeap::new(), whole }
    }
}

impl<P: Copy, B: Body, F: UpperBound> PendingPieces<P, B, F> {
    pub(crate) fn clear(&mut self) {
        self.pieces.clear();
        self.free.clear();
        self.queue.clear();
        self.whole.clear();
    }

    pub(crate) fn push<T>(&mut self, tube: &T, piece: PendingPiece<P, B, F>)
    where
        T: Refinable<Piece = P, Body = B, Upper = F>,
    {
        let slot = self.free.pop().unwrap_or(self.pieces.len() as u32);
        let (doubt, upper, is_measured) = match &piece.state {
            PieceState::Open => (0.0, 0.0, false),
            PieceState::Distant => (0.0, Real::INFINITY, false),
            PieceState::Measured(_, found) => {
                (tube.direction_uncertainty(&piece.piece), found.upper(), true)
            }
        };
        let place = tube.place(&piece.piece);
        self.queue.push(Rank { least: piece.lower + doubt, upper, is_measured, place, slot });
        match self.pieces.get_mut(slot as usize) {
            Some(free) => *free = piece,
            None => self.pieces.push(piece),
        }
    }

    /// Keeps a measured piece that cannot be divided.
    pub(crate) fn push_whole(&mut self, piece: PendingPiece<P, B, F>) {
        self.whole.push(piece);
    }

    pub(crate) fn first(&self) -> Option<First> {
        let rank = self.queue.peek()?;
        Some(First { least: rank.least, is_measured: rank.is_measured })
    }

    /// Takes the first piece.
    pub(crate) fn pop(&mut self) -> Option<PendingPiece<P, B, F>> {
        let rank = self.queue.pop()?;
        self.free.push(rank.slot);
        Some(self.pieces[rank.slot as usize])
    }

    /// All pieces: together they are the whole tube, but for those that the query dropped.
    pub(crate) fn all(&self) -> impl Iterator<Item = &PendingPiece<P, B, F>> {
        let queued = self.queue.iter().map(|rank| &self.pieces[rank.slot as usize]);
        queued.chain(&self.whole)
    }

    /// Looks at a piece that was taken and is not measured: divides it if `width` of its body is
    /// too much, or measures it. Its parts are pushed.
    ///
    /// # Errors
    /// The curve is not finite there.
    pub(crate) fn examine<T>(
        &mut self,
        tube: &mut T,
        open: &PendingPiece<P, B, F>,
        bound: Real,
        start: Option<u32>,
        width: impl Fn(&B) -> Real,
    ) -> Result<Examined<F>, ProximityError>
    where
        T: Refinable<Piece = P, Body = B, Upper = F>,
    {
        let body = tube.body(&open.piece);
        tube.check_finite(&open.piece, &body)?;
        if open.levels > 0
            && width(&body) > open.narrow
            && let Some(halves) = tube.halves(&open.piece, &body, AIM_OF_HALVES * body.excess())
        {
            if !tube.may_meet(&body, bound) {
                return Ok(Examined::Away);
            }
            for piece in halves {
                self.push(tube, PendingPiece { piece, levels: open.levels - 1, ..*open });
            }
            return Ok(Examined::Divided);
        }
        let Some(nearest) = tube.nearest(&body, bound, start) else { return Ok(Examined::Away) };
        let found = tube.found(&open.piece, &body, &nearest);
        let lower = open.lower.max(T::distance(&nearest));
        self.push(tube, PendingPiece { lower, state: PieceState::Measured(body, found), ..*open });
        Ok(Examined::Measured(found))
    }

    /// Divides a measured piece that was taken, and pushes its halves, which are open. False if it
    /// has none. A body of a half that is wider than `narrow` is divided before it is measured.
    pub(crate) fn divide<T>(
        &mut self,
        tube: &T,
        piece: &PendingPiece<P, B, F>,
        body: &B,
        narrow: Real,
    ) -> bool
    where
        T: Refinable<Piece = P, Body = B, Upper = F>,
    {
        let Some(halves) = tube.halves(&piece.piece, body, AIM_OF_HALVES * body.excess()) else {
            return false;
        };
        for half in halves {
            let (lower, state) = (piece.lower, PieceState::Open);
            self.push(
                tube,
                PendingPiece { piece: half, lower, state, narrow, levels: MOST_LEVELS },
            );
        }
        true
    }
}
