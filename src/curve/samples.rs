//! A tube from samples: its sections, and bounds on the curve between the samples.
//!
//! # Definitions
//! - Segment: the chord between two neighbouring samples; `h` is its length.
//! - Turn at a sample: the length of the difference of the unit directions of its two segments.
//! - `k`: the curvature bound of a section, the largest turn over distance among its samples, where
//!   distance is half of the sum of the two segments' lengths. For a circle k is exact.
//! - `t`: the unit tangent of the curve.
//!
//! # Assumption
//! The samples do not determine the curve between them. It is assumed to satisfy `|t'| <= k` almost
//! everywhere, so the curvature may jump. Three rules refine k:
//!
//! 1. A turn at a step in radius counts only for a section with fewer than two turns of its own.
//! 2. The mean over two segments hides part of a curvature that changes evenly; `between_samples`
//!    adds it.
//! 3. If samples lie unevenly, a turn counts only for the two segments on either side of its sample
//!    (`section_samples`).
//!
//! # Claims
//! For a piece of curve over a chord of length c with `k c <= 1`:
//!
//! 1. Its length is at most `(2 / k) asin(k c / 2) <= c (1 + (k c)^2 / 20)`.
//! 2. It leaves the chord by at most `k l^2 / 8`, where l is its length.
//!
//! **Proof.** 1. By Schwarz, an arc of curvature k has the shortest chord; and
//! `asin x <= x (1 + x^2 / 5)` up to 1/2. Both claims need `|t'| <= k` almost everywhere only.
//!
//! # Repeated samples
//! Samples at one place, up to rounding, count as one. The first of them stays. The curve continues
//! from within the gap between them: directions on either side are uncertain by gap over length,
//! every point by the gap. `sample_clusters` treats a sample that was taken twice, a little apart.
//! `direction_at_end` determines the directions of faces.

use super::Tube;
use super::centreline::{Curve, Samples};
use super::curve_bound::CurveBound;
use super::direction_at_end::direction_at_end;
use super::open_section::{OpenSection, SamplePrefix};
use super::sample_clusters::{self, SampleCluster};
use super::section::{CapPersistence, EndFace, Section};
use super::section_samples::{Bend, Hat};
use super::segment::{Segment, curvature_between};
use crate::distance::Scalar;
use crate::robot::{COORDINATE_LIMIT, RobotError, check_segments};
use parry3d_f64::math::{Real, Vector};

/// Most searches for clusters of samples.
const MAX_TRIALS: u32 = 16;

/// Number of samples that determine a face's direction.
const FACE_SAMPLES: usize = 3;

impl Tube {
    /// Fills the tube; see [`Tube::set_samples`].
    pub(super) fn measure(
        &mut self,
        samples: &[Vector],
        radii: &[Real],
        end_tangents: Option<[Vector; 2]>,
    ) -> Result<(), RobotError> {
        // One branch-free pass. Only if it finds an error do the exact checks run.
        let (mut reach, mut is_good) =
            ([0.0; 3], samples.len() >= 2 && radii.len() + 1 == samples.len());
        for point in samples {
            for (reach, value) in reach.iter_mut().zip(point.abs().to_array()) {
                // NaN is not larger, but it clears `is_good`.
                *reach = if value > *reach { value } else { *reach };
                is_good &= value <= COORDINATE_LIMIT;
            }
        }
        is_good &= radii
            .iter()
            .fold(true, |good, &radius| good & (0.0..=COORDINATE_LIMIT).contains(&radius));
        if !is_good {
            check_segments(samples, radii)?;
        }
        let reach = reach.into_iter().fold(0.0, Real::max);
        let tangents = end_tangents.map(super::unit_tangents).transpose()?;
        // Coordinates of one place that were computed in two ways may differ by this.
        let one_place = 32.0 * Real::UNIT_ROUNDOFF * reach;
        let given = InputSamples { samples, radii, tangents, reach, one_place };
        let [mut clusters, mut good] = std::mem::take(&mut self.clusters);
        let mut hats = std::mem::take(&mut self.hats);
        clusters.clear();
        let (mut result, mut dense_sample) = self.lay_samples(&given, &mut clusters, &mut hats);
        for _ in 0..MAX_TRIALS {
            let at = match result {
                Err(RobotError::TurnsTooSharply { index, .. }) => Some(index),
                Ok(()) | Err(RobotError::BendsWithinRadius { .. }) => dense_sample,
                Err(_) => None,
            };
            let is_good = result.is_ok();
            good.clone_from(&clusters);
            if !at.is_some_and(|at| {
                sample_clusters::find(samples, radii, tangents, at, one_place, &mut clusters)
            }) {
                break;
            }
            (result, dense_sample) = self.lay_samples(&given, &mut clusters, &mut hats);
            if is_good && result.is_err() {
                clusters.clone_from(&good);
                (result, _) = self.lay_samples(&given, &mut clusters, &mut hats);
                break;
            }
        }
        (self.clusters, self.hats) = ([clusters, good], hats);
        if result.is_ok() {
            self.lay_long_segments(tangents);
        }
        result
    }

