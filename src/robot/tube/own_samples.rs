//! How much a section may bend between its samples.
//!
//! A sample shows a bend: the turn between its two segments over half of their lengths together. That is a mean of the
//! curvature vector t', weighted by a hat over the two segments (for l1 and l2 long ones, and directions m1 and m2 as means
//! of t: m2 - m1 is the integral of w t', w rising to 1 at the sample and falling again, and (l1 + l2) / 2 is that of w).
//! The centre of a hat is (l2 - l1) / 3 behind its sample.
//!
//! **A curvature that changes evenly** is shown exactly at the hat's centre, but for two places: at a section's ends, beyond
//! the last centre, where the change goes on as far as the end; and at a peak, which lies up to two segments from the largest
//! bend and above it by no more than twice what bends fall by on its flatter side. Where that would be more than a
//! quarter of the bend at a peak, or half of it at an end, the change is not even, and no more is added.
//!
//! **A bend that turns about the curve**, as in a helix, by the angle q from one sample to the next: its mean over a hat
//! is less than the curvature k by q^2 / 12 of it. The differences of bends are about q k long; q^2 / 8 is added.
//!
//! **Uneven samples.** The turn at two samples that are close together is all noise. So a sample less than a quarter of the
//! usual distance (the geometric mean) behind the one before it counts only for its own two segments. Of the others, the two
//! before a segment and the two behind it count for the segment. So its curvature may jump anywhere: the hats of the outer
//! two end where the segment begins and where it ends, and show what is before the jump and what is behind it, if
//! there is no other jump under them. A peak in the segment is above one of the four by no more than is added.

use super::crowds::{Crowd, bend_at, gap_at};
use super::curve::CurveBound;
use super::segment::{Segment, curvature_between, curvature_from};
use crate::robot::RobotError;
use parry3d_f64::math::{Real, Vector};

/// Samples closer than this share of the usual distance to the one before count only for their own segments.
const CLOSE: Real = 0.25;

/// What a sample shows more than others counts where it turns a segment by more than this.
const SHARPER: Real = 1.0 / 64.0;

/// The samples of one section.
pub(super) struct OwnSamples<'a> {
    pub points: &'a [Vector],
    pub arcs: &'a [Real],
    /// The directions of the curve at its ends, where they are given.
    pub tangents: [Option<Vector>; 2],
    pub radius: Real,
    /// What rounding can do to a point.
    pub rounding: Real,
    /// The number of the first of them among all samples, and those that crowd.
    pub first: usize,
    pub crowds: &'a [Crowd],
    /// Samples closer than this to the one before are left out.
    pub shortest: Real,
}

/// A segment in which more turns than samples tell of.
pub(super) struct Bend {
    /// The sample whose turn says so.
    pub at: usize,
    /// The sample before the segment.
    pub from: usize,
    pub turn: Real,
}

impl Bend {
    /// `segments` are the segments of the input that begin at each sample.
    pub(super) fn error(&self, segments: &[u32]) -> RobotError {
        let index = if self.at > 0 { segments[self.at - 1] as usize + 1 } else { 0 };
        RobotError::TurnsTooSharply { index, after: segments[self.from] as usize, turn: self.turn }
    }
}

