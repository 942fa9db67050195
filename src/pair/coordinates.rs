//! The coordinates in which a link and a triangle are measured.
//!
//! Each pair of link and triangle has its own coordinates: relative to the link's start, scaled by
//! the power of two that brings the largest of them near one. So the rounding does not depend on
//! the position, the unit or distant parts of the scene, and nothing overflows or underflows.
//! Distances and bounds outside of a pair are in the mesh's unit.

use crate::distance::{Closest, Link, Scalar, Vec3, gives_direction};
use parry3d_f64::math::{Real, Vector};

/// The most by which a lower bound on the measured distance of a pair may be too large by rounding,
/// in its own coordinates: all numbers are below 2, and the extent is below 4.
///
/// **Derivation.**
/// 1. A bound by an axis distance of the narrow phase errs by 16 u of the extent: 64 u
///    (`distance/touching.rs`).
/// 2. A bound by a plane across n: two inner products of three terms err by 3 u of at most
///    `2 sqrt(3) |n|` each; their difference, `|n|` and the division by 5 u of a distance below 7;
///    the difference to the radius by 2 u. The sum is less than 64 u.
/// 3. The measured distance at a flat cap may be too short by another 16 u of the extent: 64 u.
pub(super) const BOUND_ROUNDING: Real = 128.0 * f64::UNIT_ROUNDOFF;

/// A link in the mesh's frame, or a pack of links.
#[derive(Clone, Copy)]
pub(super) struct Placed<T: Scalar> {
    pub start: Vec3<T>,
    /// The vector from start to end.
    pub along: Vec3<T>,
    /// The unit direction of the axis, or zero if it has none.
    pub axis: Vec3<T>,
    pub radius: T,
    pub flat: [T::Mask; 2],
    /// The largest coordinate relative to the start, or the radius.
    pub extent: T,
}

/// A link and a triangle in their own coordinates, or a pack of pairs.
pub(super) struct Pair<T: Scalar> {
    pub triangle: [Vec3<T>; 3],
    pub link: Link<T>,
    /// The length of 1 in the mesh's unit.
    pub unit: T,
    /// The largest coordinate of link and triangle relative to the link's start, or the radius, in
    /// the mesh's unit.
    pub extent: T,
}

impl<T: Scalar> Placed<T> {
    /// Returns the pair with a triangle of the mesh's frame.
    #[inline(always)]
    pub(super) fn with(&self, [a, b, c]: [Vec3<T>; 3]) -> Pair<T> {
        let Self { start, along, axis, radius, flat, extent } = *self;
        let [a, b, c] = [a - start, b - start, c - start];
        let extent = a.largest().max(b.largest()).max(c.largest()).max(extent);
        let scale = extent.power_of_two_to_unity();
        let end = along * scale;
        // A length whose square underflows beside the triangle gives no direction.
        let axis =
            Vec3::select(gives_direction(end.norm_squared()), axis, Vec3::zero(extent.zero()));
        Pair {
            triangle: [a * scale, b * scale, c * scale],
            link: Link { end, axis, radius: radius * scale, flat },
            unit: scale.one() / scale,
            extent,
        }
    }
}

impl Pair<Real> {
    /// Returns a lower bound on the distance, by a plane across the vector from the axis to the
    /// triangle's centre.
    pub(super) fn at_least(&self) -> Real {
        let [a, b, c] = self.triangle;
        let centre = (a + b + c) * (1.0 / 3.0);
        let normal = offset_from_axis(&self.link, centre);
        let beyond =
            normal.dot(a).min(normal.dot(b)).min(normal.dot(c)) - self.link.reach_along(normal);
        beyond.over(normal.norm()) - self.link.radius - BOUND_ROUNDING
    }

    /// Returns an answer in the mesh's frame. `start` is the pair's origin and `unit` the length of
    /// 1.
    pub(crate) fn report(
        unit: Real,
        start: Vector,
        triangle: u32,
        closest: Closest<Real>,
    ) -> Nearest {
        let place = |point: Vec3<Real>| start + Vector::from(point) * unit;
        Nearest::new(triangle, closest.distance * unit, place(closest.point1), || {
            place(closest.point2)
        })
    }
}

/// Returns the vector from the closest axis point to `point`.
pub(super) fn offset_from_axis(link: &Link<Real>, point: Vec3<Real>) -> Vec3<Real> {
    let t = point.dot(link.axis).max(0.0).min(link.end.dot(link.axis));
    point.along(link.axis, -t)
}

/// A triangle's distance from a link and the closest points, in the mesh's frame and unit.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Nearest {
    pub triangle: u32,
    pub distance: Real,
    pub on_robot: Vector,
    pub on_mesh: Vector,
}

impl Nearest {
    /// Returns the result, with one common point if the two touch: rounding may have separated the
    /// points.
    #[inline(always)]
    pub(crate) fn new(
        triangle: u32,
        distance: Real,
        on_mesh: Vector,
        on_robot: impl FnOnce() -> Vector,
    ) -> Self {
        let on_robot = if distance > 0.0 { on_robot() } else { on_mesh };
        Self { triangle, distance, on_robot, on_mesh }
    }
}
