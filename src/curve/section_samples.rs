//! Upper bounds on the bend of a section between its samples.
//!
//! # Definitions
//! - Chain: samples in order, including the first and the last. The *whole* chain has all samples.
//!   The *wide* chain has no two samples closer than a quarter of the usual distance (their
//!   geometric mean).
//! - Hat of a sample: the range between its two neighbours in the chain. At an end with a given
//!   tangent it is the range to the only neighbour.
//! - `b`: the bend that a sample shows, the turn between its two segments over half of the sum of
//!   their lengths. At an end with a given tangent: the turn from the tangent over half of the
//!   segment's length.
//! - `e`: the error of b due to rounding of the samples.
//! - Counted bend of a sample in the whole chain: `b + min(e, b)`.
//! - `t`: the unit tangent. `k`: the curvature.
//!
//! # What a bend is
//! A bend is a mean of the curvature vector t', weighted by a hat. Let l1 and l2 be the lengths of
//! the two segments and m1 and m2 their directions as means of t. Then m2 - m1 is the integral of
//! `w t'`, where w rises to 1 at the sample and falls again, and `(l1 + l2) / 2` is the integral of
//! w. The centre of the hat is `(l2 - l1) / 3` behind its sample.
//!
//! # Corrections
//! 1. **Evenly changing curvature.** A bend is then the exact curvature at the hat's centre. Two
//!    places are not covered:
//!    - the ends of the section beyond the last centre: the change continues up to the end;
//!    - a peak: it lies up to two segments from the largest bend, and above it by at most twice the
//!      decrease of bends on its flatter side.
//!
//!    The correction is limited to a quarter of the bend at a peak and to half of it at an end:
//!    beyond that the change is not even.
//! 2. **A bend that turns about the curve**, as in a helix, by q per sample. Its mean over a hat is
//!    less than k by `q^2 / 12` of it. The differences of bends have the length `q k`; `q^2 / 8` is
//!    added.
//! 3. **Uneven samples.** Close samples show the bend at one place, but with noise, and they say
//!    little about its change farther on. So both chains are evaluated, and the larger curvature
//!    counts.
//!
//! # Claim
//! Let the curvature vector jump in a segment, and be constant on either side over a hat of one of
//! the two samples next to that side. Then the curvature in the segment is at most the largest
//! counted bend of the two samples before it and the two behind it, unless rounding hides more than
//! half of a bend.
//!
//! # Proof
//! 1. The hat is an arc of curvature k, in two parts that turn by x and y. Their chords have the
//!    lengths `(2 / k) sin(x / 2)` and `(2 / k) sin(y / 2)`, and enclose the angle `(x + y) / 2`.
//!    Without rounding the sample shows
//!    `b0 = 2 k sin((x + y) / 4) / (sin(x / 2) + sin(y / 2)) = k / cos((x - y) / 4) >= k`. With a
//!    tangent, `x = 0`.
//! 2. `|b - b0| <= e`. If `b >= e`, `b + e >= b0`. Otherwise `2 b >= b0` if `|b - b0| <= b0 / 2`.
//! 3. The curvature in the segment is the curvature of one side or of the other.
//!
//! # Details
//! - In the whole chain, the change of bends is evaluated only between hats whose two segments are
//!   about equally long, as in a section with even samples.
//! - A counted bend is at most 2 b, so samples that show rounding only cost at most what they show.
//!   For a sample's own two segments, b + e counts in full.
//! - In the wide chain, the noise of its closest samples counts.

use super::curve_bound::CurveBound;
use super::sample_clusters::{SampleCluster, bend_at, beyond_at, gap_at};
use super::segment::{Segment, curvature_between, curvature_from};
use crate::robot::RobotError;
use parry3d_f64::math::{Real, Vector};

/// Samples closer to the previous one than this share of the usual distance are not in the wide
/// chain.
const CLOSE: Real = 0.25;

/// A sample that shows more than the others is reported if it turns a segment by more than this.
const SHARPER: Real = 1.0 / 64.0;

