//! Clearances as data (feature `serde-serialize`).

use super::Clearance;
use parry3d_f64::math::{Real, Vector};
use serde::{Deserialize, Serialize};

/// The fields of a [`Clearance`], points as `[x, y, z]`.
#[derive(Serialize, Deserialize)]
#[serde(rename = "Clearance")]
pub(super) struct Fields {
    lower: Real,
    upper: Real,
    arc_length: Real,
    section: u32,
    triangle: u32,
    on_robot: [Real; 3],
    on_mesh: [Real; 3],
}

impl From<Clearance> for Fields {
    fn from(found: Clearance) -> Self {
        let Clearance { lower, upper, arc_length, section, triangle, on_robot, on_mesh } = found;
        let (on_robot, on_mesh) = (on_robot.to_array(), on_mesh.to_array());
        Self { lower, upper, arc_length, section, triangle, on_robot, on_mesh }
    }
}

/// No engine gives bounds that are negative, in the wrong order or not finite, nor such a place.
impl TryFrom<Fields> for Clearance {
    type Error = String;

    fn try_from(fields: Fields) -> Result<Self, String> {
        let Fields { lower, upper, arc_length, section, triangle, on_robot, on_mesh } = fields;
        if !(0.0 <= lower && lower <= upper && upper.is_finite()) {
            return Err(format!(
                "the bounds are {lower} and {upper}; they must be finite, at least 0, and in order"
            ));
        }
        let (on_robot, on_mesh) = (Vector::from_array(on_robot), Vector::from_array(on_mesh));
        check_place(arc_length, on_robot, on_mesh)?;
        Ok(Self { lower, upper, arc_length, section, triangle, on_robot, on_mesh })
    }
}

/// Every answer names a finite place.
pub(in crate::proximity) fn check_place(
    arc_length: Real,
    on_robot: Vector,
    on_mesh: Vector,
) -> Result<(), String> {
    if arc_length.is_finite() && on_robot.is_finite() && on_mesh.is_finite() {
        Ok(())
    } else {
        Err(format!("a place is not finite: {arc_length}, {on_robot} or {on_mesh}"))
    }
}
