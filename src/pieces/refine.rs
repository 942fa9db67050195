//! The loop that divides a tube in the shape of one moment, no finer than a question about a motion
//! needs.
//!
//! The centreline is taken in pieces, each in a convex body that is searched like a link. A body
//! that keeps away settles its piece; one that does not gives a triangle, whose nearest point
//! bounds the clearance from above, and the piece is halved where the two bounds are too far apart.
//! So far from the wall one capsule stands for a whole section, and near it the curve is resolved
//! as finely as the answer needs. A chain is a tube whose pieces are straight: their bodies are the
//! links themselves.

use super::refinable::Refinable;
use crate::answer::ProximityError;
use parry3d_f64::math::Real;

/// What waits for its turn: a piece, or what is one in the present shape of a tube that moves.
pub(crate) trait WorkItem<T: Refinable>: Copy {
    /// The piece that holds it.
    fn piece(&self, tube: &T) -> T::Piece;

    /// Its halves, as the piece that holds it is halved.
    fn halves(self, tube: &T, halves: [T::Piece; 2]) -> [Self; 2];
}

/// How a question looks at a body.
pub(crate) struct BodyQuery {
    /// What is farther away than this does not matter.
    pub bound: Real,
    /// Whether the body is so wide that its halves are better looked at, if anything is near it at
    /// all.
    pub is_wide: bool,
    /// How near to the tube the bodies of halves are to come at a face.
    pub aim: Real,
    /// A triangle that is likely to be near.
    pub start: Option<u32>,
}

/// A part with its body, and what was found near it.
pub(crate) struct BoundedPiece<'a, T: Refinable, P> {
    pub part: &'a P,
    pub piece: &'a T::Piece,
    pub outer: &'a T::Body,
    /// What is nearest to the body, at a distance that bounds the clearance of the part from
    /// below.
    pub nearest: &'a T::Nearest,
    /// What bounds it from above.
    pub found: &'a T::Upper,
}

/// What becomes of a part that something is near to.
pub(crate) enum RefineAction {
    /// It is settled.
    Settled,
    /// Its halves have to be looked at, which come as near to the tube as this at a face.
    Halve(Real),
    /// The question is answered.
    Answered,
}

/// What is asked of a tube.
pub(crate) trait RefinePolicy<T: Refinable, P> {
    /// Whether the half that is nearer to what was found comes first.
    const NEARER_HALF_FIRST: bool;

    /// Whether the parts that are left cannot change the answer.
    fn is_done(&self) -> bool;

    /// # Errors
    /// The part cannot be judged.
    fn body_query(
        &mut self,
        tube: &T,
        part: &P,
        piece: &T::Piece,
        outer: &T::Body,
    ) -> Result<BodyQuery, ProximityError>;

    /// The body of a part is farther away than the bound of its look.
    fn on_cleared(&mut self, piece: &T::Piece, outer: &T::Body, bound: Real);

    /// # Errors
    /// The part cannot be judged.
    fn decide(
        &mut self,
        tube: &T,
        near: &BoundedPiece<T, P>,
    ) -> Result<RefineAction, ProximityError>;

    /// A part whose halves were wanted has none.
    ///
    /// # Errors
    /// It cannot be judged without.
    fn decide_indivisible(
        &mut self,
        tube: &T,
        near: &BoundedPiece<T, P>,
    ) -> Result<(), ProximityError>;
}

/// Asks a question of all parts, the last one first. Those that were not needed for the answer are
/// left in `parts`.
///
/// # Errors
/// The curve of the tube is not finite, or a part cannot be judged.
pub(crate) fn refine<T: Refinable, P: WorkItem<T>, Q: RefinePolicy<T, P>>(
    tube: &mut T,
    parts: &mut Vec<P>,
    question: &mut Q,
) -> Result<(), ProximityError> {
    while let Some(part) = parts.pop() {
        if question.is_done() {
            parts.push(part);
            return Ok(());
        }
        let piece = part.piece(tube);
        let outer = tube.body(&piece);
        tube.check_finite(&piece, &outer)?;
        let BodyQuery { bound, is_wide, aim, start } =
            question.body_query(tube, &part, &piece, &outer)?;
        if is_wide && let Some(halves) = tube.halves(&piece, &outer, aim) {
            if tube.may_meet(&outer, bound) {
                parts.extend(part.halves(tube, halves));
            } else {
                question.on_cleared(&piece, &outer, bound);
            }
            continue;
        }
        let Some(nearest) = tube.nearest(&outer, bound, start) else {
            question.on_cleared(&piece, &outer, bound);
            continue;
        };
        let found = tube.found(&piece, &outer, &nearest);
        let near = BoundedPiece {
            part: &part,
            piece: &piece,
            outer: &outer,
            nearest: &nearest,
            found: &found,
        };
        match question.decide(tube, &near)? {
            RefineAction::Settled => {}
            RefineAction::Answered => return Ok(()),
            RefineAction::Halve(aim) => match tube.halves(&piece, &outer, aim) {
                Some(halves) => {
                    let is_in_first = tube.is_in_first_half(&found, &halves);
                    let [first, second] = part.halves(tube, halves);
                    let swap = Q::NEARER_HALF_FIRST && is_in_first;
                    parts.extend(if swap { [second, first] } else { [first, second] });
                }
                None => question.decide_indivisible(tube, &near)?,
            },
        }
    }
    Ok(())
}
