//! The place of an answer about robot and mesh.

use parry3d_f64::math::{Real, Vector};

/// Two points that realise a distance, and their places on robot and mesh, in the mesh's frame and
/// unit.
///
/// Every answer that names a place of the mesh has one, in its field `witness`.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde-serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde-serialize",
    serde(try_from = "witness_fields::Fields", into = "witness_fields::Fields")
)]
#[non_exhaustive]
pub struct Witness {
    /// The robot's point.
    pub on_robot: Vector,
    /// The triangle's point; equal to `on_robot` if they touch or overlap.
    pub on_mesh: Vector,
    /// The triangle's index in the mesh.
    pub triangle: u32,
    /// The place along the robot's centreline, from the base: the point nearest to `on_mesh` on the
    /// axis of the link, or of the tube's section of constant radius, to which `on_robot` belongs.
    /// Beside a step the axis of the next section may be nearer.
    pub arc_length: Real,
    /// The segment of the robot's input at this place, between the points `segment` and `segment +
    /// 1`. For a tube without points, the section of constant radius.
    pub segment: u32,
}

impl Witness {
    /// Placeholder in a batch.
    pub(crate) fn placeholder() -> Self {
        let nowhere = Vector::splat(Real::NAN);
        Self { on_robot: nowhere, on_mesh: nowhere, triangle: 0, arc_length: Real::NAN, segment: 0 }
    }
}

#[cfg(feature = "serde-serialize")]
mod witness_fields {
    use super::Witness;
    use parry3d_f64::math::{Real, Vector};
    use serde::{Deserialize, Serialize};

    /// The fields of a [`Witness`], points as `[x, y, z]`.
    #[derive(Serialize, Deserialize)]
    #[serde(rename = "Witness")]
    pub(crate) struct Fields {
        on_robot: [Real; 3],
        on_mesh: [Real; 3],
        triangle: u32,
        arc_length: Real,
        segment: u32,
    }

    impl From<Witness> for Fields {
        fn from(found: Witness) -> Self {
            let Witness { on_robot, on_mesh, triangle, arc_length, segment } = found;
            let (on_robot, on_mesh) = (on_robot.to_array(), on_mesh.to_array());
            Self { on_robot, on_mesh, triangle, arc_length, segment }
        }
    }

    /// Rejects places that are not finite: no query returns them.
    impl TryFrom<Fields> for Witness {
        type Error = String;

        fn try_from(fields: Fields) -> Result<Self, String> {
            let Fields { on_robot, on_mesh, triangle, arc_length, segment } = fields;
            let (on_robot, on_mesh) = (Vector::from_array(on_robot), Vector::from_array(on_mesh));
            if arc_length.is_finite() && on_robot.is_finite() && on_mesh.is_finite() {
                Ok(Self { on_robot, on_mesh, triangle, arc_length, segment })
            } else {
                Err(format!("a place is not finite: {arc_length}, {on_robot} or {on_mesh}"))
            }
        }
    }
}
