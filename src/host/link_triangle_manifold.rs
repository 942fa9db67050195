//! The contact manifold of a link and a triangle: points that share the contact's normal.
//!
//! The normal is the contact's own (see [`link_triangle`](super::link_triangle)), led through the constraints that a
//! mesh puts on it. Every point is a pair, one on the link's surface and one on the triangle, `dist` apart along the
//! normal, exactly:
//!
//! 1. **What the link stands on**, where the triangle is below it: see [`footing`](super::footing).
//! 2. **What of the triangle's outline** is below a flat cap or across or along the barrel's crest: see
//!    [`rim`](super::rim) and [`crest`](super::crest).
//! 3. **The closest points themselves**, if none of the others are as close: a corner against the barrel, an
//!    edge across a cap.
//!
//! Points that coincide are one, the nearest of them, so that the least `dist` is the contact's own. Where it is within
//! the prediction, all count, so that the host sees what a fast link is about to reach. Tolerances are relative to the link, so the unit of length does not
//! matter. Nothing is kept from one call to the next but what the host stores with its points, which are
//! matched by feature.

use super::axial::unit;
use super::link_triangle::{LinkTrianglePair, Local};
use super::meeting::Meeting;
use super::{crest, feature, footing, rim};
use parry3d_f64::math::{Pose, Real};
use parry3d_f64::query::details::{NormalConstraints, NormalConstraintsPair};
use parry3d_f64::query::{ContactManifold, TrackedContact, Unsupported};

/// How much deeper than the overlap a point may be where a constraint has turned the normal; as in parry.
const DEEPER: Real = 5.0;
/// A normal turned by more than this was turned by a constraint, not by rounding.
const TURNED: Real = 1e-9;

/// Brings the manifold of the pair up to date.
///
/// # Errors
/// [`Unsupported`] for numbers out of range.
pub(super) fn update<M, C: Default + Copy>(
    pos12: &Pose,
    pair: &LinkTrianglePair,
    constraints: (Option<&dyn NormalConstraints>, Option<&dyn NormalConstraints>),
    prediction: Real,
    manifold: &mut ContactManifold<M, C>,
) -> Result<(), Unsupported> {
    let link_is_first = pair.link_is_first;
    let to_link = |p| if link_is_first { pos12 * p } else { pos12.inverse_transform_point(p) };
    let to_triangle = |p| if link_is_first { pos12.inverse_transform_point(p) } else { pos12 * p };
    let local = Local::new(pair.link, pair.triangle.vertices().map(to_link)).ok_or(Unsupported)?;

    let before = std::mem::take(&mut manifold.points);
    let margin = prediction / local.unit;
    // An overlap is found first, then measured.
    let found = local.contact_within(margin.max(0.0)).filter(|found| found.distance <= margin);
    let Some(found) = found else { return Ok(()) };
    let rotation = pos12.rotation;
    let (mut n1, mut n2) = if link_is_first {
        (found.normal, rotation.inverse() * -found.normal)
    } else {
        (rotation * -found.normal, found.normal)
    };
    if !constraints.project_local_normals(pos12, &mut n1, &mut n2) {
        return Ok(());
    }
    let normal = if link_is_first { n1 } else { n2 };
    // A rotation that is not quite of unit length is not to be taken for a turn.
    let normal = unit(normal).unwrap_or(normal);
    let is_turned = (normal - found.normal).length() > TURNED;

    // Coordinates of the local problem are at most 1.
    let mut meeting =
        Meeting::new(&local.link, local.triangle, if is_turned { normal } else { found.normal }, 1.0);
    rim::collect(&mut meeting);
    let normal = meeting.normal;
    footing::points(&local.link, normal, |on_link, name| meeting.add_above_face(on_link, name));
    crest::collect(&mut meeting);
    if !is_turned {
        meeting.add_closest(found.distance, found.on_link);
    }
    let deepest = if is_turned { DEEPER * found.distance.min(0.0) } else { Real::NEG_INFINITY };
    let deepest = deepest - feature::SAME_POINT * meeting.size;
    for point in meeting.points.iter().filter(|point| point.dist >= deepest) {
        let on_link = local.origin + point.on_link * local.unit;
        let on_triangle = local.origin + (point.on_link + meeting.normal * point.dist) * local.unit;
        manifold.points.push(TrackedContact::flipped(
            on_link,
            to_triangle(on_triangle),
            point.of_link,
            point.of_triangle,
            point.dist * local.unit,
            !link_is_first,
        ));
    }
    (manifold.local_n1, manifold.local_n2) = (n1, n2);
    manifold.match_contacts(&before);
    Ok(())
}
