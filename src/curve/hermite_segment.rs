//! What two frames show of the curve between them. A frame is a point of the centreline with the
//! direction of the curve there.
//!
//! # Definitions
//! - `p`, `t` and `q`, `u`: the points and unit directions of the two frames.
//! - `d`, `c`: direction and length of the chord from p to q.
//! - The curve is c(s), s from 0 to its length `l`; `x = s / l`.
//! - `X`, `y`: the curve along the chord and across it. As `|c'| = 1`, `X' = sqrt(1 - |y'|^2)`.
//! - `T`, `U`: the parts of t and u across the chord.
//! - `|.|^2` of a function: its mean square over the segment.
//! - `A = |z| + w`, with the ball (z, w) of the assumption below.
//! - `k`: an upper bound on the curvature.
//!
//! # What the frames show
//! y is 0 at both ends, and y' is T and U there. So y'' has three known means:
//!
//! - the plain mean `m = (U - T) / l`;
//! - the mean weighted towards the start by `2 (1 - x)`: `a = -2 T / l`;
//! - the mean weighted towards the end by `2 x`: `b = 2 U / l`.
//!
//! # Assumption
//! The curve is at most 1.06 times as long as its chord. Its curvature vector across the chord
//! satisfies `|y''| <= |z| + w` everywhere and `|y'' - z|^2 <= w^2` in mean square. Every curve
//! whose y'' stays within the ball of radius w around z satisfies this. The ball contains
//!
//! 1. m, a and b;
//! 2. the means m of the segments before and behind in the section, turned with the chord. So the
//!    curvature may change evenly from one to the other, or jump anywhere;
//! 3. at an end of the section, where one neighbour is missing: m plus the difference between m and
//!    the other neighbour's mean. The change continues. (A section of one segment takes its
//!    neighbours' means; see below.)
//! 4. If m changes in the same sense towards both sides, here or from one neighbour on, half of the
//!    smaller change is added to w: at a peak of an evenly changing curvature the mean hides at
//!    most this much.
//!
//! w also grows by `k (k l)^2 / 16`. A bend of constant size k that turns by `k l` appears across
//! the chord with a size between `k (1 - (k l)^2 / 8)` and k. Its mean is `k (1 - (k l)^2 / 24)`;
//! its root mean square distance from that is `k (k l)^2 / 26`.
//!
//! # Turn
//! **Claim.** No direction is farther from d than the angle f with `sin f = A l / 2`, and
//! `k <= A / cos f`.
//!
//! **Proof.** The mean of y' is 0. So y'(x) is l times the integral of y'' with the weight x before
//! that place and `-(1 - x)` behind it. This is at most `l A (x^2 + (1 - x)^2) / 2 <= l A / 2`.
//!
//! For `A l < 0.9`, `k < A (1 + (A l)^2 / 4)`, and the mean of `|y'|^2` is at most `7/60 (A l)^2`.
//! So the curve is indeed at most 1.06 times as long as c.
//!
//! # Distance from the cubic
//! Let h be the cubic with the same ends and slopes as y over the same length. Its second
//! derivative is the line closest to y'' in mean square: h'' and `y'' - h''` are orthogonal, and so
//! are `h'' - z` and `y'' - h''`. Hence
//!
//! `|y'' - h''|^2 = |y'' - z|^2 - |h'' - z|^2 <= w^2 - |h'' - z|^2 =: v^2`,
//!
//! `|h'' - z|^2 = |m - z|^2 + 3 |T + U|^2 / l^2`.
//!
//! (If the line is farther from z than that of any function in the ball, w is enlarged.)
//!
//! **Claim.** `r = y - h` satisfies `|r| <= l^2 v / 13.85` everywhere, and `|r'| <= l v / (2 pi)`
//! in mean square.
//!
//! **Proof.** r has value 0 and slope 0 at both ends. A beam clamped at both ends yields most in
//! the middle, by `l^3 / 192` per load, so `|r(s)| <= sqrt(l^3 / 192) (integral of |r''|^2)^(1/2)`.
//! And r' is 0 at both ends and in the mean, so its lowest sine has the frequency `2 pi / l`.
//!
//! # A section of one segment
//! Its neighbours belong to other tubes. They show how large its bend may be, not how the bend
//! changes. The bend is assumed to change in one sense, evenly or in jumps: its changes c at the
//! places p are all within 60 degrees of one direction.
//!
//! **Claim.** Here `v = 4.6 |T + U| / l + 0.47 k (k l)^2` is an upper bound as well.
//!
//! **Proof.**
//! 1. A jump by c at p moves the curve from the cubic by `l^2 |c| f(x, p)`, where
//!    `f = x^2 (1 - p) |1 - 3 p + 2 p x| / 2` for `x <= p`, and symmetrically on the other side. f
//!    is at most `p (1 - p) 4/27`, and f' is `p (1 - p) sqrt(2 / 15)` in mean square. Both factors
//!    are largest for a jump at an end.
//! 2. Each jump shows: `(T + U) / l = m - a` is the sum of all `c p (1 - p)`. By the assumption it
//!    is at least half as long as the sum of all `|c| p (1 - p)`.
//! 3. Hence `|r| <= 8/27 l |T + U|`, and r' is at most `2 sqrt(2 / 15) |T + U|` in mean square.
//!    Both hold with `v = 4.6 |T + U| / l` in the formulas for r.
//! 4. Across the chord a bend k appears as `k cos q`, where `q <= k l / 2`. The missing part of k
//!    is at most `E = k (k l)^2 / 8`. It appears as at most `E / sqrt(3)` (the root mean square of
//!    `|1 - 2 x|`), and moves the curve by its own root mean square. So v grows by
//!    `4.6 E / sqrt(3) + E < 0.47 k (k l)^2`. (Here `A l` stands for `k l`, and `q <= f` is used:
//!    the bound on k is at least `A / cos f`, which is enough up to `A l = 0.9`.)
//!
//! # Error along the chord
//! Two slopes p and q of size at most `sin f` differ in X' by at most `|p - q| tan f`. y' is such a
//! slope, and so is h': `h' = (1 - x)(1 - 3 x) T + x (3 x - 2) U`, whose factors add up to at most
//! 1. So X is known to `l tan f l v / (2 pi)`, and l, from `X(l) = c`, to that over `cos f`.
//!
//! The cubic is laid over the length l' whose X is c: `l' = c / mean of sqrt(1 - |h'|^2)`, where h'
//! as a function of x does not depend on l'. For another l the cubic is longer by the same factor,
//! at most `4/27 (|T| + |U|) |l - l'|` across. In v, m and `T / l` change by the factor
//! `|l - l'| / l`. Both lengths are at least c; since the means of y' and h' are small, both are at
//! most `c (1 + (k c)^2 / 20)`.

