//! Two shapes of moving robots that violate a margin.

use super::PairWitness;
#[cfg(feature = "serde-serialize")]
use super::checked_fields::check_shape;
use super::checked_fields::checked_fields;
use parry3d_f64::math::Real;

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
    /// A point of each robot, at most `upper` apart, and their places.
    pub witness: PairWitness,
}

checked_fields!(
    "RobotsInContact",
    RobotsInContact {
        t: Real,
        upper: Real,
        sections: [u32; 2],
        #[serde(flatten)]
        witness: PairWitness,
    },
    |&Fields { t, upper, .. }| check_shape(t, upper)
);
