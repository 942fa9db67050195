//! A link in its own axial frame: coordinates along the axis and away from it.
//!
//! All closed forms of this folder use two coordinates: `z` along the unit axis from the start
//! point, and `rho` away from the axis. Three choices keep them accurate to the rounding of the
//! problem's extent:
//!
//! 1. Coordinates are differences from the link's start point, so a link far from the origin loses
//!    no digits.
//! 2. Coordinates are halved, subtracted, and scaled by a power of two so that the largest is near
//!    one. Nothing overflows, no significant square underflows, and a problem multiplied by 2^k
//!    gives the same bits.
//! 3. The axis is normalised by its own power of two, so a short link seen from far away keeps its
//!    direction.
//!
//! How far the foot of a contact on the axis is from a flat end ([`to_flat`]) decides whether the
//! contact of the link equals the contact of its capsule: see `distance/depth/foot.rs`.

use crate::distance::Scalar;
use crate::distance::depth;
pub(super) use crate::distance::depth::{perpendicular, unit, unit_across};
use crate::robot::ModifiedCylinder;
use parry3d_f64::math::{Real, Vector};

/// Returns the power of two that scales `x` near one, and its inverse.
pub(super) fn power_of_two(x: Real) -> (Real, Real) {
    let down = x.power_of_two_to_unity();
    (down, 1.0 / down)
}

/// Returns the unit axis of `link`; any unit vector for a ball.
pub(super) fn axis_or_x(link: &ModifiedCylinder) -> Vector {
    let axis = link.axis();
    if axis == Vector::ZERO { Vector::X } else { axis }
}

/// A link, scaled, relative to its start point.
#[derive(Clone, Copy, Debug)]
pub(super) struct AxialFrame {
    /// Unit axis; any unit vector if the length is zero.
    pub axis: Vector,
    /// End point minus start point, in scaled units.
    pub span: Vector,
    /// Length of the axis, in scaled units.
    pub length: Real,
    /// Radius, in scaled units.
    pub radius: Real,
    up: Real,
}

impl AxialFrame {
    /// Returns the frame of `link` in a unit that suits it and `point`, and `point` in that frame;
    /// `None` if `point` is not finite.
    pub fn around(link: &ModifiedCylinder, point: Vector) -> Option<(Self, Vector)> {
        if !point.is_finite() {
            return None;
        }
        let from_start = 0.5 * point - 0.5 * link.start();
        let span = 0.5 * link.end() - 0.5 * link.start();
        let radius = 0.5 * link.radius();
        let largest = from_start.abs().max_element().max(span.abs().max_element()).max(radius);
        let (down, up) = power_of_two(largest);
        let axis = axis_or_x(link);
        let span = span * down;
        let frame = Self { axis, span, length: span.dot(axis), radius: radius * down, up };
        Some((frame, from_start * down))
    }

    /// Converts a length or an offset of the frame to the caller's unit.
    pub fn restore<T: std::ops::Mul<Real, Output = T>>(&self, scaled: T) -> T {
        scaled * self.up * 2.0
    }
}

/// Returns the distance along the axis from a point of it to the nearest flat end; infinite if both
/// ends are round.
pub(super) fn to_flat(link: &ModifiedCylinder, on_axis: Vector) -> Real {
    let (from_start, to_end) = (on_axis - link.start(), link.end() - on_axis);
    depth::to_flat(from_start, to_end, axis_or_x(link), link.flat())
}
