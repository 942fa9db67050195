//! An answer about two tubes.

use super::clearance::resolve;
use parry3d_f64::math::{Real, Vector};

/// How near two tubes are, between bounds, in the frame and unit of the poses.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde-serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde-serialize",
    serde(try_from = "serialised::Fields", into = "serialised::Fields")
)]
#[non_exhaustive]
pub struct RobotClearance {
    /// The clearance is at least this.
    pub lower: Real,
    /// The clearance is at most this: 0 where the tubes touch or overlap.
    pub upper: Real,
    /// Whether the bounds are as close as was asked for: no farther apart than the tolerance and
    /// `uncertainty`.
    pub resolved: bool,
    /// What the errors cost that the tubes state for themselves, and no finer tolerance can mend;
    /// and near a flat face whose direction is not known ([`Tube::fit`](crate::Tube::fit)),
    /// what that costs.
    pub uncertainty: Real,
    /// The sections of constant radius that realise `upper`, counted from each base.
    pub sections: [u32; 2],
    /// A point of the first tube, `upper` or less from `on_second`.
    pub on_first: Vector,
    /// A point of the second tube; the same as `on_first` where they touch or overlap.
    pub on_second: Vector,
    /// Where along each tube's centreline, from the base.
    pub arc_lengths: [Real; 2],
}

impl RobotClearance {
    /// What two answers to one question say together.
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

    /// No bound is negative or not finite.
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