/// The samples of one section.
pub(super) struct SectionSamples<'a> {
    pub points: &'a [Vector],
    pub arcs: &'a [Real],
    /// The tangents of the curve at its ends, where given.
    pub tangents: [Option<Vector>; 2],
    pub radius: Real,
    /// Upper bound on the rounding error of a point.
    pub rounding: Real,
    /// The index of the first of them among all samples, and the clusters.
    pub first: usize,
    pub clusters: &'a [SampleCluster],
}

/// A segment in which the curve may turn too far.
pub(super) struct Bend {
    /// The sample that shows it.
    pub at: usize,
    /// The sample before the segment.
    pub from: usize,
    pub turn: Real,
}

impl Bend {
    /// Returns the error. `segments` are the input segments that begin at each sample.
    pub(super) fn error(&self, segments: &[u32]) -> RobotError {
        let index = if self.at > 0 { segments[self.at - 1] as usize + 1 } else { 0 };
        RobotError::TurnsTooSharply { index, after: segments[self.from] as usize, turn: self.turn }
    }
}

/// The bend that a sample shows in a chain.
#[derive(Clone, Copy, Debug)]
pub(super) struct Hat {
    sample: usize,
    /// The bend as a vector; `None` at an end without a tangent.
    bend: Option<Vector>,
    /// Upper bound on the error of the bend due to clusters.
    bend_noise: Real,
    /// Whether the bend may be compared with its neighbours' (see **Details**).
    is_even: bool,
    /// The counted bend.
    shown: Real,
    /// The curvature around the sample, with corrections 1 and 2.
    around: Real,
}

/// A chain of samples whose hats are looked up or measured on demand.
struct Chain<F: Fn(usize) -> Hat> {
    count: usize,
    hat: F,
}

impl<F: Fn(usize) -> Hat> Chain<F> {
    /// Returns the next place in the chain towards an end.
    fn next(&self, place: usize, end: usize) -> Option<usize> {
        if end == 0 {
            place.checked_sub(1)
        } else {
            Some(place + 1).filter(|&next| next < self.count)
        }
    }

    /// Returns the curvature around a sample that shows `most`: corrections 1 (peak) and 2.
    fn around(&self, place: usize, most: Real) -> Real {
        let mut curvature = most;
        let Hat { bend, bend_noise, is_even, .. } = (self.hat)(place);
        if let Some(here) = bend.filter(|_| is_even) {
            // The decrease of bends towards an end, and how far they turn.
            let side = |end: usize| {
                let next = self.next(place, end)?;
                let Hat { bend, bend_noise: own, is_even, .. } = (self.hat)(next);
                let bend = bend.filter(|_| is_even)?;
                let fall = (here.length() - bend.length()).abs() + bend_noise + own;
                let next_fall = self.next(next, end).and_then(|beyond| {
                    let beyond = Some((self.hat)(beyond)).filter(|beyond| beyond.is_even)?;
                    let fall = (bend.length() - beyond.bend?.length()).abs();
                    Some(fall + own + beyond.bend_noise)
                });
                let (apart, more) = (bend - here, bend_noise + own);
                let turned = apart.length_squared() + more * (2.0 * apart.length() + more);
                Some([next_fall.map_or(fall, |next_fall| fall.max(next_fall)), turned])
            };
            let [peak, turned] = match [side(0), side(1)] {
                [Some(one), Some(other)] => [one[0].min(other[0]), one[1].min(other[1])],
                // `at_end` covers the part beyond the end.
                [Some(one), None] | [None, Some(one)] => [0.0, one[1]],
                [None, None] => [0.0; 2],
            };
            let [least, size] = [here.length() - bend_noise, here.length() + bend_noise];
            if size > 0.0 {
                let hidden = if least > 0.0 { turned.min(size * least) / least } else { size };
                curvature += (2.0 * peak).min(0.25 * most) + hidden / 8.0;
            }
        }
        curvature
    }

