//! How fast and how far a centreline moves.

use crate::robot::RobotError;
use parry3d_f64::math::{Real, Vector};

/// Linear and angular speed of a centreline per unit of the motion's time. A constant speed equals
/// the distance moved from t = 0 to 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Speed {
    /// The linear speed of its points, in units of length.
    pub point: Real,
    /// The angular speed of its direction, in rad. Times the radius it is the speed of a disc's rim
    /// relative to the disc's centre.
    pub turn: Real,
}

/// Checks a speed or an angular speed that a motion states for a section.
///
/// # Errors
/// The value is negative, infinite or NaN.
pub(crate) fn check_speed(section: usize, value: Real) -> Result<Real, RobotError> {
    // Written so that NaN is an error.
    if (0.0..Real::INFINITY).contains(&value) {
        Ok(value)
    } else {
        Err(RobotError::BadSpeed { section, value })
    }
}

/// A bound on the displacement of a piece of the centreline from one time to another.
///
/// # Definitions
/// - d: the displacement of a point at its share of the piece, interpolated linearly between the
///   displacements `ways` of the piece's two ends.
/// - The point is at `p0` at the first time and at `p1` at the last. At the fraction q of the time
///   it is within `off` of `p0 + q d`, and also within `off` of `p1 - (1 - q) d`.
///
/// # How to state it
/// A point with acceleration at most a leaves the straight motion at constant speed between its
/// places at two times, T apart, by at most `a T^2 / 8`. If a motion knows these places, `off` is
/// this, plus the difference between inner displacements and the interpolated ones.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DisplacementBound {
    /// The displacements of the two ends of the piece, in the mesh's frame.
    pub ways: [Vector; 2],
    /// Largest distance of a point of the piece from its straight motion, in units of length.
    pub off: Real,
}

impl DisplacementBound {
    /// Builds the bound for a piece whose ends are at `here` first and at `there` last.
    pub(super) fn between(here: [Vector; 2], there: [Vector; 2], off: Real) -> Self {
        Self { ways: [there[0] - here[0], there[1] - here[1]], off }
    }

    /// Returns the displacement at a share of the piece, from 0 to 1.
    pub(super) fn way(&self, share: Real) -> Vector {
        self.ways[0] + (self.ways[1] - self.ways[0]) * share
    }
}
