//! Decides whether a link's contact is the contact of its capsule.
//!
//! ```text
//!                b       closest point of the other body
//!                |
//!                | d     ^ n
//!      __________|_______|____
//!     |          |            |
//!     |   axis   a            | flat end
//!     |__________|____________|
//!                <---- t ---->
//! ```
//!
//! # Definitions
//! - `a`: the axis point closest to another convex body. `b`: that body's closest point. `d`: their
//!   distance. `n`: the unit vector from `a` to `b`.
//! - `r`: the link's radius. `t > 0`: the distance from `a` to the nearest flat end, along the
//!   axis. So `n` does not lean towards a flat end.
//! - `h`: how far the link extends along a unit vector `m`, from `a`.
//!
//! # Claim
//! 1. **Apart**, `d > r`: link and capsule are equally far from the body. The point `a + r n`
//!    belongs to both.
//! 2. **Overlapping**, `0 < d <= r`: the capsule is separated by the translation `p = r - d` along
//!    `n`. If `t >= p`, no translation that separates the link is shorter.
//!
//! # Proof of 2
//! For a unit vector `m` with the cosine `c` to `n`, the overlap along `m` is at least `h - d c`.
//!
//! - `m` leans towards a flat end, with the cosine `z` and the sine `s` to the axis, and `c >= 0`.
//!   Then
//!
//!   ```text
//!   h >= r s + t z,   c <= s,   so   h - d c >= p c + r (s - c) + t z >= p (s + z) >= p.
//!   ```
//! - The same with `c < 0`: `h - d c >= min(r, t) >= p`.
//! - `m` does not lean towards a flat end: `h >= r`, so `h - d c >= r - d`.
//!
//! For two links the radii add up, and `p = r1 + r2 - d`. The claim holds if each link with a flat
//! end also has `p <= r`: then the excess of `h` over `r c` of this link alone is at least
//! `p (1 - c)`, and the remainder is `p c`.

use parry3d_f64::math::{Real, Vector};

/// Returns the distance of a point of a link's axis from the nearest flat end, along the axis;
/// infinite if both ends are round.
///
/// `from_start` and `to_end` are the vectors from the start to the point and from the point to the
/// end. `axis` is the unit axis.
pub(crate) fn to_flat(from_start: Vector, to_end: Vector, axis: Vector, flat: [bool; 2]) -> Real {
    let along = [from_start.dot(axis), to_end.dot(axis)];
    let ends = along.into_iter().zip(flat).filter(|(_, is_flat)| *is_flat);
    ends.map(|(along, _)| along).fold(Real::INFINITY, Real::min)
}
