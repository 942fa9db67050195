//! Whether a robot is inside a mesh and keeps away from it.

use super::Side;

/// Whether a robot is inside a wall and keeps a margin from it: both, if [`holds`](Self::holds).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde-serialize", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct InsideAnswer {
    /// Where the robot's base is, the first point of its centreline.
    pub base: Side,
    /// Whether every link keeps more than the margin.
    pub clears: bool,
}

impl InsideAnswer {
    /// Whether the base is inside and every link keeps the margin: then, in a closed mesh, all of
    /// the robot is inside.
    pub fn holds(&self) -> bool {
        self.base == Side::Inside && self.clears
    }
}
