//! Exact closest points of a link to a point.
//!
//! # Derivation
//! Let `k` be the distance from the point to the axis segment and `z` its coordinate along the
//! axis.
//!
//! 1. **Beyond a flat end** (`z < 0` at a flat start, `z > length` at a flat end): the closest
//!    point lies on the disc, at the lateral offset clamped to the radius. The distance is the
//!    hypotenuse of the height above the disc and the clamped part.
//! 2. **Otherwise, `k > radius`**: the closest point of the capsule belongs to the link too,
//!    because a round end is a half ball and the rest a barrel. The distance is `k - radius`.
//! 3. **Otherwise, `k <= radius`**: the point is inside. The link is the intersection of a capsule
//!    and one half-space per flat end. From inside, the distance to the boundary of an intersection
//!    of convex sets is the least distance to their boundaries: `radius - k`, `z` for a flat start,
//!    `length - z` for a flat end. No case needs a length greater than the radius.
//!
//! On the axis all directions away from it are equally close; one of them is used.

use super::axial::{AxialFrame, perpendicular, unit, unit_across};
use super::feature;
use crate::robot::{Cap, ModifiedCylinder};
use parry3d_f64::math::{Real, Vector};
use parry3d_f64::query::{PointProjection, PointQuery};
use parry3d_f64::shape::FeatureId;

/// The closest point of a link's surface to a query point.
pub(super) struct NearestOnSurface {
    /// Distance to the surface, negative inside.
    pub signed_distance: Real,
    pub is_inside: bool,
    pub point: Vector,
    pub feature: FeatureId,
}

/// Returns the closest point of the surface; `None` if `point` is not finite.
pub(super) fn nearest(link: &ModifiedCylinder, point: Vector) -> Option<NearestOnSurface> {
    let (frame, from_start) = AxialFrame::around(link, point)?;
    let from_end = from_start - frame.span;
    let z = from_start.dot(frame.axis);
    let beyond = from_end.dot(frame.axis);
    let [start_cap, end_cap] = link.caps();

    // Case 1.
    if z < 0.0 && start_cap == Cap::Flat {
        return Some(above_disc(&frame, link.start(), from_start, -z, 0));
    }
    if beyond > 0.0 && end_cap == Cap::Flat {
        return Some(above_disc(&frame, link.end(), from_end, beyond, 1));
    }

    // Cases 2 and 3: the capsule first, then the flat ends as half-spaces.
    let lateral = from_start - frame.axis * z;
    let (base, away, outward, face) = if z < 0.0 {
        (link.start(), from_start, unit(from_start), feature::CAP[0])
    } else if beyond > 0.0 {
        (link.end(), from_end, unit(from_end), feature::CAP[1])
    } else {
        let base = link.start() + frame.restore(frame.axis * z);
        (base, lateral, unit_across(lateral, frame.axis), feature::BARREL)
    };
    let k = away.length();
    let outward = outward.unwrap_or_else(|| perpendicular(frame.axis));
    let mut best = NearestOnSurface {
        signed_distance: frame.restore(k - frame.radius),
        is_inside: k <= frame.radius,
        point: base + outward * link.radius(),
        feature: face,
    };
    if best.is_inside {
        let ends =
            [(start_cap, z, link.start(), lateral), (end_cap, -beyond, link.end(), from_end)];
        for (end, (cap, depth, centre, offset)) in ends.into_iter().enumerate() {
            let signed_distance = frame.restore(-depth);
            if cap == Cap::Flat && signed_distance > best.signed_distance {
                let on_disc = offset - frame.axis * offset.dot(frame.axis);
                best.signed_distance = signed_distance;
                best.point = centre + frame.restore(on_disc);
                best.feature = feature::CAP[end];
            }
        }
    }
    Some(best)
}

/// Case 1: the point at `offset` from the centre of a flat end, `height` above its disc.
fn above_disc(
    frame: &AxialFrame,
    centre: Vector,
    offset: Vector,
    height: Real,
    end: usize,
) -> NearestOnSurface {
    let lateral = offset - frame.axis * offset.dot(frame.axis);
    let rho = lateral.length();
    let excess = rho - frame.radius;
    let (on_disc, past_rim, feature) = if excess > 0.0 {
        (lateral * (frame.radius / rho), excess, feature::RIM[end])
    } else {
        (lateral, 0.0, feature::CAP[end])
    };
    NearestOnSurface {
        signed_distance: frame.restore((height * height + past_rim * past_rim).sqrt()),
        is_inside: false,
        point: centre + frame.restore(on_disc),
        feature,
    }
}

/// Exact closest points (see the head of this file). A point on the surface counts as inside. A
/// point that is not finite projects onto itself, as everywhere in parry, and its distance is NaN
/// or infinite.
impl PointQuery for ModifiedCylinder {
    fn project_local_point(&self, pt: Vector, solid: bool) -> PointProjection {
        match nearest(self, pt) {
            Some(found) if solid && found.is_inside => PointProjection::new(true, pt),
            Some(found) => PointProjection::new(found.is_inside, found.point),
            None => PointProjection::new(false, pt),
        }
    }

    fn project_local_point_and_get_feature(&self, pt: Vector) -> (PointProjection, FeatureId) {
        match nearest(self, pt) {
            Some(found) => (PointProjection::new(found.is_inside, found.point), found.feature),
            None => (PointProjection::new(false, pt), FeatureId::Unknown),
        }
    }

    fn distance_to_local_point(&self, pt: Vector, solid: bool) -> Real {
        match nearest(self, pt) {
            Some(found) if solid => found.signed_distance.max(0.0),
            Some(found) => found.signed_distance,
            None => pt.length(),
        }
    }

    fn contains_local_point(&self, pt: Vector) -> bool {
        nearest(self, pt).is_some_and(|found| found.is_inside)
    }
}
