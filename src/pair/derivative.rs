//! The derivative of a distance with respect to the points of link and triangle. [`Derivative`]
//! states the formulas.

use super::contact::near;
use super::nearest_features::NearPair;
use crate::answer::{Derivative, LinkProximity, ProximityError};
use crate::distance::{DoubleDouble, Scalar, Vec3};
use crate::mesh::Mesh;
use crate::robot::Chain;
use parry3d_f64::math::{Pose, Real, Vector};

/// Returns the derivative of the distance, or of the depth, of an answer about this mesh.
///
/// # Errors
/// As [`Proximity::derivative`](crate::proximity::Proximity::derivative).
pub(crate) fn derivative(
    mesh: &Mesh,
    robot: &Chain,
    pose: &Pose,
    answer: &LinkProximity,
) -> Result<Option<Derivative>, ProximityError> {
    let (link, corners, measured) = near(mesh, robot, pose, answer)?;
    let way_out = || measured.pair.parting().derivative(|number| number);
    if measured.pair.parts.asks_way_out {
        return Ok(way_out());
    }
    let exact = NearPair::exactly(&link, corners);
    let found =
        if exact.parts.asks_way_out { way_out() } else { exact.derivative(DoubleDouble::rounded) };
    // The same decision on kinks as in the features.
    let kink = measured.features(|| exact).kink;
    Ok(found.map(|found| Derivative { kink, ..found }))
}

impl<T: Scalar<Mask = bool> + PartialEq> NearPair<T> {
    fn derivative(&self, round: impl Fn(T) -> Real) -> Option<Derivative> {
        let (link, parts) = (&self.link, &self.parts);
        let one = link.radius.one();
        if !parts.has_normal {
            return None;
        }
        let rounded = |v: Vec3<T>| Vector::new(round(v.x), round(v.y), round(v.z));
        let normal = parts.normal;
        let (mut start, mut end) = (normal * (one - parts.fraction), normal * parts.fraction);
        let mut radius = -one;
        if parts.at_flat_cap {
            let turn = parts.lever * normal.dot(link.axis).over(link.end.norm());
            (start, end) = (start + turn, end - turn);
            radius = -normal.cross(link.axis).norm();
        }
        Some(Derivative {
            start: rounded(start),
            end: rounded(end),
            radius: round(radius),
            vertices: self.weights().map(|weight| rounded(-normal * weight)),
            kink: self.kink,
        })
    }
}
