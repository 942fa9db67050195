//! Triangle against solid disc (paper, equations (22) to (25), corrected).
//!
//! 1. **Edges.** If the triangle's closest point is on its boundary, segment-disc finds it.
//! 2. **Face, apart.** If it is in the interior, the line between the closest points is normal to
//!    the plane, so the disc's point is its nearest to the plane: on the rim, or (parallel) the
//!    centre serves, unless an edge passes over the disc.
//! 3. **Face, crossing.** If the disc crosses the plane, plane-disc returns the middle of the chord
//!    that the disc cuts out of the plane. Either it lies in the triangle, or the chord leaves the
//!    triangle through an edge, or the two are apart; the edges find the last two.
//!
//! The face's candidate is the distance between two actual points, the disc's and its foot on the
//! triangle.

use super::{Closest, Convex, DiscSolver, Scalar, Vec3, face::Face, frame::Frame, plane_disc};

/// How far rounding may bring a point of the triangle from it, in units of u and numbers near one.
const ROUNDING: f64 = 32.0;

/// The distance between a triangle and a solid disc with the given centre, normal (of any length
/// but 0) and radius; (22) to (25).
#[inline(always)]
pub fn triangle_disc<T: Scalar>(
    triangle: [Vec3<T>; 3],
    centre: Vec3<T>,
    normal: Vec3<T>,
    radius: T,
) -> Closest<T> {
    triangle_disc_by::<Convex, T>(triangle, centre, normal, radius)
}

/// As [`triangle_disc`], by the route `S`.
#[inline(always)]
pub fn triangle_disc_by<S: DiscSolver<T>, T: Scalar>(
    triangle: [Vec3<T>; 3],
    centre: Vec3<T>,
    normal: Vec3<T>,
    radius: T,
) -> Closest<T> {
    let frame = Frame::around(centre, triangle, radius);
    let face = Face::new(triangle.map(|vertex| frame.point(vertex)));
    frame.answer(from_centre::<S, T>(&face, normal.normalised(), frame.length(radius)))
}

/// As [`triangle_disc`], for a disc around the origin, a unit normal and numbers near one.
#[inline(always)]
pub(crate) fn from_centre<S: DiscSolver<T>, T: Scalar>(
    face: &Face<T>,
    normal: Vec3<T>,
    radius: T,
) -> Closest<T> {
    let [a, b, c] = face.vertices;
    // Case 1.
    let edges = S::segment_disc([a, b], normal, radius)
        .nearer(S::segment_disc([b, c], normal, radius))
        .nearer(S::segment_disc([c, a], normal, radius));
    // Cases 2 and 3.
    let plane_normal = face.normal();
    let nearest = plane_disc::from_centre(plane_normal.dot(a), plane_normal, normal, radius);
    let projection = face.project(nearest.point);
    // A sliver whose height is rounding may seem to hold what is far from it; but no point of a
    // triangle is farther from its longest edge than its height.
    let within_height = edges.distance.le(face.height() + radius.lit(ROUNDING * T::UNIT_ROUNDOFF));
    let crosses = nearest.distance.le(radius.zero()) & within_height;
    let apart = Closest {
        distance: projection.residual.norm(),
        point1: face.at(projection.alpha, projection.beta),
        point2: nearest.point,
    };
    let common = Closest { distance: radius.zero(), point1: nearest.point, point2: nearest.point };
    let face_answer = Closest::select(crosses, common, apart);
    Closest::select(projection.inside & face_answer.distance.le(edges.distance), face_answer, edges)
}
