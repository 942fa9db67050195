//! Plane against disc (paper, equations (20) and (21), corrected).
//!
//! 1. **Tilted.** The disc's point nearest to the plane lies along u, the part of the plane's
//!    normal that lies in the disc's plane: at the rim, or where the plane cuts that diameter. The
//!    clamp makes the difference: without it the point overshoots as soon as the disc crosses the
//!    plane.
//! 2. **Parallel.** u = 0: every point is as near; the centre is taken.

use super::{Closest, Mask, Scalar, Vec3, frame::Frame};

/// The distance between the plane through `point` with the given normal and a solid disc; (20),
/// (21). Neither normal needs unit length.
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

/// The disc's point nearest to a plane.
#[derive(Clone, Copy)]
pub(crate) struct NearestOnPlane<T> {
    pub point: Vec3<T>,
    pub distance: T,
}

/// The point nearest to the plane at signed `height` along its unit normal, for the disc around the
/// origin.
#[inline(always)]
pub(crate) fn from_centre<T: Scalar>(
    height: T,
    plane_normal: Vec3<T>,
    disc_normal: Vec3<T>,
    radius: T,
) -> NearestOnPlane<T> {
    let radial = plane_normal.along(disc_normal, -plane_normal.dot(disc_normal));
    let slope = radial.norm();
    // How far out along the radial direction the plane is met, unless the rim comes first.
    let reach = height.abs();
    let out = (radius * slope).lt(reach).select(radius, reach.over(slope));
    let direction = radial * slope.one().over(slope);
    // Back into the disc's plane: a remainder as short as its own rounding points anywhere.
    let direction = direction.along(disc_normal, -direction.dot(disc_normal));
    NearestOnPlane {
        point: direction * height.lt(height.zero()).select(-out, out),
        distance: (-radius).mul_add(slope, reach).max(reach.zero()),
    }
}
