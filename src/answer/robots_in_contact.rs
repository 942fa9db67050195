//! Two shapes of moving robots that violate a margin.

use parry3d_f64::math::{Real, Vector};

/// Two shapes that motions take at the same time, at most the margin apart, in the frame and unit
/// of the motions.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde-serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde-serialize",
    serde(try_from = "serialised::Fields", into = "serialised::Fields")
)]
#[non_exhaustive]
pub struct RobotsInContact {
    /// The time of the shapes, from 0 to 1.
    pub t: Real,
    /// Upper bound on their clearance, at most the margin: 0 if they touch or overlap.
    pub upper: Real,
    /// The sections of constant radius that realise `upper`, counted from each base.
    pub sections: [u32; 2],
    /// A point of the first robot, at most `upper` from `on_second`.
    pub on_first: Vector,
    /// A point of the second robot; equal to `on_first` if the robots touch or overlap.
    pub on_second: Vector,
    /// The places along each centreline, from the base.
    pub arc_lengths: [Real; 2],
}

#[cfg(feature = "serde-serialize")]
mod serialised {
    use super::RobotsInContact;
    use parry3d_f64::math::{Real, Vector};
    use serde::{Deserialize, Serialize};

    /// The fields of a [`RobotsInContact`], points as `[x, y, z]`.
    #[derive(Serialize, Deserialize)]
    #[serde(rename = "RobotsInContact")]
    pub(crate) struct Fields {
        t: Real,
        upper: Real,
        sections: [u32; 2],
        on_first: [Real; 3],
        on_second: [Real; 3],
        arc_lengths: [Real; 2],
    }

    impl From<RobotsInContact> for Fields {
        fn from(found: RobotsInContact) -> Self {
            let RobotsInContact { t, upper, sections, on_first, on_second, arc_lengths } = found;
            let (on_first, on_second) = (on_first.to_array(), on_second.to_array());
            Self { t, upper, sections, on_first, on_second, arc_lengths }
        }
    }

    /// Rejects fields that no query returns: a time outside the motions, a clearance that is
    /// negative or not finite, or a place that is not finite.
    impl TryFrom<Fields> for RobotsInContact {
        type Error = String;

        fn try_from(fields: Fields) -> Result<Self, String> {
            let Fields { t, upper, sections, on_first, on_second, arc_lengths } = fields;
            let (on_first, on_second) =
                (Vector::from_array(on_first), Vector::from_array(on_second));
            if !(0.0..=1.0).contains(&t) {
                return Err(format!("times of a motion are from 0 to 1, not {t}"));
            }
            if !(upper.is_finite() && upper >= 0.0) {
                return Err(format!("the clearance is {upper}; it must be finite and at least 0"));
            }
            let is_finite = on_first.is_finite() && on_second.is_finite();
            if !(is_finite && arc_lengths.iter().all(|length| length.is_finite())) {
                return Err("a place is not finite; repair the answer".to_owned());
            }
            Ok(Self { t, upper, sections, on_first, on_second, arc_lengths })
        }
    }
}
