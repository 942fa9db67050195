//! A section under construction, sample by sample.

use super::curve_bound::CurveBound;
use super::sample_clusters::SampleCluster;
use super::section::{Section, stretch};
use super::section_samples::{Bend, Hat, SectionSamples};
use super::segment::{Segment, curvature_between, curvature_from};
use crate::robot::is_same;
use parry3d_f64::math::{Real, Vector};

/// All samples so far.
pub(super) struct SamplePrefix<'a> {
    pub points: &'a [Vector],
    /// The length of the polyline up to each sample.
    pub arcs: &'a [Real],
    /// The clusters.
    pub clusters: &'a [SampleCluster],
}

/// A section under construction.
pub(super) struct OpenSection {
    pub section: Section,
    longest: Real,
    /// The sample before the longest segment.
    longest_from: usize,
    /// The sample at which it turns most.
    sharpest: usize,
    /// Whether one of two neighbouring segments is more than four times as long as the other.
    is_uneven: bool,
    /// The largest relative amount by which a segment may be longer.
    loosest: Real,
    /// The number of turns at inner samples.
    turns: usize,
    /// The curvature that the turns at steps in radius show.
    pub at_ends: Real,
    /// The tangents of the curve at its ends, where given.
    tangents: [Option<Vector>; 2],
    /// The radii of the first and of the thinnest segment.
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

    /// Begins behind a step in radius, at which the samples show the curvature `shown`.
    pub(super) fn behind_step(first: usize, start: Real, radius: Real, shown: Real) -> Self {
        Self { at_ends: shown, ..Self::new(first, start, radius) }
    }

    /// Returns whether a segment with this radius belongs to the section; if so, records the
    /// radius.
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

    /// Records the turn at a sample.
    #[inline(always)]
    pub(super) fn bend(&mut self, at: usize, before: &Segment, segment: &Segment) {
        self.turns += 1;
        self.is_uneven |= segment.is_uneven(before);
        let squared = (segment.direction - before.direction).length_squared();
        let noise = segment.noise + before.noise;
        // Most turns do not raise the maximum. This test needs no root and no division.
        let known = self.section.curvature * (0.5 * (segment.least + before.least)) - noise;
        if known < 0.0 || squared > known * known {
            self.raise(at, curvature_between(before, segment));
        }
    }

    /// Records the tangent at an end.
    pub(super) fn bend_from(&mut self, at: usize, end: usize, tangent: Vector, segment: &Segment) {
        self.tangents[end] = Some(tangent);
        self.raise(at, curvature_from(tangent, segment));
    }

    /// Records a segment that leads to a sample.
    #[inline(always)]
    pub(super) fn extend(&mut self, to: usize, segment: &Segment) {
        if segment.length > self.longest {
            (self.longest, self.longest_from) = (segment.length, to - 1);
        }
        if segment.least < segment.length {
            self.loosest = self.loosest.max(segment.looseness());
            // The bends of clusters count next to them only.
            self.is_uneven = true;
        }
    }

    fn raise(&mut self, at: usize, curvature: Real) {
        if curvature > self.section.curvature {
            (self.section.curvature, self.sharpest) = (curvature, at);
        }
    }

    /// Ends the section at a sample and appends its segments' bounds to `bounds`, if any.
    ///
    /// Also returns a sample that shows more than others because another one is very near.
    ///
    /// # Errors
    /// The curve may turn by more than 1 rad in a segment.
    pub(super) fn close(
        mut self,
        last: usize,
        rounding: Real,
        so_far: &SamplePrefix,
        hats: &mut Vec<Hat>,
        bounds: &mut Vec<CurveBound>,
    ) -> Result<(Section, Option<usize>), Bend> {
        let SamplePrefix { points, arcs, clusters } = *so_far;
        let first = self.section.first as usize;
        (self.section.last, self.section.end) = (last as u32, arcs[last]);
        let own = SectionSamples {
            points: &points[first..=last],
            arcs: &arcs[first..=last],
            tangents: self.tangents,
            radius: self.section.radius,
            rounding,
            first,
            clusters,
        };
        let (mut sharpest, mut dense_sample) = (None, None);
        if self.is_uneven {
            bounds.resize(first, CurveBound::default());
            let least = if self.turns < 2 { self.at_ends } else { 0.0 };
            (sharpest, dense_sample) = own.bound_unevenly(least, hats, bounds);
            self.section.bound_by(&bounds[first..], &arcs[first..=last]);
            if self.loosest > 0.0 {
                // The true chords may be longer by this share, and their turn with them, squared.
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
            None => Ok((self.section, dense_sample.map(|sample| first + sample))),
        }
    }
}
