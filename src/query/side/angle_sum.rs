//! The sum of solid angles, and the side that it proves.

use crate::answer::Side;
use crate::distance::Scalar;
use parry3d_f64::math::Real;
use std::f64::consts::PI;

/// The largest solid angle, out of `4 pi`, that holes in the mesh may cover together.
const HOLE: Real = PI;

/// A signed solid angle in steradians, and a bound on its error.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct SolidAngle {
    pub(super) value: Real,
    pub(super) error: Real,
}

impl SolidAngle {
    /// Returns the side that the sum of all solid angles proves. None if a smaller error might
    /// prove one.
    pub(crate) fn side(self) -> Option<Side> {
        // Covers the rounding in the sum of the errors.
        let error = self.error * (1.0 + 1e-6);
        let (least, most) = (self.value.abs() - error, self.value.abs() + error);
        if least > 4.0 * PI - HOLE {
            Some(Side::Inside)
        } else if most < HOLE {
            Some(Side::Outside)
        } else if least > HOLE && most < 4.0 * PI - HOLE {
            Some(Side::Undecided)
        } else {
            None
        }
    }

    pub(crate) fn error(&self) -> Real {
        self.error
    }
}

impl std::ops::AddAssign for SolidAngle {
    /// Adds a solid angle, and counts the rounding of the sum as an error.
    ///
    /// The errors are summed with rounding too. For 2^32 summands that is less than 2^-20 of the
    /// sum. [`side`](Self::side) allows for it, and for the few roundings of each error.
    fn add_assign(&mut self, other: Self) {
        self.value += other.value;
        self.error += other.error + f64::UNIT_ROUNDOFF * self.value.abs();
    }
}
