//! Clusters of samples: a sample that was taken twice, a little apart.
//!
//! Two samples 0.01 mm apart, whose neighbours are a millimetre away, show a sharp bend if one of
//! them is off by their distance. Either the curve bends like that, or the bend is noise. The
//! bounds cover both.
//!
//! # Definitions
//! - Cluster: samples that count as one. `gap`, `g`: the largest distance of the others from the
//!   first.
//!
//! # When samples form a cluster
//! A cluster is formed only around a sample that shows a sharp bend: the tube would be refused for
//! it, or it exceeds every bend of samples farther apart by a quarter. All conditions must hold:
//!
//! 1. The samples are as close, up to rounding, as that sample and its nearer neighbour, or up to
//!    2^[`MAX_DOUBLINGS`] times as far if there are more than two.
//! 2. The samples before and behind are at least [`APART`] times as far from the first as the
//!    farthest of the cluster is.
//! 3. The segments in the cluster have the radius of the segment before or behind: a flange is not
//!    noise.
//! 4. The cluster does not make a valid tube invalid.
//!
//! # Assumption
//! The first sample stays. One of two cases holds:
//!
//! 1. The curve passes within g of the first sample. It bends at most as much as the samples on the
//!    curve show: those outside of clusters, and for each cluster the true place within its gap.
//! 2. The curve passes through all samples. In the two segments before the cluster and the two
//!    behind it, it bends at most as much as they show (`section_samples`). Bends of more than 1
//!    rad, or within the radius, are excluded: the tube would be refused.
//!
//! # Bounds
//! The sample that stays is off by g, and so is every chord to it. All bodies and witnesses include
//! g. Consider a chord of length l between clusters with the gaps g1 and g2, and `g = g1 + g2`. For
//! two vectors v and w with `|v - w| <= g`, the lengths differ by at most g and the unit vectors by
//! at most `2 g / (|v| + |w|) <= g / (l - g)`. (Dunkl and Williams, American Mathematical Monthly
//! 71, 1964.) Hence
//!
//! - a turn grows by at most `g / (l - g)` for each of its two segments;
//! - half of the sum of the two lengths shrinks by at most half of the sum of their g;
//! - the curve between the samples is longer by at most the relative amount `g / l`.

use super::segment::{Segment, curvature_between, curvature_from};
use crate::robot::is_same;
use parry3d_f64::math::{Real, Vector};

/// The samples outside are at least this many times as far from the first as the cluster's radius.
const APART: Real = 32.0;

/// Most samples of a cluster.
const MOST: usize = 8;

/// A cluster is up to 2 to the power of this times as wide as two samples that show a bend.
const MAX_DOUBLINGS: u32 = 3;

/// Samples that count as one.
#[derive(Clone, Copy, Debug)]
pub(super) struct SampleCluster {
    /// The indices of the first sample, which stays, and of the last.
    pub first: usize,
    pub last: usize,
    /// The index of the point that represents them, once it is laid.
    pub point: usize,
    /// The largest distance of the others from the first.
    pub gap: Real,
    /// The bends of the segments before and behind, if the curve passes through all samples.
    pub bends: [Through; 2],
}

/// The bends that a cluster shows for the two segments on one side, if the curve passes through all
/// its samples.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Through {
    /// For the adjacent segment: the largest bend from its turns into the segments of the cluster,
    /// and the bend that the second sample shows.
    beside: [Real; 2],
    /// For the segment beyond it: the bend that the first sample shows.
    beyond: Real,
}

/// Finds the clusters that are as close as two samples around `at`, or a few times as wide.
///
/// Returns whether more samples are dropped than before.
pub(super) fn find(
    samples: &[Vector],
    radii: &[Real],
    tangents: Option<[Vector; 2]>,
    at: usize,
    one_place: Real,
    clusters: &mut Vec<SampleCluster>,
) -> bool {
    let apart = |other: &Vector| (*other - samples[at]).length();
    let is_apart = |length: &Real| *length > one_place;
    let before = samples[..at].iter().rev().map(apart).find(is_apart);
    let behind = samples[at..].iter().map(apart).find(is_apart);
    let closest = before.into_iter().chain(behind).fold(Real::INFINITY, Real::min);
    let left_out = |clusters: &[SampleCluster]| {
        clusters.iter().map(|cluster| cluster.last - cluster.first).sum::<usize>()
    };
    let known = left_out(clusters);
    // Gaps that differ by rounding alone are equal.
    let mut within = closest + one_place;
    for _ in 0..=MAX_DOUBLINGS {
        find_within(samples, radii, tangents, [within, one_place], clusters);
        if left_out(clusters) > known {
            return true;
        }
        within *= 2.0;
    }
    false
}

/// Finds all clusters whose samples are at most `within` from their first one.
fn find_within(
    samples: &[Vector],
    radii: &[Real],
    tangents: Option<[Vector; 2]>,
    [within, one_place]: [Real; 2],
    clusters: &mut Vec<SampleCluster>,
) {
    clusters.clear();
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
            clusters.push(SampleCluster { first, last: next - 1, point, gap, bends });
        } else {
            // Repeated samples are dropped elsewhere.
            next = first + 1;
            while next < samples.len() && apart(next) <= one_place {
                next += 1;
            }
        }
        before = if next < samples.len() { apart(next) } else { before };
        (previous, first) = (Some(first), next);
    }
}

/// Returns the bends for the segments towards an end, if the curve passes through all samples.
///
/// `near`: the next sample at that end. `far`: the next sample at the other end. If there is none,
/// the curve ends along `tangent`.
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
        // Samples at one place determine no direction.
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

/// Returns the bends of the segment adjacent to a cluster's point, if the curve passes through all
/// samples.
pub(super) fn bend_at(clusters: &[SampleCluster], point: usize, end: usize) -> [Real; 2] {
    crowd_at(clusters, point).map_or([0.0; 2], |cluster| cluster.bends[end].beside)
}

/// As [`bend_at`], for the segment beyond it.
pub(super) fn beyond_at(clusters: &[SampleCluster], point: usize, end: usize) -> Real {
    crowd_at(clusters, point).map_or(0.0, |cluster| cluster.bends[end].beyond)
}

fn crowd_at(clusters: &[SampleCluster], point: usize) -> Option<&SampleCluster> {
    let cluster = clusters.get(clusters.partition_point(|cluster| cluster.point < point));
    cluster.filter(|cluster| cluster.point == point)
}

/// Returns the largest distance of the curve from a cluster's point; 0 for other points.
pub(super) fn gap_at(clusters: &[SampleCluster], point: usize) -> Real {
    crowd_at(clusters, point).map_or(0.0, |cluster| cluster.gap)
}
