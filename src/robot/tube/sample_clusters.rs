//! Samples that crowd: where a sample was taken twice, a little apart.
//!
//! Two samples 0.01 mm apart, whose neighbours are a millimetre away, show a sharp bend if one of
//! them is off by as much as they are apart. Then either the curve bends like that, or the bend is
//! noise. Both are covered:
//!
//! - *When.* Only where the tube would be refused because of a bend that one of them shows, or
//!   where that is sharper by a quarter than all that samples show which are farther apart. They
//!   are as close together as that one and its nearer neighbour, or up to 2^[`MAX_DOUBLINGS`] times
//!   as far if there are more than two; the other samples before and behind are [`APART`] times as
//!   far from the first of them as the farthest of them is. The segments between them have the
//!   radius of the segment before or of the one behind: a flange is no noise.
//! - *What is taken to be.* The first of them stays. Let g be how far the others are from it at
//!   most, the gap. The curve passes within g of the one that stays, and bends no more than the
//!   samples show that are on the curve: those that do not crowd, and for each crowd the place
//!   within the gap where the curve is. Or else the curve goes through all of them, and in the two
//!   segments before and the two behind bends no more than they show (`section_samples`). A bend is
//!   left out that would be by more than 1 rad or within the radius, for which the tube would be
//!   refused. Where a tube that was good would be refused because of a crowd, that is none.
//! - *What follows.* Beside a curve through samples, the one that stays is off by g. So is every
//!   chord to it; all bodies and witnesses count g. A chord l long between samples with the gaps g1
//!   and g2 has an end moved by g1 and another by g2. Of two vectors v and w with |v - w| <= g = g1
//!   + g2, the unit vectors differ by at most 2 g / (|v| + |w|) <= g / (l - g) (Dunkl and Williams,
//!   American Mathematical Monthly 71, 1964), and the lengths by g at most. So a turn is larger
//!   than it seems by no more than that for each of its segments, half of their lengths together is
//!   less by no more than half of their g, and the curve between them is longer by no more than the
//!   share g / l.

use super::segment::{Segment, curvature_between, curvature_from};
use crate::robot::radius_steps::is_same;
use parry3d_f64::math::{Real, Vector};

/// Other samples are so many times as far away as those that crowd are from the first of them.
const APART: Real = 32.0;

/// No more samples are taken for one.
const MOST: usize = 8;

/// Those that crowd are up to 2 to the power of this times as far apart as two that show a bend.
const MAX_DOUBLINGS: u32 = 3;

/// Samples that are taken for one.
#[derive(Clone, Copy, Debug)]
pub(super) struct SampleCluster {
    /// The first of them, which stays, and the last.
    pub first: usize,
    pub last: usize,
    /// The number of the point that stands for them, once it is laid.
    pub point: usize,
    /// How far the others are from the first at most.
    pub gap: Real,
    /// What the segments before them and behind them bend, if the curve goes through all of them.
    pub bends: [Through; 2],
}

/// The bends that samples which crowd show, if the curve goes through all of them, for the two
/// segments on one side.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Through {
    /// For the segment beside them: what its turn into each segment between them shows, and what
    /// the second sample shows.
    beside: [Real; 2],
    /// For the segment beyond that one: what the first sample shows.
    beyond: Real,
}

/// Finds the crowds that are as close together as two of the samples around `at`, or a few times as
/// far. Whether there are more of them than before.
pub(super) fn find(
    samples: &[Vector],
    radii: &[Real],
    tangents: Option<[Vector; 2]>,
    at: usize,
    one_place: Real,
    crowds: &mut Vec<SampleCluster>,
) -> bool {
    let apart = |other: &Vector| (*other - samples[at]).length();
    let is_apart = |length: &Real| *length > one_place;
    let before = samples[..at].iter().rev().map(apart).find(is_apart);
    let behind = samples[at..].iter().map(apart).find(is_apart);
    let closest = before.into_iter().chain(behind).fold(Real::INFINITY, Real::min);
    let left_out = |crowds: &[SampleCluster]| {
        crowds.iter().map(|crowd| crowd.last - crowd.first).sum::<usize>()
    };
    let known = left_out(crowds);
    let mut within = closest;
    for _ in 0..=MAX_DOUBLINGS {
        find_within(samples, radii, tangents, [within, one_place], crowds);
        if left_out(crowds) > known {
            return true;
        }
        within *= 2.0;
    }
    false
}

