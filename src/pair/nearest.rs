//! What is found of a link and a triangle.

use parry3d_f64::math::{Real, Vector};

/// The triangle nearest to a link, in the mesh's frame and unit.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Nearest {
    pub triangle: u32,
    pub distance: Real,
    pub on_robot: Vector,
    pub on_mesh: Vector,
}
