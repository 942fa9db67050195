//! The distance between two solid discs.
//!
//! ```text
//!     Seen along the line l of the planes:
//!
//!                / m2
//!               C   disc 2, radius r2
//!              /
//!             /   angle with sine s, cosine c
//!     -------l--------o------|-----> m1
//!                     0      a    disc 1, radius r1
//! ```
//!
//! # Definitions
//! - `r1`, `r2`: the radii. The first disc's centre is the origin; `C` is the second disc's centre.
//! - `l`: the unit vector along the line in which the planes meet, directed so that
//!   `L = <C, l> >= 0`.
//! - `m1`, `m2`: the unit vectors across `l` in each plane.
//! - `s`, `c`: the sine and the cosine of the angle between the planes.
//! - The chord at the offset `a` along `m1` runs along `l` and has the half length
//!   `k = sqrt(r1^2 - a^2)`.
//! - All of this chord has the height `h = h0 + s a` over the second plane and the offset
//!   `b = b0 + c a` across `C`. Its point nearest to `C` misses the foot of `C` by
//!   `e = max(0, L - k)`.
//! - `rho = sqrt(b^2 + e^2)`, `o = max(0, rho - r2)`. The squared distance of the chord from the
//!   second disc is
//!
//! ```text
//! F(a) = h^2 + o^2.
//! ```
//!
//! # Algorithm
//! Both discs are convex, so a local minimum is the global one. `F` is the least of a convex
//! function over a chord, so `F` is convex in `a`. Its minimum falls into one of two cases:
//!
//! 1. `e = 0`. The nearest point lies on the chord of the first disc that passes through the
//!    foot of `C` and runs across `l`. Its counterpart lies on the parallel diameter of the second
//!    disc. Both lie in one plane: segment-segment. This includes parallel and crossing discs with
//!    such a minimum.
//! 2. `e > 0`. The nearest point lies on the rim: `a = r1 sin(theta)`, `k = r1 cos(theta)`. The
//!    side of the minimum is given by the sign of
//!
//!    ```text
//!    g = w h s k + o (b c k + e a),      w / 2 times the derivative of F by theta,
//!    ```
//!
//!    with `w = rho`, or `w = 1` where `o = 0`: there `rho` is only a weight, which may vanish.
//!    Bisect `t = tan(theta / 2)` from -1 to 1. This needs no root of a polynomial, and no
//!    division: all lengths are multiplied by `1 + t^2`. Then replace the remaining arc by its
//!    tangent and use segment-disc.
//!
//! # Number of halvings
//! After `H` halvings `t` is known within `2^-H`, and `theta = 2 atan(t)` within `2^(1-H)`. An arc
//! deviates from its tangent by `r1 (1 - cos) <= r1 2^(1-2H)`. This is at most `u r1 = 2^-p r1` for
//! `H = (p + 1) / 2`: 13 halvings in single precision, 27 in double.
//!
//! # Rounding
//! - `h`, `b`, `e` and `o` err by a few `u` of the extent, so the computed `g` belongs to a
//!   residual `(h, o)` with an error of that size. A sign can be wrong only if `F` falls by no more
//!   than this error explains. What a wrong halving cuts off is therefore nearer by a few `u` at
//!   most.
//! - `l` and `m1` are made perpendicular to the first normal again. If the planes are nearly
//!   parallel, the cross product is short and its relative error large. The remaining error turns
//!   `l` within the first plane by `u / s`, and lifts it out of the second plane by `s` times that:
//!   `u`.
//! - Every candidate is a distance between a point of each disc, so the smaller is right if either
//!   is right.

use super::{Closest, Convex, DiscSolver, Mask, Scalar, Vec3, frame::Frame, segment_segment};

/// Returns the distance between two solid discs, and the closest points.
///
/// ```text
///        ^ normal1                     /
///        |                            o centre2, radius2, normal2
///        |              distance     /
///   =====o=====* - - - - - - - - - -*
///      centre1  point1          point2
///        <-----> radius1
/// ```
///
/// - `centre1`, `centre2`, `radius1`, `radius2`: in one frame and unit; radii at least 0.
/// - `normal1`, `normal2`: of any length except 0.
#[inline(always)]
pub fn disc_disc<T: Scalar>(
    centre1: Vec3<T>,
    normal1: Vec3<T>,
    radius1: T,
    centre2: Vec3<T>,
    normal2: Vec3<T>,
    radius2: T,
) -> Closest<T> {
    let frame = Frame::around(centre1, [centre2], radius1.max(radius2));
    let radii = [frame.length(radius1), frame.length(radius2)];
    frame.answer(from_centre(
        radii,
        [normal1.normalised(), normal2.normalised()],
        frame.point(centre2),
    ))
}

/// Returns the number of halvings after which an arc deviates from its tangent by less than
/// rounding.
const fn halvings(unit_roundoff: f64) -> usize {
    let (mut deviation, mut count) = (2.0, 0);
    while deviation > unit_roundoff {
        deviation *= 0.25;
        count += 1;
    }
    count
}

