//! Which local minima are prominent: how far every path on the mesh to a nearer minimum must first
//! rise.
//!
//! # Definitions
//! - p: the prominence that the query asks for.
//! - d(C): the distance of a minimum C.
//! - Take the minima of one link, nearest first. C is *dropped* if a path on the wall leads from C
//!   to a kept minimum, such that
//!   - the distance along the path stays below `d(C) + p` and within the margin, and
//!   - the normals of the two minima differ by at most 60 degrees.
//!
//! A contact without a normal is always kept, and represents no other.
//!
//! # Claim
//! 1. *Each wall stays*: a dropped minimum has a nearer one that *represents* it. A path between
//!    the two rises by less than p, and the directions in which they push the link differ by at
//!    most 60 degrees. In particular the nearest minimum of each connected piece of wall within the
//!    margin is kept, and so are both sides of a groove.
//! 2. *No shallow minimum stays*: a path from a kept minimum to a nearer one with such a normal
//!    rises by at least p, or leaves the margin.
//! 3. *The choice is unique* with properties 1 and 2, because it is made from the nearest minimum
//!    on.
//!
//! # Passes
//! The part of a triangle within a distance c is convex, because the link is. So two triangles are
//! joined by a shared corner or edge f exactly from `c = d(f)` on (see `local_minima`). A path
//! within c can follow a chain of triangles in which each shares with the next an f with
//! `d(f) <= c`. The least distance of f is a *pass*. The pieces of wall within c are joined by the
//! passes up to c. If an edge is nearer between its ends than at both, the edge itself is a pass;
//! otherwise the nearer of its ends is.
//!
//! C queries the pieces of wall below `d(C) + p`. These distances rise, since the minima are taken
//! nearest first. So a piece for one minimum is part of one piece for all later minima. All
//! triangles that may be within the margin take part, culled ones too.
//!
//! **Determinism.** Passes are measured in double precision, an edge always from the same end. So
//! they are the same bit for bit in all engines. A pass f counts as within the margin only if it is
//! so by more than the rounding of its distance. Then every engine finds every triangle that has f.
//!
//! # Cost
//! - A minimum is kept at once if no kept minimum has a similar normal.
//! - From any other one the wall is flooded (`flood`) over passes below `d(C) + p`, corners first.
//!   The flood ends at a minimum that represents it. Mostly that minimum is a few triangles away.
//! - Reached pieces stay joined, because the distances rise. So no triangle is flooded twice, and a
//!   later flood continues at the rim of an earlier one.
//! - A corner is measured once, when a triangle that has it is reached, in waves, so that packs are
//!   full. An edge is measured only if it may be nearer between its ends and may join another
//!   piece.
//! - Only a kept minimum is flooded over the whole piece below `d(C) + p`. A triangle is at the rim
//!   of few such pieces: the kept minima of one piece differ in their normals by more than 60
//!   degrees, and at most a dozen directions can do so. So the cost of kept minima grows with the
//!   triangles less than p above a minimum, and at most with the triangles within the margin.
//! - A dropped minimum may go around the whole rim of such a piece before it meets its
//!   representative, but mostly that is beside it. It tests the kept minima of a piece in turn, the
//!   last representative first: if there are many, most have a similar normal.

use super::flood::Flood;
use super::link_neighbourhood::LinkNeighbourhood;
use crate::answer::Contact;
use fearless_simd::Level;
use parry3d_f64::math::Real;

/// The cosine of the greatest angle between the normals of a contact and its representative.
const MIN_COSINE: Real = 0.5;

/// The contacts that a caller wants.
#[derive(Clone, Copy)]
pub(crate) struct ContactQuery {
    /// The greatest distance of a contact.
    pub margin: Real,
    /// The least prominence of a contact.
    pub prominence: Real,
}

/// State of a query; its memory is reused by later queries.
#[derive(Clone, Default)]
pub(super) struct Prominence {
    flood: Flood,
    /// The kept minima.
    kept: Vec<u32>,
}

impl Prominence {
    /// Appends to `keep`, for each contact of one link, nearest first, whether it has the
    /// prominence.
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
            let is_near = contact.normal.is_some() && around.holds(contact.witness.triangle);
            let stands_for_it = |other: u32| {
                let normals = contact.normal.zip(contacts[other as usize].normal);
                normals.is_some_and(|(one, other)| MIN_COSINE <= one.dot(other))
            };
            let below = contact.distance + prominence;
            let is_left_out = is_near
                && is_represented(kept, stands_for_it)
                && flood.reaches(level, around, contact.witness.triangle, below, stands_for_it);
            if is_near && !is_left_out {
                flood.keep(around, contact.witness.triangle, minimum);
                kept.push(minimum);
            }
            keep.push(!is_left_out);
        }
    }
}

/// Returns true if a kept minimum can represent another one. Moves it to the front, because the
/// next minimum is mostly beside this one.
fn is_represented(kept: &mut [u32], stands_for_it: impl Fn(u32) -> bool) -> bool {
    let place = kept.iter().position(|&other| stands_for_it(other));
    if let Some(place) = place {
        kept.swap(0, place);
    }
    place.is_some()
}