use super::centreline::NextPoint;
use super::curve_bound::CurveBound;
use super::segment::Segment;
use crate::distance::Scalar;
use parry3d_f64::math::{Real, Rotation, Vector};
use std::f64::consts::TAU;

/// Most parts into which a segment is laid.
pub(super) const MAX_PARTS: u32 = 16;

/// Nodes and weights of the Gauss rule with four points from -1 to 1.
const GAUSS: [[Real; 2]; 4] = [
    [-0.861_136_311_594_052_6, 0.347_854_845_137_453_85],
    [-0.339_981_043_584_856_3, 0.652_145_154_862_546_2],
    [0.339_981_043_584_856_3, 0.652_145_154_862_546_2],
    [0.861_136_311_594_052_6, 0.347_854_845_137_453_85],
];

/// The cubic between two frames.
#[derive(Clone, Copy)]
pub(super) struct HermiteSegment {
    /// The segment of the input.
    pub segment: u32,
    pub radius: Real,
    pub start: Vector,
    /// The unit directions at its ends.
    pub tangents: [Vector; 2],
    /// The chord's direction.
    chord: Vector,
    chord_length: Real,
    /// T and U: the parts of the tangents across the chord.
    slopes: [Vector; 2],
    /// l': the length of the curve if it is the cubic.
    length: Real,
}

