//! The pending pieces of a query, in a priority queue: best first.
//!
//! # Definitions
//! - `lower` of a piece: a lower bound on its clearance. Of a measured piece it is max(distance of
//!   its body, `lower` of its parent).
//! - `direction_gap` of a piece: the gap between its bounds that the unknown or uncertain direction
//!   of a face causes ([`Refinable::direction_uncertainty`]).
//! - `found` of a piece: the upper bound on the clearance that the piece yields.
//! - A **measured** piece has its distance and its `found`. An **open** piece has the `lower` of
//!   its parent. A **distant** piece was searched without a result, and `lower` is the bound of
//!   that search: its distance is strictly larger.
//! - The **rank** of a measured piece: (`lower` + `direction_gap`, upper bound of `found`, place
//!   along the tube). An open piece ranks by (`lower`, 0, place), a distant piece by (`lower`,
//!   infinity, place).
//!
//! # Claim
//! Let a query divide only the measured piece of least rank, and only if it is first among all
//! pieces. Then the sequence of divisions depends only on the tube and on the obstacle. It is
//! independent of search bounds, of start triangles and of the tolerance.
//!
//! **Proof.** Distance, `found`, `direction_gap` and place are functions of the piece. By induction
//! over its parents, so is the `lower` of a measured piece. Measuring a piece never lowers its
//! rank: an open piece has the least second part, and a distant piece gets a larger `lower`. So if
//! a measured piece is the first of all, it would also be the first if all pieces were measured.
//!
//! Two consequences:
//! - An upper bound of an earlier query may save searches. It never enters a result.
//! - A finer tolerance continues the same sequence. No `lower` falls and no upper bound rises, so
//!   its bounds are never looser.

use super::refinable::{Body, Refinable, UpperBound};
use crate::answer::ProximityError;
use parry3d_f64::math::Real;
use std::cmp::Ordering;
use std::collections::BinaryHeap;

/// The body of a half at a face exceeds the tube by at most this share of its parent's excess.
const AIM_OF_HALVES: Real = 1.0 / 8.0;

/// How often a piece may be halved before it is measured. Each halving divides the excess of a body
/// along its chord by about four.
pub(crate) const MOST_LEVELS: u8 = 2;

/// The state of a pending piece.
#[derive(Clone, Copy, Debug)]
pub(crate) enum PieceState<B, F> {
    /// Not examined.
    Open,
    /// Its distance is larger than its `lower`.
    Distant,
    /// Measured: its body and its upper bound.
    Measured(B, F),
}

/// A piece with its lower bound and its state.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PendingPiece<P, B, F> {
    pub piece: P,
    pub lower: Real,
    pub state: PieceState<B, F>,
    /// A body wider than this is halved before it is measured.
    pub narrow: Real,
    /// How many such halvings are left.
    pub levels: u8,
}

/// The position of a piece in the queue, and its slot.
#[derive(Clone, Copy, Debug)]
struct Rank {
    /// `lower` + `direction_gap`; the `direction_gap` of an unmeasured piece is 0.
    least: Real,
    /// The upper bound of a measured piece; infinity for a distant piece, 0 for an open one.
    upper: Real,
    is_measured: bool,
    place: [u32; 4],
    slot: u32,
}

impl Ord for Rank {
    /// Reversed: the piece of least rank is the greatest element of the heap.
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

/// The first piece of the queue.
#[derive(Clone, Copy, Debug)]
pub(crate) struct First {
    /// `lower` + `direction_gap`; the `direction_gap` of an unmeasured piece is 0.
    pub least: Real,
    pub is_measured: bool,
}

/// The result of [`PendingPieces::examine`].
#[derive(Clone, Copy, Debug)]
pub(crate) enum Examined<F> {
    /// The body is farther away than the bound.
    Away,
    /// The piece was halved because its body is too wide.
    Divided,
    /// The piece was measured; its upper bound.
    Measured(F),
}

/// The undivided pieces of a query. A later query reuses the memory.
#[derive(Clone, Debug)]
pub(crate) struct PendingPieces<P, B, F> {
    pieces: Vec<PendingPiece<P, B, F>>,
    /// Free slots of `pieces`.
    free: Vec<u32>,
    queue: BinaryHeap<Rank>,
    /// Measured pieces that have no halves.
    whole: Vec<PendingPiece<P, B, F>>,
    /// The initial pieces of a decision.
    pub begun: Vec<P>,
}

impl<P, B, F> Default for PendingPieces<P, B, F> {
    fn default() -> Self {
        let (pieces, free, whole) = (Vec::new(), Vec::new(), Vec::new());
        Self { pieces, free, queue: BinaryHeap::new(), whole, begun: Vec::new() }
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
        let (direction_gap, upper, is_measured) = match &piece.state {
            PieceState::Open => (0.0, 0.0, false),
            PieceState::Distant => (0.0, Real::INFINITY, false),
            PieceState::Measured(_, found) => {
                (tube.direction_uncertainty(&piece.piece), found.upper(), true)
            }
        };
        let place = tube.place(&piece.piece);
        self.queue.push(Rank {
            least: piece.lower + direction_gap,
            upper,
            is_measured,
            place,
            slot,
        });
        match self.pieces.get_mut(slot as usize) {
            Some(free) => *free = piece,
            None => self.pieces.push(piece),
        }
    }

    /// Keeps a measured piece that has no halves, outside the queue.
    pub(crate) fn push_whole(&mut self, piece: PendingPiece<P, B, F>) {
        self.whole.push(piece);
    }

    pub(crate) fn first(&self) -> Option<First> {
        let rank = self.queue.peek()?;
        Some(First { least: rank.least, is_measured: rank.is_measured })
    }

    /// Removes the first piece.
    pub(crate) fn pop(&mut self) -> Option<PendingPiece<P, B, F>> {
        let rank = self.queue.pop()?;
        self.free.push(rank.slot);
        Some(self.pieces[rank.slot as usize])
    }

    /// Returns all pieces. They cover the tube except for the pieces that the query dropped.
    pub(crate) fn all(&self) -> impl Iterator<Item = &PendingPiece<P, B, F>> {
        let queued = self.queue.iter().map(|rank| &self.pieces[rank.slot as usize]);
        queued.chain(&self.whole)
    }

    /// Examines a popped piece that is not measured.
    ///
    /// Halves the piece if `width` of its body exceeds its `narrow` and halvings are left;
    /// otherwise measures it within `bound`. Pushes the halves or the measured piece. `start`: a
    /// triangle that is probably near.
    ///
    /// # Errors
    /// The curve of the piece is not finite.
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

    /// Halves a popped measured piece and pushes the open halves; false if it has no halves. Halves
    /// with bodies wider than `narrow` are halved again before they are measured.
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
