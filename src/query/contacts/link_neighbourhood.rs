//! The passes between the triangles near a link: the least distances of the corners and edges that
//! they share. `prominence` says what for.

use super::triangle_candidates::{CandidateIndex, LinkCandidates};
use super::wall::Wall;
use crate::pair::{Height, PlacedLink};
use parry3d_f64::math::{Real, Vector};

/// What is near one link.
#[derive(Clone, Copy)]
pub(super) struct LinkNeighbourhood<'a> {
    pub link: &'a PlacedLink,
    pub wall: Wall<'a>,
    pub near: LinkCandidates<'a>,
    pub index: &'a CandidateIndex,
    /// How far away a pass may be.
    pub margin: Real,
}

impl LinkNeighbourhood<'_> {
    /// Whether a triangle is near.
    #[inline(always)]
    pub(super) fn holds(&self, triangle: u32) -> bool {
        self.near.index(self.index, triangle).is_some()
            || self.near.is_culled(self.index, self.wall.place_of(), triangle)
    }

    /// Whether what has this height is a pass below a distance.
    #[inline(always)]
    pub(super) fn is_pass(&self, height: &Height, below: Real) -> bool {
        height.distance < below && height.distance + height.rounding <= self.margin
    }

    /// Whether an edge that leads `along` from one end to the other may be a pass below a distance
    /// although neither of its ends is.
    pub(super) fn may_pass_between(&self, ends: [&Height; 2], along: Vector, below: Real) -> bool {
        lower_between(ends, along).is_some_and(|lower| lower < below && lower <= self.margin)
    }
}

/// A lower bound on the distance of an edge that leads `along` from one end to the other, if that
/// may be less than at both ends.
///
/// The distance is convex along the edge. At an end at the distance d and with the way W from the
/// link to it, it changes by g = W . along / |W| on the whole edge. If it does not fall from one of
/// the ends on, it is least there. Else it lies above both tangents d1 + s g1 and d2 + (1 - s) g2,
/// which cross at s = (d2 + g2 - d1) / (g1 + g2). Rounding turns W by its own share of d.
fn lower_between([one, other]: [&Height; 2], along: Vector) -> Option<Real> {
    let rounding = one.rounding.max(other.rounding);
    let turned = 4.0 * rounding * along.length() / one.distance.min(other.distance);
    let change =
        [one.way.dot(along) / one.way.length(), -other.way.dot(along) / other.way.length()];
    // No number where there is no way: nothing is nearer.
    if !(change[0] < turned && change[1] < turned) {
        return None;
    }
    let fall = change.map(|change| change.min(0.0) - turned);
    let share = (other.distance + fall[1] - one.distance) / (fall[0] + fall[1]);
    // 0 / 0 where nothing falls: the comparison turns it into 0.
    let share = if share > 0.0 { share.min(1.0) } else { 0.0 };
    Some(one.distance + fall[0] * share - 4.0 * rounding)
}
