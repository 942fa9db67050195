//! What is found of a link and a triangle.

use crate::answer::LinkProximity;
use parry3d_f64::math::{Real, Vector};

/// The triangle nearest to a link, in the mesh's frame and unit.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Nearest {
    pub triangle: u32,
    pub distance: Real,
    pub on_robot: Vector,
    pub on_mesh: Vector,
}

impl Nearest {
    /// The answer about a link.
    pub(crate) fn report(&self, link: usize) -> LinkProximity {
        let Self { triangle, distance, on_robot, on_mesh } = *self;
        LinkProximity { link: link as u32, triangle, distance, on_robot, on_mesh }
    }
}
