//! What every question refuses of its own numbers.

use crate::answer::ProximityError;
use parry3d_f64::math::Real;

/// A margin that can be kept.
pub(crate) fn check_margin(margin: Real) -> Result<(), ProximityError> {
    check_not_negative("margin", margin)
}

/// A margin, a prominence, a tolerance or a resolution, as the function that was called names it.
pub(crate) fn check_not_negative(
    parameter: &'static str,
    value: Real,
) -> Result<(), ProximityError> {
    // Written so that NaN is an error.
    if value >= 0.0 { Ok(()) } else { Err(ProximityError::Negative { parameter, value }) }
}

/// A margin, and how near to it the clearance must be for the answer to stay open.
#[cfg(feature = "tubes")]
pub(crate) fn check_decision(margin: Real, resolution: Real) -> Result<(), ProximityError> {
    check_margin(margin)?;
    check_not_negative("resolution", resolution)
}

/// A bound, which asks for nothing where it is below zero.
pub(crate) fn check_bound(bound: Real) -> Result<(), ProximityError> {
    if bound.is_nan() { Err(ProximityError::NotANumber { parameter: "bound" }) } else { Ok(()) }
}
