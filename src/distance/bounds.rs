//! Bounds on the distance to a flat cap, from the closest points of the axis alone.
//!
//! Let F be the distance between axis and triangle, p* the triangle's point, and U the distance of p* from
//! the link. With K the capsule around the link, d_K = max(0, F - r) and
//!
//! ```text
//! d_K <= d <= U <= F
//! ```
//!
//! because the link lies in K and p* lies in the triangle. A sharper lower bound is the plane through the
//! link's point x nearest to p*, with normal p* - x: the (convex) link lies on one side of it, so
//!
//! ```text
//! min over the vertices T_i of <p* - x, T_i - x> / U <= d.
//! ```
//!
//! Where it reaches U the disc need not be looked at; elsewhere it tells whether the disc can still win.

use super::{Mask, Scalar, Vec3, face::Face};

/// The plane's lower bound. `upper` is the distance between `on_triangle` and `on_link`.
#[inline(always)]
pub(crate) fn separating_plane<T: Scalar>(
    face: &Face<T>,
    upper: T,
    on_triangle: Vec3<T>,
    on_link: Vec3<T>,
) -> T {
    let zero = upper.zero();
    let normal = on_triangle - on_link;
    let [a, b, c] = face.vertices.map(|vertex| normal.dot(vertex - on_link));
    zero.lt(upper).select(a.min(b).min(c).over(upper).max(zero), zero)
}
