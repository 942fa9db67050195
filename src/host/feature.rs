//! The pieces of a link's surface: their names, as every query reports them, and their normals.

use super::axial::{AxialFrame, unit, unit_across};
use crate::robot::{Cap, ModifiedCylinder};
use parry3d_f64::math::{Real, Vector};
use parry3d_f64::shape::{FeatureId, PackedFeatureId};

/// Points of a link that are closer together than this share of its length and radius are one.
pub(super) const SAME_POINT: Real = 1e-6;

/// The barrel: the points at one radius from the inside of the axis.
pub(super) const BARREL: FeatureId = FeatureId::Face(0);
/// The start and the end cap, a disc or a half ball.
pub(super) const CAP: [FeatureId; 2] = [FeatureId::Face(1), FeatureId::Face(2)];
/// The circle around a flat start or end.
pub(super) const RIM: [FeatureId; 2] = [FeatureId::Edge(0), FeatureId::Edge(1)];
/// The edge that stands for the barrel in the polygonal features.
pub(super) const BARREL_LINE: u32 = 2;
/// The first of the eight vertices and edges of the squares that stand for flat caps there.
pub(super) const SQUARE: u32 = 3;
/// The first of the two edges that stand for what an edge of a triangle along the barrel touches.
pub(super) const ALONG_EDGE: u32 = SQUARE + 8;
/// The first of the four edges that stand for the rims where they cross an edge of a triangle.
pub(super) const RIM_CROSSINGS: u32 = ALONG_EDGE + 2;

/// Names of the points where the rim at either end comes over an edge and leaves it.
pub(super) const RIM_ENDS: [[u32; 2]; 2] =
    [[RIM_CROSSINGS, RIM_CROSSINGS + 1], [RIM_CROSSINGS + 2, RIM_CROSSINGS + 3]];

/// The name of an end of the crest, or of a round cap's lowest point, which it is when the link
/// lies.
pub(super) fn crest_end(end: usize) -> PackedFeatureId {
    PackedFeatureId::vertex(end as u32)
}

/// The name of a corner of the square that stands for a flat cap.
pub(super) fn square_corner(end: usize, corner: usize) -> PackedFeatureId {
    PackedFeatureId::vertex(SQUARE + (4 * end + corner) as u32)
}

/// The outward unit normal of `feature` at a point on it; on a rim, the bisector of the two faces
/// that meet there. Nothing for a feature that the link does not have, and where there is no normal
/// (on a wire).
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
