//! Segment against segment (paper, equations (1) to (8), corrected).
//!
//! With S(s) = S0 + s e, U(t) = U0 + t f and w = S0 - U0, minimise |w + s e - t f|^2 over the unit
//! square. Write a = <e,e>, b = <e,f>, c = <f,f>.
//!
//! 1. **Skew lines.** The free minimiser is s = <w x f, n> / <n,n> with n = f x e. The cross
//!    product keeps its digits where the determinant a c - b^2 of the normal equations loses half
//!    of them: for nearly parallel lines. For every t the best s on the line is s(t) = (b t -
//!    <e,w>) / a, monotone in t, so a minimiser with t in `[0, 1]` has s between s(0) and s(1); and
//!    since the minimum over t is convex in s, clamping s first to that interval and then to `[0,
//!    1]` is exact.
//! 2. **Parallel lines.** n = 0 leaves s free: any point of the interval between s(0) and s(1) is
//!    as good as another, and the clamps bring s there.
//! 3. **Degenerate segments.** a = 0 or c = 0: the parameter is 0.
//!
//! Then t follows from s, and s once more from t: a half step that costs little and removes the
//! rounding of the first quotient. A parameter at an end is exactly 0 or 1; in packs of single
//! precision that of the first segment may be a rounding below 1.

use super::{Closest, Scalar, Vec3, frame::Frame};

/// The distance between the segments `s[0]`-`s[1]` and `u[0]`-`u[1]`; (1) to (8).
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

/// Where two segments are closest.
#[derive(Clone, Copy)]
pub(crate) struct Parameters<T> {
    /// On the first segment, in `[0, 1]`.
    pub s: T,
    /// On the second segment, in `[0, 1]`.
    pub t: T,
    /// From the point of the second segment to that of the first.
    pub gap: Vec3<T>,
}

/// The closest parameters of S0 + s e and U0 + t f, where `w` = S0 - U0.
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
