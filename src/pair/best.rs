//! The nearest triangle so far.

use super::nearest::Nearest;
use super::placed_link::PlacedLink;
use parry3d_f64::math::{Real, Vector};

/// The nearest triangle so far of those at most so far away; of two as near the one with the lower
/// number.
#[derive(Clone, Copy)]
pub(crate) struct Best {
    bound: Real,
    nearest: Option<Nearest>,
    /// Of the triangles that touch, only those with a lower number than this are wanted.
    below: u32,
}

impl Best {
    /// Nothing yet.
    pub(crate) fn within(bound: Real) -> Self {
        Self { bound, nearest: None, below: u32::MAX }
    }

    /// The same, where of the triangles that touch only those with a lower number than `below` are
    /// wanted.
    pub(crate) fn touching_below(self, below: u32) -> Self {
        Self { below, ..self }
    }

    /// What was found so far, of which something at most `bound` away would be an improvement.
    pub(crate) fn resume(bound: Real, nearest: Option<Nearest>) -> Self {
        Self { bound, nearest, below: u32::MAX }
    }

    /// What a triangle must not be farther than.
    pub(crate) fn bound(&self) -> Real {
        self.bound
    }

    pub(crate) fn nearest(&self) -> Option<Nearest> {
        self.nearest
    }

    /// Only triangles with a lower number than this can still be better: nothing is nearer than
    /// what touches.
    #[inline(always)]
    pub(crate) fn triangle_limit(&self) -> u32 {
        if self.bound <= 0.0 { self.below } else { u32::MAX }
    }

    /// Measures a triangle. True if it is the best so far.
    #[inline(never)] // the same code whatever the instruction set
    pub(crate) fn measure(
        &mut self,
        link: &PlacedLink,
        triangle: u32,
        corners: [Vector; 3],
    ) -> bool {
        link.measure_within(self.bound, triangle, corners).is_some_and(|nearest| self.take(nearest))
    }

    /// Whether a triangle so far away would be the best so far.
    #[inline(always)]
    pub(crate) fn is_worse_than(&self, distance: Real, triangle: u32) -> bool {
        distance <= self.bound
            && self.nearest.is_none_or(|mine| {
                distance < mine.distance || (distance <= mine.distance && triangle < mine.triangle)
            })
            && (distance > 0.0 || triangle < self.below)
    }

    /// Keeps a triangle if it is the best so far.
    pub(crate) fn take(&mut self, other: Nearest) -> bool {
        let is_better = self.is_worse_than(other.distance, other.triangle);
        if is_better {
            let below = if other.distance > 0.0 { self.below } else { other.triangle };
            *self = Self { bound: other.distance, nearest: Some(other), below };
        }
        is_better
    }
}
