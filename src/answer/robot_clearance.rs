//! The clearance of two tubes, between bounds.

use super::clearance::resolve;
use parry3d_f64::math::{Real, Vector};

/// The place where two tubes are closest, between bounds, in the frame and unit of the poses.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde-serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde-serialize",
    serde(try_from = "serialised::Fields", into = "serialised::Fields")
)]
#[non_exhaustive]
pub struct RobotClearance {
    /// Lower bound on the clearance.
    pub lower: Real,
    /// Upper bound on the clearance: 0 if the tubes touch or overlap.
    pub upper: Real,
    /// Whether the bounds meet the tolerance: `upper - lower <= tolerance + uncertainty`.
    pub resolved: bool,
    /// The part of the gap that no finer tolerance closes: the errors that the tubes state of
    /// themselves. Near a flat face of unknown direction ([`Tube::fit`](crate::Tube::fit)) it
    /// includes the effect of that direction.
    pub uncertainty: Real,
    /// The sections of constant radius that realise `upper`, counted from each base.
    pub sections: [u32; 2],
    /// A point of the first tube, at most `upper` from `on_second`.
    pub on_first: Vector,
    /// A point of the second tube; equal to `on_first` if the tubes touch or overlap.
    pub on_second: Vector,
    /// The places along each tube's centreline, from the base.
    pub arc_lengths: [Real; 2],
}

impl RobotClearance {
    /// Combines two answers to one query: the larger `lower`, and the smaller `upper` with its
    /// place.
    pub(crate) fn and(self, other: Self, tolerance: Real) -> Self {
        let nearer = if other.upper < self.upper { other } else { self };
        let lower = self.lower.max(other.lower);
        let uncertainties = [self.uncertainty, other.uncertainty];
        let (resolved, uncertainty) = resolve(nearer.upper - lower, uncertainties, tolerance);
        Self { lower, resolved, uncertainty, ..nearer }
    }
}

#[cfg(feature = "serde-serialize")]
mod serialised {
    use super::RobotClearance;
    use parry3d_f64::math::{Real, Vector};
    use serde::{Deserialize, Serialize};

    /// The fields of a [`RobotClearance`], points as `[x, y, z]`.
    #[derive(Serialize, Deserialize)]
    #[serde(rename = "RobotClearance")]
    pub(crate) struct Fields {
        lower: Real,
        upper: Real,
        resolved: bool,
        uncertainty: Real,
        sections: [u32; 2],
        on_first: [Real; 3],
        on_second: [Real; 3],
        arc_lengths: [Real; 2],
    }

    impl From<RobotClearance> for Fields {
        fn from(found: RobotClearance) -> Self {
            let RobotClearance {
                lower, upper, resolved, uncertainty, sections, arc_lengths, ..
            } = found;
            let (on_first, on_second) = (found.on_first.to_array(), found.on_second.to_array());
            Self { lower, upper, resolved, uncertainty, sections, on_first, on_second, arc_lengths }
        }
    }

    /// Rejects fields that no query returns: bounds that are negative, out of order or not finite,
    /// or a place that is not finite.
    impl TryFrom<Fields> for RobotClearance {
        type Error = String;

        fn try_from(fields: Fields) -> Result<Self, String> {
            let Fields { lower, upper, resolved, uncertainty, sections, arc_lengths, .. } = fields;
            let (on_first, on_second) =
                (Vector::from_array(fields.on_first), Vector::from_array(fields.on_second));
            if !(0.0 <= lower && lower <= upper && upper.is_finite()) {
                return Err(format!(
                    "the bounds are {lower} and {upper}; they must be finite, at least 0, and in order"
                ));
            }
            if !(uncertainty.is_finite() && uncertainty >= 0.0) {
                return Err(format!(
                    "the uncertainty is {uncertainty}; it must be finite and at least 0"
                ));
            }
            let is_finite = on_first.is_finite() && on_second.is_finite();
            if !(is_finite && arc_lengths.iter().all(|length| length.is_finite())) {
                return Err("a place is not finite; repair the answer".to_owned());
            }
            Ok(Self {
                lower,
                upper,
                resolved,
                uncertainty,
                sections,
                on_first,
                on_second,
                arc_lengths,
            })
        }
    }
}
