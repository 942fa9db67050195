//! The sum of solid angles, and the side that it proves.

use crate::answer::Side;
use crate::distance::Scalar;
use parry3d_f64::math::Real;
use std::f64::consts::PI;

/// The part of the view, out of 4 pi, that a hole may cover at most.
const HOLE: Real = PI;

/// A signed solid angle in steradians, and the most that the true one is off.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct SolidAngle {
    pub(super) value: Real,
    pub(super) error: Real,
}

impl SolidAngle {
    /// The side that the sum of all solid angles proves; none where a smaller error might.
    pub(crate) fn side(self) -> Option<Side> {
        // What rounding took from the sum of the errors.
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
    /// The sum, whose rounding counts as an error. The errors are themselves summed with rounding,
    /// which 2^32 times adds less than 2^-20 of them: [`side`](Self::side) allows for that, and
    /// with it for the few roundings of each error.
    fn add_assign(&mut self, other: Self) {
        self.value += other.value;
        self.error += other.error + f64::UNIT_ROUNDOFF * self.value.abs();
    }
}