    /// Returns the curvature at an end if it continues to change: correction 1 (end).
    fn at_end(&self, end: usize, points: &[Vector]) -> Real {
        let end_of_chain = if end == 0 { 0 } else { self.count - 1 };
        let inwards = |place: usize| self.next(place, end ^ 1);
        let length = |from: Option<usize>, to: Option<usize>| match (from, to) {
            (Some(from), Some(to)) => {
                let [from, to] = [from, to].map(|place| points[(self.hat)(place).sample]);
                (to - from).length()
            }
            _ => 0.0,
        };
        let (mut first, mut outer) = (end_of_chain, 0.0);
        if (self.hat)(first).bend.is_none() {
            let Some(next) = inwards(first) else { return 0.0 };
            outer = length(Some(first), Some(next));
            first = next;
        }
        let Hat { bend: Some(bend), bend_noise, .. } = (self.hat)(first) else { return 0.0 };
        let size = bend.length() + bend_noise;
        let second = inwards(first);
        let Some((next, next_doubt)) = second.and_then(|second| {
            let next = Some((self.hat)(second)).filter(|next| next.is_even)?;
            Some((next.bend?, next.bend_noise))
        }) else {
            return size;
        };
        let between = length(Some(first), second);
        let beyond = length(second, second.and_then(inwards));
        // The distance between the centres of two hats, and from the first centre to the end.
        let apart = (outer + between + beyond) / 3.0;
        let to_end = if outer > 0.0 { (2.0 * outer + between) / 3.0 } else { between / 3.0 };
        let fall = size - next.length() + next_doubt;
        let increase = fall * (to_end / apart);
        // Written so that NaN is no growth.
        if increase > 0.0 { size + increase.min(0.5 * size) } else { size }
    }
}

/// Bounds from one chain, segment by segment.
struct Sweep<'a> {
    hats: &'a [Hat],
    ends: [Real; 2],
    /// The place in the chain behind the segment.
    behind: usize,
}

impl<'a> Sweep<'a> {
    /// Computes the curvature around each sample of a chain.
    fn over(hats: &'a mut [Hat], points: &[Vector]) -> Self {
        for place in 0..hats.len() {
            let chain = Chain { count: hats.len(), hat: |place| hats[place] };
            hats[place].around = chain.around(place, hats[place].shown);
        }
        let chain = Chain { count: hats.len(), hat: |place| hats[place] };
        let ends = [0, 1].map(|end| chain.at_end(end, points));
        Self { hats, ends, behind: 0 }
    }

    /// Advances to the segment that begins at `from`. Returns the largest curvature shown by the
    /// two samples before it and the two behind it, and the sample that shows it.
    fn at(&mut self, from: usize) -> (Real, Hat) {
        while self.hats[self.behind].sample <= from {
            self.behind += 1;
        }
        let (hats, behind) = (self.hats, self.behind);
        let last = hats.len() - 1;
        let four = &hats[behind.saturating_sub(2)..=(behind + 1).min(last)];
        // In this order ties go to the first.
        let nearest = hats[behind - 1];
        let sharpest = four
            .iter()
            .fold(nearest, |most, hat| if hat.around > most.around { *hat } else { most });
        let at_ends = [behind <= 2, behind + 1 >= last];
        let shown = [0, 1].map(|end| if at_ends[end] { self.ends[end] } else { 0.0 });
        (sharpest.around.max(shown[0]).max(shown[1]), sharpest)
    }
}

