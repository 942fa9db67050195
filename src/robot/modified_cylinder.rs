//! The link: a cylinder whose two ends are each flat or round.
//!
//! # The tight bounding box
//! - `n`: the outward unit axis at an end. `e`: a unit vector along a coordinate axis.
//!
//! A link is the convex hull of its two ends: a disc each, plus the outward half ball at a round
//! end. So its box is the box of the two ends. From the end's centre along e,
//!
//! - the disc reaches `r |n x e|`;
//! - the half ball reaches `r` if `n . e >= 0`, and otherwise no further than the disc.

use super::scale::direction;
use super::{RobotError, scale};
use parry3d_f64::bounding_volume::Aabb;
use parry3d_f64::math::{Pose, Real, Vector};
use parry3d_f64::shape::Capsule;

/// Largest coordinate or radius accepted. Squares of differences of such numbers stay finite, and
/// so do the results of every query.
pub(crate) const COORDINATE_LIMIT: Real = 1.0e150;

/// A cylinder of finite length whose ends are each flat or round (paper, section III.E).
///
/// Special cases: two round caps make a capsule, two flat caps a cylinder; radius 0 makes a wire;
/// length 0 with two round caps makes a ball. Coordinates are in the caller's unit and frame.
/// ```
/// use parry_continuum::{Cap, ModifiedCylinder, parry::math::Vector};
///
/// let link = ModifiedCylinder::new(Vector::ZERO, Vector::Z, 0.25, [Cap::Flat, Cap::Round])?;
/// assert_eq!(link.length(), 1.0);
/// # Ok::<(), parry_continuum::RobotError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde-serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde-serialize",
    serde(try_from = "super::serialised::Link", into = "super::serialised::Link")
)]
pub struct ModifiedCylinder {
    start: Vector,
    end: Vector,
    radius: Real,
    caps: [Cap; 2],
}

impl ModifiedCylinder {
    /// Builds a link from `start` to `end`; `caps` are the caps at the start and at the end.
    ///
    /// All lengths are in one unit; `start` and `end` are in the link's frame.
    ///
    /// # Errors
    /// - a coordinate or the radius is not finite or beyond 1e150, or the radius is negative;
    /// - a cap is flat although the length is 0, or at most 2^-400 of the radius.
    pub fn new(
        start: Vector,
        end: Vector,
        radius: Real,
        caps: [Cap; 2],
    ) -> Result<Self, RobotError> {
        check_place("start", 0, start)?;
        check_place("end", 1, end)?;
        check_radii("radius", &[radius])?;
        if !has_direction(start, end, radius) && caps != [Cap::Round; 2] {
            return Err(if start == end {
                RobotError::FlatCapWithoutAxis { index: 0 }
            } else {
                let length = scale::length(end - start);
                RobotError::HidesLength { parameter: "radius", index: 0, value: radius, length }
            });
        }
        Ok(Self::unchecked(start, end, radius, caps))
    }

    /// As [`ModifiedCylinder::new`], for arguments that are known to be valid.
    pub(crate) fn unchecked(start: Vector, end: Vector, radius: Real, caps: [Cap; 2]) -> Self {
        Self { start, end, radius, caps }
    }

    /// Builds a link with two round caps (the paper's K).
    ///
    /// # Errors
    /// As [`ModifiedCylinder::new`].
    pub fn capsule(start: Vector, end: Vector, radius: Real) -> Result<Self, RobotError> {
        Self::new(start, end, radius, [Cap::Round; 2])
    }

    /// Builds a link with two flat caps (the paper's Z).
    ///
    /// # Errors
    /// As [`ModifiedCylinder::new`].
    pub fn cylinder(start: Vector, end: Vector, radius: Real) -> Result<Self, RobotError> {
        Self::new(start, end, radius, [Cap::Flat; 2])
    }

    /// Returns the start point of the axis.
    pub fn start(&self) -> Vector {
        self.start
    }

    /// Returns the end point of the axis.
    pub fn end(&self) -> Vector {
        self.end
    }

    /// Returns the radius.
    pub fn radius(&self) -> Real {
        self.radius
    }

    /// Returns the caps at the start and at the end.
    pub fn caps(&self) -> [Cap; 2] {
        self.caps
    }

    /// Returns which caps are flat, in the form that the distance kernels take.
    pub(crate) fn flat(&self) -> [bool; 2] {
        self.caps.map(|cap| cap == Cap::Flat)
    }

    /// Returns the length of the axis, without the radius that a round cap adds.
    pub fn length(&self) -> Real {
        scale::length(self.end - self.start)
    }

    /// Returns the unit vector from start to end, or zero for a ball.
    ///
    /// ```
    /// # use parry_continuum::{ModifiedCylinder, parry::math::Vector};
    /// let link = ModifiedCylinder::capsule(Vector::ZERO, Vector::Z * 3.0, 1.0)?;
    /// assert_eq!(link.axis(), Vector::Z);
    /// # Ok::<(), parry_continuum::RobotError>(())
    /// ```
    pub fn axis(&self) -> Vector {
        scale::direction(self.end - self.start)
    }

