//! Long segments between short ones: samples that lie close together tell which way the curve goes
//! there, and so where it is in the long segment between them.
//!
//! At a sample the curve goes in the direction of the short segment beside it, but for half of what
//! that bends at most. So a long segment is one between two frames whose directions are known to
//! the errors p and q. It is laid as the cubic of `hermite_segment`, whose letters are used here.
//! What is assumed stays what it was, that the curvature is nowhere more than k. So |y''| <= k, and
//! of the ball in `hermite_segment` the centre is 0 and the radius k.
//!
//! - With T and U off by p and q, m is off by (p + q) / l and (T + U) / l as well. So the line h''
//!   is at least as large in the mean of squares as it seems, less 2 (p + q) / l.
//! - The true cubic leaves the one that is laid by 4/27 (p + q) l at most, the largest that its
//!   factors x (1 - x)^2 l and x^2 (1 - x) l are.
//! - Its slope leaves that of the other by the larger of p and q at most, as the factors of T and U
//!   add up to 1 or less. So X is off by tan f l times as much, where f is no angle of the curve
//!   only, but one of the cubic too: sin f + q <= sin(f + 1.2 q), as f + 1.2 q is less than 0.58,
//!   whose cosine is above 1 / 1.2.
//!
//! Points may be off by rounding, and where samples are one by what these are apart; that turns
//! chords, and is in the errors of all three directions. How far points are off themselves is
//! counted elsewhere.
//!
//! The cubic's length may differ from c by more than c (k c)^2 / 20: its slopes are as large as k l
//! / 2 + q. With k c + 2 q for k c that holds.
//!
//! It is done where the cubic leaves open less than half of what the chord does. Arc lengths stay
//! those of the chords: a share of a section is the same place whether a segment is laid so or not.

use super::Tube;
use super::curve::{Curve, CurveBound, NextPoint, Samples};
use super::hermite_segment::{HermiteSegment, MAX_PARTS};
use super::section::Section;
use super::segment::Segment;
use crate::distance::Scalar;
use parry3d_f64::math::{Real, Vector};

/// Each of the two segments beside a long one is shorter than this share of it.
const SHORT: Real = 0.5;

/// The samples of a tube, and what else is known of the curve through them.
struct SampledCurve<'a> {
    tube: &'a Tube,
    samples: &'a Samples,
    /// The directions of the curve at its ends, where they are given.
    tangents: Option<[Vector; 2]>,
    /// How far the ends of a segment may be off, together.
    off: Real,
    /// A power of two that brings all near to 1: squares of lengths neither overflow nor vanish
    /// then.
    scale: Real,
}

/// A long segment as an arch.
struct LongSegment {
    arch: HermiteSegment,
    bound: CurveBound,
}

impl SampledCurve<'_> {
    fn segment(&self, from: usize) -> Option<Segment> {
        let points = &self.samples.points;
        Segment::between(*points.get(from)?, *points.get(from + 1)?, self.off)
    }

    /// The direction at an end of the curve, or of a segment next to a sample that is shorter than
    /// `most`; and how far off it may be.
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

    /// A segment as an arch, if that tells more of it than its chord.
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
        // The chord is off as well, between the two.
        let tilts = [before, behind].map(|(_, tilt)| tilt + 2.0 * chord.noise);
        let found = arch.bound_bend(curvature, tilts, self.off * scale)?;
        let length = chord.length * scale;
        let is_better = found.bound.off < 0.5 * curvature * length * length / 8.0;
        is_better.then_some(LongSegment { arch, bound: found.bound })
    }
}

impl Tube {
    /// Lays the long segments of uneven sections as arches, where that tells more. The spare
    /// samples are lost.
    pub(super) fn lay_long_segments(&mut self, tangents: Option<[Vector; 2]>) {
        let Curve::Samples(samples) = &mut self.curve else { return };
        if samples.bounds.is_empty() {
            return;
        }
        // Either of the two is laid into one day. In a loop the memory is to last, however many
        // arches there will be.
        let most = 1 + MAX_PARTS as usize * (samples.points.len() - 1);
        let mut laid = std::mem::take(&mut self.spare.0).into_samples();
        samples.reserve(most);
        laid.reserve(most);
        let mut sections = std::mem::take(&mut self.spare.1);
        let is_laid = self.with_long_segments(tangents, &mut laid, &mut sections);
        self.spare = (Curve::Samples(laid), sections);
        if is_laid {
            self.exchange();
            let Curve::Samples(samples) = &self.curve else { return };
            let points = samples.points.iter();
            self.reach =
                points.fold(self.reach, |reach, point| point.abs().max_element().max(reach));
        }
    }

    /// The samples and sections with long segments laid as arches; whether there is one.
    fn with_long_segments(
        &self,
        tangents: Option<[Vector; 2]>,
        laid: &mut Samples,
        sections: &mut Vec<Section>,
    ) -> bool {
        let Curve::Samples(samples) = &self.curve else { return false };
        let Samples { points, arcs, segments, bounds } = samples;
        let off = 4.0 * Real::UNIT_ROUNDOFF * self.reach + 2.0 * self.merged;
        let scale = self.reach.power_of_two_to_unity();
        let curve = SampledCurve { tube: self, samples, tangents, off, scale };
        laid.clear();
        sections.clear();
        laid.points.push(points[0]);
        laid.arcs.push(0.0);
        let mut is_laid = false;
        for section in &self.sections {
            let first = laid.points.len() as u32 - 1;
            for from in section.first as usize..section.last as usize {
                let long = if section.is_even { None } else { curve.long(from, section.radius) };
                let (number, point) = (segments[from], points[from + 1]);
                let length = arcs[from + 1] - arcs[from];
                if let Some(LongSegment { arch, bound }) = long {
                    is_laid = true;
                    let length = length / Real::from(arch.parts(bound));
                    for next in arch.points(bound, point * scale, 1.0 / scale) {
                        laid.push(number, NextPoint { length, ..next });
                    }
                } else {
                    laid.push(number, NextPoint { point, length, bound: bounds[from] });
                }
                // Without what rounding does to a sum of parts.
                if let Some(end) = laid.arcs.last_mut() {
                    *end = arcs[from + 1];
                }
            }
            sections.push(Section { first, last: laid.points.len() as u32 - 1, ..*section });
        }
        laid.segments.push(segments.last().copied().unwrap_or(0));
        laid.bounds.push(CurveBound::default());
        is_laid
    }
}
