//! The contact manifold of a link and a half-space: what the link stands on (see [`footing`](super::footing)), and how
//! high each of these points is over the plane; and the link's lowest point, if none of the others is as low: where a flat
//! cap all but lies on the plane, no more than rounding tells at which of its rim's points.
//!
//! Where the nearest is within the prediction, all count, so that the host sees what a fast link is about to reach.

use super::axial::unit;
use super::meeting::ROUNDING;
use super::{feature, footing};
use crate::ModifiedCylinder;
use parry3d_f64::math::{Pose, Real, Vector};
use parry3d_f64::query::{ContactManifold, TrackedContact, Unsupported};
use parry3d_f64::shape::{PackedFeatureId, Shape, SupportMap};

/// Brings the manifold up to date, if the shapes are a link and a half-space, in either order. Returns whether they
/// are.
///
/// # Errors
/// [`Unsupported`] if the half-space's normal has no direction, or for numbers out of range.
pub(super) fn update<M, C: Default + Copy>(
    pos12: &Pose,
    (g1, g2): (&dyn Shape, &dyn Shape),
    prediction: Real,
    manifold: &mut ContactManifold<M, C>,
) -> Result<bool, Unsupported> {
    let links = (g1.as_shape::<ModifiedCylinder>(), g2.as_shape::<ModifiedCylinder>());
    let (link, half_space, link_is_first) = match (links, g1.as_halfspace(), g2.as_halfspace()) {
        ((Some(link), _), _, Some(half_space)) => (link, half_space, true),
        ((_, Some(link)), Some(half_space), _) => (link, half_space, false),
        _ => return Ok(false),
    };
    let plane = unit(half_space.normal).ok_or(Unsupported)?;
    // Of the link in the half-space's frame.
    let pose = if link_is_first { pos12.inverse() } else { *pos12 };
    let down = pose.rotation.inverse() * -plane;
    let before = std::mem::take(&mut manifold.points);
    let mut nearest = Real::INFINITY;
    let mut add = |on_link: Vector, name: PackedFeatureId| {
        let over = pose * on_link;
        let height = over.dot(plane);
        // A number that is none is refused below.
        let is_lowest_too =
            name == feature::BARREL.into() && height >= nearest - ROUNDING * over.abs().max_element();
        if !is_lowest_too {
            nearest = nearest.min(height);
            let below = over - plane * height;
            let face = PackedFeatureId::face(0);
            manifold.points.push(TrackedContact::flipped(on_link, below, name, face, height, !link_is_first));
        }
    };
    footing::points(link, down, &mut add);
    add(link.local_support_point_toward(down), feature::BARREL.into());
    if !manifold.points.iter().all(|point| point.dist.is_finite()) {
        manifold.points.clear();
        return Err(Unsupported);
    }
    if nearest > prediction {
        manifold.points.clear();
        return Ok(true);
    }
    (manifold.local_n1, manifold.local_n2) = if link_is_first { (down, plane) } else { (plane, down) };
    manifold.match_contacts(&before);
    Ok(true)
}
