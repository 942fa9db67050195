//! The clearance of two tubes, between bounds.

use super::PairWitness;
#[cfg(feature = "serde-serialize")]
use super::checked_fields::check_bounds;
use super::checked_fields::checked_fields;
use super::clearance::resolve;
use parry3d_f64::math::Real;

/// The place where two tubes are closest, between bounds, in the frame and unit of the poses.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde-serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde-serialize",
    serde(try_from = "serialised::Fields", into = "serialised::Fields")
)]
#[non_exhaustive]
pub struct RobotClearance {
    /// Lower bound on the clearance.
    pub lower: Real,
    /// Upper bound on the clearance: 0 if the tubes touch or overlap.
    pub upper: Real,
    /// Whether the bounds meet the tolerance: `upper - lower <= tolerance + uncertainty`.
    pub resolved: bool,
    /// The part of the gap that no finer tolerance closes: the errors that the tubes state of
    /// themselves. Near a flat face of unknown direction ([`Tube::fit`](crate::Tube::fit)) it
    /// includes the effect of that direction.
    pub uncertainty: Real,
    /// The sections of constant radius that realise `upper`, counted from each base.
    pub sections: [u32; 2],
    /// A point of each tube, at most `upper` apart, and their places.
    pub witness: PairWitness,
}

impl RobotClearance {
    /// Combines two answers to one query: the larger `lower`, and the smaller `upper` with its
    /// place.
    pub(crate) fn and(self, other: Self, tolerance: Real) -> Self {
        let nearer = if other.upper < self.upper { other } else { self };
        let lower = self.lower.max(other.lower);
        let uncertainties = [self.uncertainty, other.uncertainty];
        let (resolved, uncertainty) = resolve(nearer.upper - lower, uncertainties, tolerance);
        Self { lower, resolved, uncertainty, ..nearer }
    }
}

checked_fields!(
    "RobotClearance",
    RobotClearance {
        lower: Real,
        upper: Real,
        resolved: bool,
        uncertainty: Real,
        sections: [u32; 2],
        #[serde(flatten)]
        witness: PairWitness,
    },
    |&Fields { lower, upper, uncertainty, .. }| check_bounds([lower, upper], uncertainty)
);
