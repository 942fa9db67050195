//! The support points of a link: points of its surface that a plane across a unit normal would
//! carry.
//!
//! 1. **A round cap** that leans along the normal: its point farthest along it.
//! 2. **A flat cap** that faces along it: four points of its rim, fixed on the link, so that they
//!    are the same from step to step. The rim's lowest point is an end of the crest.
//! 3. **The crest** of the barrel, its line farthest along the normal: its two ends. At a round cap
//!    that leans along the normal the crest ends in the cap's own lowest point.

use super::axial::{perpendicular, unit_across};
use super::feature::{self, crest_end};
use crate::robot::{Cap, ModifiedCylinder};
use parry3d_f64::math::{Real, Vector};
use parry3d_f64::shape::PackedFeatureId;

/// The cosine between normal and axis above which a flat cap faces along the normal.
const FACING: Real = 0.5;
/// The sine of the lean below which an upright link has no crest: its azimuth would be rounding.
const UPRIGHT: Real = 1e-6;

/// Returns an end point of the axis.
pub(super) fn centre(link: &ModifiedCylinder, end: usize) -> Vector {
    if end == 0 { link.start() } else { link.end() }
}

/// Returns the unit vector along the axis out of an end; zero for a ball.
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

/// Passes the points and their names to `consider`: first the points of flat caps, then one point
/// per end, in the order of the ends. The order stays when a link rocks. (A host that selects among
/// equally good points takes the first.)
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

/// Returns the unit vector from the axis to the crest, if the link has one.
pub(super) fn lateral(link: &ModifiedCylinder, normal: Vector) -> Option<Vector> {
    let axis = link.axis();
    let lateral = unit_across(normal, axis).filter(|_| axis != Vector::ZERO)?;
    (normal.dot(lateral) >= UPRIGHT).then_some(lateral)
}
