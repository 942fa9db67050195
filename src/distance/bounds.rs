//! Bounds on the distance to a flat cap, from the closest points of the axis alone.
//!
//! Let F be the distance between axis and triangle, p* the triangle's point, and U the distance of
//! p* from the link. With K the capsule around the link, d_K = max(0, F - r) <= d <= U <= F,
//! because the link lies in K and p* lies in the triangle. A lower bound far sharper than d_K is a
//! separating plane. Beyond a flat end, with A the axis pointing out of it, l the height of p* over
//! the cap and b its distance from the rim's cylinder, take the normal (l A + b R) / |(l, b)| where
//! R points radially from the axis to p*. Both coefficients are >= 0, so whatever their rounding
//! the link lies behind the plane through x, the rim point towards p* (or the foot of p* on the
//! cap, where b = 0), and
//!
//! ```text
//! min over the vertices T_i of <normal, T_i - x> <= d.
//! ```
//!
//! The difference p* - x would do as a normal in exact arithmetic; its rounding tilts it by u
//! extent / U, and the bound would then be wrong by as much wherever the link nearly touches. R is
//! at a right angle to A only to rounding too: where p* lies much nearer to the axis than to the
//! centre of the cap, the far end of the link sticks out of the plane by -<normal, A> times its
//! distance from the cap, which is taken off.

use super::{Mask, Scalar, Vec3};

/// The plane's lower bound on the distance between a triangle and a link whose flat cap lies around
/// the origin with the outward unit normal `outward` and which reaches at most `behind` behind it,
/// less what rounding can have added to it; and U.
#[inline(always)]
pub(crate) fn separating_plane<T: Scalar>(
    vertices: [Vec3<T>; 3],
    on_triangle: Vec3<T>,
    outward: Vec3<T>,
    radius: T,
    behind: T,
) -> (T, T) {
    let zero = radius.zero();
    let height = on_triangle.dot(outward);
    let radial = on_triangle.along(outward, -height);
    let rho = radial.norm();
    let direction = radial * zero.one().over(rho);
    let (up, out) = (height.max(zero), (rho - radius).max(zero));
    let normal = outward * up + direction * out;
    let upper = up.mul_add(up, out * out).sqrt();

    let support = direction * rho.min(radius);
    let [a, b, c] = vertices;
    let ahead = normal.dot(a - support).min(normal.dot(b - support)).min(normal.dot(c - support));
    let tilt = (-normal.dot(outward)).max(zero);
    let extent = a.largest().max(b.largest()).max(c.largest()).max(behind);
    let bound = (ahead - tilt * behind).over(upper) - extent * zero.lit(16.0 * T::UNIT_ROUNDOFF);
    (zero.lt(upper).select(bound.max(zero), zero), upper)
}
