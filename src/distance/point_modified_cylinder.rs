//! The distance between a point and a modified cylinder, in closed form.
//!
//! ```text
//!    case 3           case 1            case 2
//!    p                  p                   p
//!     \                 | rho - r          /
//!      \ _______________|_________________/
//!      /                                  |
//!     |  o ------------ axis ------------ o   z = L
//!      \__________________________________|
//!    round                              flat
//! ```
//!
//! In axial coordinates, with `z` along the axis, `rho` from it, and the link on `0 <= z <= L`:
//!
//! 1. **Beside the barrel**, `0 <= z <= L`: `rho - r`.
//! 2. **Beyond a flat end** by `dz`: the disc of that end, `sqrt(dz^2 + max(0, rho - r)^2)`.
//! 3. **Beyond a round end**: the ball of that end, `|p - end| - r`.
//!
//! All are 0 inside.

use super::{Closest, Mask, Scalar, Vec3, frame::Frame, point_disc};

/// Returns the distance between a point and a solid modified cylinder, and the closest points; 0
/// inside.
///
/// ```text
///                  * point
///                  |
///                  | distance
///       ___________*___________
///      /         point2        |  ^
///     |  o start ---------- end o | radius
///      \_______________________|
///  flat[0] = false      flat[1] = true
/// ```
///
/// - `point`, `start`, `end`, `radius`: in one frame and unit.
/// - `flat`: whether the cap at `start` and the cap at `end` are flat; a cap that is not flat is
///   round.
#[inline(always)]
pub fn point_modified_cylinder<T: Scalar>(
    point: Vec3<T>,
    start: Vec3<T>,
    end: Vec3<T>,
    radius: T,
    flat: [T::Mask; 2],
) -> Closest<T> {
    let frame = Frame::around(start, [end, point], radius);
    let link = Link::new(frame.point(end), frame.length(radius), flat);
    let point = frame.point(point);
    let (distance, on_link) = link.closest_to(point);
    frame.answer(Closest { distance, point1: point, point2: on_link })
}

/// A link that starts at the origin, with its unit axis.
#[derive(Clone, Copy)]
pub(crate) struct Link<T: Scalar> {
    /// The end point of the axis.
    pub end: Vec3<T>,
    /// The unit direction of the axis; zero for a ball, whose caps count as round.
    pub axis: Vec3<T>,
    pub radius: T,
    /// Whether the cap at the start and the cap at the end are flat.
    pub flat: [T::Mask; 2],
}

impl<T: Scalar> Link<T> {
    #[inline(always)]
    pub(crate) fn new(end: Vec3<T>, radius: T, flat: [T::Mask; 2]) -> Self {
        let axis =
            Vec3::select(gives_direction(end.norm_squared()), end.normalised(), Vec3::zero(radius));
        Self { end, axis, radius, flat }
    }

    /// Returns the largest `<v, x>` over the axis.
    ///
    /// A vector from the axis to a nearby point is perpendicular to the axis only within rounding.
    /// Far from its foot the axis then leaves the plane through the foot. So a separating plane is
    /// placed before both ends instead.
    #[inline(always)]
    pub(crate) fn reach_along(&self, v: Vec3<T>) -> T {
        v.dot(self.end).max(self.radius.zero())
    }

    /// Returns the distance of a point from the solid link, and the link's closest point (the point
    /// itself inside).
    #[inline(always)]
    pub(crate) fn closest_to(&self, point: Vec3<T>) -> (T, Vec3<T>) {
        let zero = self.radius.zero();
        let from_end = point - self.end;
        let beyond_end = zero.lt(from_end.dot(self.axis));
        let before_start = !beyond_end & point.dot(self.axis).lt(zero);

        // Cases 2 and 3 measure from the end that the point lies beyond. Case 1 measures from the
        // axis.
        let centre = Vec3::select(beyond_end, self.end, Vec3::zero(zero));
        let relative = point - centre;
        let radial = relative.along(self.axis, -relative.dot(self.axis));
        let round = (beyond_end & !self.flat[1]) | (before_start & !self.flat[0]);
        let flat = (beyond_end & self.flat[1]) | (before_start & self.flat[0]);

        let arm = Vec3::select(round, relative, radial);
        let reach = arm.norm();
        let outward = self.radius.lt(reach).select(self.radius.over(reach), reach.one());
        let pulled = point.along(arm, outward - reach.one());
        let barrel = (reach - self.radius).max(zero);

        let (to_disc, on_disc) = point_disc::from_centre(relative, self.axis, self.radius);
        (flat.select(to_disc, barrel), Vec3::select(flat, centre + on_disc, pulled))
    }
}

/// Returns whether a segment's squared length is large enough to distinguish its ends: not
/// subnormal.
#[inline(always)]
pub(crate) fn gives_direction<T: Scalar>(squared: T) -> T::Mask {
    squared.zero().lt(squared * squared.lit(2.0 * T::UNIT_ROUNDOFF))
}
