//! The passes between the triangles near a link: the least distances of shared corners and edges.
//! `prominence` defines them.

use super::triangle_candidates::{CandidateIndex, LinkCandidates};
use super::wall::Wall;
use crate::pair::{Height, PlacedLink};
use parry3d_f64::math::{Real, Vector};

/// The triangles near one link.
#[derive(Clone, Copy)]
pub(super) struct LinkNeighbourhood<'a> {
    pub link: &'a PlacedLink,
    pub wall: Wall<'a>,
    pub near: LinkCandidates<'a>,
    pub index: &'a CandidateIndex,
    /// The greatest distance of a pass.
    pub margin: Real,
}

impl LinkNeighbourhood<'_> {
    /// Returns true if a triangle may be within the margin.
    #[inline(always)]
    pub(super) fn holds(&self, triangle: u32) -> bool {
        self.near.index(self.index, triangle).is_some()
            || self.near.is_culled(self.index, self.wall.place_of(), triangle)
    }

    /// Returns true if a corner or edge at this distance is a pass below `below`.
    #[inline(always)]
    pub(super) fn is_pass(&self, height: &Height, below: Real) -> bool {
        height.distance < below && height.distance + height.rounding <= self.margin
    }

    /// Returns true if an edge may be a pass below `below` although neither of its ends is. `along`
    /// leads from one end to the other.
    pub(super) fn may_pass_between(&self, ends: [&Height; 2], along: Vector, below: Real) -> bool {
        lower_between(ends, along).is_some_and(|lower| lower < below && lower <= self.margin)
    }
}

/// Returns a lower bound on the distance of an edge, if the edge may be nearer than both of its
/// ends. `along` leads from one end to the other.
///
/// **Derivation.** The distance is convex along the edge. Let an end have the distance d and the
/// vector W from the link. Along the whole edge the tangent there changes by `g = W . along / |W|`.
/// If the distance does not fall from an end on, that end is nearest. Otherwise it lies above both
/// tangents `d1 + s g1` and `d2 + (1 - s) g2`, which cross at `s = (d2 + g2 - d1) / (g1 + g2)`.
///
/// **Rounding.** W turns by the ratio of its rounding to d.
fn lower_between([one, other]: [&Height; 2], along: Vector) -> Option<Real> {
    let rounding = one.rounding.max(other.rounding);
    let turned = 4.0 * rounding * along.length() / one.distance.min(other.distance);
    let change =
        [one.way.dot(along) / one.way.length(), -other.way.dot(along) / other.way.length()];
    // NaN if W is 0: then no point is nearer.
    if !(change[0] < turned && change[1] < turned) {
        return None;
    }
    let fall = change.map(|change| change.min(0.0) - turned);
    let share = (other.distance + fall[1] - one.distance) / (fall[0] + fall[1]);
    // If nothing falls this is 0 / 0; the comparison turns NaN into 0.
    let share = if share > 0.0 { share.min(1.0) } else { 0.0 };
    Some(one.distance + fall[0] * share - 4.0 * rounding)
}
