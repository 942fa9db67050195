//! Long segments between short ones. Close samples determine the direction of the curve there, and
//! so bound the curve in the long segment between them.
//!
//! At a sample the curve has the direction of the short segment beside it, up to half of that
//! segment's largest bend. So a long segment lies between two frames whose directions are known up
//! to the errors p and q. It is laid as the cubic of `hermite_segment`.
//!
//! # Definitions
//! As in `hermite_segment`. The assumption is still that the curvature is at most k. So
//! `|y''| <= k`, and the ball has centre 0 and radius k.
//!
//! # Claims
//! 1. The line h'' is in mean square at least as large as it appears, minus `2 (p + q) / l`.
//!    **Proof.** m is off by at most `(p + q) / l`, and so is `(T + U) / l`.
//! 2. The true cubic leaves the laid one by at most `4/27 (p + q) l`. **Proof.** This is the
//!    maximum of its factors `x (1 - x)^2 l` and `x^2 (1 - x) l`.
//! 3. X is off by `tan f l` times the larger of p and q in addition. **Proof.** The factors of T
//!    and U add up to at most 1. So the slopes of the two cubics differ by at most the larger of p
//!    and q. Here f must bound the angles of the cubic too: `sin f + q <= sin(f + 1.2 q)`, as
//!    `f + 1.2 q < 0.58`, whose cosine exceeds 1 / 1.2.
//! 4. The cubic is longer than c by at most `c (k c + 2 q)^2 / 20`. **Proof.** Its slopes are at
//!    most `k l / 2 + q`, so `k c + 2 q` replaces `k c` in the bound of `hermite_segment`.
//!
//! # Rounding
//! Points may be off by rounding, and merged samples by their distance. This turns chords and is
//! included in the errors of all three directions. The errors of the points themselves are counted
//! elsewhere.
//!
//! # When
//! A segment is laid as a cubic if the cubic's uncertainty is less than half of the chord's. Arc
//! lengths are still the chords' lengths, so a share of a section is the same place either way.

use super::Tube;
use super::centreline::{Curve, NextPoint, Samples};
use super::curve_bound::CurveBound;
use super::hermite_segment::{HermiteSegment, MAX_PARTS};
use super::section::Section;
use super::segment::Segment;
use crate::distance::Scalar;
use parry3d_f64::math::{Real, Vector};

/// Each of the two segments beside a long one is shorter than this share of it.
const SHORT: Real = 0.5;

/// The samples of a tube and the further knowledge of the curve through them.
struct SampledCurve<'a> {
    tube: &'a Tube,
    samples: &'a Samples,
    /// The tangents of the curve at its ends, where given.
    tangents: Option<[Vector; 2]>,
    /// Upper bound on the sum of the errors of a segment's two ends.
    off: Real,
    /// A power of two that scales the points near 1, where squares neither overflow nor underflow.
    scale: Real,
}

/// A long segment as a cubic.
struct LongSegment {
    arch: HermiteSegment,
    bound: CurveBound,
}

impl SampledCurve<'_> {
    fn segment(&self, from: usize) -> Option<Segment> {
        let points = &self.samples.points;
        Segment::between(*points.get(from)?, *points.get(from + 1)?, self.off)
    }

    /// Returns the direction at an end of a segment and its uncertainty: from the segment `beside`
    /// it, if that is shorter than `most`, or from the tangent at an end of the curve.
    fn direction(&self, end: usize, beside: Option<usize>, most: Real) -> Option<(Vector, Real)> {
        let Some(beside) = beside.filter(|&beside| beside + 1 < self.samples.points.len()) else {
            return self.tangents.map(|tangents| (tangents[end], 4.0 * Real::UNIT_ROUNDOFF));
        };
        let segment = self.segment(beside)?;
        let tick = beside as u32;
        let sections = &self.tube.sections;
        let section = sections.get(sections.partition_point(|section| section.last <= tick))?;
        let curvature = self.tube.curve.bound(section, [tick, tick + 1]).curvature;
        let tilt = 0.5 * curvature * segment.length * section.stretch + 4.0 * segment.noise;
        (segment.length < most).then_some((segment.direction, tilt))
    }

    /// Returns a segment as a cubic, if the cubic is known better than the chord.
    fn long(&self, from: usize, radius: Real) -> Option<LongSegment> {
        let scale = self.scale;
        let chord = self.segment(from)?;
        let most = SHORT * chord.length;
        let before = self.direction(0, from.checked_sub(1), most)?;
        let behind = self.direction(1, Some(from + 1), most)?;
        let ends = [from, from + 1].map(|k| self.samples.points[k] * scale);
        let number = self.samples.segments[from];
        let arch =
            HermiteSegment::between(number, radius, ends, [before.0, behind.0], self.off * scale)?;
        let curvature = self.samples.bounds[from].curvature / scale;
        // The chord of the two points is uncertain as well.
        let tilts = [before, behind].map(|(_, tilt)| tilt + 2.0 * chord.noise);
        let found = arch.bound_bend(curvature, tilts, self.off * scale)?;
        let length = chord.length * scale;
        let is_better = found.bound.off < 0.5 * curvature * length * length / 8.0;
        is_better.then_some(LongSegment { arch, bound: found.bound })
    }
}

