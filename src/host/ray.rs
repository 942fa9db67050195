//! Exact ray casts against a link.
//!
//! # Derivation
//! The link is convex, so a line meets it in one interval `[entry, exit]`. The link lies in the
//! infinite cylinder around the axis. The line's interval `[c0, c1]` in that cylinder decides to
//! which part of the surface each bound belongs. Let `z` be the coordinate along the axis of the
//! line's point at `c0`:
//!
//! 1. `0 <= z <= length`: the line enters through the barrel, at `c0`.
//! 2. `z < 0`, flat start: the line can enter only through the disc. It crosses the plane `z = 0`
//!    there, and does so exactly if that time is between `c0` and `c1`.
//! 3. `z < 0`, round start: the line enters where it enters the ball around the start point. Proof:
//!    below the plane `z = 0` the point is in the half ball. Above it, the line would have crossed
//!    the plane before, inside the cylinder and hence inside the ball. A line that misses the ball
//!    misses the link.
//! 4. `z > length`: 2 and 3 mirrored.
//!
//! The exit follows with `c1` and the directions reversed. A line parallel to the axis has
//! `c0 = -inf` and `c1 = inf`; cases 2 to 4 hold for it unchanged.
//!
//! # Rounding
//! Both quadratics are solved about the point of the line closest to the centre of the cylinder or
//! ball. The half chord is `sqrt((radius - gap)(radius + gap))` for the line's distance `gap`. So
//! the radius is never subtracted from the square of a distant origin's distance. The direction may
//! have any length; time is in units of it.

use super::axial::{AxialFrame, perpendicular, power_of_two, unit, unit_across};
use super::feature;
use crate::robot::{Cap, ModifiedCylinder};
use parry3d_f64::math::{Real, Vector};
use parry3d_f64::query::{PointQuery, Ray, RayCast, RayIntersection};
use parry3d_f64::shape::FeatureId;

/// A crossing of the line and the surface.
#[derive(Clone, Copy)]
struct Crossing {
    /// In units of the line's direction, from the line's point closest to the link's middle.
    time: Real,
    /// Outward unit normal.
    normal: Vector,
    feature: FeatureId,
}

/// A line relative to the middle of the link, in the units of `frame`.
struct Line<'a> {
    frame: &'a AxialFrame,
    caps: [Cap; 2],
    /// The line's point closest to the middle of the axis, relative to that middle.
    point: Vector,
    direction: Vector,
    /// The components of `point` and `direction` perpendicular to the axis.
    lateral: Vector,
    lateral_direction: Vector,
    /// The coordinate of `point` along the axis from the start, and the axial component of
    /// `direction`.
    z: Real,
    rise: Real,
}

impl<'a> Line<'a> {
    fn new(frame: &'a AxialFrame, caps: [Cap; 2], point: Vector, direction: Vector) -> Self {
        let axis = frame.axis;
        let (height, rise) = (point.dot(axis), direction.dot(axis));
        Self {
            frame,
            caps,
            point,
            direction,
            lateral: point - axis * height,
            lateral_direction: direction - axis * rise,
            z: height + 0.5 * frame.length,
            rise,
        }
    }

    /// Returns the interval of the line inside the link.
    fn interval(&self) -> Option<(Crossing, Crossing)> {
        let (enters, leaves) = self.within_cylinder()?;
        let entry = self.crossing(enters, -1.0, enters, leaves)?;
        let exit = self.crossing(leaves, 1.0, enters, leaves).unwrap_or(entry);
        Some((entry, exit))
    }

    /// Returns the interval of the line inside the infinite cylinder.
    fn within_cylinder(&self) -> Option<(Real, Real)> {
        let speed_squared = self.lateral_direction.length_squared();
        if speed_squared == 0.0 {
            let inside = self.lateral.length() <= self.frame.radius;
            return inside.then_some((Real::NEG_INFINITY, Real::INFINITY));
        }
        chord(self.lateral, self.lateral_direction, self.frame.radius)
    }

