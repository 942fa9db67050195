//! Comparisons of distances with a radius or a tolerance.
//!
//! Two callers ask for ties: a joint exactly one radius from the limit takes a round cap
//! (Algorithm 1), and a vertex exactly one tolerance from a chord may be removed (`simplify`).
//!
//! # Rounding
//! Each test is one comparison of squares in f64. A power of two scales the numbers near one, so
//! that no square overflows or underflows. The result is right in two cases:
//!
//! 1. The two lengths differ by more than 2^-50 of the larger one (for a distance from a chord: of
//!    the chord's length).
//! 2. The lengths are equal and their squares are exact, as in hand-made robots.
//!
//! Coordinates are rounded before they arrive here. Exact arithmetic would therefore only move the
//! cases that rounding decides.

use crate::distance::Scalar;
use parry3d_f64::math::{Real, Vector};

/// Returns whether `|p - q| >= radius`.
pub(super) fn at_least_apart(p: Vector, q: Vector, radius: Real) -> bool {
    let apart = p - q;
    let scale = apart.abs().max_element().max(radius).power_of_two_to_unity();
    (apart * scale).length_squared() >= (radius * scale) * (radius * scale)
}

/// A segment of positive length and a tolerance.
///
/// The points within the tolerance form two balls around the ends and a cylinder between them. With
/// tolerance 0 the cylinder holds the points whose cross product rounds to zero.
pub(super) struct ToleranceSegment {
    start: Vector,
    end: Vector,
    scale: Real,
    /// The axis from start to end; this field and those below are scaled.
    vector: Vector,
    tolerance_squared: Real,
    /// Upper bound on the squared cross product of a point in the cylinder.
    cross_squared: Real,
}

impl ToleranceSegment {
    pub(super) fn new(start: Vector, end: Vector, tolerance: Real) -> Self {
        let vector = end - start;
        // If the square of a point's distance overflows after scaling, it compares as infinite and
        // the point counts as outside.
        let scale = vector.abs().max_element().max(tolerance).power_of_two_to_unity();
        let vector = vector * scale;
        let tolerance_squared = (tolerance * scale) * (tolerance * scale);
        let cross_squared = tolerance_squared * vector.length_squared();
        Self { start, end, scale, vector, tolerance_squared, cross_squared }
    }

    /// Returns whether `p` is within the tolerance of the segment.
    #[inline(always)]
    pub(super) fn has_near(&self, p: Vector) -> bool {
        let from_start = (p - self.start) * self.scale;
        let from_end = (p - self.end) * self.scale;
        // The cylinder first: it holds most points of a run.
        (from_start.dot(self.vector) > 0.0
            && from_end.dot(self.vector) < 0.0
            && from_start.cross(self.vector).length_squared() <= self.cross_squared)
            || from_start.length_squared() <= self.tolerance_squared
            || from_end.length_squared() <= self.tolerance_squared
    }
}
