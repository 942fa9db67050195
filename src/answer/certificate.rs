//! A proof of an answer.

use parry3d_f64::math::Real;

/// Bounds on a distance that hold whatever was rounded on the way: `lower <= true <= upper`.
///
/// The true distance is that between the triangle and the link whose axis ends are `pose * start` and `pose * end`,
/// both computed in `f64`, and whose radius is as given.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde-serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde-serialize", serde(try_from = "serialised::Bounds", into = "serialised::Bounds"))]
#[non_exhaustive]
pub struct Certificate {
    /// The distance is at least this, in the mesh's unit.
    pub lower: Real,
    /// The distance is at most this.
    pub upper: Real,
}

#[cfg(feature = "serde-serialize")]
mod serialised {
    use super::Certificate;
    use parry3d_f64::math::Real;
    use serde::{Deserialize, Serialize};

    /// The fields of a [`Certificate`].
    #[derive(Serialize, Deserialize)]
    #[serde(rename = "Certificate")]
    pub(crate) struct Bounds {
        lower: Real,
        upper: Real,
    }

    impl From<Certificate> for Bounds {
        fn from(Certificate { lower, upper }: Certificate) -> Self {
            Self { lower, upper }
        }
    }

    /// No proof gives bounds on a distance that are negative, not finite or the wrong way round.
    impl TryFrom<Bounds> for Certificate {
        type Error = String;

        fn try_from(Bounds { lower, upper }: Bounds) -> Result<Self, String> {
            if !(0.0 <= lower && lower <= upper && upper.is_finite()) {
                return Err(format!("{lower} to {upper} bounds no distance"));
            }
            Ok(Self { lower, upper })
        }
    }
}
