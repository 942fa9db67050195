//! The least clearance of a motion, between bounds.

use super::Witness;
use super::checked_fields::checked_fields;
#[cfg(feature = "serde-serialize")]
use super::checked_fields::{check_bounds, check_time};
use parry3d_f64::math::Real;

/// The time and the place where a motion is closest to a mesh, between bounds. All fields are in
/// the mesh's frame and unit.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde-serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde-serialize",
    serde(try_from = "serialised::Fields", into = "serialised::Fields")
)]
#[non_exhaustive]
pub struct MotionClearance {
    /// Lower bound on the clearance of every shape of the motion.
    pub lower: Real,
    /// Upper bound on the clearance of the shape at `t`: 0 if it touches the mesh.
    pub upper: Real,
    /// Whether the bounds meet the tolerance: `upper - lower <= tolerance + uncertainty`.
    pub resolved: bool,
    /// The part of the gap that no finer tolerance closes: the errors that the shapes state of
    /// themselves.
    pub uncertainty: Real,
    /// The time of the shape that realises `upper`, from 0 to 1.
    pub t: Real,
    /// The section of constant radius at the place that realises `upper`, counted from the base.
    pub section: u32,
    /// A point of the tube and a point of the mesh that are at most `upper` apart.
    pub witness: Witness,
}

checked_fields!(
    "MotionClearance",
    MotionClearance {
        lower: Real,
        upper: Real,
        resolved: bool,
        uncertainty: Real,
        t: Real,
        section: u32,
        #[serde(flatten)]
        witness: Witness,
    },
    |&Fields { lower, upper, uncertainty, t, .. }| check_bounds([lower, upper], uncertainty)
        .and(check_time(t))
);
