//! The closest place of two robots, or of two parts of one robot.

use parry3d_f64::math::{Real, Vector};

/// The place where two links are closest, one of each robot, in the frame and unit of the poses.
///
/// For one robot and itself, the first link is the one nearer to the base, and the frame is the
/// robot's own.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde-serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde-serialize",
    serde(try_from = "serialised::Fields", into = "serialised::Fields")
)]
#[non_exhaustive]
pub struct RobotProximity {
    /// The links' indices in [`Chain::links`](crate::Chain::links), of the first robot and of the
    /// second.
    pub links: [u32; 2],
    /// The distance between the two links, 0 if they touch or overlap.
    pub distance: Real,
    /// The first link's closest point.
    pub on_first: Vector,
    /// The second link's closest point; equal to `on_first` if the links touch or overlap.
    pub on_second: Vector,
    /// The places along each robot's centreline, from the base: on the link's axis, nearest to the
    /// other link's point.
    pub arc_lengths: [Real; 2],
}

#[cfg(feature = "serde-serialize")]
mod serialised {
    use super::RobotProximity;
    use parry3d_f64::math::{Real, Vector};
    use serde::{Deserialize, Serialize};

    /// The fields of a [`RobotProximity`], points as `[x, y, z]`.
    #[derive(Serialize, Deserialize)]
    #[serde(rename = "RobotProximity")]
    pub(crate) struct Fields {
        links: [u32; 2],
        distance: Real,
        on_first: [Real; 3],
        on_second: [Real; 3],
        arc_lengths: [Real; 2],
    }

    impl From<RobotProximity> for Fields {
        fn from(found: RobotProximity) -> Self {
            let RobotProximity { links, distance, on_first, on_second, arc_lengths } = found;
            let (on_first, on_second) = (on_first.to_array(), on_second.to_array());
            Self { links, distance, on_first, on_second, arc_lengths }
        }
    }

    /// Rejects fields that no query returns: a distance that is negative or not finite, or a place
    /// that is not finite.
    impl TryFrom<Fields> for RobotProximity {
        type Error = String;

        fn try_from(fields: Fields) -> Result<Self, String> {
            let Fields { links, distance, on_first, on_second, arc_lengths } = fields;
            let (on_first, on_second) =
                (Vector::from_array(on_first), Vector::from_array(on_second));
            if !(distance.is_finite() && distance >= 0.0) {
                return Err(format!(
                    "the distance is {distance}; it must be finite and at least 0"
                ));
            }
            if !(on_first.is_finite()
                && on_second.is_finite()
                && arc_lengths.iter().all(|length| length.is_finite()))
            {
                return Err("a place is not finite; repair the answer".to_owned());
            }
            Ok(Self { links, distance, on_first, on_second, arc_lengths })
        }
    }
}
