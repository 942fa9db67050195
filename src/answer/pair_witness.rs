//! The place of an answer about two robots.

use parry3d_f64::math::{Real, Vector};

/// Two points that realise a distance, one of each robot, and their places, in the frame and unit
/// of the poses.
///
/// For one robot and itself, the first part is the one nearer to the base, and the frame is the
/// robot's own.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde-serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde-serialize",
    serde(try_from = "pair_witness_fields::Fields", into = "pair_witness_fields::Fields")
)]
#[non_exhaustive]
pub struct PairWitness {
    /// The first robot's point.
    pub on_first: Vector,
    /// The second robot's point; equal to `on_first` if the robots touch or overlap.
    pub on_second: Vector,
    /// The places along each robot's centreline, from the base: on the axis of the link, or of the
    /// tube's section of constant radius, nearest to the other robot's point.
    pub arc_lengths: [Real; 2],
}

#[cfg(feature = "serde-serialize")]
mod pair_witness_fields {
    use super::PairWitness;
    use parry3d_f64::math::{Real, Vector};
    use serde::{Deserialize, Serialize};

    /// The fields of a [`PairWitness`], points as `[x, y, z]`.
    #[derive(Serialize, Deserialize)]
    #[serde(rename = "PairWitness")]
    pub(crate) struct Fields {
        on_first: [Real; 3],
        on_second: [Real; 3],
        arc_lengths: [Real; 2],
    }

    impl From<PairWitness> for Fields {
        fn from(PairWitness { on_first, on_second, arc_lengths }: PairWitness) -> Self {
            let (on_first, on_second) = (on_first.to_array(), on_second.to_array());
            Self { on_first, on_second, arc_lengths }
        }
    }

    /// Rejects places that are not finite: no query returns them.
    impl TryFrom<Fields> for PairWitness {
        type Error = String;

        fn try_from(fields: Fields) -> Result<Self, String> {
            let Fields { on_first, on_second, arc_lengths } = fields;
            let (on_first, on_second) =
                (Vector::from_array(on_first), Vector::from_array(on_second));
            let is_finite = on_first.is_finite() && on_second.is_finite();
            if is_finite && arc_lengths.iter().all(|length| length.is_finite()) {
                Ok(Self { on_first, on_second, arc_lengths })
            } else {
                Err(format!("a place is not finite: {arc_lengths:?}, {on_first} or {on_second}"))
            }
        }
    }
}
