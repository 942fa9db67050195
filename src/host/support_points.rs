//! What a link stands on: the points of its surface that a plane beyond it, across a unit normal,
//! would carry.
//!
//! 1. **A round cap** that leans along the normal: its one point furthest along it.
//! 2. **A flat cap** that faces along it: four points of its rim that stay where they are on the
//!    link, so that they are the same from step to step. The rim's lowest point is an end of the
//!    crest.
//! 3. **The crest** of the barrel, its line furthest along the normal: its two ends. At a round cap
//!    that leans along the normal it ends in the cap's own lowest point.

use super::axial::{perpendicular, unit_across};
use super::feature::{self, crest_end};
use crate::robot::{Cap, ModifiedCylinder};
use parry3d_f64::math::{Real, Vector};
use parry3d_f64::shape::PackedFeatureId;

/// The cosine between the normal and the axis from which a flat cap counts as facing along it.
const FACING: Real = 0.5;
/// The sine of the lean below which an upright link has no crest: its azimuth would be rounding.
const UPRIGHT: Real = 1e-6;

/// The end points of the axis.
pub(super) fn centre(link: &ModifiedCylinder, end: usize) -> Vector {
    if end == 0 { link.start() } else { link.end() }
}

/// The unit vectors along the axis out of the link; zero for a ball.
pub(super) fn outward(link: &ModifiedCylinder, end: usize) -> Vector {
    if end == 0 { -link.axis() } else { link.axis() }
}

/// Case 1.
pub(super) fn leans_round(link: &ModifiedCylinder, normal: Vector, end: usize) -> bool {
    link.caps()[end] == Cap::Round && normal.dot(outward(link, end)) >= 0.0
}

/// Case 2.
pub(super) fn faces_flat(link: &ModifiedCylinder, normal: Vector, end: usize) -> bool {
    link.caps()[end] == Cap::Flat && normal.dot(outward(link, end)) >= FACING
}

/// The points and their names, handed one by one to `consider`: those of flat caps first, then one
/// for each end, in the order of the ends. A link that rocks keeps the order. (A host that has to
/// choose among points as good as each other takes the first.)
pub(super) fn points(
    link: &ModifiedCylinder,
    normal: Vector,
    mut consider: impl FnMut(Vector, PackedFeatureId),
) {
    let radius = link.radius();
    for end in (0..2).filter(|&end| faces_flat(link, normal, end)) {
        let first = perpendicular(link.axis());
        let second = link.axis().cross(first);
        for (corner, way) in [first, second, -first, -second].into_iter().enumerate() {
            consider(centre(link, end) + way * radius, feature::square_corner(end, corner));
        }
    }
    let lateral = lateral(link, normal);
    for end in 0..2 {
        let way = if leans_round(link, normal, end) { Some(normal) } else { lateral };
        if let Some(way) = way {
            consider(centre(link, end) + way * radius, crest_end(end));
        }
    }
}

/// The unit vector from the axis to the crest, if the link has one.
pub(super) fn lateral(link: &ModifiedCylinder, normal: Vector) -> Option<Vector> {
    let axis = link.axis();
    let lateral = unit_across(normal, axis).filter(|_| axis != Vector::ZERO)?;
    (normal.dot(lateral) >= UPRIGHT).then_some(lateral)
}
