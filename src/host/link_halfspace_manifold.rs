//! The contact manifold of a link and a half-space: the link's
//! [`support_points`](super::support_points) and their heights over the plane.
//!
//! The lowest point gets the height of the link's true lowest point: if a flat cap almost lies on
//! the plane, rounding alone decides which point of its rim is lowest. If the nearest point is
//! within the prediction, all points count, so that the host sees what a fast link is about to
//! reach.

use super::axial::unit;
use super::feature::{self, SAME_POINT};
use super::support_points;
use crate::robot::ModifiedCylinder;
use parry3d_f64::math::{Pose, Real, Vector};
use parry3d_f64::query::{ContactManifold, TrackedContact, Unsupported};
use parry3d_f64::shape::{PackedFeatureId, Shape, SupportMap};

/// Updates the manifold, if the shapes are a link and a half-space, in either order. Returns
/// whether they are.
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
    // The link's pose in the half-space's frame.
    let pose = if link_is_first { pos12.inverse() } else { *pos12 };
    let down = pose.rotation.inverse() * -plane;
    let before = std::mem::take(&mut manifold.points);
    let height_of = |on_link: Vector| (pose * on_link).dot(plane);
    let point_at = |on_link: Vector, name: PackedFeatureId| {
        let height = height_of(on_link);
        let below = pose * on_link - plane * height;
        TrackedContact::flipped(
            on_link,
            below,
            name,
            PackedFeatureId::face(0),
            height,
            !link_is_first,
        )
    };
    support_points::points(link, down, |on_link, name| {
        manifold.points.push(point_at(on_link, name))
    });
    let lowest = link.local_support_point_toward(down);
    // Rounded as in `contact`.
    let nearest = plane.dot(link.transformed(&pose).local_support_point_toward(-plane));
    let stands_for_it = manifold.points.iter_mut().min_by(|a, b| a.dist.total_cmp(&b.dist));
    let share = SAME_POINT * (link.length() + link.radius());
    match stands_for_it.filter(|point| point.dist - nearest <= share) {
        Some(point) => point.dist = nearest,
        None => manifold.points.push(point_at(lowest, feature::BARREL.into())),
    }
    if !manifold.points.iter().all(|point| point.dist.is_finite()) {
        manifold.points.clear();
        return Err(Unsupported);
    }
    if nearest > prediction {
        manifold.points.clear();
        return Ok(true);
    }
    (manifold.local_n1, manifold.local_n2) =
        if link_is_first { (down, plane) } else { (plane, down) };
    manifold.match_contacts(&before);
    Ok(true)
}
