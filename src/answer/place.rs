//! Where an answer is.

use parry3d_f64::math::{Real, Vector};

/// Every answer names a finite place.
pub(crate) fn check_place(arc_length: Real, on_robot: Vector, on_mesh: Vector) -> Result<(), String> {
    if arc_length.is_finite() && on_robot.is_finite() && on_mesh.is_finite() {
        Ok(())
    } else {
        Err(format!("a place is not finite: {arc_length}, {on_robot} or {on_mesh}"))
    }
}
