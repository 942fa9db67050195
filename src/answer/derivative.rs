//! The derivative of a distance by the numbers that define link and triangle.

use parry3d_f64::math::{Real, Vector};

/// The derivative of a link's distance from a triangle by the axis ends, the radius and the
/// corners, in the mesh's frame.
///
/// If the two overlap, it is the derivative of [`depth`](super::Contact::depth), minus the least
/// translation.
///
/// # Definitions
/// - n: the normal, from triangle to link.
/// - f: the fraction along the axis at the link's closest point.
/// - w: the barycentric coordinates of the triangle's closest point.
/// - L, a: the length of the axis, and its unit direction.
/// - l: the lever, from the axis to the link's closest point.
///
/// If the two overlap, the points that separate last replace the closest points.
///
/// # Formulas
/// By the envelope theorem the closest points count as they are, not how they move. So the distance
/// grows by n times the motion of the link's closest point, minus n times the motion of the
/// triangle's closest point:
///
/// | derivative by | beside the link, or beyond a round cap | beyond a flat cap |
/// |---|---|---|
/// | `start` | (1 - f) n | (1 - f) n + (n . a) l / L |
/// | `end` | f n | f n - (n . a) l / L |
/// | `radius` | -1 | -abs(n x a) |
/// | `vertices[i]` | -w_i n | -w_i n |
///
/// The second term for a flat cap is its lever: the cap turns with the axis. The radius counts at
/// the rim alone, because n is parallel to a if the closest point lies inside the cap.
///
/// # Rounding
/// The derivative is computed with about 32 digits and rounded at the end. If a flat cap or a
/// crossing axis decides the way out, it is computed with 16 digits.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Derivative {
    /// By the start of the axis.
    pub start: Vector,
    /// By the end of the axis.
    pub end: Vector,
    /// By the radius.
    pub radius: Real,
    /// By the triangle's corners.
    pub vertices: [Vector; 3],
    /// Whether the distance has a kink here, as [`Contact::kink`](super::Contact::kink). The fields
    /// are then the derivatives for one of the equally near points.
    pub kink: bool,
}

impl Derivative {
    /// The rate of change of the distance if the ends of the link's axis move with these
    /// velocities, in the mesh's frame.
    pub fn rate(&self, start: Vector, end: Vector) -> Real {
        self.start.dot(start) + self.end.dot(end)
    }
}
