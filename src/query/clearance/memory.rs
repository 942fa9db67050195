//! What a query about a tube leaves for the next.

use crate::pieces::{BoundingBody, MeshUpperBound, PendingPieces, Piece};
use parry3d_f64::math::Real;

/// Where a query ended, for the next to begin.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LastPlace {
    pub triangle: u32,
    pub section: u32,
    pub arc: Real,
}

impl From<&MeshUpperBound> for LastPlace {
    fn from(found: &MeshUpperBound) -> Self {
        let witness = found.witness;
        Self { triangle: witness.triangle, section: found.section, arc: witness.arc_length }
    }
}

/// What a query about a tube leaves for the next.
#[derive(Clone, Default)]
pub(crate) struct TubeMemory {
    pub pieces: PendingPieces<Piece, BoundingBody, MeshUpperBound>,
    /// The pieces that a query begins with.
    pub begun: Vec<Piece>,
    pub last: Option<LastPlace>,
}

impl TubeMemory {
    pub(crate) fn forget(&mut self) {
        self.last = None;
    }
}