impl HermiteSegment {
    pub(super) fn between(
        segment: u32,
        radius: Real,
        points: [Vector; 2],
        tangents: [Vector; 2],
        rounding: Real,
    ) -> Option<Self> {
        let Segment { direction: chord, length: chord_length, .. } =
            Segment::between(points[0], points[1], rounding)?;
        let slopes = tangents.map(|tangent| tangent - chord * tangent.dot(chord));
        let mut arch = Self {
            segment,
            radius,
            start: points[0],
            tangents,
            chord,
            chord_length,
            slopes,
            length: chord_length,
        };
        arch.length = chord_length / arch.advance(0.0, 1.0);
        Some(arch)
    }

    /// Returns the end whose direction deviates more from the chord.
    pub(super) fn sharper_end(&self) -> usize {
        let [first, last] = self.tangents.map(|tangent| tangent.dot(self.chord));
        usize::from(last < first)
    }

    /// Returns the slope h' at x.
    fn slope(&self, x: Real) -> Vector {
        let [t, u] = self.slopes;
        t * ((3.0 * x - 4.0) * x + 1.0) + u * ((3.0 * x - 2.0) * x)
    }

    /// Returns the advance along the chord from one x to another, for l' = 1.
    fn advance(&self, from: Real, to: Real) -> Real {
        let half = 0.5 * (to - from);
        let at = |[place, weight]: [Real; 2]| {
            let slope = self.slope(from + half * (1.0 + place)).length_squared();
            weight * (1.0 - slope).max(0.0).sqrt()
        };
        half * GAUSS.into_iter().map(at).sum::<Real>()
    }

    /// Returns an upper bound on the error of [`advance`](Self::advance) over the whole length,
    /// including its rounding.
    ///
    /// The slope s is quadratic in x with the leading coefficient `3 (T + U)`, and the Gauss rule
    /// is exact up to x^7. Of `sqrt(1 - s^2) = 1 - s^2 / 2 - s^4 / 8 - ...`, the third term errs by
    /// its x^8 part, at most `|T + U|^4 / 500`. All other terms err by less than
    /// `(|T| + |U|)^6 / 1000`. Measured: 40,000 pairs of slopes of every kind err by less than a
    /// fifth of this.
    fn gauss_error(&self) -> Real {
        let [t, u] = self.slopes;
        let (lean, all) = ((t + u).length_squared(), t.length() + u.length());
        2e-3 * lean * lean + 1e-3 * (all * all) * (all * all) * (all * all) + 2.0_f64.powi(-40)
    }

    /// Returns m, a and b.
    fn bends(&self) -> [Vector; 3] {
        let [t, u] = self.slopes;
        [(u - t) / self.length, t * (-2.0 / self.length), u * (2.0 / self.length)]
    }

    /// Returns m as it appears across another segment's chord.
    fn bend_for(&self, other: &Self) -> Vector {
        Rotation::from_rotation_arc(self.chord, other.chord) * self.bends()[0]
    }

