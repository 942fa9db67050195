//! The state that warm-starts the next query about a tube.

use crate::refine::{BoundingBody, MeshUpperBound, PendingPieces, Piece};
use parry3d_f64::math::Real;

/// The place that realised the last answer.
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

/// The state that warm-starts the next query about a tube.
#[derive(Clone, Default)]
pub(crate) struct TubeMemory {
    pub pieces: PendingPieces<Piece, BoundingBody, MeshUpperBound>,
    /// The initial pieces of a query.
    pub begun: Vec<Piece>,
    pub last: Option<LastPlace>,
}

impl TubeMemory {
    pub(crate) fn forget(&mut self) {
        self.last = None;
    }
}
