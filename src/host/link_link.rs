//! The contact of two links in closed form, if at most one of them meets the other with a flat cap.
//!
//! 1. **Barrels and round caps** meet as capsules do. The axes' nearest points give the normal, and
//!    their distance minus the two radii is the distance.
//! 2. **A flat cap against a barrel or a round cap.** Take the nearest points of the first link and
//!    the other's axis, which the distance kernel treats as a triangle without area. Subtract the
//!    other's radius.
//!
//! `distance/depth/foot.rs` derives where this is exact. If the axes of two round links are so
//! close that their nearest points give no direction, [`depth`](crate::distance::depth) gives the
//! normal. Two flat caps, and a flat cap deep in the other link, have no closed form here;
//! [`LinkPair`](super::link_pair::LinkPair) measures them.

use super::axial::{to_flat, unit};
use super::link_triangle::closest;
use crate::distance::depth::{LinkLink, SolidLink};
use crate::distance::{Vec3, segment_segment};
use crate::robot::ModifiedCylinder;
use parry3d_f64::math::{Real, Vector};

/// Rounding error of a distance, relative to the largest coordinate.
const DISTANCE_ROUNDING: Real = 8.0 * Real::EPSILON;
/// Axes closer than this share of the largest coordinate give no direction: half of its digits
/// would be rounding.
pub(super) const DIRECTION: Real = 1.5e-8;
/// Axes closer than this share of the largest coordinate give a direction that has lost digits. The
/// directions of features have all digits.
pub(super) const FINE_DIRECTION: Real = 1e-2;

/// The contact of two links.
pub(super) struct TouchPoint {
    /// Distance, or minus the length of the least separating translation.
    pub dist: Real,
    /// Unit vector out of the first link.
    pub normal: Vector,
    pub on_first: Vector,
}

pub(super) enum Answer {
    /// Farther apart than the margin.
    Apart,
    TouchPoint(TouchPoint),
    /// No closed form.
    Unknown,
}

/// Cases 1 and 2, for links with coordinates at most `extent` and a margin of at least 0.
///
/// If an axis lies in the other link, no distance gives the depth of the overlap.
pub(super) fn touch(
    first: &ModifiedCylinder,
    second: &ModifiedCylinder,
    extent: Real,
    margin: Real,
) -> Answer {
    let rounding = DISTANCE_ROUNDING * extent;
    let axis = |link: &ModifiedCylinder| [link.start(), link.end()].map(Vec3::from);
    let axes = segment_segment(axis(first), axis(second));
    let feet = [Vector::from(axes.point1), Vector::from(axes.point2)];
    let dist = axes.distance - first.radius() - second.radius();
    // A link is contained in its capsule.
    if dist > margin + rounding {
        return Answer::Apart;
    }
    let is_capsule = |link: &ModifiedCylinder, at| {
        let to_flat = to_flat(link, at);
        to_flat > rounding - dist.min(0.0) && (to_flat == Real::INFINITY || -dist <= link.radius())
    };
    if is_capsule(first, feet[0]) && is_capsule(second, feet[1]) {
        let pair = pair(first, second);
        let way = unit(feet[1] - feet[0]).filter(|_| axes.distance > DIRECTION * extent);
        let normal = match way {
            Some(normal) => pair.refined(normal).normal,
            None => pair.widest([]).normal,
        };
        return Answer::TouchPoint(TouchPoint {
            dist,
            normal,
            on_first: feet[0] + normal * first.radius(),
        });
    }
    for (solid, swollen, is_swapped) in [(first, second, false), (second, first, true)] {
        let (apart, on_solid, on_axis) =
            closest(solid, [swollen.start(), swollen.end(), swollen.end()]);
        let dist = apart - swollen.radius();
        if dist > margin + rounding {
            return Answer::Apart;
        }
        let is_exact = to_flat(swollen, on_axis) > rounding - dist.min(0.0);
        if let (Some(out), true) =
            (unit(on_axis - on_solid), is_exact && apart > DIRECTION * extent)
        {
            let first_out = if is_swapped { -out } else { out };
            let pair = pair(first, second);
            let gap = if apart > FINE_DIRECTION * extent {
                pair.refined(first_out)
            } else {
                pair.widest([first_out])
            };
            let out = if is_swapped { -gap.normal } else { gap.normal };
            let on_swollen = on_axis - out * swollen.radius();
            return Answer::TouchPoint(if is_swapped {
                TouchPoint { dist, normal: -out, on_first: on_swollen }
            } else {
                TouchPoint { dist, normal: out, on_first: on_solid }
            });
        }
    }
    Answer::Unknown
}

/// Returns the two links in the form of the distance kernels.
pub(super) fn pair(first: &ModifiedCylinder, second: &ModifiedCylinder) -> LinkLink {
    let [first, second] = [first, second]
        .map(|link| SolidLink::new(link.start(), link.end(), link.radius(), link.flat()));
    LinkLink { first, second }
}
