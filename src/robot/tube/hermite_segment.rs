//! What two frames show of the curve between them: points of the centreline with the directions
//! that it has there.
//!
//! Let c(s) be the curve between two frames, p with the direction t and q with the direction u, d
//! the direction of the chord from p to q and c its length; s runs from 0 to the curve's length l,
//! and x = s / l. Split c into its way X along the chord and y across it. As |c'| = 1, X' = sqrt(1
//! - |y'|^2).
//!
//! **What is seen.** y is 0 at both ends, and y' is T there and U, the parts of t and u across the
//! chord. So the mean of y'' is m = (U - T) / l; its mean weighted towards the start, by 2 (1 - x),
//! is a = -2 T / l, and towards the end b = 2 U / l.
//!
//! **What is assumed.** The curve is at most 6 hundredths longer than its chord. Seen across the
//! chord, its curvature vector y'' is at most |z| + w long, and in the mean of squares at most w
//! from z. That holds for all that stays within the ball around z of the radius w, which holds
//! - m, a and b;
//! - the means m of the segments before and behind in the section, turned with the chord: so the
//!   curvature may change evenly from one to the other, or jump at any place;
//! - at an end of the section, where one of the two is missing, m and as much again as the other
//!   one differs from it: the change goes on (a section of one segment takes its neighbours' means,
//!   and see below);
//! - where m changes the same way towards both sides, here or from one neighbour on, half of the
//!   smaller change more: at a peak of a curvature that changes evenly, its mean hides as much, at
//!   most.
//!
//! w is larger by k (k l)^2 / 16: a bend of constant size k that turns by k l is seen between k (1
//! - (k l)^2 / 8) and k across the chord, in the mean k (1 - (k l)^2 / 24) and in the mean of
//! squares k (k l)^2 / 26 from that.
//!
//! **How far it turns.** Let A = |z| + w. The mean of y' is 0, so y'(x) is l times the integral of
//! y'' with the weight x up to there and -(1 - x) behind, which is at most l A (x^2 + (1 - x)^2) /
//! 2 <= l A / 2. So no direction is farther from d than f with sin f = A l / 2, and the curvature k
//! is at most A / cos f. With A l < 0.9 that is less than A (1 + (A l)^2 / 4), and the mean of
//! |y'|^2 is at most 7/60 (A l)^2, so that the curve is indeed at most 1.06 times as long as c.
//!
//! **What follows.** Let h be the cubic with the same ends and slopes as y, over the same length.
//! Its second derivative is the straight line that comes next to y'' in the mean of squares: h''
//! and y'' - h'' are orthogonal, and so are h'' - z and y'' - h''. With the mean of squares written
//! |.|^2,
//!
//! |y'' - h''|^2 = |y'' - z|^2 - |h'' - z|^2 <= w^2 - |h'' - z|^2 =: v^2, |h'' - z|^2 = |m - z|^2 + 3 |T + U|^2 / l^2.
//!
//! (Where the line is farther from z than what is in a ball can be, w is larger.)
//!
//! **A section of one segment.** Its neighbours are other tubes. They tell how large its bend may
//! be, but not how it changes. It is taken to change one way, evenly or in jumps: let its changes c
//! at the places p all be within 60 degrees of one direction. A jump by c at p moves the curve from
//! the cubic by l^2 |c| f(x, p), f = x^2 (1 - p) |1 - 3 p + 2 p x| / 2 for x <= p, and as much on
//! the other side seen from there. That is p (1 - p) times 4/27 at most, and f' is in the mean of
//! squares p (1 - p) times sqrt(2 / 15): both factors are largest for a jump at an end. And each
//! jump shows: (T + U) / l = m - a is the sum of all c p (1 - p), so it is at least half as long as
//! the sum of all |c| p (1 - p). Hence |r| <= 8/27 l |T + U|, and r' is in the mean of squares at
//! most 2 sqrt(2 / 15) |T + U|. Both hold with v = 4.6 |T + U| / l in what follows. Across the
//! chord a bend k is seen as k cos q, where q <= k l / 2. What is missing of k is at most E = k (k
//! l)^2 / 8. It shows as E / sqrt(3) at most (|1 - 2 x| is that in the mean of squares), and moves
//! the curve by what E does in the mean of squares: v is larger by 4.6 E / sqrt(3) + E < 0.47 k (k
//! l)^2. (Here A l stands for k l, and q <= f is what is used: as the bound on k is A / cos f or
//! more, that is enough up to A l = 0.9.)
//!
//! r = y - h has no value and no slope at both ends. A beam that is clamped at both ends gives way
//! most in the middle, by l^3 / 192 of a load: |r(s)| <= sqrt(l^3 / 192) (integral of
//! |r''|^2)^(1/2) <= l^2 v / 13.85. And r' is 0 at both ends and in the mean: in the mean of
//! squares |r'| <= l v / 2 pi (its lowest sine has the frequency 2 pi / l).
//!
//! **Along the chord.** Two slopes of at most sin f, p and q, differ in X' by at most |p - q| tan
//! f. y' is one, and h' too: h' = (1 - x)(1 - 3 x) T + x (3 x - 2) U, whose factors add up to 1 at
//! most. So X is known to l tan f l v / 2 pi, and l to as much over cos f: X(l) = c.
//!
//! The cubic is taken over the length l' whose X is c: l' = c / mean of sqrt(1 - |h'|^2), where h'
//! as a function of x does not depend on l'. For another l the cubic is longer by the same factor:
//! at most 4/27 (|T| + |U|) |l - l'| aside. As for v, m and T / l change by the factor |l - l'| /
//! l. Both lengths are at least c, and as y' and h' are small in the mean, at most c (1 + (k c)^2 /
//! 20).

