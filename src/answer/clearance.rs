//! An answer about a tube.

use parry3d_f64::math::{Real, Vector};

/// Where a tube is closest to a mesh, between bounds. All in the mesh's frame and unit.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde-serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde-serialize", serde(try_from = "serialised::Fields", into = "serialised::Fields"))]
#[non_exhaustive]
pub struct Clearance {
    /// The clearance is at least this.
    pub lower: Real,
    /// The clearance is at most this: 0 where the tube touches the mesh.
    pub upper: Real,
    /// The arc length on the centreline at the place that realises `upper`.
    pub arc_length: Real,
    /// The section of constant radius at that place, counted from the base.
    pub section: u32,
    /// The triangle there.
    pub triangle: u32,
    /// A point of the tube that is `upper` away from `on_mesh`, or nearer.
    pub on_robot: Vector,
    /// A point of the triangle; the same as `on_robot` where `upper` is 0.
    pub on_mesh: Vector,
}

impl Clearance {
    /// What stands in a batch until its turn comes.
    pub(crate) fn unanswered() -> Self {
        let nowhere = Vector::splat(Real::NAN);
        Self {
            lower: Real::NAN,
            upper: Real::NAN,
            arc_length: Real::NAN,
            section: 0,
            triangle: 0,
            on_robot: nowhere,
            on_mesh: nowhere,
        }
    }
}

#[cfg(feature = "serde-serialize")]
mod serialised {
    use super::Clearance;
    use crate::answer::place::check_place;
    use parry3d_f64::math::{Real, Vector};
    use serde::{Deserialize, Serialize};

    /// The fields of a [`Clearance`], points as `[x, y, z]`.
    #[derive(Serialize, Deserialize)]
    #[serde(rename = "Clearance")]
    pub(crate) struct Fields {
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
}
