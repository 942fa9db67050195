//! Answers as data (feature `serde-serialize`).

use super::{Certificate, LinkProximity};
use parry3d_f64::math::{Real, Vector};
use serde::{Deserialize, Serialize};

/// The fields of a [`LinkProximity`], points as `[x, y, z]`.
#[derive(Serialize, Deserialize)]
#[serde(rename = "LinkProximity")]
pub(super) struct Fields {
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

/// The fields of a [`Certificate`].
#[derive(Serialize, Deserialize)]
#[serde(rename = "Certificate")]
pub(super) struct Bounds {
    lower: Real,
    upper: Real,
}

impl From<Certificate> for Bounds {
    fn from(Certificate { lower, upper }: Certificate) -> Self {
        Self { lower, upper }
    }
}

/// No proof gives bounds on a distance that are negative, not finite or the wrong way round.
impl TryFrom<Bounds> for Certificate {
    type Error = String;

    fn try_from(Bounds { lower, upper }: Bounds) -> Result<Self, String> {
        if !(0.0 <= lower && lower <= upper && upper.is_finite()) {
            return Err(format!("{lower} to {upper} bounds no distance"));
        }
        Ok(Self { lower, upper })
    }
}
