//! The refinement of a shape of a motion: it divides a tube only as finely as a policy needs.
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

use super::approach_bound::Approach;
use crate::answer::ProximityError;
use crate::refine::Refinable;
use parry3d_f64::math::Real;

/// A work item: a piece, or an item that has a piece in the current shape of a moving tube.
pub(super) trait WorkItem<T: Refinable>: Copy {
    /// Returns the piece of this item in the current shape.
    fn piece(&self, tube: &T) -> T::Piece;

    /// Splits the item as its piece is split.
    fn halves(self, tube: &T, halves: [T::Piece; 2]) -> [Self; 2];
}

/// The policy's query for one body.
pub(super) struct BodyQuery {
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
pub(super) struct BoundedPiece<'a, T: Refinable, P> {
    pub part: &'a P,
    pub piece: &'a T::Piece,
    pub outer: &'a T::Body,
    /// What is nearest to the body. Its distance is a lower bound on the clearance of the part.
    pub nearest: &'a T::Nearest,
    /// The upper bound on the clearance.
    pub found: &'a T::Upper,
}

/// What happens to a part whose body is within the bound.
pub(super) enum RefineAction {
    /// The part needs no more work in this shape.
    Settled,
    /// Process the halves. Their bodies at a face exceed the tube by about this length.
    Halve(Real),
    /// Stop: the answer is known.
    Answered,
}

/// Decides how far [`refine`] divides the parts, and collects the answer.
pub(super) trait RefinePolicy<T: Refinable, P> {
    /// Whether the half that contains the place of the upper bound is processed first.
    const NEARER_HALF_FIRST: bool;

    /// Whether the remaining parts cannot change the answer.
    fn is_done(&self) -> bool;

    /// Returns the query for the body of a part, and how much nearer the part may come.
    ///
    /// # Errors
    /// The part cannot be tested.
    fn body_query(
        &mut self,
        tube: &T,
        part: &P,
        piece: &T::Piece,
        outer: &T::Body,
    ) -> Result<(BodyQuery, Approach), ProximityError>;

    /// Called for a body that is farther away than its bound.
    fn on_cleared(&mut self) {}

    /// Decides what happens to a part whose body is within the bound.
    ///
    /// # Errors
    /// The part cannot be tested.
    fn decide(
        &mut self,
        tube: &T,
        bounded: &BoundedPiece<T, P>,
        approach: &Approach,
    ) -> Result<RefineAction, ProximityError>;

    /// Called for a part that should be halved and has no halves.
    ///
    /// # Errors
    /// The part cannot be decided without its halves.
    fn decide_indivisible(
        &mut self,
        tube: &T,
        bounded: &BoundedPiece<T, P>,
        approach: &Approach,
    ) -> Result<(), ProximityError>;
}

/// Refines all parts, the last one first. Parts that the answer did not need stay in `parts`.
///
/// # Errors
/// The curve of the tube is not finite, or a part cannot be tested.
pub(super) fn refine<T: Refinable, P: WorkItem<T>, R: RefinePolicy<T, P>>(
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
        let (BodyQuery { bound, is_wide, aim, start }, approach) =
            policy.body_query(tube, &part, &piece, &outer)?;
        // Step 2.
        if is_wide && let Some(halves) = tube.halves(&piece, &outer, aim) {
            if tube.may_meet(&outer, bound) {
                parts.extend(part.halves(tube, halves));
            } else {
                policy.on_cleared();
            }
            continue;
        }
        // Step 3.
        let Some(nearest) = tube.nearest(&outer, bound, start) else {
            policy.on_cleared();
            continue;
        };
        // Step 4.
        let found = tube.found(&piece, &outer, &nearest);
        let bounded = BoundedPiece {
            part: &part,
            piece: &piece,
            outer: &outer,
            nearest: &nearest,
            found: &found,
        };
        // Step 5.
        match policy.decide(tube, &bounded, &approach)? {
            RefineAction::Settled => {}
            RefineAction::Answered => return Ok(()),
            RefineAction::Halve(aim) => match tube.halves(&piece, &outer, aim) {
                Some(halves) => {
                    let is_in_first = tube.is_in_first_half(&found, &halves);
                    let [first, second] = part.halves(tube, halves);
                    let swap = R::NEARER_HALF_FIRST && is_in_first;
                    parts.extend(if swap { [second, first] } else { [first, second] });
                }
                None => policy.decide_indivisible(tube, &bounded, &approach)?,
            },
        }
    }
    Ok(())
}
