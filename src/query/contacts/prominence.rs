//! Which local minima are prominent: how far every way on the mesh to a nearer one leads away
//! first.
//!
//! # What is left out
//! A rough wall has a local minimum at each of its bumps. Let p be the prominence that is asked
//! for, and take the minima of one link nearest first. The minimum C, at the distance d(C), is
//! *left out* if a way on the wall leads from it to one that is kept, along which the distance
//! stays below d(C) + p and within the margin, and if the normals of the two differ by 60 degrees
//! at most. So
//!
//! 1. *each wall stays*: a minimum that is left out has a nearer one that stands for it, is joined
//!    with it by a way that rises by less than p, and pushes the link within 60 degrees of the same
//!    direction. In particular the nearest of each connected piece of wall within the margin is
//!    kept, and so are both sides of a groove;
//! 2. *none is left that is shallow*: a way from a minimum that is kept to a nearer one with such a
//!    normal rises by p at least, or leads beyond the margin;
//! 3. *the choice is the only one* with these two properties, because it is made from the nearest
//!    on.
//!
//! A contact without a normal stands for itself alone.
//!
//! # Passes
//! What of a triangle is within a distance c is convex, because the link is. So two triangles are
//! joined by a corner or an edge f that both have exactly from c = d(f) on (see `local_minima`): a
//! way that stays within c can follow a chain of triangles each of which shares with the next an f
//! with d(f) <= c. The least distance of f is a *pass*, and the pieces of wall within c are what
//! passes up to c join. Between its ends an edge may be nearer than at them, and is a pass of its
//! own; else the nearer of its ends is one.
//!
//! C asks for the pieces of wall below d(C) + p. As the minima are taken nearest first, these
//! distances rise: what is one piece for one of them is so for all that come later. All triangles
//! that may be within the margin take part, those on slopes too. Passes are measured in double
//! precision, an edge always from the same end, so that they are the same bit for bit in all
//! engines.
//!
//! The pass f counts as within the margin if it is so by more than what rounding can do to its
//! distance. Then every triangle that has f is found by every engine.
//!
//! # How much work it is
//! A minimum without a normal like that of one that is kept is kept. From any other the wall is
//! followed (`flood`), over passes below d(C) + p, corners first, until one is reached that stands
//! for it, and no farther: mostly that one is a few triangles away. What was reached stays joined,
//! as these distances rise, so that nothing is followed twice and a minimum that reaches what
//! another has followed goes on at its rim. A corner is measured once, when a triangle that has it
//! is reached, in waves, so that packs are full. An edge is measured only if it may be nearer
//! between its ends and joins something that is not joined yet.
//!
//! Only from a minimum that is kept all is followed that is below d(C) + p. A triangle is at the
//! rim of few such pieces: those of their minima that are in one piece differ in their normals by
//! more than 60 degrees, and no more than a dozen can. So their work grows with what is less than p
//! above a minimum, and at most with the triangles within the margin. One that is left out may
//! go around the whole rim of such a piece before it meets what stands for it, but mostly that is
//! beside it. Of those that are kept in one piece a minimum asks one after another, first the one
//! that answered last: where there are many, most have such a normal.

use super::flood::Flood;
use super::link_neighbourhood::LinkNeighbourhood;
use crate::answer::Contact;
use fearless_simd::Level;
use parry3d_f64::math::Real;

/// The cosine of the angle between normals beyond which no contact stands for another.
const MIN_COSINE: Real = 0.5;

/// Which contacts a caller wants.
#[derive(Clone, Copy)]
pub(crate) struct ContactQuery {
    /// How far away they may be.
    pub margin: Real,
    /// How prominent each must be.
    pub prominence: Real,
}

/// Memory that is used again.
#[derive(Clone, Default)]
pub(super) struct Prominence {
    flood: Flood,
    /// The minima that are kept.
    kept: Vec<u32>,
}

impl Prominence {
    /// For each contact of one link, nearest first, whether it has such a prominence. `keep` gets
    /// the answers.
    pub(super) fn keep_prominent(
        &mut self,
        level: Level,
        around: LinkNeighbourhood,
        prominence: Real,
        contacts: &[Contact],
        keep: &mut Vec<bool>,
    ) {
        if contacts.len() < 2 {
            keep.extend(contacts.iter().map(|_| true));
            return;
        }
        let Self { flood, kept } = self;
        flood.begin(around);
        kept.clear();
        for (minimum, contact) in (0..).zip(contacts) {
            let is_near = contact.normal.is_some() && around.holds(contact.triangle);
            let stands_for_it = |other: u32| {
                let normals = contact.normal.zip(contacts[other as usize].normal);
                normals.is_some_and(|(one, other)| MIN_COSINE <= one.dot(other))
            };
            let below = contact.distance + prominence;
            let is_left_out = is_near
                && is_represented(kept, stands_for_it)
                && flood.reaches(level, around, contact.triangle, below, stands_for_it);
            if is_near && !is_left_out {
                flood.keep(around, contact.triangle, minimum);
                kept.push(minimum);
            }
            keep.push(!is_left_out);
        }
    }
}

/// Whether one of them stands for a minimum. It is the first to be asked about the next, which
/// mostly is beside this one.
fn is_represented(kept: &mut [u32], stands_for_it: impl Fn(u32) -> bool) -> bool {
    let place = kept.iter().position(|&other| stands_for_it(other));
    if let Some(place) = place {
        kept.swap(0, place);
    }
    place.is_some()
}
