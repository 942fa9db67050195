//! Comparisons of distances with a radius or a tolerance.
//!
//! A joint exactly one radius from the limit takes a round cap (Algorithm 1), and a vertex exactly
//! one tolerance from a chord may go (`simplify`). Each is one comparison of squares in f64, of
//! numbers brought near one so that none overflows or vanishes. It is right wherever the two
//! lengths differ by more than 2^-50 of the larger (of the chord, for the distance from it), and
//! for ties whose squares are exact, as those of hand-made robots are. Coordinates are rounded
//! before they come here, so that deciding the rest exactly would only move the chance.

use crate::distance::Scalar;
use parry3d_f64::math::{Real, Vector};

/// Whether `p` and `q` are at least `radius` apart.
pub(super) fn at_least_apart(p: Vector, q: Vector, radius: Real) -> bool {
    let apart = p - q;
    let scale = apart.abs().max_element().max(radius).power_of_two_to_unity();
    (apart * scale).length_squared() >= (radius * scale) * (radius * scale)
}

/// A segment that has a length, and a tolerance.
///
/// The points within the tolerance make up two balls around the ends and a cylinder between them.
/// With a tolerance of 0 these are the points for which no cross product is left after rounding.
pub(super) struct ToleranceSegment {
    start: Vector,
    end: Vector,
    scale: Real,
    /// Scaled, as are the others from here.
    vector: Vector,
    tolerance_squared: Real,
    /// What the cross product of a point in the cylinder may square to.
    cross_squared: Real,
}

impl ToleranceSegment {
    pub(super) fn new(start: Vector, end: Vector, tolerance: Real) -> Self {
        let vector = end - start;
        // What lies so far out that its square overflows after this is compared as infinite, and is
        // not within.
        let scale = vector.abs().max_element().max(tolerance).power_of_two_to_unity();
        let vector = vector * scale;
        let tolerance_squared = (tolerance * scale) * (tolerance * scale);
        let cross_squared = tolerance_squared * vector.length_squared();
        Self { start, end, scale, vector, tolerance_squared, cross_squared }
    }

    /// Whether a point is within the tolerance.
    #[inline(always)]
    pub(super) fn has_near(&self, p: Vector) -> bool {
        let from_start = (p - self.start) * self.scale;
        let from_end = (p - self.end) * self.scale;
        // The cylinder first: most points of a stretch are in it.
        (from_start.dot(self.vector) > 0.0
            && from_end.dot(self.vector) < 0.0
            && from_start.cross(self.vector).length_squared() <= self.cross_squared)
            || from_start.length_squared() <= self.tolerance_squared
            || from_end.length_squared() <= self.tolerance_squared
    }
}
