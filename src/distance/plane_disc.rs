//! The distance between a plane and a solid disc (paper, equations (20) and (21), corrected).
//!
//! ```text
//!     ____________________________  plane
//!        |               |
//!        | distance      | height
//!        |               |
//!        p               |
//!          `-._          |
//!              `-._      |
//!                  `-._  o centre
//!                       `-._
//!                           `-.  disc, seen edge-on
//! ```
//!
//! 1. **Tilted.** The closest disc point lies along `u`, the part of the plane's normal in the
//!    disc's plane: at the rim, or where the plane cuts that diameter. Without this clamp the point
//!    overshoots when the disc crosses the plane.
//! 2. **Parallel.** `u = 0`: all points are equally near. Return the centre.

use super::{Closest, Mask, Scalar, Vec3, frame::Frame};

/// Returns the distance between a plane and a solid disc, and the closest points; (20), (21).
///
/// ```text
///        ^ plane_normal
///   _____|________*__________   plane
///   plane_point   | point1
///                 | distance
///                 *._ point2
///                    `-o-._     disc with centre, radius and disc_normal
/// ```
///
/// - `plane_point`, `plane_normal`: a point of the plane, and its normal.
/// - `centre`, `disc_normal`, `radius`: the disc, in the same frame and unit.
///
/// Neither normal needs unit length.
#[inline(always)]
pub fn plane_disc<T: Scalar>(
    plane_point: Vec3<T>,
    plane_normal: Vec3<T>,
    centre: Vec3<T>,
    disc_normal: Vec3<T>,
    radius: T,
) -> Closest<T> {
    let frame = Frame::around(centre, [plane_point], radius);
    let normal = plane_normal.normalised();
    let height = normal.dot(frame.point(plane_point));
    let nearest = from_centre(height, normal, disc_normal.normalised(), frame.length(radius));
    let on_plane = nearest.point.along(normal, height - normal.dot(nearest.point));
    frame.answer(Closest { distance: nearest.distance, point1: on_plane, point2: nearest.point })
}

/// The disc point closest to a plane, and its distance.
#[derive(Clone, Copy)]
pub(crate) struct NearestOnPlane<T> {
    pub point: Vec3<T>,
    pub distance: T,
}

/// Returns the closest point of the disc around the origin to the plane at the signed `height`
/// along its unit normal.
#[inline(always)]
pub(crate) fn from_centre<T: Scalar>(
    height: T,
    plane_normal: Vec3<T>,
    disc_normal: Vec3<T>,
    radius: T,
) -> NearestOnPlane<T> {
    let radial = plane_normal.along(disc_normal, -plane_normal.dot(disc_normal));
    let slope = radial.norm();
    // The offset along the radial direction: where it meets the plane, at most the rim.
    let reach = height.abs();
    let out = (radius * slope).lt(reach).select(radius, reach.over(slope));
    let direction = radial * slope.one().over(slope);
    // Project back into the disc's plane: a difference as short as its own rounding has a random
    // direction.
    let direction = direction.along(disc_normal, -direction.dot(disc_normal));
    NearestOnPlane {
        point: direction * height.lt(height.zero()).select(-out, out),
        distance: (-radius).mul_add(slope, reach).max(reach.zero()),
    }
}