use super::curve::{CurveBound, NextPoint};
use super::segment::Segment;
use crate::distance::Scalar;
use parry3d_f64::math::{Real, Rotation, Vector};
use std::f64::consts::TAU;

/// A segment is laid in no more parts.
pub(super) const MAX_PARTS: u32 = 16;

/// The places and weights of Gauss's rule with four points, between -1 and 1.
const GAUSS: [[Real; 2]; 4] = [
    [-0.861_136_311_594_052_6, 0.347_854_845_137_453_85],
    [-0.339_981_043_584_856_3, 0.652_145_154_862_546_2],
    [0.339_981_043_584_856_3, 0.652_145_154_862_546_2],
    [0.861_136_311_594_052_6, 0.347_854_845_137_453_85],
];

/// What two frames show.
#[derive(Clone, Copy)]
pub(super) struct HermiteSegment {
    /// The segment of the input.
    pub segment: u32,
    pub radius: Real,
    pub start: Vector,
    /// The directions at its ends.
    pub tangents: [Vector; 2],
    /// The chord's direction and length.
    chord: Vector,
    chord_length: Real,
    /// The parts of the tangents across the chord.
    slopes: [Vector; 2],
    /// The length of the curve, if it is the cubic.
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

    /// The end whose direction leads farther away from the chord.
    pub(super) fn sharper_end(&self) -> usize {
        let [first, last] = self.tangents.map(|tangent| tangent.dot(self.chord));
        usize::from(last < first)
    }

    /// The cubic's slope at a share of its length.
    fn slope(&self, x: Real) -> Vector {
        let [t, u] = self.slopes;
        t * ((3.0 * x - 4.0) * x + 1.0) + u * ((3.0 * x - 2.0) * x)
    }

    /// How far it gets along the chord between two shares, for a length of 1.
    fn advance(&self, from: Real, to: Real) -> Real {
        let half = 0.5 * (to - from);
        let at = |[place, weight]: [Real; 2]| {
            let slope = self.slope(from + half * (1.0 + place)).length_squared();
            weight * (1.0 - slope).max(0.0).sqrt()
        };
        half * GAUSS.into_iter().map(at).sum::<Real>()
    }

    /// How far [`advance`](Self::advance) may be off over the whole length, what is computed here
    /// included. The slope s is a square in x whose leading part is 3 (T + U), and Gauss's rule
    /// is exact up to x^7. So of sqrt(1 - s^2) = 1 - s^2 / 2 - s^4 / 8 - ... the third term
    /// leaves what its x^8 does, at most |T + U|^4 / 500, and all others less than (|T| + |U|)^6 /
    /// 1000: 40,000 pairs of slopes of every kind err by less than a fifth of that.
    fn gauss_error(&self) -> Real {
        let [t, u] = self.slopes;
        let (lean, all) = ((t + u).length_squared(), t.length() + u.length());
        2e-3 * lean * lean + 1e-3 * (all * all) * (all * all) * (all * all) + 2.0_f64.powi(-40)
    }