    /// Returns the ball (z, w) of the assumption. `neighbours`: for each end the next segment of
    /// the section and the one beyond it.
    pub(super) fn ball(&self, neighbours: [[Option<&Self>; 2]; 2]) -> (Vector, Real) {
        let [mean, first, last] = self.bends();
        let mut seen = [mean, first, last, mean, mean];
        let mut seen_beside = [None; 2];
        // The changes of the mean towards either end: to the neighbour, and from there on.
        let mut changes = [[Vector::ZERO; 2]; 2];
        for (end, [next, beyond]) in neighbours.into_iter().enumerate() {
            if let Some(next) = next {
                let bend = next.bend_for(self);
                seen[3 + end] = bend;
                seen_beside[end] = Some(bend);
                let turn = Rotation::from_rotation_arc(next.chord, self.chord);
                let further = beyond.map_or(Vector::ZERO, |beyond| {
                    turn * (beyond.bend_for(next) - next.bends()[0])
                });
                changes[end] = [bend - mean, further];
            }
        }
        match seen_beside {
            // Item 3: at an end the change continues.
            [None, Some(behind)] => seen[3] = mean + (mean - behind),
            [Some(before), None] => seen[4] = mean + (mean - before),
            _ => {}
        }
        let low = seen.into_iter().fold(mean, Vector::min);
        let high = seen.into_iter().fold(mean, Vector::max);
        let centre = (low + high) * 0.5;
        let mut radius =
            seen.into_iter().fold(0.0, |most: Real, bend| most.max((bend - centre).length()));
        let [[before, far], [behind, beyond]] = changes;
        let mut peak: Real = 0.0;
        for (one, other) in [(before, behind), (before, beyond), (far, behind)] {
            if one.dot(other) > 0.0 {
                peak = peak.max(0.5 * one.length().min(other.length()));
            }
        }
        radius += peak;
        let line = self.line_off(centre);
        // A function that jumps across the ball has 3/4 of its mean square in the line.
        (centre, radius.max(line * (4.0 / 3.0_f64).sqrt()))
    }

    /// Returns `|h'' - z|` in mean square.
    fn line_off(&self, centre: Vector) -> Real {
        let [t, u] = self.slopes;
        let lean = (t + u).length_squared() * 3.0 / (self.length * self.length);
        ((self.bends()[0] - centre).length_squared() + lean).sqrt()
    }

    /// Returns the bounds on the curve, or the turn if it may exceed the limit of the derivation.
    ///
    /// `is_section`: whether the segment is a section of its own.
    pub(super) fn bound(
        &self,
        (centre, radius): (Vector, Real),
        is_section: bool,
        rounding: Real,
    ) -> Result<SegmentBounds, Real> {
        let longest = self.chord_length * 1.06;
        let across = centre.length() + radius;
        let turn = across * longest;
        // If a direction leads backwards, its part across the chord determines nothing.
        if let Some(back) = self.tangents.iter().find(|tangent| tangent.dot(self.chord) <= 0.0) {
            return Err(libm::acos(back.dot(self.chord).max(-1.0)));
        }
        // Written so that NaN is too much.
        if turn.is_nan() || turn >= 0.9 {
            return Err(turn);
        }
        let curvature = across * (1.0 + 0.25 * turn * turn);
        let radius = radius + curvature * turn * turn / 16.0;
        let one_way = if is_section {
            // Rounding of the chord's ends turns the chord.
            let shown =
                (self.slopes[0] + self.slopes[1]).length() + 4.0 * rounding / self.chord_length;
            4.6 * shown / self.chord_length + 0.47 * curvature * turn * turn
        } else {
            Real::INFINITY
        };
        Ok(self.known(&BendModel { centre, radius, curvature, one_way, tilts: [0.0; 2] }, rounding))
    }

    /// Returns the bounds on a curve of curvature at most `curvature`, if the directions at its
    /// ends may be off by `tilts`. `None` if it may turn too far, or if a direction is too
    /// uncertain or leads backwards.
    pub(super) fn bound_bend(
        &self,
        curvature: Real,
        tilts: [Real; 2],
        rounding: Real,
    ) -> Option<SegmentBounds> {
        let is_ahead = |tangent: &Vector| tangent.dot(self.chord) > 0.0;
        let turn = curvature * self.chord_length * 1.06;
        let may = turn < 0.9 && tilts[0].max(tilts[1]) < 0.1 && self.tangents.iter().all(is_ahead);
        let bends = BendModel {
            centre: Vector::ZERO,
            radius: curvature,
            curvature,
            one_way: Real::INFINITY,
            tilts,
        };
        may.then(|| self.known(&bends, rounding))
    }

