//! Bounds on the distance between a triangle and a flat cap, from the closest points of the axis
//! alone.
//!
//! ```text
//!       A ^                      . p*
//!         |                   .  |
//!         +---> R          .     | l        normal along the dots
//!                       .        |
//!      _______________x..........|
//!     |               |    b
//!     |     link      |
//! ```
//!
//! # Definitions
//! - `F`: the distance between axis and triangle. `p*`: the triangle's closest point. `d`: the
//!   distance between link and triangle.
//! - `K`: the capsule around the link, with the distance `d_K = max(0, F - r)`.
//! - `U`: the distance of `p*` from the link.
//! - `A`: the unit axis pointing out of the flat end. `R`: the unit vector from the axis to `p*`,
//!   across the axis.
//! - `l`: the height of `p*` over the cap. `b`: the distance of `p*` from the rim's cylinder.
//! - `x`: the rim point towards `p*`, or the foot of `p*` on the cap if `b = 0`.
//!
//! # Claim
//! `d_K <= d <= U <= F`, and with the separating plane through `x`,
//!
//! ```text
//! normal = (l A + b R) / |(l, b)|,
//! min over the vertices T_i of <normal, T_i - x> <= d.
//! ```
//!
//! # Proof
//! `K` contains the link, and `p*` lies in the triangle: this gives the first line. Both
//! coefficients of the normal are at least 0, with any rounding, so the link lies behind the plane.
//! The triangle lies ahead of the plane by at least the minimum over its vertices. This bound is
//! far sharper than `d_K`.
//!
//! # Rounding
//! - In exact arithmetic `p* - x` is the same normal. Its rounding tilts it by `u extent / U`,
//!   which makes the bound wrong by as much where the link nearly touches. So the normal is
//!   composed of `A` and `R`.
//! - `R` is perpendicular to `A` only within rounding. `p*` may be much nearer to the axis than to
//!   the cap's centre. The far end of the link then passes through the plane by `-<normal, A>`
//!   times its distance from the cap. This amount is subtracted.

use super::{Mask, Scalar, Vec3};

/// Returns a lower bound on the distance between a triangle and a link, and the upper bound `U`.
///
/// - `vertices`, `on_triangle`: the triangle and `p*`, relative to the centre of the flat cap.
/// - `outward`: the outward unit normal of the cap. `radius`: the radius of the link.
/// - `behind`: how far the link extends behind the cap, at most.
///
/// The lower bound is reduced by what rounding may have added.
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
