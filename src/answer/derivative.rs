//! How a distance changes with the points that link and triangle are made of.

use parry3d_f64::math::{Real, Vector};

/// The derivative of a link's distance from a triangle with respect to each number that the two are
/// made of, in the mesh's frame; of [`depth`](super::Contact::depth), the least translation, where
/// the two overlap.
///
/// By the envelope theorem only the closest points as they are count, and not how they move: with n
/// the normal from triangle to link, the distance grows by n times what the motion does to the
/// link's closest point, less what it does to the triangle's. Let f be the fraction along the axis,
/// w the triangle's closest point as a mean of its corners, L the length, a the axis and l the
/// lever, from the axis to the link's closest point (where they overlap, those that part last):
///
/// | derivative with respect to | beside the link, or beyond a round cap | beyond a flat cap |
/// |---|---|---|
/// | `start` | (1 - f) n | (1 - f) n + (n . a) l / L |
/// | `end` | f n | f n - (n . a) l / L |
/// | `radius` | -1 | -abs(n x a) |
/// | `vertices[i]` | -w_i n | -w_i n |
///
/// The second term for a flat cap is its lever: the cap turns with the axis. Its radius counts at
/// the rim alone, because n is parallel to a where the closest point lies inside of it. Computed
/// with about 32 digits and rounded at the end; where a flat cap or a crossing axis decides the way
/// out, with 16.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Derivative {
    /// With respect to the start of the axis.
    pub start: Vector,
    /// With respect to the end of the axis.
    pub end: Vector,
    /// With respect to the radius.
    pub radius: Real,
    /// With respect to the triangle's corners.
    pub vertices: [Vector; 3],
    /// Whether the distance has a kink here: the same as [`Contact::kink`](super::Contact::kink).
    /// These are then the derivatives for one of the points that are as near.
    pub kink: bool,
}

impl Derivative {
    /// How fast the distance changes if the ends of the link's axis move with these velocities, in
    /// the mesh's frame.
    pub fn rate(&self, start: Vector, end: Vector) -> Real {
        self.start.dot(start) + self.end.dot(end)
    }
}
