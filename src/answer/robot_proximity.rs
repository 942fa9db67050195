//! The closest place of two robots, or of two parts of one robot.

use super::PairWitness;
#[cfg(feature = "serde-serialize")]
use super::checked_fields::check_distance;
use super::checked_fields::checked_fields;
use parry3d_f64::math::Real;

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
    /// The closest points of the two links and their places.
    pub witness: PairWitness,
}

checked_fields!(
    "RobotProximity",
    RobotProximity {
        links: [u32; 2],
        distance: Real,
        #[serde(flatten)]
        witness: PairWitness,
    },
    |&Fields { distance, .. }| check_distance(distance)
);