    /// Returns the crossing at one bound of the interval. `side` is -1 at the entry and 1 at the
    /// exit; `bound` is the bound in the infinite cylinder.
    fn crossing(&self, bound: Real, side: Real, enters: Real, leaves: Real) -> Option<Crossing> {
        let z = self.z + bound * self.rise;
        let (end, outward, from_end) = if z < 0.0 {
            (0, -1.0, self.point + 0.5 * self.frame.span)
        } else if z > self.frame.length {
            (1, 1.0, self.point - 0.5 * self.frame.span)
        } else {
            return Some(self.barrel(bound));
        };
        let feature = feature::CAP[end];
        if self.caps[end] == Cap::Flat {
            let height = if end == 0 { self.z } else { self.z - self.frame.length };
            let time = -height / self.rise;
            let normal = self.frame.axis * outward;
            (enters <= time && time <= leaves).then_some(Crossing { time, normal, feature })
        } else {
            let (first, last) = chord(from_end, self.direction, self.frame.radius)?;
            let time = if side < 0.0 { first } else { last };
            let normal = unit(from_end + self.direction * time);
            Some(Crossing { time, normal: normal.unwrap_or_else(|| self.facing()), feature })
        }
    }

    fn barrel(&self, time: Real) -> Crossing {
        let normal = unit_across(self.lateral + self.lateral_direction * time, self.frame.axis);
        Crossing { time, normal: normal.unwrap_or_else(|| self.facing()), feature: feature::BARREL }
    }

    /// Returns the normal for a wire, which has none: the direction that faces the ray.
    fn facing(&self) -> Vector {
        unit_across(-self.direction, self.frame.axis)
            .unwrap_or_else(|| perpendicular(self.frame.axis))
    }
}

/// Returns the times at which `point + t direction` enters and leaves the ball of `radius` around
/// the origin (or, for vectors perpendicular to the axis, the cylinder).
fn chord(point: Vector, direction: Vector, radius: Real) -> Option<(Real, Real)> {
    let speed_squared = direction.length_squared();
    let middle = -point.dot(direction) / speed_squared;
    let gap = (point + direction * middle).length();
    if gap > radius {
        return None;
    }
    let half = ((radius - gap) * (radius + gap)).sqrt() / speed_squared.sqrt();
    Some((middle - half, middle + half))
}

/// Returns the ray's first hit of the link: of the solid, or of its surface if `solid` is false.
fn cast(link: &ModifiedCylinder, ray: &Ray, solid: bool) -> Option<RayIntersection> {
    if !ray.dir.is_finite() {
        return None;
    }
    let (frame, from_start) = AxialFrame::around(link, ray.origin)?;
    let (at_origin, feature) = link.project_local_point_and_get_feature(ray.origin);
    let inside = at_origin.is_inside;
    if inside && solid {
        return Some(RayIntersection::new(0.0, Vector::ZERO, FeatureId::Unknown));
    }
    let (down, _) = power_of_two(ray.dir.abs().max_element());
    let direction = ray.dir * down;
    if direction == Vector::ZERO {
        return None;
    }

    let from_middle = from_start - 0.5 * frame.span;
    let closest = -from_middle.dot(direction) / direction.length_squared();
    let line = Line::new(&frame, link.caps(), from_middle + direction * closest, direction);
    let time_of = |crossing: Crossing| frame.restore(closest + crossing.time) * down;

    let (time, normal, feature) = match (inside, line.interval()) {
        (true, Some((_, exit))) => (time_of(exit).max(0.0), -exit.normal, exit.feature),
        // The origin is on the surface and the line grazes it: it exits at once.
        (true, None) => {
            let normal = feature::normal(link, feature, ray.origin).unwrap_or(Vector::ZERO);
            (0.0, -normal, feature)
        }
        (false, Some((entry, exit))) => {
            let (start, end) = (time_of(entry), time_of(exit));
            // Outside, yet between the bounds: on the surface within rounding, at the nearer bound.
            if start < 0.0 && end < -start {
                return None;
            }
            (start.max(0.0), entry.normal, entry.feature)
        }
        (false, None) => return None,
    };
    Some(RayIntersection::new(time, normal, feature))
}

/// Exact times of impact (see the head of this file), in units of the ray's direction.
///
/// - From inside a solid: time 0 with a zero normal, as for parry's capsule.
/// - From inside a hollow link: the exit, with the normal pointing inwards.
/// - A direction of length zero hits only the solid that contains the origin.
/// - A ray that is not finite hits nothing.
impl RayCast for ModifiedCylinder {
    fn cast_local_ray_and_get_normal(
        &self,
        ray: &Ray,
        max_time_of_impact: Real,
        solid: bool,
    ) -> Option<RayIntersection> {
        cast(self, ray, solid).filter(|hit| hit.time_of_impact <= max_time_of_impact)
    }
}
