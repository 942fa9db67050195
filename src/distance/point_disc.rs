//! The distance between a point and a solid disc (paper, equations (9) to (12)).
//!
//! ```text
//!         p
//!         |  l
//!    -----+=====o=====+------  plane of the disc
//!         <-rho->  R
//! ```
//!
//! Let `l` be the height of the point above the disc's plane, `rho` its distance from the disc's
//! axis, and `R` the radius. The distance is `sqrt(l^2 + max(0, rho - R)^2)`, a form without a
//! division.
//!
//! 1. **Above the interior**, `rho <= R`: the disc point is the foot.
//! 2. **Outside**, `rho > R`: the disc point lies on the rim.
//! 3. **On the axis**, `rho = 0`: the foot is the centre, also for `R = 0`.

use super::{Closest, Mask, Scalar, Vec3, frame::Frame};

/// Returns the distance between a point and a solid disc, and the closest points; (9) to (12).
///
/// ```text
///        ^ normal  * point
///        |        /
///        |       / distance
///   =====o=====* point2
///      centre
///        <-----> radius
/// ```
///
/// - `point`, `centre`, `radius`: in one frame and unit.
/// - `normal`: of any length. A zero normal makes the disc a ball.
#[inline(always)]
pub fn point_disc<T: Scalar>(
    point: Vec3<T>,
    centre: Vec3<T>,
    normal: Vec3<T>,
    radius: T,
) -> Closest<T> {
    let frame = Frame::around(centre, [point], radius);
    let point = frame.point(point);
    let (distance, on_disc) = from_centre(point, normal.normalised(), frame.length(radius));
    frame.answer(Closest { distance, point1: point, point2: on_disc })
}

/// Returns the distance of `point` from the disc around the origin, and the closest disc point.
#[inline(always)]
pub(crate) fn from_centre<T: Scalar>(
    point: Vec3<T>,
    unit_normal: Vec3<T>,
    radius: T,
) -> (T, Vec3<T>) {
    let height = point.dot(unit_normal);
    let radial = point.along(unit_normal, -height);
    let rho = radial.norm();
    let beyond = (rho - radius).max(rho.zero());
    let shrink = radius.lt(rho).select(radius.over(rho), rho.one());
    (height.mul_add(height, beyond * beyond).sqrt(), radial * shrink)
}
