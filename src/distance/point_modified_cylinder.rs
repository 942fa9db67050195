//! Point against modified cylinder, in closed form.
//!
//! In axial coordinates, z along the axis and rho from it, with the link on 0 <= z <= L:
//!
//! 1. **Beside the barrel**, 0 <= z <= L: rho - r.
//! 2. **Beyond a flat end**: the disc of that end, sqrt(dz^2 + max(0, rho - r)^2).
//! 3. **Beyond a round end**: the ball of that end, |p - end| - r.

use super::{Closest, Mask, Scalar, Vec3, frame::Frame, point_disc};

/// The distance between a point and the solid modified cylinder from `start` to `end`; 0 inside.
/// `flat` says which of the two caps are flat.
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

/// A link that starts at the origin, with what is computed once for it.
#[derive(Clone, Copy)]
pub(crate) struct Link<T: Scalar> {
    /// The end point of the axis.
    pub end: Vec3<T>,
    /// The unit direction of the axis; zero for a ball, whose caps count as round.
    pub axis: Vec3<T>,
    pub radius: T,
    /// Which caps are flat.
    pub flat: [T::Mask; 2],
}

impl<T: Scalar> Link<T> {
    #[inline(always)]
    pub(crate) fn new(end: Vec3<T>, radius: T, flat: [T::Mask; 2]) -> Self {
        let axis =
            Vec3::select(gives_direction(end.norm_squared()), end.normalised(), Vec3::zero(radius));
        Self { end, axis, radius, flat }
    }

    /// How far the axis reaches along `v`, from the link's start and in units of 1 / |v|.
    ///
    /// A vector from the axis to a point near it is not quite at a right angle to the axis, for
    /// rounding, and far from its foot the axis then sticks out of the plane through the foot.
    /// So planes are set before the ends instead.
    #[inline(always)]
    pub(crate) fn reach_along(&self, v: Vec3<T>) -> T {
        v.dot(self.end).max(self.radius.zero())
    }

    /// The distance of a point from the solid link, and the link's nearest point (the point itself
    /// inside).
    #[inline(always)]
    pub(crate) fn closest_to(&self, point: Vec3<T>) -> (T, Vec3<T>) {
        let zero = self.radius.zero();
        let from_end = point - self.end;
        let beyond_end = zero.lt(from_end.dot(self.axis));
        let before_start = !beyond_end & point.dot(self.axis).lt(zero);

        // Cases 2 and 3 measure from the end that the point is beyond; case 1 from the nearest axis
        // point.
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

/// Whether a segment's squared length is large enough to tell its ends apart: not below the normal
/// numbers.
#[inline(always)]
pub(crate) fn gives_direction<T: Scalar>(squared: T) -> T::Mask {
    squared.zero().lt(squared * squared.lit(2.0 * T::UNIT_ROUNDOFF))
}
