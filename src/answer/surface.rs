//! What a mesh is as a surface: its openings, and the edges that make its sides doubtful.

use parry3d_f64::math::{Real, Vector};

/// What a mesh is as a surface.
///
/// Corners at the same place are one corner, and an edge is the pair of its ends. Triangles with
/// two corners at the same place have no share in an edge. A closed surface whose triangles all
/// face the same way has no openings, and no edges of any of these kinds: see
/// [`is_sound`](Self::is_sound).
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct SurfaceReport {
    /// The openings, the widest first.
    pub openings: Vec<Opening>,
    /// The number of edges of more than two triangles.
    pub nonmanifold_edges: usize,
    /// The number of edges whose two triangles face opposite ways.
    pub misoriented_edges: usize,
    /// The number of edges of two or more triangles where not as many triangles face one way as the
    /// other.
    pub unbalanced_edges: usize,
}

/// A group of boundary edges, connected by their corners. A boundary edge belongs to one triangle.
/// Corners on the side of a triangle divide it into edges, so that T-vertices are no opening.
///
/// Most often it is one loop. Loops that share a corner are one opening. Edges that lie on one line
/// within the rounding of their coordinates are a seam, not an opening.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Opening {
    /// The number of its edges.
    pub edges: usize,
    /// How wide it is: the extent of its corners across the line between two that are far apart.
    /// For a circle this is the diameter, for a slit the gap.
    pub width: Real,
    /// The mean of the ends of its edges.
    pub centre: Vector,
}

impl SurfaceReport {
    /// Returns whether the surface is closed and all triangles face the same way. Inside and
    /// outside are then defined everywhere.
    pub fn is_sound(&self) -> bool {
        self.openings.is_empty() && self.nonmanifold_edges == 0 && self.misoriented_edges == 0
    }

    /// Returns whether the surface bounds a volume: its winding number is an integer everywhere off
    /// the surface. It has no openings and no unbalanced edges. Two boxes that share an edge bound
    /// a volume.
    pub fn bounds_volume(&self) -> bool {
        self.openings.is_empty() && self.unbalanced_edges == 0
    }

    /// Returns a line for each reason why inside and outside may be doubtful, without a full stop.
    /// Empty if the surface [is sound](Self::is_sound).
    pub fn doubts(&self) -> Vec<String> {
        let opening = self.openings.first().map(|Opening { width, centre, .. }| {
            let [x, y, z] = centre.to_array().map(short);
            let count = match self.openings.len() {
                1 => "one opening".into(),
                count => format!("{count} openings, the widest"),
            };
            format!(
                "the mesh is open: {count} {} wide at ({x}, {y}, {z}); a robot may leave there \
                 without touching it",
                short(*width)
            )
        });
        let edges = |count: usize, what: &str, remedy: &str| {
            let edges = if count == 1 { "edge" } else { "edges" };
            (count > 0).then(|| format!("the mesh has {count} {edges} {what}; {remedy}"))
        };
        let nonmanifold = edges(
            self.nonmanifold_edges,
            "of more than two triangles",
            "inside and outside are right only if each of its parts is closed",
        );
        let misoriented = edges(
            self.misoriented_edges,
            "whose triangles face opposite ways",
            "inside and outside may be reversed: make all triangles face the same way",
        );
        opening.into_iter().chain(nonmanifold).chain(misoriented).collect()
    }
}

/// Returns a number rounded to four significant digits, with an exponent if it is very large or
/// very small.
fn short(number: Real) -> String {
    let rounded: Real = format!("{number:.3e}").parse().unwrap_or(number);
    let is_plain = rounded == 0.0 || (1e-6..1e15).contains(&rounded.abs());
    if is_plain { rounded.to_string() } else { format!("{rounded:e}") }
}
