//! Candidate normals for a plane between a group of triangles and a run of bodies. A candidate may
//! be wrong: the plane counts only after it is shown to separate both.

use super::body::ProofBody;
use super::groups::Group;
use crate::answer::LinkProximity;
use crate::mesh::Mesh;
use crate::pair::{PlacedLink, PlacedPair, add_contacts};
use fearless_simd::Level;
use parry3d_f64::math::{Pose, Real, Vector};
use parry3d_f64::query::gjk::{CsoPoint, GJKResult, VoronoiSimplex, closest_points};
use parry3d_f64::shape::SupportMap;

/// Points, translated and scaled to near 1.
struct PointSet<'a> {
    points: Vec<&'a Vector>,
    centre: Vector,
    scale: Real,
}

impl SupportMap for PointSet<'_> {
    fn local_support_point(&self, direction: Vector) -> Vector {
        let farther = |a: (Real, Vector), point: &&Vector| {
            let height = direction.dot(**point);
            if height > a.0 { (height, **point) } else { a }
        };
        let (_, point) = self.points.iter().fold((Real::NEG_INFINITY, self.centre), farther);
        (point - self.centre) * self.scale
    }
}

/// Returns the vector from the bodies' axes to the group's hull along their shortest distance
/// (parry's GJK); `None` if they touch.
pub(super) fn between_hulls(group: &Group, bodies: &[ProofBody]) -> Option<Vector> {
    let ends = bodies.iter().flat_map(|body| &body.ends);
    let [low, high] =
        ends.clone().fold(group.bounds, |[low, high], &end| [low.min(end), high.max(end)]);
    let size = (high - low).max_element();
    let scale = if size > 0.0 { 1.0 / size } else { 1.0 };
    let centre = 0.5 * low + 0.5 * high;
    let wall = PointSet { points: group.vertices.iter().collect(), centre, scale };
    let robot = PointSet { points: ends.collect(), centre, scale };
    let mut simplex = VoronoiSimplex::new();
    simplex.reset(CsoPoint::from_shapes(&Pose::IDENTITY, &robot, &wall, Vector::X));
    match closest_points(&Pose::IDENTITY, &robot, &wall, Real::MAX, true, &mut simplex) {
        GJKResult::ClosestPoints(on_robot, on_wall, _) => Some(on_wall - on_robot),
        _ => None,
    }
}

/// Returns candidate normals between a body and one triangle.
pub(super) fn between_pair(
    level: Level,
    mesh: &Mesh,
    triangle: u32,
    body: &ProofBody,
) -> [Option<Vector>; 4] {
    let (corners, [start, end]) = (mesh.corners(triangle), body.ends);
    let link = PlacedLink::between(start, end, body.radius, body.flat);
    let answer: LinkProximity = link.answer(0, &link.measure(triangle, corners));
    let place =
        PlacedPair { ends: body.ends, radius: body.radius, flat: body.flat, corners, before: 0.0 };
    let mut contacts = Vec::new();
    add_contacts(level, &[answer], |_| place, &mut contacts);
    let from_features = contacts.first().and_then(|contact| contact.normal).map(|normal| -normal);
    let face = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
    [from_features, Some(answer.witness.on_mesh - answer.witness.on_robot), Some(face), Some(-face)]
}
