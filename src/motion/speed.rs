//! How fast a centreline moves and turns.

use crate::robot::RobotError;
use parry3d_f64::math::Real;

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
