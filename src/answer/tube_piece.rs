//! A piece of a tube and how near it may be.

use crate::robot::ModifiedCylinder;
use parry3d_f64::math::Real;

/// A piece of a tube as
/// [`BvhSearch::clearance_pieces`](crate::proximity::BvhSearch::clearance_pieces) left it: no finer
/// than the answer needed. All in the mesh's frame and unit.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct TubePiece {
    /// The section of constant radius that it is a piece of, counted from the base.
    pub section: u32,
    /// The arc lengths on the centreline between which it lies.
    pub arc_lengths: [Real; 2],
    /// A convex body that holds it. The more its radius exceeds the section's, the coarser it is.
    pub body: ModifiedCylinder,
    /// The piece is at least this far from the mesh. It is no more than the answer needed, so
    /// often less than there is.
    pub lower: Real,
}
