//! The closest place of one link.

use super::Witness;
#[cfg(feature = "serde-serialize")]
use super::checked_fields::check_distance;
use super::checked_fields::checked_fields;
use parry3d_f64::math::Real;

/// The place where one link of a robot is closest to a mesh, in the mesh's frame and unit.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde-serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde-serialize",
    serde(try_from = "serialised::Fields", into = "serialised::Fields")
)]
#[non_exhaustive]
pub struct LinkProximity {
    /// The link's index in [`Chain::links`](crate::Chain::links).
    pub link: u32,
    /// The distance between link and triangle, 0 if they touch or overlap.
    pub distance: Real,
    /// The two closest points and their places.
    pub witness: Witness,
}

impl LinkProximity {
    /// Placeholder in a batch.
    pub(crate) fn placeholder() -> Self {
        Self { link: 0, distance: Real::NAN, witness: Witness::placeholder() }
    }
}

checked_fields!(
    "LinkProximity",
    LinkProximity {
        link: u32,
        distance: Real,
        #[serde(flatten)]
        witness: Witness,
    },
    |&Fields { distance, .. }| check_distance(distance)
);
