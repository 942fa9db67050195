//! Where a piece of the centreline goes between two times.

use parry3d_f64::math::{Real, Vector};

/// Where a piece of the centreline goes from one time to another, as nearly as its motion knows.
///
/// Straight and evenly, but for `off`: at the share q of the time, a point is within `off` of where
/// it was plus q times its way, and also within `off` of where it will be less 1 - q times its way.
/// The way of a point between the two ends of the piece is between theirs, in proportion to its
/// share of the section's length.
///
/// If a point's acceleration is at most a, it leaves the straight and even way between its places
/// at two times, T apart, by at most a T^2 / 8. So where a motion knows the places, that is `off`,
/// and what ways in between differ by from those of the ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Course {
    /// The ways of the two ends of the piece, in the mesh's frame.
    pub ways: [Vector; 2],
    /// How far any point of the piece may be from where its way leads, in units of length.
    pub off: Real,
}

impl Course {
    /// That of a piece whose ends are here at first, and there at last.
    pub(super) fn between(here: [Vector; 2], there: [Vector; 2], off: Real) -> Self {
        Self { ways: [there[0] - here[0], there[1] - here[1]], off }
    }

    /// The way at a share of the piece, from 0 to 1.
    pub(super) fn way(&self, share: Real) -> Vector {
        self.ways[0] + (self.ways[1] - self.ways[0]) * share
    }
}
