//! A proof of an answer.

use super::checked_fields::checked_fields;
use parry3d_f64::math::Real;

/// Bounds on a distance that hold whatever was rounded on the way: `lower <= true <= upper`.
///
/// The true distance is that between the triangle, or another link, and the link whose axis ends
/// are `pose * start` and `pose * end`, both computed in `f64`, and whose radius is as given.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde-serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde-serialize",
    serde(try_from = "serialised::Fields", into = "serialised::Fields")
)]
#[non_exhaustive]
pub struct Certificate {
    /// The distance is at least this, in the unit of the shapes.
    pub lower: Real,
    /// The distance is at most this.
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
