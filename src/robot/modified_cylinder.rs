//! The one shape of this crate: a cylinder whose two ends are each flat or round.

use super::scale;
use super::{Cap, RobotError};
use parry3d_f64::math::{Pose, Real, Vector};
use parry3d_f64::shape::Capsule;

/// Largest coordinate or radius accepted. Squares of differences of such numbers are finite, and so
/// are the results of every query.
pub(crate) const COORDINATE_LIMIT: Real = 1.0e150;

/// A cylinder of finite length whose ends are each flat or round (paper, section III.E).
///
/// Two round caps make a capsule, two flat caps a cylinder. With radius 0 it is a wire; with length
/// 0 and two round caps it is a ball. Coordinates are in the unit and frame of whoever builds it.
///
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
    /// A link from `start` to `end` with the given `radius` and the caps at start and end.
    ///
    /// # Errors
    /// A coordinate or the radius is not finite or out of range, the radius is negative, or a cap
    /// is flat although the length is 0, or vanishes beside the radius (2^-400 of it).
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

    /// As [`ModifiedCylinder::new`], for arguments that are known to be good.
    pub(crate) fn unchecked(start: Vector, end: Vector, radius: Real, caps: [Cap; 2]) -> Self {
        Self { start, end, radius, caps }
    }

    /// A link with two round caps (the paper's K).
    ///
    /// # Errors
    /// As [`ModifiedCylinder::new`].
    pub fn capsule(start: Vector, end: Vector, radius: Real) -> Result<Self, RobotError> {
        Self::new(start, end, radius, [Cap::Round; 2])
    }

    /// A link with two flat caps (the paper's Z).
    ///
    /// # Errors
    /// As [`ModifiedCylinder::new`].
    pub fn cylinder(start: Vector, end: Vector, radius: Real) -> Result<Self, RobotError> {
        Self::new(start, end, radius, [Cap::Flat; 2])
    }

    /// The start point of the axis.
    pub fn start(&self) -> Vector {
        self.start
    }

    /// The end point of the axis.
    pub fn end(&self) -> Vector {
        self.end
    }

    /// The radius.
    pub fn radius(&self) -> Real {
        self.radius
    }

    /// The caps at the start and at the end.
    pub fn caps(&self) -> [Cap; 2] {
        self.caps
    }

    /// Which caps are flat, as the narrow phase wants it.
    pub(crate) fn flat(&self) -> [bool; 2] {
        self.caps.map(|cap| cap == Cap::Flat)
    }

    /// The length of the axis; a round cap reaches one radius further.
    pub fn length(&self) -> Real {
        scale::length(self.end - self.start)
    }

    /// The unit vector from start to end, or zero for a ball.
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

    /// The [`length`](Self::length) and the [`axis`](Self::axis).
    pub(crate) fn length_and_axis(&self) -> (Real, Vector) {
        scale::length_and_direction(self.end - self.start)
    }

    /// The same link moved by `pose`.
    ///
    /// If a short link is moved so far out that rounding makes its two ends one, its caps become
    /// round: the ball holds the link whichever way its lost axis pointed.
    #[inline]
    pub fn transformed(&self, pose: &Pose) -> Self {
        let (start, end) = (pose * self.start, pose * self.end);
        let caps = if has_direction(start, end, self.radius) { self.caps } else { [Cap::Round; 2] };
        Self { start, end, caps, ..*self }
    }
}

/// Whether a link is long enough for flat caps. Where its length is 2^-400 of its radius, its
/// square would vanish in the narrow phase.
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

/// Every coordinate is finite and within [`COORDINATE_LIMIT`].
pub(crate) fn check_points(parameter: &'static str, points: &[Vector]) -> Result<(), RobotError> {
    points.iter().enumerate().try_for_each(|(index, &point)| check_place(parameter, index, point))
}

/// The same of one point.
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

/// Every radius is finite, not negative and within [`COORDINATE_LIMIT`].
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
