//! Answers about a tube and a mesh: the clearance between bounds, its pieces, and the decision.

use super::Witness;
#[cfg(feature = "serde-serialize")]
use super::checked_fields::check_bounds;
use super::checked_fields::checked_fields;
use crate::robot::ModifiedCylinder;
use parry3d_f64::math::Real;

/// The place where a tube is closest to a mesh, between bounds. All fields are in the mesh's frame
/// and unit.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde-serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde-serialize",
    serde(try_from = "clearance_fields::Fields", into = "clearance_fields::Fields")
)]
#[non_exhaustive]
pub struct Clearance {
    /// Lower bound on the clearance.
    pub lower: Real,
    /// Upper bound on the clearance: 0 if the tube touches the mesh.
    pub upper: Real,
    /// Whether the bounds meet the tolerance: `upper - lower <= tolerance + uncertainty`.
    pub resolved: bool,
    /// The part of the gap that no finer tolerance closes: the errors that the tube states of
    /// itself. Near a flat face of unknown direction ([`Tube::fit`](crate::Tube::fit)) it includes
    /// the effect of that direction.
    pub uncertainty: Real,
    /// The section of constant radius at the place that realises `upper`, counted from the base.
    pub section: u32,
    /// A point of the tube and a point of the mesh that are at most `upper` apart.
    pub witness: Witness,
}

impl Clearance {
    /// Combines two answers to one query: the larger `lower`, and the smaller `upper` with its
    /// place.
    pub(crate) fn and(self, other: Self, tolerance: Real) -> Self {
        let nearer = if other.upper < self.upper { other } else { self };
        let lower = self.lower.max(other.lower);
        let uncertainties = [self.uncertainty, other.uncertainty];
        let (resolved, uncertainty) = resolve(nearer.upper - lower, uncertainties, tolerance);
        Self { lower, resolved, uncertainty, ..nearer }
    }

    /// Placeholder in a batch.
    pub(crate) fn placeholder() -> Self {
        Self {
            lower: Real::NAN,
            upper: Real::NAN,
            resolved: false,
            uncertainty: Real::NAN,
            section: 0,
            witness: Witness::placeholder(),
        }
    }
}

/// Returns whether a gap of `apart` meets the tolerance with either uncertainty, and which one.
pub(super) fn resolve(apart: Real, [one, other]: [Real; 2], tolerance: Real) -> (bool, Real) {
    let (least, most) = (one.min(other), one.max(other));
    if apart <= tolerance + least { (true, least) } else { (apart <= tolerance + most, most) }
}

checked_fields!(
    clearance_fields,
    "Clearance",
    Clearance {
        lower: Real,
        upper: Real,
        resolved: bool,
        uncertainty: Real,
        section: u32,
        #[serde(flatten)]
        witness: Witness,
    },
    |&Fields { lower, upper, uncertainty, .. }| check_bounds([lower, upper], uncertainty)
);

/// A piece of a tube, as
/// [`BvhSearch::clearance_pieces`](crate::proximity::BvhSearch::clearance_pieces) returns it: as
/// fine as the answer needed. All fields are in the mesh's frame and unit.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct TubePiece {
    /// The section of constant radius to which the piece belongs, counted from the base.
    pub section: u32,
    /// The arc lengths of its two ends on the centreline.
    pub arc_lengths: [Real; 2],
    /// A convex body that contains the piece. The excess of its radius over the section's radius
    /// measures how coarse the piece is.
    pub body: ModifiedCylinder,
    /// Lower bound on the piece's distance from the mesh. It is only as tight as the answer needed,
    /// so often well below the distance.
    pub lower: Real,
}
