//! The foot of a contact on a link's axis, and whether the link answers there as its capsule does.
//!
//! Let `a` be the axis point nearest to another convex body, `b` that body's nearest point, `d`
//! their distance and `n` the unit vector from `a` to `b`. Let the link have the radius `r`, and a
//! flat end, if it has one, be `t > 0` away from `a` along the axis. So `n` does not lean towards a
//! flat end, and
//!
//! 1. **Apart**, `d > r`, link and capsule are as far from the body: the point `a + r n` belongs to
//!    both.
//! 2. **Overlapping**, `0 < d <= r`, the capsule is out after the way `p = r - d` along `n`. No way
//!    out of the link is shorter where `t >= p`. For a unit vector `m` at the cosine `c` to `n`,
//!    the overlap along `m` is at least `h - d c`, with `h` how far the link reaches along `m` from
//!    `a`. If `m` leans towards a flat end, at a cosine `z` to the axis and a sine `s`, ```text h
//!    >= r s + t z,   c <= s,   so   h - d c >= p c + r (s - c) + t z >= p (s + z) >= p   for c >=
//!    0, ``` and `h - d c >= min(r, t) >= p` otherwise. If it does not, `h >= r` and `h - d c >= r
//!    - d`.
//!
//! For two links, whose radii add up, the same holds with `p = r1 + r2 - d` where each link with a
//! flat end also has `p <= r`: the excess of `h` over `r c` of one such link alone is at least `p
//! (1 - c)` then, and what is left is `p c`.

use parry3d_f64::math::{Real, Vector};

/// How far a point of a link's axis is along the axis from the nearest flat end; infinite if both
/// are round. `from_start` and `to_end` are the ways from the start to the point and on to the end,
/// and `axis` is the unit axis.
pub(crate) fn to_flat(from_start: Vector, to_end: Vector, axis: Vector, flat: [bool; 2]) -> Real {
    let along = [from_start.dot(axis), to_end.dot(axis)];
    let ends = along.into_iter().zip(flat).filter(|(_, is_flat)| *is_flat);
    ends.map(|(along, _)| along).fold(Real::INFINITY, Real::min)
}
