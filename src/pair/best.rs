//! The closest triangle so far.

use super::nearest::Nearest;
use super::placed_link::PlacedLink;
use parry3d_f64::math::{Real, Vector};

/// The closest triangle so far among those within a bound. Ties go to the lower triangle number.
#[derive(Clone, Copy)]
pub(crate) struct Best {
    bound: Real,
    nearest: Option<Nearest>,
    /// Among triangles at distance 0, only those with a lower number are candidates.
    below: u32,
}

impl Best {
    /// Returns an empty best with this bound.
    pub(crate) fn within(bound: Real) -> Self {
        Self { bound, nearest: None, below: u32::MAX }
    }

    /// Restricts triangles at distance 0 to those with a lower number than `below`.
    pub(crate) fn touching_below(self, below: u32) -> Self {
        Self { below, ..self }
    }

    /// Returns an earlier best, to be improved by triangles at most `bound` away.
    pub(crate) fn resume(bound: Real, nearest: Option<Nearest>) -> Self {
        Self { bound, nearest, below: u32::MAX }
    }

    /// The upper bound: only triangles at most this far away are candidates.
    pub(crate) fn bound(&self) -> Real {
        self.bound
    }

    pub(crate) fn nearest(&self) -> Option<Nearest> {
        self.nearest
    }

    /// Returns a limit on the number of a triangle that can still improve the best: at distance 0
    /// only a lower number can.
    #[inline(always)]
    pub(crate) fn triangle_limit(&self) -> u32 {
        if self.bound <= 0.0 { self.below } else { u32::MAX }
    }

    /// Measures a triangle. Returns whether it is the best so far.
    #[inline(never)] // the same code whatever the instruction set
    pub(crate) fn measure(
        &mut self,
        link: &PlacedLink,
        triangle: u32,
        corners: [Vector; 3],
    ) -> bool {
        link.measure_within(self.bound, triangle, corners).is_some_and(|nearest| self.take(nearest))
    }

    /// Returns whether a triangle at this distance improves the best.
    #[inline(always)]
    pub(crate) fn is_worse_than(&self, distance: Real, triangle: u32) -> bool {
        distance <= self.bound
            && self.nearest.is_none_or(|mine| {
                distance < mine.distance || (distance <= mine.distance && triangle < mine.triangle)
            })
            && (distance > 0.0 || triangle < self.below)
    }

    /// Keeps a triangle if it improves the best. Returns whether it does.
    pub(crate) fn take(&mut self, other: Nearest) -> bool {
        let is_better = self.is_worse_than(other.distance, other.triangle);
        if is_better {
            let below = if other.distance > 0.0 { self.below } else { other.triangle };
            *self = Self { bound: other.distance, nearest: Some(other), below };
        }
        is_better
    }
}
