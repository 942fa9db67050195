//! A shape of a motion that violates a margin.

use super::Witness;
#[cfg(feature = "serde-serialize")]
use super::checked_fields::check_shape;
use super::checked_fields::checked_fields;
use parry3d_f64::math::Real;

/// A shape of a motion that is at most the margin away, in the mesh's frame and unit.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde-serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde-serialize",
    serde(try_from = "serialised::Fields", into = "serialised::Fields")
)]
#[non_exhaustive]
pub struct ShapeInContact {
    /// The time of the shape, from 0 to 1.
    pub t: Real,
    /// Upper bound on its clearance, at most the margin.
    pub upper: Real,
    /// The section of constant radius at the place that realises `upper`, counted from the base.
    pub section: u32,
    /// A point of the tube and a point of the mesh that are at most `upper` apart.
    pub witness: Witness,
}

checked_fields!(
    "ShapeInContact",
    ShapeInContact {
        t: Real,
        upper: Real,
        section: u32,
        #[serde(flatten)]
        witness: Witness,
    },
    |&Fields { t, upper, .. }| check_shape(t, upper)
);