impl OwnSamples<'_> {
    fn last(&self) -> usize {
        self.points.len() - 1
    }

    fn is_kept(&self, sample: usize) -> bool {
        sample == 0 || self.arcs[sample] - self.arcs[sample - 1] >= self.shortest
    }

    fn behind(&self, sample: usize) -> Option<usize> {
        (sample + 1..=self.last()).find(|&sample| self.is_kept(sample))
    }

    fn before(&self, sample: usize) -> Option<usize> {
        (0..sample).rev().find(|&sample| self.is_kept(sample))
    }

    fn segment(&self, from: usize, to: usize) -> Option<Segment> {
        let gap = |sample: usize| gap_at(self.crowds, self.first + sample);
        let segment = Segment::between(self.points[from], self.points[to], self.rounding)?;
        Some(segment.with_gap(gap(from) + gap(to)))
    }

    /// By how much the bend that a sample shows may be off because samples crowd.
    fn doubt(&self, sample: usize) -> Real {
        if self.crowds.is_empty() {
            return 0.0;
        }
        let before = self.before(sample).and_then(|before| self.segment(before, sample));
        let behind = self.behind(sample).and_then(|behind| self.segment(sample, behind));
        let bend = self.bend(sample).map_or(0.0, |bend| bend.length());
        let sum = |of: fn(&Segment) -> Real| before.iter().chain(&behind).map(of).sum::<Real>();
        let gap = sum(|segment| segment.length - segment.least);
        (2.0 * sum(|segment| segment.noise) + bend * gap) / sum(|segment| segment.least)
    }

    /// The bend that a sample shows, as a vector; none at an end whose direction is not given.
    fn bend(&self, sample: usize) -> Option<Vector> {
        let before = self.before(sample).and_then(|before| self.segment(before, sample));
        let behind = self.behind(sample).and_then(|behind| self.segment(sample, behind));
        match (before, behind) {
            (Some(before), Some(behind)) => {
                Some((behind.direction - before.direction) / (0.5 * (before.length + behind.length)))
            }
            (None, Some(behind)) if sample == 0 => {
                self.tangents[0].map(|tangent| (behind.direction - tangent) / (0.5 * behind.length))
            }
            (Some(before), None) if sample == self.last() => {
                self.tangents[1].map(|tangent| (tangent - before.direction) / (0.5 * before.length))
            }
            _ => None,
        }
    }

    /// The neighbour that is kept, towards an end.
    fn next(&self, sample: usize, end: usize) -> Option<usize> {
        if end == 0 { self.before(sample) } else { self.behind(sample) }
    }

    /// The curvature between samples, if the largest bend that they show is `most`, at the sample `at`.
    pub(super) fn between_samples(&self, at: usize, most: Real) -> Real {
        self.at_end(0).max(self.at_end(1)).max(self.around(at, most))
    }

    /// The curvature around a sample that shows `most`, but for what is beyond an end.
    fn around(&self, at: usize, most: Real) -> Real {
        let mut curvature = most;
        let doubt = self.doubt(at);
        if let Some(here) = self.bend(at) {
            // By how much bends fall towards an end, and by how much they turn.
            let side = |end: usize| {
                let next = self.next(at, end)?;
                let bend = self.bend(next)?;
                let own = self.doubt(next);
                let fall = (here.length() - bend.length()).abs() + doubt + own;
                let next_fall = self.next(next, end).and_then(|beyond| {
                    let fall = (bend.length() - self.bend(beyond)?.length()).abs();
                    Some(fall + own + self.doubt(beyond))
                });
                let (apart, more) = (bend - here, doubt + own);
                let turned = apart.length_squared() + more * (2.0 * apart.length() + more);
                Some([next_fall.map_or(fall, |next_fall| fall.max(next_fall)), turned])
            };
            let [peak, turned] = match [side(0), side(1)] {
                [Some(one), Some(other)] => [one[0].min(other[0]), one[1].min(other[1])],
                // What is beyond the end is told below.
                [Some(one), None] | [None, Some(one)] => [0.0, one[1]],
                [None, None] => [0.0; 2],
            };
            let [least, size] = [here.length() - doubt, here.length() + doubt];
            if size > 0.0 {
                let hidden = if least > 0.0 { turned.min(size * least) / least } else { size };
                curvature += (2.0 * peak).min(0.25 * most) + hidden / 8.0;
            }
        }
        curvature
    }

    /// The curvature at an end, if it goes on changing as it does next to it.
    fn at_end(&self, end: usize) -> Real {
        let mut first = if end == 0 { 0 } else { self.last() };
        let mut outer = 0.0;
        if self.bend(first).is_none() {
            let Some(next) = self.next(first, end ^ 1) else { return 0.0 };
            outer = (self.points[next] - self.points[first]).length();
            first = next;
        }
        let second = self.next(first, end ^ 1);
        let (Some(bend), Some(next)) = (self.bend(first), second.and_then(|second| self.bend(second))) else {
            return 0.0;
        };
        let size = bend.length() + self.doubt(first);
        let length = |from: Option<usize>, to: Option<usize>| match (from, to) {
            (Some(from), Some(to)) => (self.points[to] - self.points[from]).length(),
            _ => 0.0,
        };
        let between = length(Some(first), second);
        let beyond = length(second, second.and_then(|second| self.next(second, end ^ 1)));
        // Of the centres of two hats, and from the first of them to the end.
        let apart = (outer + between + beyond) / 3.0;
        let to_end = if outer > 0.0 { (2.0 * outer + between) / 3.0 } else { between / 3.0 };
        let fall = size - next.length() + second.map_or(0.0, |second| self.doubt(second));
        let growth = fall * (to_end / apart);
        // Written so that NaN is no growth.
        if growth > 0.0 { size + growth.min(0.5 * size) } else { size }
    }

    /// Adds bounds of all segments. The sample at which the curve may turn too much between it and a neighbour is
    /// returned, if there is one; and one that shows more than others because another one is very near. The curve bends
    /// by `least` at least.
    pub(super) fn bound_unevenly(
        mut self,
        least: Real,
        bounds: &mut Vec<CurveBound>,
    ) -> (Option<Bend>, Option<usize>) {
        let last = self.last();
        let logarithms: Real = self.arcs.windows(2).map(|arcs| libm::log2(arcs[1] - arcs[0])).sum();
        self.shortest = CLOSE * libm::exp2(logarithms / last as Real);
        let noise = 2.0 * self.rounding / self.shortest;
        let shown = |sample: usize| {
            let bend = self.bend(sample).map_or(0.0, |bend| bend.length() + noise / self.shortest);
            bend + self.doubt(sample)
        };
        let most = (0..=last).filter(|&sample| self.is_kept(sample)).map(shown).fold(0.0, Real::max);
        let ends = [0, 1].map(|end| self.at_end(end));
        // Of a segment the two samples before it and the two behind it, as far as there are any, and what the four show.
        let around = |sample: Option<usize>| sample.map_or(0.0, |sample| self.around(sample, shown(sample)));
        let mut four = [None, None, Some(0), self.behind(0)];
        let mut bends = four.map(around);
        let segment = |from: usize| self.segment(from, from + 1);
        let own = |sample: usize| match sample {
            0 => self.tangents[0]
                .zip(segment(0))
                .map_or(0.0, |(tangent, first)| curvature_from(tangent, &first)),
            _ if sample == last => self.tangents[1]
                .zip(segment(last - 1))
                .map_or(0.0, |(tangent, segment)| curvature_from(tangent, &segment)),
            _ => segment(sample - 1)
                .zip(segment(sample))
                .map_or(0.0, |(before, behind)| curvature_between(&before, &behind)),
        };
        let longest_beside = |sample: usize| {
            let behind =
                if sample < last { segment(sample).map_or(0.0, |segment| segment.length) } else { 0.0 };
            sample.checked_sub(2).and_then(segment).map_or(behind, |before| before.length.max(behind))
        };
        let (mut sharpest, mut crowded) = (None, None);
        let mut before = own(0);
        for from in 0..last {
            let behind = own(from + 1);
            if self.is_kept(from) {
                let next = four[3].and_then(|sample| self.behind(sample));
                four = [four[1], four[2], four[3], next];
                bends = [bends[1], bends[2], bends[3], around(next)];
            }
            let at_ends =
                [four[0].is_none_or(|sample| sample == 0), four[3].is_none_or(|sample| sample == last)];
            let shown = [0, 1].map(|end| if at_ends[end] { ends[end] } else { 0.0 });
            let local = bends.into_iter().chain(shown).fold(least, Real::max);
            let curvature = local.max(before).max(behind);
            // For a curve that bends by more than 1 rad there, or within its radius, the tube would be refused.
            let through = bend_at(self.crowds, self.first + from, 1).max(bend_at(
                self.crowds,
                self.first + from + 1,
                0,
            ));
            let is_possible =
                through * (self.arcs[from + 1] - self.arcs[from]) <= 1.0 && through * self.radius < 1.0;
            let curvature = if is_possible { curvature.max(through) } else { curvature };
            bounds.push(CurveBound { curvature, off: 0.0 });
            let longest = segment(from).map_or(0.0, |segment| 2.0 * segment.length - segment.least);
            let turn = curvature * longest;
            if turn > 1.0 && sharpest.is_none() {
                let sharpest_of =
                    |one: usize, other: usize| if bends[other] > bends[one] { other } else { one };
                let at = four[[0, 2, 3].into_iter().fold(1, sharpest_of)].unwrap_or(from);
                let is_own = local <= before.max(behind);
                let sample = if is_own { from + usize::from(behind > before) } else { at };
                sharpest = Some(Bend { at: sample, from, turn });
            }
            before = behind;
            let crowding =
                if self.is_kept(from + 1) { None } else { Some((own(from).max(behind), from + 1)) };
            if let Some((bend, sample)) = crowding
                && crowded.is_none()
                && (bend - 1.25 * most) * longest_beside(sample) > SHARPER
            {
                crowded = Some(sample);
            }
        }
        (sharpest, crowded)
    }
}
