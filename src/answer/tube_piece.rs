//! A piece of a tube, with a lower bound on its distance.

use crate::robot::ModifiedCylinder;
use parry3d_f64::math::Real;

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
