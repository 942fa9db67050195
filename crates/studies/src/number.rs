//! What the narrow phase and the root finders both compute with.

use parry_continuum::distance::Scalar;
use real_polynomial_roots::Real;

/// A single number of either kind: `f32`, `f64`, or one that counts.
pub trait Number: Real + Scalar<Mask = bool> {}

impl<T: Real + Scalar<Mask = bool>> Number for T {}
