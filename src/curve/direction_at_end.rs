//! The direction of a section's face if none is given.
//!
//! # Definitions
//! - `t`: the unit tangent, out of the section. Known: `|t'| <= k` almost everywhere, and the
//!   samples. The curvature may jump anywhere, because the joint of two tubes need not fall on a
//!   sample. So a steady turn must not be assumed.
//! - `s`: the arc length from the face inwards. `l1`, `l2`: the lengths of curve over the first and
//!   the second segment. `m1`, `m2`: the means of t over them.
//! - `w`: the hat `s / l1` over the first segment and `(l1 + l2 - s) / l2` over the second.
//!
//! Integration by parts gives, exactly,
//!
//! - `t(0) = m1 + E`, `E = -integral over the first of (1 - s / l1) t'`;
//! - `m1 - m2 = -integral over both of w t'`.
//!
//! # Case 1: plain
//! `|E| <= k l1 / 2`, also as an angle (`refine::bounding_body`). So the first segment's direction
//! is that of the face up to `k l1 / 2`. If the turn between the segments is less than k allows,
//! little more can be said: a curve that bends by k in one sense next to the face and in the other
//! sense farther on shows no turn.
//!
//! # Case 2: full turn
//! If the turn is nearly as large as k allows, the curve bends by k nearly everywhere. Let e be a
//! unit vector and `v = k + <t', e>`, so `0 <= v <= 2 k`. Then
//!
//! - `integral over both of w v = k (l1 + l2) / 2 - <m1 - m2, e> = d`,
//! - `|-t' - k e|^2 = |t'|^2 + 2 k <t', e> + k^2 <= 2 k v`.
//!
//! So E differs from `(k l1 / 2) e` by at most the integral over the first segment of
//! `(1 - s / l1) sqrt(2 k v)`. With `x = s / l1` and `y = sqrt(v / 2 k) <= 1` this is `2 k l1`
//! times the integral of `(1 - x) y`, where the integral of `x y^2` is at most `D = d / (2 k l1)`.
//! For any p, use `y <= 1` up to p and Schwarz beyond p:
//!
//! `integral of (1 - x) y <= p - p^2 / 2 + sqrt(D (ln(1 / p) - 3 / 2 + 2 p - p^2 / 2))`.
//!
//! `p = sqrt(D) / 4` is nearly optimal; where it exceeds 1, case 1 is better. The root of D is the
//! right order for a hidden jump: a jump of size `q k` at `j l1` from the face reduces the turn by
//! `q k l1 j^2 / 2` and E by `q k l1 (j - j^2 / 2)`.
//!
//! # From samples
//! The samples show chords of lengths h_i and directions d_i: `m_i = d_i h_i / l_i` and
//! `l_i <= g h_i`, with `g = 1 + (k h)^2 / 20` and h the longer chord. Take e along `d1 - d2`; then
//! `<d1, e>` and `-<d2, e>` are half of the turn `T = |d1 - d2|`. So
//!
//! - `d <= k g (h1 + h2) / 2 - T / g`;
//! - `m1 + (k l1 / 2) e` is within `(g - 1)(1 + k h1 / 2)` of `d1 + (k h1 / 2) e`.
//!
//! # Hidden curvature
//! Samples show means. If the bend turns about the curve, as in a helix, by q per sample, the mean
//! over two segments is less than k by `q^2 / 12` of it. The roots of case 2 would amplify this
//! error, so k is increased by `q^2 / 8` of it. Here q is the difference between the bends at the
//! first two samples, relative to k.

use super::segment::Segment;
use parry3d_f64::math::{Real, Vector};

/// Returns the direction out of a section at its first sample and its uncertainty.
///
/// `sample(k)` is the k-th of `count` samples, counted from the end inwards.
pub(super) fn direction_at_end(
    sample: impl Fn(usize) -> Vector,
    count: usize,
    curvature: Real,
    rounding: Real,
) -> (Vector, Real) {
    let segment = |k: usize| {
        if k + 1 < count { Segment::between(sample(k + 1), sample(k), rounding) } else { None }
    };
    let Some(first) = segment(0) else { return (Vector::ZERO, Real::INFINITY) };
    let plain = (first.direction, 0.5 * curvature * first.length * 1.05 + 4.0 * first.noise);
    let (Some(second), Some(third)) = (segment(1), segment(2)) else { return plain };

    let turn = first.direction - second.direction;
    let size = turn.length();
    let bend = turn / (0.5 * (first.length + second.length));
    let next = (second.direction - third.direction) / (0.5 * (second.length + third.length));
    let curvature = curvature + (bend - next).length_squared() / (8.0 * curvature);

    let noise = 4.0 * (first.noise + second.noise);
    let longer = curvature * first.length.max(second.length);
    let stretch = 1.0 + longer * longer / 20.0;
    let missing =
        0.5 * curvature * stretch * (first.length + second.length) - size / stretch + noise;
    let half = 0.5 * curvature * first.length;
    let share = missing.max(0.0) / (4.0 * half);
    let off = 4.0 * half * stretch * reach_of(share) + (stretch - 1.0) * (1.0 + half) + noise;
    // The angle's sine is at most `off`; an angle up to 1/2 is at most 1.05 times its sine.
    let tilt = 1.05 * off;
    // Written so that NaN, for a section that does not turn, is not less.
    if tilt < plain.1.min(0.5) {
        ((first.direction + turn * (half / size)).normalize(), tilt)
    } else {
        plain
    }
}

/// Upper bound on the integral of `(1 - x) y` if the integral of `x y^2` is at most `share`.
fn reach_of(share: Real) -> Real {
    let root = share.sqrt();
    let p = 0.25 * root;
    // ln z <= n (z^(1 / n) - 1). Roots are bit-identical on every machine.
    let inverse = 1.0 / p;
    let sixteenth = inverse.sqrt().sqrt().sqrt().sqrt();
    let logarithm = 16.0 * (sixteenth - 1.0);
    p + root * (logarithm - 1.5 + 2.0 * p).max(0.0).sqrt()
}
