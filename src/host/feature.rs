//! The names of the parts of a link's surface, as every query reports them, and their normals.

use super::axial::{AxialFrame, unit, unit_across};
use crate::robot::{Cap, ModifiedCylinder};
use parry3d_f64::math::{Real, Vector};
use parry3d_f64::shape::{FeatureId, PackedFeatureId};

/// Points of a link closer together than this share of its length and radius count as one.
pub(super) const SAME_POINT: Real = 1e-6;

/// The barrel: the surface at one radius from the inside of the axis.
pub(super) const BARREL: FeatureId = FeatureId::Face(0);
/// The start cap and the end cap: a disc or a half ball.
pub(super) const CAP: [FeatureId; 2] = [FeatureId::Face(1), FeatureId::Face(2)];
/// The circle around a flat start or end.
pub(super) const RIM: [FeatureId; 2] = [FeatureId::Edge(0), FeatureId::Edge(1)];
/// The edge that represents the barrel in polygonal features.
pub(super) const BARREL_LINE: u32 = 2;
/// The first of the eight vertices and edges of the squares that represent flat caps.
pub(super) const SQUARE: u32 = 3;
/// The first of the two edges that represent the contact of a triangle's edge along the barrel.
pub(super) const ALONG_EDGE: u32 = SQUARE + 8;
/// The first of the four edges that represent crossings of a rim and a triangle's edge.
pub(super) const RIM_CROSSINGS: u32 = ALONG_EDGE + 2;

/// Names of the points where an edge comes below the rim at either end, and where it leaves it.
pub(super) const RIM_ENDS: [[u32; 2]; 2] =
    [[RIM_CROSSINGS, RIM_CROSSINGS + 1], [RIM_CROSSINGS + 2, RIM_CROSSINGS + 3]];

/// Returns the name of an end of the crest. If the link lies flat, this is also the lowest point of
/// a round cap.
pub(super) fn crest_end(end: usize) -> PackedFeatureId {
    PackedFeatureId::vertex(end as u32)
}

/// Returns the name of a corner of the square that represents a flat cap.
pub(super) fn square_corner(end: usize, corner: usize) -> PackedFeatureId {
    PackedFeatureId::vertex(SQUARE + (4 * end + corner) as u32)
}

/// Returns the outward unit normal of `feature` at a point on it; on a rim, the bisector of the two
/// adjacent normals.
///
/// `None` for a feature that the link does not have, and for a wire, which has no normal.
pub(super) fn normal(link: &ModifiedCylinder, feature: FeatureId, point: Vector) -> Option<Vector> {
    let (frame, from_start) = AxialFrame::around(link, point)?;
    let lateral = || unit_across(from_start, frame.axis);
    if feature == BARREL {
        return lateral();
    }
    let centres = [from_start, from_start - frame.span];
    let outwards = [-frame.axis, frame.axis];
    for end in 0..2 {
        match link.caps()[end] {
            Cap::Flat if feature == CAP[end] => return Some(outwards[end]),
            Cap::Flat if feature == RIM[end] => return unit(lateral()? + outwards[end]),
            Cap::Round if feature == CAP[end] => return unit(centres[end]),
            _ => {}
        }
    }
    None
}
