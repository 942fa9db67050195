//! What a search tells of a triangle that may be within a margin of a link, before it is measured.

use super::shared_parts::PART_WITHOUT;
use parry3d_f64::math::Real;

/// A triangle that may be within a margin of a link.
#[derive(Clone, Copy)]
pub(super) struct NearTriangle {
    pub triangle: u32,
    /// Another triangle whose `upper` is below this is certainly nearer, by more than the rounding of both distances.
    pub lower: Real,
    pub upper: Real,
    /// One bit for each corner that certainly has no share in the nearest point.
    pub away: u8,
    /// Whether all edges are certainly farther than the nearest point, by more than the rounding of both distances.
    pub is_inside: bool,
}

impl NearTriangle {
    /// A triangle of which nothing is known.
    pub(super) fn unknown(triangle: u32) -> Self {
        let everywhere = Real::INFINITY;
        Self { triangle, lower: -everywhere, upper: everywhere, away: 0, is_inside: false }
    }

    /// The corner or edge on which the nearest point certainly lies, if there is one.
    pub(super) fn foot(&self) -> Option<usize> {
        PART_WITHOUT[self.away as usize].map(usize::from)
    }
}
