//! Which way a section's face stands where its direction is not given.
//!
//! All that is known of the unit tangent t is |t'| <= k almost everywhere in the section, and the
//! samples. The curvature may jump anywhere: the joint of two tubes need not fall on a sample. So a
//! steady turn must not be taken for granted.
//!
//! Let the arc length s count from the face inwards, the first segment end at l1 and the second l2
//! farther on, t point out of the section, and m1 and m2 be the means of t in them. By parts, and
//! without any error,
//!
//! t(0) = m1 + E, E = - integral over the first of (1 - s / l1) t'
//! m1 - m2 = - integral over both of w t', w = s / l1 in the first, (l1 + l2 - s) / l2 in the
//! second.
//!
//! **Plain.** |E| <= k l1 / 2, and as an angle the same (`pieces::bounding_body`): the first
//! segment's direction is that of the face to k l1 / 2. If the turn between the segments is less
//! than it could be, little more can be said: a curve that bends by k the one way next to the face
//! and the other way farther on shows no turn at all.
//!
//! **Full turn.** But if the turn is nearly as large as k allows, the curve bends by k nearly
//! everywhere. Let e be a unit vector and v = k + <t', e>, which lies between 0 and 2 k. Then
//!
//! integral over both of w v = k (l1 + l2) / 2 - <m1 - m2, e> = d,
//! |-t' - k e|^2 = |t'|^2 + 2 k <t', e> + k^2 <= 2 k v,
//!
//! so E is off k l1 / 2 e by at most the integral over the first segment of (1 - s / l1) sqrt(2 k
//! v). With x = s / l1 and y = sqrt(v / 2 k) <= 1 that is 2 k l1 times the integral of (1 - x) y,
//! where the integral of x y^2 is at most D = d / (2 k l1). Up to any p, y is at most 1; beyond it
//! the product of the two roots counts (Schwarz):
//!
//! integral of (1 - x) y <= p - p^2 / 2 + sqrt(D (ln(1 / p) - 3 / 2 + 2 p - p^2 / 2)).
//!
//! p = sqrt(D) / 4 is about the best, and where that is above 1 the plain bound is the better one.
//! A hidden jump counts by the root of D, as it should: one of the size q k at j l1 from the face
//! takes q k l1 j^2 / 2 from the turn, and q k l1 (j - j^2 / 2) from E.
//!
//! The samples show the chords, h_i long in the directions d_i: m_i = d_i h_i / l_i, and l_i <= g
//! h_i with g = 1 + (k h)^2 / 20, h the longer of the two. With e along
//! d1 - d2, <d1, e> and -<d2, e> are half of the turn T = |d1 - d2|, so
//! d <= k g (h1 + h2) / 2 - T / g; and m1 + k l1 / 2 e is within (g - 1)(1 + k h1 / 2) of d1 + k h1
//! / 2 e.
//!
//! **What the samples hide.** They show means. Where the bend turns about the curve, as in a helix,
//! by q from one sample to the next, the mean over two segments is less than k by q^2 / 12 of it.
//! Beside a face the roots would make much of that, so there k is taken q^2 / 8 larger, q being the
//! difference between the bends at the first two samples as a share of k.

use super::segment::Segment;
use parry3d_f64::math::{Real, Vector};

/// The direction out of a section at its first sample and how far off it may be; `sample` counts
/// from there.
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
    // The angle's sine is at most `off`, and an angle up to 1/2 no more than 1.05 times its sine.
    let tilt = 1.05 * off;
    // Written so that NaN, where nothing turns, is not less.
    if tilt < plain.1.min(0.5) {
        ((first.direction + turn * (half / size)).normalize(), tilt)
    } else {
        plain
    }
}

/// The largest integral of (1 - x) y for an integral of x y^2 of `share`, or more.
fn reach_of(share: Real) -> Real {
    let root = share.sqrt();
    let p = 0.25 * root;
    // The logarithm of z is at most n (z^(1 / n) - 1). Roots are the same to the last bit on every
    // machine.
    let inverse = 1.0 / p;
    let sixteenth = inverse.sqrt().sqrt().sqrt().sqrt();
    let logarithm = 16.0 * (sixteenth - 1.0);
    p + root * (logarithm - 1.5 + 2.0 * p).max(0.0).sqrt()
}