/// Same as [`disc_disc`], for a first disc around the origin, a second disc around `centre`, unit
/// normals and numbers near one.
#[inline(always)]
pub(crate) fn from_centre<T: Scalar>(
    [radius1, radius2]: [T; 2],
    [normal1, normal2]: [Vec3<T>; 2],
    centre: Vec3<T>,
) -> Closest<T> {
    let (zero, one) = (radius1.zero(), radius1.one());
    let line = line_of_planes(normal1, normal2, centre);
    let line = Vec3::select(centre.dot(line).lt(zero), -line, line);
    let (across1, across2) = (line.cross(normal1), line.cross(normal2));
    let (sine, cosine) = (across1.dot(normal2), normal1.dot(normal2));
    let (height0, offset0, foot) = (-centre.dot(normal2), -centre.dot(across2), centre.dot(line));

    // Case 1. If the foot lies beyond the first disc, the chord is a point of the rim.
    let at = foot.min(radius1);
    let half = ((radius1 - at) * (radius1 + at)).sqrt();
    let (chord, diameter) = (across1 * (half + half), across2 * (radius2 + radius2));
    let from = line * at + across1 * -half;
    let to = centre.along(across2, -radius2);
    let found = segment_segment::parameters(from - to, chord, diameter);
    let inner = Closest {
        distance: found.gap.norm(),
        point1: from.along(chord, found.s),
        point2: to.along(diameter, found.t),
    };
    // If the chord passes through the second disc, the crossing is a common point, even if rounding
    // puts it off the plane.
    let climb = sine * half;
    let (low, high) = (height0 - climb, height0 + climb);
    let share = low.abs().over(low.abs() + high.abs());
    let across = from.along(chord, share) - centre;
    let across = across.along(normal2, -across.dot(normal2));
    let passes = (low * high).le(zero) & across.norm_squared().le(radius2 * radius2);
    let common = across + centre;
    let met = Closest { distance: zero, point1: common, point2: common };
    let inner = Closest::select(passes, met, inner);

    // Case 2, with all lengths multiplied by 1 + t^2.
    let mut t = zero;
    let mut step = one;
    for _ in 0..const { halvings(T::UNIT_ROUNDOFF) } {
        step = step * one.lit(0.5);
        let whole = t.mul_add(t, one);
        let (a, k) = (radius1 * (t + t), radius1 * (one - t * t));
        let (h, b) = (sine.mul_add(a, height0 * whole), cosine.mul_add(a, offset0 * whole));
        let e = foot.mul_add(whole, -k).max(zero);
        let rho = b.mul_add(b, e * e).sqrt();
        let o = (-radius2).mul_add(whole, rho).max(zero);
        let weight = zero.lt(o).select(rho, one);
        let g = (weight * h) * (sine * k) + o * (b * cosine).mul_add(k, e * a);
        t = t + g.lt(zero).select(step, -step);
    }
    let per_whole = one / t.mul_add(t, one);
    let (a, k) = ((t + t) * per_whole, (one - t * t) * per_whole);
    let point = (across1 * a + line * k) * radius1;
    let arc = (across1 * k - line * a) * (radius1 * (step + step) * per_whole);
    let ends = [point - arc - centre, point + arc - centre];
    let rim = Convex::segment_disc(ends, normal2, radius2);
    let rim = Closest {
        distance: rim.distance,
        point1: rim.point1 + centre,
        point2: rim.point2 + centre,
    };
    inner.nearer(rim)
}

/// Returns a unit vector of the first plane that also lies in the second plane, within rounding.
#[inline(always)]
fn line_of_planes<T: Scalar>(normal1: Vec3<T>, normal2: Vec3<T>, centre: Vec3<T>) -> Vec3<T> {
    let (zero, one) = (normal1.x.zero(), normal1.x.one());
    let is_none = |v: Vec3<T>| v.largest().le(zero);
    let in_plane = |v: Vec3<T>| v.along(normal1, -v.dot(normal1)).normalised();
    // The perpendicular part of a short product may be short again and consist of rounding: two
    // passes are enough.
    let made_perpendicular = |v: Vec3<T>| in_plane(in_plane(v.normalised()));
    let meeting = made_perpendicular(normal1.cross(normal2));
    // If the planes are parallel, any line is correct. The line across the offset of the centres
    // leads to case 1.
    let lateral = made_perpendicular(normal1.cross(centre));
    let is_x_least = normal1.x.abs().le(normal1.y.abs()) & normal1.x.abs().le(normal1.z.abs());
    let is_y_less = normal1.y.abs().le(normal1.z.abs());
    let unlike = Vec3::new(
        is_x_least.select(one, zero),
        (!is_x_least & is_y_less).select(one, zero),
        (!is_x_least & !is_y_less).select(one, zero),
    );
    let any = made_perpendicular(normal1.cross(unlike));
    let of_parallel = Vec3::select(is_none(lateral), any, lateral);
    Vec3::select(is_none(meeting), of_parallel, meeting)
}
