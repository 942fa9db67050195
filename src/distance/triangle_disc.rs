//! The distance between a triangle and a solid disc (paper, equations (22) to (25), corrected).
//!
//! ```text
//!     Triangle and disc, both seen edge-on:
//!
//!     1. edge                2. face, apart        3. face, crossing
//!     \ disc                     \ disc                \ disc
//!      \                          \                     \
//!       \                          \                  ___\______ triangle
//!         ________ triangle     ____._____ triangle       \
//! ```
//!
//! 1. **Edges.** If the triangle's closest point is on its boundary, segment-disc finds it.
//! 2. **Face, apart.** If the closest point is in the interior, the line between the closest points
//!    is normal to the plane. So the disc's point is its nearest to the plane: on the rim. If disc
//!    and plane are parallel, the centre is equally good, unless an edge passes over the disc; then
//!    case 1 finds the answer.
//! 3. **Face, crossing.** If the disc crosses the plane, plane-disc returns the middle of the chord
//!    in which the disc meets the plane. Either this middle lies in the triangle, or the chord
//!    leaves the triangle through an edge, or the two are apart. The edges cover the last two.
//!
//! The candidate of the face is a distance between two points: the disc's, and its foot on the
//! triangle.

use super::{Closest, Convex, DiscSolver, Scalar, Vec3, face::Face, frame::Frame, plane_disc};

/// How far rounding may move a point of the triangle off it, in units of `u` and numbers near one.
const OFF_FACE_ROUNDING: f64 = 32.0;

/// Returns the distance between a triangle and a solid disc, and the closest points; (22) to (25).
///
/// ```text
///        ^ normal
///        |         *____________ triangle, edge-on
///        |        / point1
///        |       / distance
///   =====o=====* point2
///      centre
///        <-----> radius
/// ```
///
/// - `triangle`, `centre`, `radius`: in one frame and unit.
/// - `normal`: of any length except 0.
#[inline(always)]
pub fn triangle_disc<T: Scalar>(
    triangle: [Vec3<T>; 3],
    centre: Vec3<T>,
    normal: Vec3<T>,
    radius: T,
) -> Closest<T> {
    triangle_disc_by::<Convex, T>(triangle, centre, normal, radius)
}

/// Same as [`triangle_disc`], with the solver `S` for the edges.
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

/// Same as [`triangle_disc`], for a disc around the origin, a unit normal and numbers near one.
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
    // If the height of a sliver is within rounding, distant points may seem to lie inside. But no
    // point of a triangle is farther from its longest edge than the triangle's height.
    let within_height =
        edges.distance.le(face.height() + radius.lit(OFF_FACE_ROUNDING * T::UNIT_ROUNDOFF));
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