    /// Returns the [`length`](Self::length) and the [`axis`](Self::axis).
    #[cfg(feature = "robots")]
    pub(crate) fn length_and_axis(&self) -> (Real, Vector) {
        scale::length_and_direction(self.end - self.start)
    }

    /// Returns the link moved by `pose`.
    ///
    /// If rounding makes both ends of a short link equal, far from the origin, both caps become
    /// round. The ball contains the link for every direction of the lost axis.
    #[inline]
    pub fn transformed(&self, pose: &Pose) -> Self {
        let (start, end) = (pose * self.start, pose * self.end);
        let caps = if has_direction(start, end, self.radius) { self.caps } else { [Cap::Round; 2] };
        Self { start, end, caps, ..*self }
    }
}

/// Returns whether a link is long enough for flat caps: its longest component exceeds 2^-400 of the
/// radius. For shorter links the squared length would underflow in the distance kernels.
pub(crate) fn has_direction(start: Vector, end: Vector, radius: Real) -> bool {
    const LEAST: Real = Real::from_bits((1023 - 400) << 52);
    (end - start).abs().max_element() > radius * LEAST
}

impl TryFrom<&Capsule> for ModifiedCylinder {
    type Error = RobotError;

    fn try_from(capsule: &Capsule) -> Result<Self, RobotError> {
        Self::capsule(capsule.segment.a, capsule.segment.b, capsule.radius)
    }
}

/// Checks that every coordinate is finite and within [`COORDINATE_LIMIT`].
pub(crate) fn check_points(parameter: &'static str, points: &[Vector]) -> Result<(), RobotError> {
    points.iter().enumerate().try_for_each(|(index, &point)| check_place(parameter, index, point))
}

/// As [`check_points`], for one point.
pub(crate) fn check_place(
    parameter: &'static str,
    index: usize,
    point: Vector,
) -> Result<(), RobotError> {
    for value in point.to_array() {
        if !value.is_finite() {
            return Err(RobotError::PointNotFinite { parameter, index, value });
        }
        if value.abs() > COORDINATE_LIMIT {
            return Err(RobotError::PointOutOfRange {
                parameter,
                index,
                value,
                limit: COORDINATE_LIMIT,
            });
        }
    }
    Ok(())
}

/// Checks that every radius is finite, at least 0 and within [`COORDINATE_LIMIT`].
pub(crate) fn check_radii(parameter: &'static str, radii: &[Real]) -> Result<(), RobotError> {
    match radii.iter().position(|radius| !(0.0..=COORDINATE_LIMIT).contains(radius)) {
        Some(index) => Err(RobotError::BadRadius {
            parameter,
            index,
            value: radii[index],
            limit: COORDINATE_LIMIT,
        }),
        None => Ok(()),
    }
}

/// The end of a [`ModifiedCylinder`](crate::ModifiedCylinder).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde-serialize", derive(serde::Serialize, serde::Deserialize))]
pub enum Cap {
    /// A disc perpendicular to the axis: the link ends at its end point.
    Flat,
    /// An outward half ball of the link's radius, centred at the end point.
    Round,
}

impl ModifiedCylinder {
    /// Returns the smallest axis-aligned box that contains the link, in the link's own frame.
    ///
    /// Each side is right within a few units in the last place of its coordinate and the radius.
    pub fn local_aabb(&self) -> Aabb {
        let axis = direction(self.end() - self.start());
        let square = axis * axis;
        let disc = Vector::new(square.y + square.z, square.z + square.x, square.x + square.y)
            .map(|s| s.sqrt());
        let [back, front] = self.caps();
        let (low_at_start, high_at_start) = self.reach(disc, -axis, back);
        let (low_at_end, high_at_end) = self.reach(disc, axis, front);
        Aabb::new(
            (self.start() - low_at_start).min(self.end() - low_at_end),
            (self.start() + high_at_start).max(self.end() + high_at_end),
        )
    }

    /// Returns the smallest axis-aligned box of the link moved by `pose`.
    pub fn aabb(&self, pose: &Pose) -> Aabb {
        self.transformed(pose).local_aabb()
    }

    /// Returns how far an end reaches along each negative and each positive coordinate axis.
    fn reach(&self, disc: Vector, outward: Vector, cap: Cap) -> (Vector, Vector) {
        let r = self.radius();
        let side = |outward: f64, disc: f64| {
            r * if cap == Cap::Round && outward >= 0.0 { 1.0 } else { disc }
        };
        let sides = |outward: Vector| {
            Vector::new(side(outward.x, disc.x), side(outward.y, disc.y), side(outward.z, disc.z))
        };
        (sides(-outward), sides(outward))
    }
}
