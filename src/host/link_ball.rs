//! A link and a ball: the point of the link's surface nearest to the ball's centre, less the radius.
//!
//! Inside the link that is the shortest way out. (parry's routine is the same but for an absolute tolerance: within 2.2e-16
//! of the surface it says that the centre is on it, so that a link and a ball of such a size always overlap.)

use super::axial::unit;
use super::meeting::ROUNDING;
use super::point::nearest;
use super::range::in_range;
use super::{axial, feature};
use crate::robot::ModifiedCylinder;
use parry3d_f64::math::{Pose, Real};
use parry3d_f64::query::{ClosestPoints, Contact, Unsupported};
use parry3d_f64::shape::Shape;

/// The contact of a link and a ball, in either order, at whatever distance. Nothing if the shapes are no such pair.
///
/// # Errors
/// [`Unsupported`] for numbers out of range.
pub(super) fn contact(pos12: &Pose, g1: &dyn Shape, g2: &dyn Shape) -> Result<Option<Contact>, Unsupported> {
    if let (Some(link), Some(ball)) = (g1.as_shape(), g2.as_ball()) {
        return of_link(pos12, link, ball.radius).map(Some);
    }
    if let (Some(ball), Some(link)) = (g1.as_ball(), g2.as_shape()) {
        return of_link(&pos12.inverse(), link, ball.radius).map(|contact| Some(contact.flipped()));
    }
    Ok(None)
}

/// The same, as closest points within a distance.
///
/// # Errors
/// As [`contact`].
pub(super) fn closest_points(
    pos12: &Pose,
    g1: &dyn Shape,
    g2: &dyn Shape,
    max_dist: Real,
) -> Result<Option<ClosestPoints>, Unsupported> {
    Ok(contact(pos12, g1, g2)?.map(|contact| {
        if contact.dist <= 0.0 {
            ClosestPoints::Intersecting
        } else if contact.dist <= max_dist {
            ClosestPoints::WithinMargin(contact.point1, contact.point2)
        } else {
            ClosestPoints::Disjoint
        }
    }))
}

fn of_link(pos12: &Pose, link: &ModifiedCylinder, radius: Real) -> Result<Contact, Unsupported> {
    let centre = pos12.translation;
    let largest = in_range(centre)?.max(in_range(link.start())?).max(in_range(link.end())?);
    let found = nearest(link, centre).ok_or(Unsupported)?;
    let out = if found.is_inside { found.point - centre } else { centre - found.point };
    // Of two points that are one but for rounding the way between them has no direction.
    let is_known = found.signed_distance.abs() > ROUNDING * largest;
    let of_surface = || feature::normal(link, found.feature, found.point);
    let normal = if is_known { unit(out) } else { of_surface().or(unit(out)) };
    let normal =
        normal.or(unit(centre - link.start())).unwrap_or(axial::perpendicular(axial::axis_or_x(link)));
    let dist = found.signed_distance - radius;
    if !dist.is_finite() {
        return Err(Unsupported);
    }
    let normal2 = pos12.rotation.inverse() * -normal;
    Ok(Contact::new(found.point, normal2 * radius, normal, normal2, dist))
}
