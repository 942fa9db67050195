//! A section on its way from sample to sample.

use super::curve::CurveBound;
use super::sample_clusters::SampleCluster;
use super::section::{Section, stretch};
use super::section_samples::{Bend, Hat, SectionSamples};
use super::segment::{Segment, curvature_between, curvature_from};
use crate::robot::radius_steps::is_same;
use parry3d_f64::math::{Real, Vector};

/// All samples so far.
pub(super) struct SamplePrefix<'a> {
    pub points: &'a [Vector],
    /// The length of the polyline up to each of them.
    pub arcs: &'a [Real],
    /// Those that crowd.
    pub crowds: &'a [SampleCluster],
}

/// A section on its way.
pub(super) struct OpenSection {
    pub section: Section,
    longest: Real,
    /// The sample before its longest segment.
    longest_from: usize,
    /// The sample where it turns most.
    sharpest: usize,
    /// Whether one of two neighbouring segments is more than four times as long as the other.
    is_uneven: bool,
    /// The largest share of a segment by which it may be longer.
    loosest: Real,
    /// How many turns it has inside.
    turns: usize,
    /// The curvature that the turns at steps in radius show.
    pub at_ends: Real,
    /// The directions of the curve at its ends, where they are given.
    tangents: [Option<Vector>; 2],
    /// The radii of its first and of its thinnest segment.
    first_radius: Real,
    pub least_radius: Real,
}

impl OpenSection {
    pub(super) fn new(first: usize, start: Real, radius: Real) -> Self {
        let section = Section::beginning(first, start, radius);
        let [first_radius, least_radius] = [radius; 2];
        Self {
            section,
            longest: 0.0,
            longest_from: first,
            sharpest: first,
            is_uneven: false,
            loosest: 0.0,
            turns: 0,
            at_ends: 0.0,
            tangents: [None; 2],
            first_radius,
            least_radius,
        }
    }

    /// Behind a step in radius, at which the samples show a curvature.
    pub(super) fn behind_step(first: usize, start: Real, radius: Real, shown: Real) -> Self {
        Self { at_ends: shown, ..Self::new(first, start, radius) }
    }

    /// Whether a segment with this radius belongs to it; then takes note of the radius.
    #[inline(always)]
    pub(super) fn takes(&mut self, radius: Real) -> bool {
        if radius == self.first_radius {
            return true;
        }
        let is_same = is_same(self.first_radius, radius);
        if is_same {
            self.section.radius = self.section.radius.max(radius);
            self.least_radius = self.least_radius.min(radius);
        }
        is_same
    }

    /// Takes note of the turn at a sample from one segment to the next.
    #[inline(always)]
    pub(super) fn bend(&mut self, at: usize, before: &Segment, segment: &Segment) {
        self.turns += 1;
        self.is_uneven |= segment.is_uneven(before);
        let squared = (segment.direction - before.direction).length_squared();
        let noise = segment.noise + before.noise;
        // Most turns are no larger than the largest so far, which is seen without a root and a
        // division.
        let known = self.section.curvature * (0.5 * (segment.least + before.least)) - noise;
        if known < 0.0 || squared > known * known {
            self.raise(at, curvature_between(before, segment));
        }
    }

    /// Takes note of the direction at an end.
    pub(super) fn bend_from(&mut self, at: usize, end: usize, tangent: Vector, segment: &Segment) {
        self.tangents[end] = Some(tangent);
        self.raise(at, curvature_from(tangent, segment));
    }

    /// Takes note of a segment that leads to a sample.
    #[inline(always)]
    pub(super) fn extend(&mut self, to: usize, segment: &Segment) {
        if segment.length > self.longest {
            (self.longest, self.longest_from) = (segment.length, to - 1);
        }
        if segment.least < segment.length {
            self.loosest = self.loosest.max(segment.looseness());
            // What those that crowd show counts only beside them.
            self.is_uneven = true;
        }
    }

    fn raise(&mut self, at: usize, curvature: Real) {
        if curvature > self.section.curvature {
            (self.section.curvature, self.sharpest) = (curvature, at);
        }
    }

    /// Ends it at a sample. `bounds` are those of the segments, if any. A sample is returned as
    /// well that shows more than others because another one is very near, if there is one.
    pub(super) fn close(
        mut self,
        last: usize,
        rounding: Real,
        so_far: &SamplePrefix,
        hats: &mut Vec<Hat>,
        bounds: &mut Vec<CurveBound>,
    ) -> Result<(Section, Option<usize>), Bend> {
        let SamplePrefix { points, arcs, crowds } = *so_far;
        let first = self.section.first as usize;
        (self.section.last, self.section.end) = (last as u32, arcs[last]);
        let own = SectionSamples {
            points: &points[first..=last],
            arcs: &arcs[first..=last],
            tangents: self.tangents,
            radius: self.section.radius,
            rounding,
            first,
            crowds,
        };
        let (mut sharpest, mut crowding) = (None, None);
        if self.is_uneven {
            bounds.resize(first, CurveBound::default());
            let least = if self.turns < 2 { self.at_ends } else { 0.0 };
            (sharpest, crowding) = own.bound_unevenly(least, hats, bounds);
            self.section.bound_by(&bounds[first..], &arcs[first..=last]);
            if self.loosest > 0.0 {
                // The chords are longer by that share, and what they turn by is, in the square.
                let longer = 1.0 + self.loosest;
                self.section.stretch *= longer * longer * longer;
            }
        } else {
            let shown = if self.turns > 0 {
                own.between_samples(self.sharpest - first, self.section.curvature)
            } else {
                0.0
            };
            let section = &mut self.section;
            section.shown_at = [section.curvature; 2];
            section.curvature = section.curvature.max(shown);
            if self.turns < 2 {
                section.curvature = section.curvature.max(self.at_ends);
            }
            let bend = section.curvature * self.longest;
            section.mean_curvature = section.curvature;
            section.curvature_at = [section.curvature; 2];
            section.stretch = stretch(bend);
            if bend > 1.0 {
                sharpest = Some(Bend {
                    at: self.sharpest - first,
                    from: self.longest_from - first,
                    turn: bend,
                });
            }
        }
        match sharpest {
            Some(Bend { at, from, turn }) => Err(Bend { at: first + at, from: first + from, turn }),
            None => Ok((self.section, crowding.map(|sample| first + sample))),
        }
    }
}
