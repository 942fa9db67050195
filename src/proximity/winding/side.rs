use super::SolidAngle;
use parry3d_f64::math::Real;
use std::f64::consts::PI;

/// On which side of a mesh a point is.
///
/// The mesh's winding number w decides, the sum of the solid angles of its triangles over 4 pi. Around a closed mesh it
/// is a whole number, and not 0 inside. Triangles may face outward or inward, as long as all do the same.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde-serialize", derive(serde::Serialize, serde::Deserialize))]
pub enum Side {
    /// |w| > 3/4 for certain.
    Inside,
    /// |w| < 1/4 for certain.
    Outside,
    /// Neither: the point lies on a triangle, as far as rounding can tell, or a hole of the mesh covers a quarter or more
    /// of what it sees.
    Undecided,
}

/// The part of the view, out of 4 pi, that a hole may cover at most.
const HOLE: Real = PI;

impl Side {
    /// The side that a sum of solid angles tells; none where a smaller error might.
    pub(in crate::proximity) fn of(sum: SolidAngle) -> Option<Self> {
        // What rounding took from the sum of the errors.
        let error = sum.error * (1.0 + 1e-6);
        let (least, most) = (sum.value.abs() - error, sum.value.abs() + error);
        if least > 4.0 * PI - HOLE {
            Some(Self::Inside)
        } else if most < HOLE {
            Some(Self::Outside)
        } else if least > HOLE && most < 4.0 * PI - HOLE {
            Some(Self::Undecided)
        } else {
            None
        }
    }
}

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
    /// Whether the base is inside and every link keeps the margin: then, in a closed mesh, all of the robot is inside.
    pub fn holds(&self) -> bool {
        self.base == Side::Inside && self.clears
    }
}