    /// Fills the tube with checked samples; each cluster counts as one sample.
    ///
    /// Also returns a sample around which there may be more clusters.
    fn lay_samples(
        &mut self,
        given: &InputSamples,
        clusters: &mut [SampleCluster],
        hats: &mut Vec<Hat>,
    ) -> (Result<(), RobotError>, Option<usize>) {
        // There are almost never clusters, and the loop without them is faster.
        if clusters.is_empty() {
            self.lay::<false>(given, clusters, hats)
        } else {
            self.lay::<true>(given, clusters, hats)
        }
    }

    fn lay<const CROWD: bool>(
        &mut self,
        given: &InputSamples,
        clusters: &mut [SampleCluster],
        hats: &mut Vec<Hat>,
    ) -> (Result<(), RobotError>, Option<usize>) {
        let InputSamples { samples, radii, tangents, reach, one_place } = *given;
        let Samples { mut points, mut arcs, mut segments, mut bounds } =
            std::mem::take(&mut self.curve).into_samples();
        bounds.clear();
        points.clear();
        points.extend_from_slice(samples);
        arcs.clear();
        arcs.resize(samples.len(), 0.0);
        segments.clear();
        segments.resize(samples.len(), 0);
        self.sections.clear();
        let rounding = 4.0 * Real::UNIT_ROUNDOFF * reach;
        let (mut gap, mut widest_gap): (Real, Real) = (0.0, 0.0);
        self.merged = 0.0;
        let (mut arc, mut before, mut last) = (0.0, None::<Segment>, 0);
        let mut open = OpenSection::new(0, 0.0, radii[0]);
        // The next cluster, and the uncertainty of the curve at the last point.
        let (mut number, mut off) = (
            0,
            clusters
                .first()
                .filter(|cluster| cluster.first == 0)
                .map_or(0.0, |cluster| cluster.gap),
        );
        let (mut result, mut dense_sample) = (Ok(()), None);
        let mut keep = |closed: Result<(Section, Option<usize>), Bend>,
                        segments: &[u32],
                        sections: &mut Vec<Section>| {
            match closed {
                Ok((section, near)) => {
                    sections.push(section);
                    dense_sample = dense_sample.or(near);
                }
                Err(bend) => result = result.and(Err(bend.error(segments))),
            }
        };
        for (k, (&sample, &radius)) in samples[1..].iter().zip(radii).enumerate() {
            let mut off_here = 0.0;
            if CROWD && let Some(cluster) = clusters.get(number) {
                if cluster.first < k + 1 && k < cluster.last {
                    number += usize::from(cluster.last == k + 1);
                    continue;
                }
                off_here = if cluster.first == k + 1 { cluster.gap } else { 0.0 };
            }
            // A part left out before the segment makes its direction uncertain.
            let Some(segment) = Segment::between(points[last], sample, rounding + gap) else {
                continue;
            };
            if segment.length <= one_place {
                gap = gap.max(segment.length);
                widest_gap = widest_gap.max(gap);
                continue;
            }
            let segment = if CROWD { segment.with_gap(off + off_here) } else { segment };
            gap = 0.0;
            if let Some(before) = &before {
                if open.takes(radius) {
                    open.bend(last, before, &segment);
                } else {
                    let turn = curvature_between(before, &segment);
                    open.at_ends = open.at_ends.max(turn);
                    let done = std::mem::replace(
                        &mut open,
                        OpenSection::behind_step(last, arc, radius, turn),
                    );
                    self.merged = self.merged.max(done.section.radius - done.least_radius);
                    let so_far = SamplePrefix { points: &points, arcs: &arcs, clusters };
                    let closed =
                        done.close(last, rounding + widest_gap, &so_far, hats, &mut bounds);
                    keep(closed, &segments, &mut self.sections);
                }
            } else {
                open = OpenSection::new(0, 0.0, radius);
                if let Some([tangent, _]) = tangents {
                    open.bend_from(0, 0, tangent, &segment);
                }
            }
            arc += segment.length;
            segments[last] = k as u32;
            // In place, unless points are repeated.
            last += 1;
            points[last] = sample;
            arcs[last] = arc;
            open.extend(last, &segment);
            before = Some(segment);
            off = off_here;
            if CROWD && off > 0.0 {
                clusters[number].point = last;
            }
        }
        if let (Some(segment), Some([_, tangent])) = (before, tangents) {
            open.bend_from(last, 1, tangent, &segment);
        }
        points.truncate(last + 1);
        arcs.truncate(last + 1);
        segments.truncate(last + 1);
        self.merged = self.merged.max(open.section.radius - open.least_radius) + widest_gap;
        self.merged += clusters.iter().fold(0.0, |widest: Real, cluster| widest.max(cluster.gap));
        let so_far = SamplePrefix { points: &points, arcs: &arcs, clusters };
        let closed = open.close(last, rounding + widest_gap, &so_far, hats, &mut bounds);
        keep(closed, &segments, &mut self.sections);
        if !bounds.is_empty() {
            bounds.resize(last + 1, CurveBound::default());
        }
        // Lengths along the tube are rounded too.
        self.reach = reach.max(arc);
        if last == 0 {
            result = Err(RobotError::AllPointsEqual);
        }
        if result.is_ok() {
            let unknown = rounding + widest_gap;
            result = self.stand_faces(&points, &bounds, unknown, given, clusters);
        }
        // Converts to the index of the sample in the input.
        let dense_sample = dense_sample
            .map(|at: usize| at.checked_sub(1).map_or(0, |before| segments[before] as usize + 1));
        self.curve = Curve::Samples(Samples { points, arcs, segments, bounds });
        (result, dense_sample)
    }

