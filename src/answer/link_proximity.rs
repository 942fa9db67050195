//! An answer about one link.

use parry3d_f64::math::{Real, Vector};

/// Where one link of a robot is closest to a mesh, in the mesh's frame and unit.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde-serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde-serialize", serde(try_from = "serialised::Fields", into = "serialised::Fields"))]
#[non_exhaustive]
pub struct LinkProximity {
    /// The link's position in [`Chain::links`](crate::Chain::links).
    pub link: u32,
    /// The triangle's position in the mesh.
    pub triangle: u32,
    /// The distance between link and triangle, 0 where they touch or overlap.
    pub distance: Real,
    /// The link's closest point.
    pub on_robot: Vector,
    /// The triangle's closest point; the same as `on_robot` where the distance is 0.
    pub on_mesh: Vector,
}

impl LinkProximity {
    /// What stands in a batch until its turn comes.
    pub(crate) fn unanswered() -> Self {
        let nowhere = Vector::splat(Real::NAN);
        Self { link: 0, triangle: 0, distance: Real::NAN, on_robot: nowhere, on_mesh: nowhere }
    }
}

#[cfg(feature = "serde-serialize")]
mod serialised {
    use super::LinkProximity;
    use parry3d_f64::math::{Real, Vector};
    use serde::{Deserialize, Serialize};

    /// The fields of a [`LinkProximity`], points as `[x, y, z]`.
    #[derive(Serialize, Deserialize)]
    #[serde(rename = "LinkProximity")]
    pub(crate) struct Fields {
        link: u32,
        triangle: u32,
        distance: Real,
        on_robot: [Real; 3],
        on_mesh: [Real; 3],
    }

    impl From<LinkProximity> for Fields {
        fn from(found: LinkProximity) -> Self {
            let LinkProximity { link, triangle, distance, on_robot, on_mesh } = found;
            Self { link, triangle, distance, on_robot: on_robot.to_array(), on_mesh: on_mesh.to_array() }
        }
    }

    /// No engine gives a distance that is negative or not finite, nor such a point.
    impl TryFrom<Fields> for LinkProximity {
        type Error = String;

        fn try_from(fields: Fields) -> Result<Self, String> {
            let Fields { link, triangle, distance, on_robot, on_mesh } = fields;
            if !(distance.is_finite() && distance >= 0.0) {
                return Err(format!("the distance is {distance}; it must be finite and at least 0"));
            }
            let (on_robot, on_mesh) = (Vector::from_array(on_robot), Vector::from_array(on_mesh));
            if !(on_robot.is_finite() && on_mesh.is_finite()) {
                return Err(format!("a closest point is not finite: {on_robot} or {on_mesh}"));
            }
            Ok(Self { link, triangle, distance, on_robot, on_mesh })
        }
    }
}
