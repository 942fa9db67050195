//! Solid disc against solid disc.
//!
//! Both discs are convex, so a pair of points that is nearest among its neighbours is nearest. Let
//! `l` be the unit vector along the line in which the planes meet, `m1` and `m2` the unit vectors
//! across it in each plane, C the second disc's centre seen from the first's. The first disc is a
//! row of chords along `l`: at the offset `a` across it the chord has the half length k = sqrt(r1^2
//! - a^2). All of a chord is at one height over the second plane, h = h0 + s a, and at one
//! offset across its centre, b = b0 + c a, where s and c are the sine and the cosine between the
//! planes. So the chord's nearest point is the one nearest to the foot of C, which is L along `l`;
//! it misses that by e = max(0, L - k), for the direction of `l` that makes L >= 0. With rho =
//! sqrt(b^2 + e^2) and o = max(0, rho - r2) the squared distance is
//!
//! ```text
//! F(a) = h^2 + o^2,
//! ```
//!
//! the least of a convex function over the chord, and so convex in `a`. Where its minimum is there
//! are two cases:
//!
//! 1. e = 0: the nearest point lies on the chord of the first disc through the foot of C, which
//!    runs across `l`. What is nearest to it is on the parallel diameter of the second: segment
//!    against segment, in one plane. Parallel and crossing discs with such a minimum are no
//!    exception.
//! 2. e > 0: it lies on the rim. There a = r1 sin(theta), k = r1 cos(theta), and the sign of
//!
//!    ```text
//!    g = w h s k + o (b c k + e a),  w / 2 times the derivative of F by theta,
//!    ```
//!
//!    with w = rho, or 1 where o = 0 and rho is no more than a weight, which may vanish,
//!    tells on which side the minimum lies. Halvings of t = tan(theta / 2), which runs from -1 to
//! 1, find it: no root of a    polynomial, no division but by 1 + t^2, by which the numbers are
//! multiplied instead. Then the arc that is left is    replaced by its tangent, and segment-disc
//! does the rest.
//!
//! **The number of halvings.** After H of them t is known within 2^-H, and theta = 2 atan(t) within
//! 2^(1-H). An arc leaves its tangent by r1 (1 - cos) <= r1 2^(1-2H), which is no more than u r1 =
//! 2^-p r1 for H = (p + 1) / 2: 13 halvings in single precision, 27 in double.
//!
//! **Rounding.** The numbers h, b, e and o err by a few u of the extent, so the computed g is that
//! of a residual (h, o) off by as much. A sign is wrong only where F falls by no more than such a
//! residual can tell, so what a wrong halving cuts off is nearer by a few u at most. The directions
//! `l` and `m1` are made perpendicular to the first normal again: where the planes are nearly
//! parallel the cross product is short, and its rounding large beside it. What is left of the error
//! turns `l` within the first plane, by u / s, and lifts it out of the second by s times that: u.
//! All candidates are distances between a point of each disc, so the lesser is right wherever
//! either is.

use super::{Closest, Convex, DiscSolver, Mask, Scalar, Vec3, frame::Frame, segment_segment};

/// The distance between two solid discs, each with its centre, normal (of any length but 0) and
/// radius.
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

/// How many halvings leave of an arc no more than its tangent, but for rounding.
const fn halvings(unit_roundoff: f64) -> usize {
    let (mut deviation, mut count) = (2.0, 0);
    while deviation > unit_roundoff {
        deviation *= 0.25;
        count += 1;
    }
    count
}

/// As [`disc_disc`], for a first disc around the origin, the second around `centre`, unit normals
/// and numbers near one.
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

    // Case 1. Where the foot is beyond the disc the chord is a point of the rim.
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
    // Where the chord passes through the second disc, that point is common, whatever rounding says
    // of its height.
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

/// A unit vector in the first plane that the second plane holds too, to rounding.
#[inline(always)]
fn line_of_planes<T: Scalar>(normal1: Vec3<T>, normal2: Vec3<T>, centre: Vec3<T>) -> Vec3<T> {
    let (zero, one) = (normal1.x.zero(), normal1.x.one());
    let is_none = |v: Vec3<T>| v.largest().le(zero);
    let in_plane = |v: Vec3<T>| v.along(normal1, -v.dot(normal1)).normalised();
    // What is left of a short product may be short again, and rounding once more: twice is enough.
    let made_perpendicular = |v: Vec3<T>| in_plane(in_plane(v.normalised()));
    let meeting = made_perpendicular(normal1.cross(normal2));
    // Of parallel planes any line will do; across the way between the centres case 1 is the answer.
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