/// Finds all crowds that are no farther than this from the first of them.
fn find_within(
    samples: &[Vector],
    radii: &[Real],
    tangents: Option<[Vector; 2]>,
    [within, one_place]: [Real; 2],
    crowds: &mut Vec<SampleCluster>,
) {
    crowds.clear();
    let (mut first, mut before, mut previous) = (0, Real::INFINITY, None);
    while first < samples.len() {
        let apart = |k: usize| (samples[k] - samples[first]).length();
        let (mut next, mut gap): (usize, Real) = (first + 1, 0.0);
        while next < samples.len() && next - first < MOST && apart(next) <= within {
            gap = gap.max(apart(next));
            next += 1;
        }
        let behind = if next < samples.len() { apart(next) } else { Real::INFINITY };
        let beside =
            [first.checked_sub(1), Some(next - 1)].map(|k| k.and_then(|k| radii.get(k)).copied());
        let is_no_flange = radii[first..next - 1]
            .iter()
            .all(|&radius| beside.into_iter().flatten().any(|beside| is_same(beside, radius)));
        let is_crowd = gap > one_place
            && APART * gap <= before.min(behind)
            && before.min(behind) < Real::INFINITY
            && is_no_flange;
        if is_crowd {
            let point = if first == 0 { 0 } else { usize::MAX };
            let here = &samples[first..next];
            let neighbours = [previous.map(|k: usize| samples[k]), samples.get(next).copied()];
            let tangents = tangents.map(|[start, end]| [-start, end]);
            let bends = [0, 1].map(|end| {
                let ends = [neighbours[end], neighbours[1 - end]];
                let tangent = tangents.map(|tangents| tangents[1 - end]);
                through(end, here, ends, tangent, one_place)
            });
            crowds.push(SampleCluster { first, last: next - 1, point, gap, bends });
        } else {
            // Samples at one place are dropped elsewhere.
            next = first + 1;
            while next < samples.len() && apart(next) <= one_place {
                next += 1;
            }
        }
        before = if next < samples.len() { apart(next) } else { before };
        (previous, first) = (Some(first), next);
    }
}

/// What samples that crowd show of the segments towards an end, if the curve goes through all of
/// them: as if they did not crowd. `near` is the next sample at that end and `far` the one at the
/// other, where the curve ends along `tangent` if there is none.
fn through(
    end: usize,
    samples: &[Vector],
    [near, far]: [Option<Vector>; 2],
    tangent: Option<Vector>,
    one_place: Real,
) -> Through {
    let sample = |k: usize| if end == 0 { samples[k] } else { samples[samples.len() - 1 - k] };
    let Some(beside) = near.and_then(|near| Segment::between(near, sample(0), one_place)) else {
        return Through::default();
    };
    let (mut most, mut last): (Real, _) = (0.0, sample(0));
    let mut first_two = [None; 2];
    let mut take = |segment: Segment| match first_two {
        [None, _] => first_two[0] = Some(segment),
        [_, None] => first_two[1] = Some(segment),
        _ => {}
    };
    for k in 1..samples.len() {
        // Between samples at one place there is no direction.
        let Some(segment) = Segment::between(last, sample(k), one_place) else { continue };
        if segment.length > one_place {
            most = most.max(curvature_between(&segment, &beside));
            take(segment);
            last = sample(k);
        }
    }
    if let Some(onwards) = far.and_then(|far| Segment::between(last, far, one_place)) {
        take(onwards);
    }
    let [first, second] = first_two;
    let beyond = first.map_or(0.0, |first| curvature_between(&beside, &first));
    let second = match (first, second, tangent) {
        (Some(first), Some(second), _) => curvature_between(&first, &second),
        (Some(first), None, Some(tangent)) => curvature_from(tangent, &first),
        _ => 0.0,
    };
    Through { beside: [most, second], beyond }
}

/// What a segment next to a point that stands for samples bends, if the curve goes through all of
/// them.
pub(super) fn bend_at(crowds: &[SampleCluster], point: usize, end: usize) -> [Real; 2] {
    crowd_at(crowds, point).map_or([0.0; 2], |crowd| crowd.bends[end].beside)
}

/// The same of the segment beyond that one.
pub(super) fn beyond_at(crowds: &[SampleCluster], point: usize, end: usize) -> Real {
    crowd_at(crowds, point).map_or(0.0, |crowd| crowd.bends[end].beyond)
}

fn crowd_at(crowds: &[SampleCluster], point: usize) -> Option<&SampleCluster> {
    let crowd = crowds.get(crowds.partition_point(|crowd| crowd.point < point));
    crowd.filter(|crowd| crowd.point == point)
}

/// How far the curve may be from a point that stands for samples.
pub(super) fn gap_at(crowds: &[SampleCluster], point: usize) -> Real {
    crowd_at(crowds, point).map_or(0.0, |crowd| crowd.gap)
}
