//! The distance between a triangle and a point.
//!
//! ```text
//!     The triangle, seen edge-on:
//!
//!     1. face              2. edge
//!          p                p
//!          |                 \
//!     _____|_____             \__________
//! ```
//!
//! 1. **Face.** If the foot of the point on the plane lies inside, the distance to the foot.
//! 2. **Edges.** The distance to the nearest of the three edges.
//!
//! An edge always gives an upper bound. The face, where it applies, is never farther. So the answer
//! is the least of the four.

use super::{Closest, Mask, Scalar, Vec3, face::Face, frame::Frame};

/// Returns the distance between a point and a triangle, and the closest points.
///
/// ```text
///            * point
///            |
///            | distance
///   _________*_______   triangle, edge-on
///          point2
/// ```
///
/// `point` and the vertices share one frame and unit. A triangle without area is a segment or a
/// point.
#[inline(always)]
pub fn point_triangle<T: Scalar>(point: Vec3<T>, triangle: [Vec3<T>; 3]) -> Closest<T> {
    let frame = Frame::around(point, triangle, point.x.zero());
    let face = Face::new(triangle.map(|vertex| frame.point(vertex)));
    let origin = Vec3::zero(point.x);
    let [a, b, c] = face.vertices;
    let projection = face.project(origin);
    let mut foot = on_segment(origin, a, b);
    for other in [on_segment(origin, b, c), on_segment(origin, c, a)] {
        foot = Vec3::select(other.norm_squared().lt(foot.norm_squared()), other, foot);
    }
    let face_nearer =
        projection.inside & projection.residual.norm_squared().lt(foot.norm_squared());
    let distance = face_nearer.select(projection.residual.norm(), foot.norm());
    frame.answer(Closest {
        distance,
        point1: origin,
        point2: Vec3::select(face_nearer, face.at(projection.alpha, projection.beta), foot),
    })
}

/// Returns the point of the segment closest to `point`.
#[inline(always)]
fn on_segment<T: Scalar>(point: Vec3<T>, start: Vec3<T>, end: Vec3<T>) -> Vec3<T> {
    let edge = end - start;
    let squared = edge.norm_squared();
    let t = edge.dot(point - start).max(squared.zero()).min(squared).over(squared);
    start.along(edge, t)
}