impl SectionSamples<'_> {
    fn last(&self) -> usize {
        self.points.len() - 1
    }

    fn segment(&self, from: usize, to: usize) -> Option<Segment> {
        let gap = |sample: usize| gap_at(self.clusters, self.first + sample);
        let segment = Segment::between(self.points[from], self.points[to], self.rounding)?;
        Some(if self.clusters.is_empty() { segment } else { segment.with_gap(gap(from) + gap(to)) })
    }

    /// Returns the hat of a sample between two segments.
    fn hat(&self, sample: usize, before: Option<Segment>, behind: Option<Segment>) -> Hat {
        let bend =
            match (before, behind) {
                (Some(before), Some(behind)) => Some(
                    (behind.direction - before.direction) / (0.5 * (before.length + behind.length)),
                ),
                (None, Some(behind)) if sample == 0 => self.tangents[0]
                    .map(|tangent| (behind.direction - tangent) / (0.5 * behind.length)),
                (Some(before), None) if sample == self.last() => self.tangents[1]
                    .map(|tangent| (tangent - before.direction) / (0.5 * before.length)),
                _ => None,
            };
        let mut bend_noise = 0.0;
        if !self.clusters.is_empty() {
            let size = bend.map_or(0.0, |bend| bend.length());
            let sum = |of: fn(&Segment) -> Real| before.iter().chain(&behind).map(of).sum::<Real>();
            let gap = sum(|segment| segment.length - segment.least);
            bend_noise =
                (2.0 * sum(|segment| segment.noise) + size * gap) / sum(|segment| segment.least);
        }
        Hat { sample, bend, bend_noise, is_even: true, shown: 0.0, around: 0.0 }
    }

    /// Appends the hats of a chain of samples.
    fn collect(
        &self,
        is_in: impl Fn(usize) -> bool,
        show: impl Fn(&mut Hat, Option<Segment>, Option<Segment>),
        hats: &mut Vec<Hat>,
    ) {
        let (mut here, mut before) = (0, None);
        let mut take = |sample: usize, before: Option<Segment>, behind: Option<Segment>| {
            let mut hat = self.hat(sample, before, behind);
            show(&mut hat, before, behind);
            hats.push(hat);
        };
        for next in (1..=self.last()).filter(|&sample| is_in(sample)) {
            let behind = self.segment(here, next);
            take(here, before, behind);
            (here, before) = (next, behind);
        }
        take(here, before, None);
    }

    /// Returns the curvature bound for even samples, if the largest bend is `most`, at sample `at`.
    pub(super) fn between_samples(&self, at: usize, most: Real) -> Real {
        let last = self.last();
        let hat = |sample: usize| {
            let before = sample.checked_sub(1).and_then(|before| self.segment(before, sample));
            let behind = if sample < last { self.segment(sample, sample + 1) } else { None };
            self.hat(sample, before, behind)
        };
        let chain = Chain { count: last + 1, hat };
        let ends = [0, 1].map(|end| chain.at_end(end, self.points));
        ends[0].max(ends[1]).max(chain.around(at, most))
    }

    /// Returns the bend that a sample shows in the whole chain, including errors by rounding and
    /// clusters, and the part due to rounding.
    fn own_bend(
        &self,
        sample: usize,
        before: Option<Segment>,
        behind: Option<Segment>,
    ) -> [Real; 2] {
        let from = |end: usize, segment: &Segment| {
            self.tangents[end].map_or([0.0; 2], |tangent| {
                let rounding = self.rounding / (0.5 * segment.least * segment.length);
                [curvature_from(tangent, segment), rounding]
            })
        };
        match (before, behind) {
            (Some(before), Some(behind)) => {
                let rounding = self.rounding / before.length + self.rounding / behind.length;
                let distance = 0.5 * (behind.least + before.least);
                [curvature_between(&before, &behind), rounding / distance]
            }
            (None, Some(behind)) if sample == 0 => from(0, &behind),
            (Some(before), None) if sample == self.last() => from(1, &before),
            _ => [0.0; 2],
        }
    }

    /// Returns the largest curvature of a segment if the curve passes through all samples of a
    /// cluster beside it. Bends of more than 1 rad along `longest`, the greatest length of the
    /// segment, or within the radius, are excluded: the tube would be refused.
    fn through_crowds(&self, from: usize, longest: Real) -> Real {
        if self.clusters.is_empty() {
            return 0.0;
        }
        let point = self.first + from;
        let is_possible = |bend: &Real| bend * longest <= 1.0 && bend * self.radius < 1.0;
        let beside = bend_at(self.clusters, point, 1).into_iter().chain(bend_at(
            self.clusters,
            point + 1,
            0,
        ));
        let before = if from > 0 { beyond_at(self.clusters, point - 1, 1) } else { 0.0 };
        let behind =
            if from + 2 <= self.last() { beyond_at(self.clusters, point + 2, 0) } else { 0.0 };
        beside.chain([before, behind]).filter(is_possible).fold(0.0, Real::max)
    }

    /// Appends the bounds of all segments; `least` is a lower limit for each curvature.
    ///
    /// Returns the first segment in which the curve may turn by more than 1 rad, and the first
    /// sample that shows a sharper bend because a neighbour is very near. `hats` is memory.
    pub(super) fn bound_unevenly(
        self,
        least: Real,
        hats: &mut Vec<Hat>,
        bounds: &mut Vec<CurveBound>,
    ) -> (Option<Bend>, Option<usize>) {
        let last = self.last();
        let logarithms: Real = self.arcs.windows(2).map(|arcs| libm::log2(arcs[1] - arcs[0])).sum();
        let shortest = CLOSE * libm::exp2(logarithms / last as Real);
        let noise = 2.0 * self.rounding / shortest;
        let is_close = |sample: usize| self.arcs[sample] - self.arcs[sample - 1] < shortest;
        // Every chain contains the last sample, so that the curvature at its end is known.
        let is_in = |sample: usize| {
            sample == last || (!is_close(sample) && self.arcs[last] - self.arcs[sample] >= shortest)
        };
        hats.clear();
        let show_widely = |hat: &mut Hat, _: Option<Segment>, _: Option<Segment>| {
            hat.shown =
                hat.bend.map_or(0.0, |bend| bend.length() + noise / shortest) + hat.bend_noise;
        };
        self.collect(is_in, show_widely, hats);
        let most = hats.iter().fold(0.0, |most: Real, hat| most.max(hat.shown));
        let count = hats.len();
        if count <= last {
            let show = |hat: &mut Hat, before: Option<Segment>, behind: Option<Segment>| {
                let [own, rounding] = self.own_bend(hat.sample, before, behind);
                hat.shown = own.min(2.0 * (own - rounding).max(0.0));
                hat.is_even = before.zip(behind).is_none_or(|(one, other)| !one.is_uneven(&other));
            };
            self.collect(|_| true, show, hats);
        }
        let (wide, whole) = hats.split_at_mut(count);
        let mut wide = Sweep::over(wide, self.points);
        let mut whole = if whole.is_empty() { None } else { Some(Sweep::over(whole, self.points)) };

        let (mut sharpest, mut crowded) = (None, None);
        let (mut before, mut here) = (None, self.segment(0, 1));
        let [mut own, _] = self.own_bend(0, None, here);
        for from in 0..last {
            let next = if from + 2 <= last { self.segment(from + 1, from + 2) } else { None };
            let [behind, _] = self.own_bend(from + 1, here, next);
            let (mut local, mut hat) = wide.at(from);
            if let Some(whole) = &mut whole {
                let (close_by, sharper) = whole.at(from);
                local = local.max(close_by);
                hat = if sharper.around > hat.around { sharper } else { hat };
            }
            local = local.max(least);
            let longest = here.map_or(0.0, |segment| 2.0 * segment.length - segment.least);
            let curvature = local.max(own).max(behind).max(self.through_crowds(from, longest));
            bounds.push(CurveBound { curvature, off: 0.0 });
            let turn = curvature * longest;
            if turn > 1.0 && sharpest.is_none() {
                let is_own = local <= own.max(behind);
                let at = if is_own { from + usize::from(behind > own) } else { hat.sample };
                sharpest = Some(Bend { at, from, turn });
            }
            if is_close(from + 1) && crowded.is_none() {
                let length =
                    |segment: Option<Segment>| segment.map_or(0.0, |segment| segment.length);
                let longest_beside = length(before).max(length(next));
                if (own.max(behind) - 1.25 * most) * longest_beside > SHARPER {
                    crowded = Some(from + 1);
                }
            }
            own = behind;
            (before, here) = (here, next);
        }
        (sharpest, crowded)
    }
}