    /// Finds the flat ends of the sections and their directions. `points` are the samples without
    /// repetitions.
    fn stand_faces(
        &mut self,
        points: &[Vector],
        bounds: &[CurveBound],
        rounding: Real,
        given: &InputSamples,
        clusters: &[SampleCluster],
    ) -> Result<(), RobotError> {
        let last = self.sections.len() - 1;
        for end in [0, 1] {
            self.walk(end, |tube, number, limit| {
                let section = &tube.sections[number];
                let stretch = &points[section.first as usize..=section.last as usize];
                let ahead =
                    |k: usize| if end == 0 { stretch[k] } else { stretch[stretch.len() - 1 - k] };
                let centre = ahead(0);
                if !tube.is_flat(end, number, limit, centre) {
                    return;
                }
                let stated = match (end, given.tangents) {
                    (0, Some([tangent, _])) if number == 0 => Some(-tangent),
                    (1, Some([_, tangent])) if number == last => Some(tangent),
                    _ => None,
                };
                let (outward, tilt) = match stated {
                    Some(outward) => (outward, 0.0),
                    None => {
                        let curvature = bend_at_end(section, end, bounds);
                        let from =
                            if end == 0 { section.first as usize } else { section.last as usize };
                        // Clusters are in the order of their points.
                        let first = clusters.partition_point(|cluster| {
                            cluster.point.saturating_add(FACE_SAMPLES) < from
                        });
                        let near = clusters[first..].iter().take_while(|cluster| {
                            cluster.point <= from.saturating_add(FACE_SAMPLES)
                        });
                        let off = near.fold(0.0, |off: Real, cluster| off.max(2.0 * cluster.gap));
                        direction_at_end(ahead, stretch.len(), curvature, rounding + off)
                    }
                };
                tube.sections[number].faces[end] =
                    Some(EndFace { centre, outward, tilt, persistence: CapPersistence::Either });
            });
        }
        for section in &self.sections {
            super::check_faces(section, || given.position_of(section.first as usize, clusters))?;
        }
        self.mark_persistent_faces();
        Ok(())
    }
}

/// Returns the curvature bound of the first two segments at an end.
fn bend_at_end(section: &Section, end: usize, bounds: &[CurveBound]) -> Real {
    if section.is_even {
        return section.curvature;
    }
    let own = &bounds[section.first as usize..section.last as usize];
    let two = if end == 0 { &own[..own.len().min(2)] } else { &own[own.len().saturating_sub(2)..] };
    two.iter().fold(0.0, |most: Real, bound| most.max(bound.curvature))
}

/// The samples of the input.
struct InputSamples<'a> {
    samples: &'a [Vector],
    radii: &'a [Real],
    /// The unit tangents of the curve at its ends.
    tangents: Option<[Vector; 2]>,
    /// The largest absolute coordinate.
    reach: Real,
    /// Points at most this far apart are at one place.
    one_place: Real,
}

impl InputSamples<'_> {
    /// Returns the index in the input of a point, counting the samples that were dropped.
    fn position_of(&self, point: usize, clusters: &[SampleCluster]) -> usize {
        let (mut last, mut count) = (0, 0);
        for (k, &sample) in self.samples.iter().enumerate().skip(1) {
            let is_apart = |segment: Segment| segment.length > self.one_place;
            let is_dropped = |cluster: &SampleCluster| cluster.first < k && k <= cluster.last;
            if count < point
                && !clusters.iter().any(is_dropped)
                && Segment::between(self.samples[last], sample, 0.0).is_some_and(is_apart)
            {
                (last, count) = (k, count + 1);
            }
        }
        last
    }
}
