//! Comparisons of distances with a radius or a tolerance.
//!
//! A joint exactly one radius from the limit takes a round cap (Algorithm 1), and a vertex exactly one tolerance from a
//! chord may go (`simplify`). Such ties are common in hand-made robots, but coordinates are rounded before they come
//! here, so that exact arithmetic would only move the chance. Instead a length counts as equal to another from which it
//! differs by less than [`TIE`], relatively: far more than the rounding of what is computed here, and of coordinates near
//! the origin, and far less than anybody can build.

use crate::distance::Scalar;
use parry3d_f64::math::{Real, Vector};

/// Squared lengths that differ by less than this, relatively, count as equal: lengths by half of it, 2^-46.
const TIE: Real = 128.0 * Real::EPSILON;

/// Whether `p` and `q` are at least `radius` apart, or as good as that.
pub(super) fn at_least_apart(p: Vector, q: Vector, radius: Real) -> bool {
    let apart = p - q;
    let scale = apart.abs().max_element().max(radius).power_of_two_to_unity();
    let radius = radius * scale;
    (apart * scale).length_squared() >= radius * radius * (1.0 - TIE)
}

/// Whether `p` is within `tolerance`, or as good as that, of the segment from `a` to `b`, which has a length.
///
/// The points that are make up two balls around the ends and a cylinder between them. With a tolerance of 0 these are
/// the points for which no cross product is left after rounding.
pub(super) fn is_within(p: Vector, a: Vector, b: Vector, tolerance: Real) -> bool {
    let (from_a, from_b, chord) = (p - a, p - b, b - a);
    let scale = from_a.abs().max(chord.abs()).max_element().max(tolerance).power_of_two_to_unity();
    let (from_a, from_b, chord) = (from_a * scale, from_b * scale, chord * scale);
    let limit = (tolerance * scale) * (tolerance * scale) * (1.0 + TIE);
    from_a.length_squared() <= limit
        || from_b.length_squared() <= limit
        || (from_a.dot(chord) > 0.0
            && from_b.dot(chord) < 0.0
            && from_a.cross(chord).length_squared() <= limit * chord.length_squared())
}
