//! Whether a robot is inside a mesh and keeps a margin.

use super::Side;

/// Whether a robot is inside a wall and keeps a margin to it: both, if [`holds`](Self::holds).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde-serialize", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct InsideAnswer {
    /// The side of the robot's base, the first point of its centreline.
    pub base: Side,
    /// Whether every link is farther than the margin.
    pub clears: bool,
}

impl InsideAnswer {
    /// Returns whether the base is inside and every link keeps the margin. In a closed mesh the
    /// whole robot is then inside.
    pub fn holds(&self) -> bool {
        self.base == Side::Inside && self.clears
    }
}
