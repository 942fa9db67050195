//! The refinement loop: it divides a tube only as finely as a policy needs.
//!
//! # Definitions
//! - **Tube**: any [`Refinable`]; one tube in a mesh, two tubes, or one tube beside itself, in the
//!   shape at one instant of a motion.
//! - **Part**: a work item. It is a piece of the tube, or it identifies one in the shape at that
//!   instant.
//! - **Body**: a convex bounding volume of a piece ([`Refinable::body`]). The pieces of a chain are
//!   straight: their bodies are the links.
//! - **Bound**: the distance beyond which a body does not matter to the policy.
//!
//! # Algorithm
//! [`refine`] takes parts from a stack until it is empty or the policy is done.
//! 1. **Query.** Compute the body of the part. The policy gives the bound.
//! 2. **Halve early.** If the body is wide and can be halved: clear it if it is farther than the
//!    bound, otherwise push its halves.
//! 3. **Measure.** Find the nearest triangle or link. A body farther than the bound is cleared.
//! 4. **Bound from above.** The point nearest to the body yields an upper bound on the clearance of
//!    the part. The distance of the body is a lower bound.
//! 5. **Decide.** The policy settles the part, halves it, or ends the loop.
//!
//! Far from the wall one capsule clears a whole section. Near the wall the curve is divided as
//! finely as the answer needs.

use crate::answer::ProximityError;
use parry3d_f64::math::Real;

/// A work item: a piece, or an item that has a piece in the current shape of a moving tube.
pub(crate) trait WorkItem<T: Refinable>: Copy {
    /// Returns the piece of this item in the current shape.
    fn piece(&self, tube: &T) -> T::Piece;

    /// Splits the item as its piece is split.
    fn halves(self, tube: &T, halves: [T::Piece; 2]) -> [Self; 2];
}

/// The policy's query for one body.
pub(crate) struct BodyQuery {
    /// Bodies farther away than this are cleared.
    pub bound: Real,
    /// Whether the body is wide enough to halve it before it is measured.
    pub is_wide: bool,
    /// The bodies of the halves at a face exceed the tube by about this length.
    pub aim: Real,
    /// A triangle that is probably near: it starts the search.
    pub start: Option<u32>,
}

/// A part with its body, and the bounds on its clearance.
pub(crate) struct BoundedPiece<'a, T: Refinable, P> {
    pub part: &'a P,
    pub piece: &'a T::Piece,
    pub outer: &'a T::Body,
    /// What is nearest to the body. Its distance is a lower bound on the clearance of the part.
    pub nearest: &'a T::Nearest,
    /// The upper bound on the clearance.
    pub found: &'a T::Upper,
}

/// What happens to a part whose body is within the bound.
pub(crate) enum RefineAction {
    /// The part needs no more work in this shape.
    Settled,
    /// Process the halves. Their bodies at a face exceed the tube by about this length.
    Halve(Real),
    /// Stop: the answer is known.
    Answered,
}

/// Decides how far [`refine`] divides the parts, and collects the answer.
pub(crate) trait RefinePolicy<T: Refinable, P> {
    /// What the query of a body computes and the decision about its part needs again.
    type OfPart;

    /// Whether the half that contains the place of the upper bound is processed first.
    const NEARER_HALF_FIRST: bool;

    /// Whether the remaining parts cannot change the answer.
    fn is_done(&self) -> bool;

    /// Returns the query for the body of a part.
    ///
    /// # Errors
    /// The part cannot be tested.
    fn body_query(
        &mut self,
        tube: &T,
        part: &P,
        piece: &T::Piece,
        outer: &T::Body,
    ) -> Result<(BodyQuery, Self::OfPart), ProximityError>;

    /// Called for a body that is farther away than its `bound`.
    fn on_cleared(&mut self, piece: &T::Piece, outer: &T::Body, bound: Real);

    /// Decides what happens to a part whose body is within the bound.
    ///
    /// # Errors
    /// The part cannot be tested.
    fn decide(
        &mut self,
        tube: &T,
        near: &BoundedPiece<T, P>,
        of_part: &Self::OfPart,
    ) -> Result<RefineAction, ProximityError>;

    /// Called for a part that should be halved and has no halves.
    ///
    /// # Errors
    /// The part cannot be decided without its halves.
    fn decide_indivisible(
        &mut self,
        tube: &T,
        near: &BoundedPiece<T, P>,
        of_part: &Self::OfPart,
    ) -> Result<(), ProximityError>;
}

/// Refines all parts, the last one first. Parts that the answer did not need stay in `parts`.
///
/// # Errors
/// The curve of the tube is not finite, or a part cannot be tested.
pub(crate) fn refine<T: Refinable, P: WorkItem<T>, R: RefinePolicy<T, P>>(
    tube: &mut T,
    parts: &mut Vec<P>,
    policy: &mut R,
) -> Result<(), ProximityError> {
    while let Some(part) = parts.pop() {
        if policy.is_done() {
            parts.push(part);
            return Ok(());
        }
        let piece = part.piece(tube);
        let outer = tube.body(&piece);
        tube.check_finite(&piece, &outer)?;
        // Step 1.
        let (BodyQuery { bound, is_wide, aim, start }, of_part) =
            policy.body_query(tube, &part, &piece, &outer)?;
        // Step 2.
        if is_wide && let Some(halves) = tube.halves(&piece, &outer, aim) {
            if tube.may_meet(&outer, bound) {
                parts.extend(part.halves(tube, halves));
            } else {
                policy.on_cleared(&piece, &outer, bound);
            }
            continue;
        }
        // Step 3.
        let Some(nearest) = tube.nearest(&outer, bound, start) else {
            policy.on_cleared(&piece, &outer, bound);
            continue;
        };
        // Step 4.
        let found = tube.found(&piece, &outer, &nearest);
        let near = BoundedPiece {
            part: &part,
            piece: &piece,
            outer: &outer,
            nearest: &nearest,
            found: &found,
        };
        // Step 5.
        match policy.decide(tube, &near, &of_part)? {
            RefineAction::Settled => {}
            RefineAction::Answered => return Ok(()),
            RefineAction::Halve(aim) => match tube.halves(&piece, &outer, aim) {
                Some(halves) => {
                    let is_in_first = tube.is_in_first_half(&found, &halves);
                    let [first, second] = part.halves(tube, halves);
                    let swap = R::NEARER_HALF_FIRST && is_in_first;
                    parts.extend(if swap { [second, first] } else { [first, second] });
                }
                None => policy.decide_indivisible(tube, &near, &of_part)?,
            },
        }
    }
    Ok(())
}

