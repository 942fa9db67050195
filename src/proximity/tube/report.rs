use super::{Outer, Piece, PlacedTube};
use crate::{Cap, ModifiedCylinder};
use parry3d_f64::math::{Real, Vector};

/// Where a tube is closest to a mesh, between bounds. All in the mesh's frame and unit.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde-serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde-serialize",
    serde(try_from = "super::serialised::Fields", into = "super::serialised::Fields")
)]
#[non_exhaustive]
pub struct Clearance {
    /// The clearance is at least this.
    pub lower: Real,
    /// The clearance is at most this: 0 where the tube touches the mesh.
    pub upper: Real,
    /// The arc length on the centreline at the place that realises `upper`.
    pub arc_length: Real,
    /// The section of constant radius at that place, counted from the base.
    pub section: u32,
    /// The triangle there.
    pub triangle: u32,
    /// A point of the tube that is `upper` away from `on_mesh`, or nearer.
    pub on_robot: Vector,
    /// A point of the triangle; the same as `on_robot` where `upper` is 0.
    pub on_mesh: Vector,
}

/// Whether a tube keeps a margin.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde-serialize", derive(serde::Serialize, serde::Deserialize))]
pub enum Decision {
    /// Its clearance is more than the margin.
    Clear,
    /// Its clearance is at most the margin.
    Touches,
    /// Its clearance is within the resolution of the margin.
    Undecided,
}

/// A piece of a tube as [`BvhSearch::clearance_pieces`](crate::proximity::BvhSearch::clearance_pieces) left it: no finer
/// than the answer needed. All in the mesh's frame and unit.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct TubePiece {
    /// The section of constant radius that it is a piece of, counted from the base.
    pub section: u32,
    /// The arc lengths on the centreline between which it lies.
    pub arc_lengths: [Real; 2],
    /// A convex body that holds it. By how much its radius is larger than the section's tells how coarse it is.
    pub body: ModifiedCylinder,
    /// The piece is at least this far from the mesh. It is no more than the answer needed, so often less than there is.
    pub lower: Real,
}

impl Clearance {
    /// What stands in a batch until its turn comes.
    pub(in crate::proximity) fn unanswered() -> Self {
        let nowhere = Vector::splat(Real::NAN);
        Self {
            lower: Real::NAN,
            upper: Real::NAN,
            arc_length: Real::NAN,
            section: 0,
            triangle: 0,
            on_robot: nowhere,
            on_mesh: nowhere,
        }
    }
}

impl PlacedTube<'_> {
    /// A piece with its finite body, which is at least `lower` away from the mesh.
    pub(crate) fn report(&self, piece: &Piece, outer: &Outer, lower: Real) -> TubePiece {
        let body = &outer.body;
        let caps = body.flat().map(|flat| if flat { Cap::Flat } else { Cap::Round });
        // Flat bodies are longer than rounding, and nothing is farther out than a few times what tube and pose were
        // checked for.
        let body = ModifiedCylinder::unchecked(body.start(), body.end(), body.radius(), caps);
        TubePiece { section: piece.section, arc_lengths: self.arcs(piece), body, lower }
    }
}