    /// The mean of the bends, and the two that lean to the ends.
    fn bends(&self) -> [Vector; 3] {
        let [t, u] = self.slopes;
        [(u - t) / self.length, t * (-2.0 / self.length), u * (2.0 / self.length)]
    }

    /// The mean of the bends as it is seen across another chord.
    fn bend_for(&self, other: &Self) -> Vector {
        Rotation::from_rotation_arc(self.chord, other.chord) * self.bends()[0]
    }

    /// The centre of the ball of bends and its radius, from the neighbours within the section, and
    /// those next to them.
    pub(super) fn ball(&self, neighbours: [[Option<&Self>; 2]; 2]) -> (Vector, Real) {
        let [mean, first, last] = self.bends();
        let mut seen = [mean, first, last, mean, mean];
        let mut seen_beside = [None; 2];
        // From the mean to the neighbours', and from there on: by how much bends change towards
        // either end.
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
            // At an end the change goes on.
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
        // What jumps from one side of the ball to the other has 3/4 of its squares in the line.
        (centre, radius.max(line * (4.0 / 3.0_f64).sqrt()))
    }

    /// How far the line of the cubic's bends is from a centre, in the mean of squares.
    fn line_off(&self, centre: Vector) -> Real {
        let [t, u] = self.slopes;
        let lean = (t + u).length_squared() * 3.0 / (self.length * self.length);
        ((self.bends()[0] - centre).length_squared() + lean).sqrt()
    }

    /// What is known of the curve, which may be a section of one segment; none if it may turn by
    /// more than 1 rad.
    pub(super) fn bound(
        &self,
        (centre, radius): (Vector, Real),
        is_section: bool,
        rounding: Real,
    ) -> Result<SegmentBounds, Real> {
        let longest = self.chord_length * 1.06;
        let across = centre.length() + radius;
        let turn = across * longest;
        // Where a direction leads back, its part across the chord tells nothing.
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
            // A chord is turned by what rounding does to its ends.
            let shown =
                (self.slopes[0] + self.slopes[1]).length() + 4.0 * rounding / self.chord_length;
            4.6 * shown / self.chord_length + 0.47 * curvature * turn * turn
        } else {
            Real::INFINITY
        };
        Ok(self.known(&BendModel { centre, radius, curvature, one_way, tilts: [0.0; 2] }, rounding))
    }

    /// What is known of a curve that bends by `curvature` at most, if the directions at its ends
    /// may be off by `tilts`; none if it may turn by too much, or a direction is off by too
    /// much or leads back.
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
        // Of two lengths between that of the chord and that of an arc; the cubic's slopes may be
        // larger by what the directions are off.
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

    /// In how many parts it is laid: so many that their chords leave the curve by no more than it
    /// is off anyway.
    pub(super) fn parts(&self, bound: CurveBound) -> u32 {
        let sagitta = bound.curvature * self.length * self.length / 8.0;
        // A number out of range becomes the nearest that is in it, and NaN becomes 0.
        ((2.0 * sagitta / bound.off).sqrt().ceil() as u32).clamp(1, MAX_PARTS)
    }

    /// The points behind its start.
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

/// What is assumed of the curvature vectors between two frames, seen across the chord.
#[derive(Clone, Copy)]
struct BendModel {
    /// In the mean of squares they are so far from a centre at most.
    centre: Vector,
    radius: Real,
    /// The curvature is at most this.
    curvature: Real,
    /// How far they are from a line at most, in the mean of squares, as far as that is known
    /// otherwise.
    one_way: Real,
    /// How far the directions at the ends may be off.
    tilts: [Real; 2],
}

/// What is known of the curve between two frames.
pub(super) struct SegmentBounds {
    pub bound: CurveBound,
    /// So many times as long as the cubic it is at most.
    pub stretch: Real,
}
