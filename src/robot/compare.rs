//! Comparisons of distances with a radius or a tolerance.
//!
//! A joint exactly one radius from the limit takes a round cap (Algorithm 1), and a vertex exactly one tolerance from a
//! chord may go (`simplify`). Each is one comparison of squares in f64, of numbers brought near one so that none
//! overflows or vanishes. It is right wherever the two lengths differ by more than 2^-50 of the larger (of the chord, for
//! the distance from it), and for ties whose squares are exact, as those of hand-made robots are. Coordinates are rounded
//! before they come here, so that deciding the rest exactly would only move the chance.

use crate::distance::Scalar;
use parry3d_f64::math::{Real, Vector};

/// Whether `p` and `q` are at least `radius` apart.
pub(super) fn at_least_apart(p: Vector, q: Vector, radius: Real) -> bool {
    let apart = p - q;
    let scale = apart.abs().max_element().max(radius).power_of_two_to_unity();
    (apart * scale).length_squared() >= (radius * scale) * (radius * scale)
}

/// Whether `p` is within `tolerance` of the segment from `a` to `b`, which has a length.
///
/// The points that are make up two balls around the ends and a cylinder between them. With a tolerance of 0 these are
/// the points for which no cross product is left after rounding.
pub(super) fn is_within(p: Vector, a: Vector, b: Vector, tolerance: Real) -> bool {
    let (from_a, from_b, chord) = (p - a, p - b, b - a);
    let scale = from_a.abs().max(chord.abs()).max_element().max(tolerance).power_of_two_to_unity();
    let (from_a, from_b, chord) = (from_a * scale, from_b * scale, chord * scale);
    let limit = (tolerance * scale) * (tolerance * scale);
    from_a.length_squared() <= limit
        || from_b.length_squared() <= limit
        || (from_a.dot(chord) > 0.0
            && from_b.dot(chord) < 0.0
            && from_a.cross(chord).length_squared() <= limit * chord.length_squared())
}
