//! Bounds on a distance that prove an answer.

use super::checked_fields::checked_fields;
use parry3d_f64::math::Real;

/// Bounds on a distance that include all rounding: `lower <= true <= upper`.
///
/// The true distance is from the placed link to the triangle or to another link. The placed link
/// has the axis ends `pose * start` and `pose * end`, both computed in `f64`, and the radius as
/// given.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde-serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde-serialize",
    serde(try_from = "serialised::Fields", into = "serialised::Fields")
)]
#[non_exhaustive]
pub struct Certificate {
    /// Lower bound on the distance, in the unit of the shapes.
    pub lower: Real,
    /// Upper bound on the distance.
    pub upper: Real,
}

checked_fields!(
    "Certificate",
    Certificate { lower: Real, upper: Real },
    |&Fields { lower, upper }| {
        if !(0.0 <= lower && lower <= upper && upper.is_finite()) {
            return Err(format!("{lower} to {upper} bounds no distance"));
        }
        Ok(())
    }
);