/// A shape that is divided into pieces, each with a convex body.
///
/// The distance of a body is a lower bound on the clearance of its piece. The bound improves as
/// pieces become shorter.
pub(crate) trait Refinable {
    /// One piece of one tube, or one piece of each of two tubes.
    type Piece: Copy;
    /// The bounding volume of a piece.
    type Body: Body;
    /// The nearest triangle or link to a body.
    type Nearest;
    /// An upper bound on the clearance, with the place that realises it.
    type Upper: UpperBound;

    fn body(&self, piece: &Self::Piece) -> Self::Body;

    /// The place of a piece along the tube: an order of pieces that do not overlap.
    fn place(&self, piece: &Self::Piece) -> [u32; 4];

    /// Checks the body of a piece. ([`body`](Self::body) returns no `Result`: the body is large,
    /// and the `Result` would copy it once more per piece.)
    ///
    /// # Errors
    /// The curve of the piece, and so its body, is not finite.
    fn check_finite(&self, piece: &Self::Piece, body: &Self::Body) -> Result<(), ProximityError>;

    /// Returns the halves of a piece; `None` if halving does not make its body narrower.
    ///
    /// At a face the short half is chosen so that its body exceeds the tube by at most about `aim`.
    fn halves(&self, piece: &Self::Piece, body: &Self::Body, aim: Real)
    -> Option<[Self::Piece; 2]>;

    /// Whether the obstacle may be at most `bound` away from a body (conservative).
    fn may_meet(&mut self, body: &Self::Body, bound: Real) -> bool;

    /// Returns what is nearest to a body, if it is at most `bound` away. `start`: a triangle that
    /// is probably near; ignored without triangles.
    fn nearest(
        &mut self,
        body: &Self::Body,
        bound: Real,
        start: Option<u32>,
    ) -> Option<Self::Nearest>;

    /// Returns the distance of `nearest`: a lower bound on the clearance of the piece.
    fn distance(nearest: &Self::Nearest) -> Real;

    /// Returns the upper bound on the clearance that `nearest` yields.
    fn found(&self, piece: &Self::Piece, body: &Self::Body, nearest: &Self::Nearest)
    -> Self::Upper;

    /// Whether the place of the upper bound lies in the first of two halves.
    fn is_in_first_half(&self, found: &Self::Upper, halves: &[Self::Piece; 2]) -> bool;

    /// Returns the larger radius of a piece.
    fn radius(&self, piece: &Self::Piece) -> Real;

    /// Returns the gap between the bounds of a piece that unknown or uncertain directions of nearby
    /// faces cause.
    fn direction_uncertainty(&self, piece: &Self::Piece) -> Real;

    /// Whether the whole piece belongs to the queried set, given its upper bound.
    fn is_entirely_queried(&self, _: &Self::Piece, _: &Self::Upper) -> bool {
        true
    }

    /// Whether bodies treat a flat end of the piece as round because it may become round in the
    /// motion.
    fn may_become_round(&self, _: &Self::Piece) -> bool {
        false
    }

    /// Returns the gap between the bounds that the stated position errors cause.
    fn position_uncertainty(&self) -> Real;

    /// A bound on the rounding error of any length.
    fn slack(&self) -> Real;

    /// Returns the gap between the bounds of a piece that all stated or missing information causes.
    fn uncertainty(&self, piece: &Self::Piece) -> Real {
        self.position_uncertainty() + self.direction_uncertainty(piece)
    }

    /// Checks that bounds that are `possible` apart meet the resolution, up to rounding.
    ///
    /// # Errors
    /// `possible > resolution`: the samples allow no finer resolution.
    fn check_resolved(&self, possible: Real, resolution: Real) -> Result<(), ProximityError> {
        // This form makes NaN an error.
        if possible <= resolution + 16.0 * self.slack() {
            Ok(())
        } else {
            Err(ProximityError::ToleranceTooFine {
                parameter: "resolution",
                tolerance: resolution,
                possible,
            })
        }
    }
}

/// The bounding volume of a piece, or of a pair of pieces.
pub(crate) trait Body: Copy {
    /// By about how much the body is larger than the piece.
    fn excess(&self) -> Real;

    /// Whether an end of the body is flat.
    fn is_flat(&self) -> bool;
}

/// An upper bound on a clearance.
pub(crate) trait UpperBound: Copy {
    fn upper(&self) -> Real;

    /// The triangle that realises the bound, if there is one.
    fn triangle(&self) -> Option<u32>;

    /// The tie order: of equal bounds the least `tie` is the answer (triangle and section, or two
    /// sections).
    fn tie(&self) -> [u32; 2];
}
