//! A link in double-double arithmetic, for certificates: its extent along a direction, and its
//! distance from a point.
//!
//! Both hold for the numbers as given: a direction that is not exactly a unit vector, and a point
//! that is rounded, are valid arguments.

use super::checks::{check_ends, rigid_pose};
use crate::answer::{Certificate, ProximityError};
use crate::distance::{DoubleDouble, Link, Scalar, Vec3, gives_direction};
use crate::robot::ModifiedCylinder;
use parry3d_f64::math::{Pose, Real, Vector};

pub(super) type Number = DoubleDouble;
pub(super) type ExactPoint = Vec3<DoubleDouble>;

/// The largest rounding error of any bound of a certificate, where no coordinate exceeds 2: a
/// hundred operations, each wrong by 2^-102 of numbers below 16, plus underflow.
pub(super) const SLACK: f64 = f64::from_bits((1023 - 88) << 52);

/// Returns the largest magnitude of a coordinate.
pub(super) fn largest<const N: usize>(points: [Vector; N]) -> Real {
    points.iter().map(|point| point.abs().max_element()).fold(0.0, Real::max)
}

/// A pair's own coordinates, in which differences are exact and the largest is near one.
#[derive(Clone, Copy)]
pub(super) struct ExactFrame {
    origin: Vector,
    coarse: Real,
    fine: Real,
}

impl ExactFrame {
    /// Returns the frame at `origin`, in which no coordinate and no radius exceeds 2; `None` if all
    /// points coincide.
    pub(super) fn around<const N: usize>(
        origin: Vector,
        points: [Vector; N],
        radius: Real,
    ) -> Option<Self> {
        // Relative to the origin every coordinate is an exact double-double, and the largest is
        // brought near one. Small numbers beside large coordinates must not underflow first, so
        // `coarse` is at least 1.
        let far = largest(points).max(largest([origin])).max(radius);
        let coarse = far.power_of_two_to_unity().max(1.0);
        let extent =
            largest(points.map(|point| point * coarse - origin * coarse)).max(radius * coarse);
        (extent > 0.0).then(|| Self { origin, coarse, fine: extent.power_of_two_to_unity() })
    }

    pub(super) fn point(&self, point: Vector) -> ExactPoint {
        self.way(self.origin, point)
    }

    /// Returns the vector from one point to another, exactly.
    fn way(&self, from: Vector, to: Vector) -> ExactPoint {
        let (from, to) = ((from * self.coarse).to_array(), (to * self.coarse).to_array());
        let along = |axis: usize| (Number::from(to[axis]) - from[axis].into()) * self.fine.into();
        Vec3::new(along(0), along(1), along(2))
    }

    fn length(&self, length: Real) -> Number {
        Number::from(length * self.coarse) * self.fine.into()
    }

    /// Returns bounds of this frame in the caller's unit, widened by one number for the rounding to
    /// `f64` and back to that unit.
    pub(super) fn certificate(&self, lower: Number, upper: Number) -> Certificate {
        let back = |bound: Number| bound.rounded() / self.fine / self.coarse;
        Certificate { lower: back(lower).next_down().max(0.0), upper: back(upper).next_up() }
    }
}

/// A link in `f64`, in the frame in which two shapes are compared.
pub(super) struct CertifiedLink {
    pub start: Vector,
    pub end: Vector,
    pub radius: Real,
    pub flat: [bool; 2],
}

impl CertifiedLink {
    /// Returns the link at `pose`. `number` is its position in its chain.
    pub(super) fn new(
        link: &ModifiedCylinder,
        pose: &Pose,
        number: usize,
    ) -> Result<Self, ProximityError> {
        let link = link.transformed(&rigid_pose(pose)?);
        let (start, end) = (link.start(), link.end());
        check_ends(number, [start, end])?;
        Ok(Self { start, end, radius: link.radius(), flat: link.flat() })
    }

    /// Returns the link in exact coordinates.
    pub(super) fn exact(&self, frame: &ExactFrame) -> ExactLink {
        let along = frame.way(self.start, self.end);
        // As in the narrow phase, a length whose square underflows beside the other shape gives no
        // direction.
        let squared =
            Vec3::new(along.x.rounded(), along.y.rounded(), along.z.rounded()).norm_squared();
        let zero = Vec3::new(Number::ZERO, Number::ZERO, Number::ZERO);
        let axis = if gives_direction(squared) { along.normalised() } else { zero };
        let start = frame.point(self.start);
        ExactLink { start, along, axis, radius: frame.length(self.radius), flat: self.flat }
    }
}

/// A link in coordinates up to 2.
#[derive(Clone, Copy)]
pub(super) struct ExactLink {
    pub start: ExactPoint,
    /// The vector from start to end.
    pub along: ExactPoint,
    /// The unit direction, or zero if it has none.
    pub axis: ExactPoint,
    pub radius: Number,
    pub flat: [bool; 2],
}

impl ExactLink {
    pub(super) fn end(&self) -> ExactPoint {
        self.start + self.along
    }

    /// Returns the link relative to its own start, as the narrow phase represents it.
    pub(super) fn seen_from_start(&self) -> Link<Number> {
        Link { end: self.along, axis: self.axis, radius: self.radius, flat: self.flat }
    }

    /// Returns a lower bound on `<direction, x>` over the link.
    pub(super) fn lowest(&self, direction: ExactPoint) -> Number {
        let along = direction.dot(self.axis);
        let across = (direction - self.axis * along).norm() * self.radius;
        let lowest = |height: Number, inward: Number, flat: bool| {
            // A round cap extends by its ball in directions from beyond its end, otherwise only by
            // its rim.
            height - if flat || inward.lt((-SLACK).into()) { across } else { self.radius }
        };
        let start = lowest(self.start.dot(direction), along, self.flat[0]);
        start.min(lowest(self.end().dot(direction), -along, self.flat[1]))
    }

    /// Returns an upper bound on `<direction, x>` over the link.
    pub(super) fn highest(&self, direction: ExactPoint) -> Number {
        -self.lowest(-direction)
    }

    /// Returns an upper bound on the distance of `point` from the link.
    pub(super) fn distance_to(&self, point: ExactPoint) -> Number {
        let zero = Number::ZERO;
        let from_start = point - self.start;
        let from_end = from_start - self.along;
        let along = from_start.dot(self.axis);
        let (above, below) = (from_end.dot(self.axis), -along);
        let radial = (from_start - self.axis * along).norm();
        let beside = (radial - self.radius).max(zero);
        let (beyond, from, flat) = if zero.lt(above) {
            (above, from_end, self.flat[1])
        } else {
            (below, from_start, self.flat[0])
        };
        if !zero.lt(beyond) {
            beside
        } else if flat {
            (beyond * beyond + beside * beside).sqrt()
        } else {
            (from.norm() - self.radius).max(zero)
        }
    }
}
