//! How a mesh winds around a point: the solid angle under which the point sees it, with a bound on its error.
//!
//! The generalised winding number (Jacobson, Kavan and Sorkine-Hornung, "Robust inside-outside segmentation using
//! generalized winding numbers", 2013) is the sum of the signed solid angles of all triangles, over 4 pi. A closed
//! mesh winds around every point a whole number of times: never around those outside.
//!
//! `solid_angle` is that of a triangle, `far_field` that of many triangles far away (after Barill et al., "Fast winding
//! numbers for soups and clouds", 2018), and both bound their error. `side` is what follows from the sum.

mod far_field;
mod side;
mod solid_angle;
#[cfg(test)]
mod tests;

pub(super) use far_field::FarField;
pub use side::{InsideAnswer, Side};
pub(super) use solid_angle::solid_angle;

use crate::distance::Scalar;
use parry3d_f64::math::Real;

/// A signed solid angle in steradians, and the most that the true one is off.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct SolidAngle {
    value: Real,
    error: Real,
}

impl SolidAngle {
    pub(super) fn error(&self) -> Real {
        self.error
    }
}

impl std::ops::AddAssign for SolidAngle {
    /// The sum, whose rounding counts as an error. The errors are themselves summed with rounding, which 2^32 times
    /// adds less than 2^-20 of them: [`Side::of`] allows for that, and with it for the few roundings of each error.
    fn add_assign(&mut self, other: Self) {
        self.value += other.value;
        self.error += other.error + f64::UNIT_ROUNDOFF * self.value.abs();
    }
}