    fn known(&self, bends: &BendModel, rounding: Real) -> SegmentBounds {
        let BendModel { centre, radius, curvature, one_way, tilts } = *bends;
        let (tilt, all_tilts) = (tilts[0].max(tilts[1]), tilts[0] + tilts[1]);
        let longest = self.chord_length * 1.06;
        let off = 0.5 * curvature * longest + 1.2 * tilt;
        let (tangent, cosine) = (libm::tan(off), libm::cos(off));
        let [t, u] = self.slopes.map(Vector::length);
        // Of two lengths between the chord's and an arc's. The cubic's slopes may be larger by the
        // tilts.
        let bend = curvature * self.chord_length + 2.0 * tilt;
        let mut stretched = self.chord_length * bend * bend / 20.0;
        let mut uneven = 0.0;
        let along = |uneven: Real| tangent * longest * (longest * uneven / TAU + tilt);
        for _ in 0..3 {
            let share = stretched / self.chord_length;
            let less = 3.5 * share * (t + u) / self.length + 2.0 * all_tilts / self.chord_length;
            let line = (self.line_off(centre) - less).max(0.0);
            uneven = ((radius - line) * (radius + line)).max(0.0).sqrt().min(one_way);
            stretched = stretched.min(along(uneven) / cosine);
        }
        let share = stretched / self.chord_length;
        let off = longest * longest * uneven / 13.85
            + along(uneven)
            + stretched * (1.0 + 4.0 / 27.0 * (t + u))
            + 4.0 / 27.0 * all_tilts * longest
            + self.gauss_error() * longest
            + rounding;
        SegmentBounds {
            bound: CurveBound { curvature, off },
            stretch: 1.0 + share + 8.0 * Real::UNIT_ROUNDOFF,
        }
    }

    /// Returns the number of parts: enough that their chords leave the curve by at most its
    /// uncertainty.
    pub(super) fn parts(&self, bound: CurveBound) -> u32 {
        let sagitta = bound.curvature * self.length * self.length / 8.0;
        // The conversion saturates; NaN becomes 0.
        ((2.0 * sagitta / bound.off).sqrt().ceil() as u32).clamp(1, MAX_PARTS)
    }

    /// Returns the points behind the start, multiplied by `unscale`.
    pub(super) fn points(
        &self,
        bound: CurveBound,
        end: Vector,
        unscale: Real,
    ) -> impl Iterator<Item = NextPoint> {
        let (arch, parts) = (*self, self.parts(bound));
        let mut along = 0.0;
        (1..=parts).map(move |k| {
            let [from, x] = [k - 1, k].map(|k| Real::from(k) / Real::from(parts));
            along += arch.length * arch.advance(from, x);
            let [t, u] = arch.slopes;
            let aside = (t * ((x - 2.0) * x + 1.0) + u * ((x - 1.0) * x)) * (x * arch.length);
            let point = if k == parts { end } else { arch.start + arch.chord * along + aside };
            NextPoint {
                point: point * unscale,
                length: arch.length / Real::from(parts) * unscale,
                bound: CurveBound {
                    curvature: bound.curvature / unscale,
                    off: bound.off * unscale,
                },
            }
        })
    }
}

/// The assumption about the curvature vectors across the chord.
#[derive(Clone, Copy)]
struct BendModel {
    /// The ball (z, w): their distance from z is at most w in mean square.
    centre: Vector,
    radius: Real,
    /// Upper bound on the curvature.
    curvature: Real,
    /// Another upper bound on v, their distance from the line in mean square.
    one_way: Real,
    /// Upper bounds on the errors of the directions at the ends.
    tilts: [Real; 2],
}

/// Bounds on the curve between two frames.
pub(super) struct SegmentBounds {
    pub bound: CurveBound,
    /// Upper bound on its length over the cubic's.
    pub stretch: Real,
}