impl Tube {
    /// Lays the long segments of uneven sections as cubics where that is better. Overwrites
    /// `buffer`.
    pub(super) fn lay_long_segments(&mut self, tangents: Option<[Vector; 2]>) {
        let Curve::Samples(samples) = &mut self.curve else { return };
        if samples.bounds.is_empty() {
            return;
        }
        // Reserve for the most parts in both buffers: later calls then allocate nothing, for any
        // number of cubics.
        let most = 1 + MAX_PARTS as usize * (samples.points.len() - 1);
        let mut new_samples = std::mem::take(&mut self.buffer.0).into_samples();
        samples.reserve(most);
        new_samples.reserve(most);
        let mut sections = std::mem::take(&mut self.buffer.1);
        let is_built = self.with_long_segments(tangents, &mut new_samples, &mut sections);
        self.buffer = (Curve::Samples(new_samples), sections);
        if is_built {
            self.exchange();
            let Curve::Samples(samples) = &self.curve else { return };
            let points = samples.points.iter();
            self.reach =
                points.fold(self.reach, |reach, point| point.abs().max_element().max(reach));
        }
    }

    /// Writes the samples and sections with cubics for long segments. Returns whether there is one.
    fn with_long_segments(
        &self,
        tangents: Option<[Vector; 2]>,
        new_samples: &mut Samples,
        sections: &mut Vec<Section>,
    ) -> bool {
        let Curve::Samples(samples) = &self.curve else { return false };
        let Samples { points, arcs, segments, bounds } = samples;
        let off = 4.0 * Real::UNIT_ROUNDOFF * self.reach + 2.0 * self.merged;
        let scale = self.reach.power_of_two_to_unity();
        let curve = SampledCurve { tube: self, samples, tangents, off, scale };
        new_samples.clear();
        sections.clear();
        new_samples.points.push(points[0]);
        new_samples.arcs.push(0.0);
        let mut is_built = false;
        for section in &self.sections {
            let first = new_samples.points.len() as u32 - 1;
            for from in section.first as usize..section.last as usize {
                let long = if section.is_even { None } else { curve.long(from, section.radius) };
                let (number, point) = (segments[from], points[from + 1]);
                let length = arcs[from + 1] - arcs[from];
                if let Some(LongSegment { arch, bound }) = long {
                    is_built = true;
                    let length = length / Real::from(arch.parts(bound));
                    for next in arch.points(bound, point * scale, 1.0 / scale) {
                        new_samples.push(number, NextPoint { length, ..next });
                    }
                } else {
                    new_samples.push(number, NextPoint { point, length, bound: bounds[from] });
                }
                // Without the rounding of a sum of parts.
                if let Some(end) = new_samples.arcs.last_mut() {
                    *end = arcs[from + 1];
                }
            }
            sections.push(Section { first, last: new_samples.points.len() as u32 - 1, ..*section });
        }
        new_samples.segments.push(segments.last().copied().unwrap_or(0));
        new_samples.bounds.push(CurveBound::default());
        is_built
    }
}
