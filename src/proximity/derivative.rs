//! How a distance changes with the points that link and triangle are made of.

use super::contact::near;
use super::mesh::Mesh;
use super::nearest_features::{NearPair, NearestFeatures};
use super::{LinkProximity, ProximityError};
use crate::Chain;
use crate::distance::{DoubleDouble, Scalar, Vec3};
use parry3d_f64::math::{Pose, Real, Vector};

/// The derivative of a link's distance from a triangle with respect to each number that the two are made of, in the
/// mesh's frame; of [`depth`](super::Contact::depth), the least translation, where the two overlap.
///
/// By the envelope theorem only the closest points as they are count, and not how they move: with n the normal from
/// triangle to link, the distance grows by n times what the motion does to the link's closest point, less what it does to
/// the triangle's. Let f be the fraction along the axis, w the triangle's closest point as a mean of its corners, L the
/// length, a the axis and l the lever, from the axis to the link's closest point (where they overlap, those that part last):
///
/// | derivative with respect to | beside the link, or beyond a round cap | beyond a flat cap |
/// |---|---|---|
/// | `start` | (1 - f) n | (1 - f) n + (n . a) l / L |
/// | `end` | f n | f n - (n . a) l / L |
/// | `radius` | -1 | -abs(n x a) |
/// | `vertices[i]` | -w_i n | -w_i n |
///
/// The second term for a flat cap is its lever: the cap turns with the axis. Its radius counts at the rim alone, because
/// n is parallel to a where the closest point lies inside of it. Computed with about 32 digits and rounded at the end;
/// where a flat cap or a crossing axis decides the way out, with 16.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Derivative {
    /// With respect to the start of the axis.
    pub start: Vector,
    /// With respect to the end of the axis.
    pub end: Vector,
    /// With respect to the radius.
    pub radius: Real,
    /// With respect to the triangle's corners.
    pub vertices: [Vector; 3],
    /// Whether the distance has a kink here: the same as [`Contact::kink`](super::Contact::kink). These are then the
    /// derivatives for one of the points that are as near.
    pub kink: bool,
}

impl Derivative {
    /// How fast the distance changes if the ends of the link's axis move with these velocities, in the mesh's frame.
    pub fn rate(&self, start: Vector, end: Vector) -> Real {
        self.start.dot(start) + self.end.dot(end)
    }
}

/// How the distance, or depth, of an answer about this mesh changes.
///
/// # Errors
/// Those of [`Proximity::derivative`](super::Proximity::derivative).
pub(super) fn derivative(
    mesh: &Mesh,
    robot: &Chain,
    pose: &Pose,
    answer: &LinkProximity,
) -> Result<Option<Derivative>, ProximityError> {
    let (link, corners) = near(mesh, robot, pose, answer)?;
    let (nearest, exact) = (NearPair::of(&link, corners), NearPair::exactly(&link, corners));
    let found = if nearest.parts.asks_way_out || exact.parts.asks_way_out {
        nearest.parting().derivative(|number| number)
    } else {
        exact.derivative(DoubleDouble::rounded)
    };
    // One place decides what is a kink.
    let kink = NearestFeatures::of(&link, corners).kink;
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
