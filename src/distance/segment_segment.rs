//! The distance between two segments (paper, equations (1) to (8), corrected).
//!
//! ```text
//!     S0 -------- s -------------> S0 + e
//!                 |
//!                 |  gap
//!                 |
//!           U0 -- t ------> U0 + f
//! ```
//!
//! # Definitions
//! `S(s) = S0 + s e`, `U(t) = U0 + t f`, `w = S0 - U0`, `a = <e, e>`, `b = <e, f>`, `c = <f, f>`.
//! Minimise `|w + s e - t f|^2` over the unit square.
//!
//! # Algorithm
//! 1. **Skew lines.** The minimiser over all `s`, `t` has `s = <w x f, n> / <n, n>` with
//!    `n = f x e`. For nearly parallel lines the cross product keeps its digits; the determinant
//!    `a c - b^2` of the normal equations loses half of them. For a given `t` the best `s` on the
//!    line is `s(t) = (b t - <e, w>) / a`, monotone in `t`. So a minimiser with `t` in `[0, 1]` has
//!    `s` between `s(0)` and `s(1)`. The minimum over `t` is convex in `s`, so clamping `s` first
//!    to this interval and then to `[0, 1]` is exact.
//! 2. **Parallel lines.** `n = 0` leaves `s` free. All `s` between `s(0)` and `s(1)` are equally
//!    good; the clamps bring `s` there.
//! 3. **Degenerate segments.** If `a = 0` or `c = 0`, that parameter is 0.
//!
//! Then `t` follows from `s`, and `s` once more from `t`.
//!
//! # Rounding
//! The second `s` removes the rounding of the first quotient at low cost. A parameter at an end is
//! exactly 0 or 1. Exception: in packs of single precision the first segment's parameter may be one
//! rounding below 1.

use super::{Closest, Scalar, Vec3, frame::Frame};

/// Returns the distance between the segments from `s[0]` to `s[1]` and from `u[0]` to `u[1]`, and
/// the closest points; (1) to (8).
///
/// ```text
///   s[0] ------------* point1 ------ s[1]
///                    |
///                    | distance
///          u[0] -----* point2 -- u[1]
/// ```
///
/// All points share one frame and unit. A segment may have length 0.
#[inline(always)]
pub fn segment_segment<T: Scalar>(s: [Vec3<T>; 2], u: [Vec3<T>; 2]) -> Closest<T> {
    let frame = Frame::around(s[0], [s[1], u[0], u[1]], s[0].x.zero());
    let (s1, u0, u1) = (frame.point(s[1]), frame.point(u[0]), frame.point(u[1]));
    let found = parameters(-u0, s1, u1 - u0);
    frame.answer(Closest {
        distance: found.gap.norm(),
        point1: s1 * found.s,
        point2: u0.along(u1 - u0, found.t),
    })
}

/// The closest points of two segments, as parameters.
#[derive(Clone, Copy)]
pub(crate) struct Parameters<T> {
    /// On the first segment, in `[0, 1]`.
    pub s: T,
    /// On the second segment, in `[0, 1]`.
    pub t: T,
    /// The vector from the second segment's point to the first segment's point.
    pub gap: Vec3<T>,
}

/// Returns the closest parameters of `S0 + s e` and `U0 + t f`, with `w = S0 - U0`.
#[inline(always)]
pub(crate) fn parameters<T: Scalar>(w: Vec3<T>, e: Vec3<T>, f: Vec3<T>) -> Parameters<T> {
    let zero = w.x.zero();
    let n = f.cross(e);
    let (a, b, c) = (e.norm_squared(), e.dot(f), f.norm_squared());
    let (d, g) = (-e.dot(w), f.dot(w));
    let free = w.cross(f).dot(n).over(n.norm_squared()); // case 2: 0, moved by the clamps
    let per_a = a.one().over(a);
    let s = (free * a).max(d.min(d + b)).min(d.max(d + b)).max(zero).min(a).share_of(a, per_a);
    let t = s.mul_add(b, g).max(zero).min(c).over(c);
    let s = t.mul_add(b, d).max(zero).min(a).share_of(a, per_a);
    Parameters { s, t, gap: w.along(e, s).along(f, -t) }
}
