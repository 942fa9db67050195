//! The result of a measurement of a link and a triangle.

use parry3d_f64::math::{Real, Vector};

/// A triangle's distance from a link and the closest points, in the mesh's frame and unit.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Nearest {
    pub triangle: u32,
    pub distance: Real,
    pub on_robot: Vector,
    pub on_mesh: Vector,
}

impl Nearest {
    /// Returns the result, with one common point if the two touch: rounding may have separated the
    /// points.
    #[inline(always)]
    pub(crate) fn new(
        triangle: u32,
        distance: Real,
        on_mesh: Vector,
        on_robot: impl FnOnce() -> Vector,
    ) -> Self {
        let on_robot = if distance > 0.0 { on_robot() } else { on_mesh };
        Self { triangle, distance, on_robot, on_mesh }
    }
}
