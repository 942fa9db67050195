//! A tube from samples: its sections, and how far the curve through the samples may be from the
//! lines between them.
//!
//! Nobody knows the curve between two samples. It is taken to bend no more than the samples show:
//! its curvature in a section is at most the largest of turn / distance over the section's samples,
//! where turn is the change of direction (as the length of the difference of the unit vectors)
//! between the two segments that meet in a sample, and distance is half of their lengths together.
//! For a circle that is its curvature exactly. A turn at a step in radius counts only for a section
//! that has fewer than two of its own. What means over two segments hide of a curvature that
//! changes evenly is added (`between_samples`). Where samples lie unevenly, what a sample shows
//! counts for the two segments on either side of it (`section_samples`).
//!
//! With that curvature k, and h the length of a segment:
//! - a piece of curve over a chord of length c with k c <= 1 is at most (2 / k) asin(k c / 2) <= c
//!   (1 + (k c)^2 / 20) long (Schwarz: the chord of an arc of curvature k is the shortest; asin x
//!   <= x (1 + x^2 / 5) up to 1/2);
//! - it leaves the chord by at most k l^2 / 8, where l is its length.
//!
//! Samples at one place, but for rounding, are one. The first of them stays, and the curve goes on
//! from within the gap: the directions on either side are unknown by the gap over the length, and
//! every point by the gap. Samples that are not quite at one place, where a sample was taken twice,
//! are told of in `sample_clusters`.
//!
//! Both hold whether or not the curvature jumps: the tangent t need only have |t'| <= k almost
//! everywhere. Which way a face stands is told in `direction_at_end`.

use super::Tube;
use super::cap_persistence::CapPersistence;
use super::curve::{Curve, CurveBound, Samples};
use super::direction_at_end::direction_at_end;
use super::open_section::{OpenSection, SamplePrefix};
use super::sample_clusters::{self, SampleCluster};
use super::section::{EndFace, Section};
use super::section_samples::Hat;
use super::segment::{Segment, curvature_between};
use crate::distance::Scalar;
use crate::robot::RobotError;
use crate::robot::chain::check_segments;
use crate::robot::modified_cylinder::COORDINATE_LIMIT;
use parry3d_f64::math::{Real, Vector};

/// How often samples that crowd are looked for.
const MAX_TRIALS: u32 = 16;

/// A face's direction is told from so many samples behind it.
const FACE_SAMPLES: usize = 3;

impl Tube {
    /// Fills the tube; see [`Tube::set_samples`].
    pub(super) fn measure(
        &mut self,
        samples: &[Vector],
        radii: &[Real],
        end_tangents: Option<[Vector; 2]>,
    ) -> Result<(), RobotError> {
        // In one sweep without branches; what it does not find good is looked at closely.
        let (mut reach, mut is_good) =
            ([0.0; 3], samples.len() >= 2 && radii.len() + 1 == samples.len());
        for point in samples {
            for (reach, value) in reach.iter_mut().zip(point.abs().to_array()) {
                // NaN is not larger, but not good either.
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
        // Coordinates that were computed in two ways may differ by so much.
        let one_place = 32.0 * Real::UNIT_ROUNDOFF * reach;
        let given = InputSamples { samples, radii, tangents, reach, one_place };
        let [mut crowds, mut good] = std::mem::take(&mut self.crowds);
        let mut hats = std::mem::take(&mut self.hats);
        crowds.clear();
        let (mut result, mut crowding) = self.lay_samples(&given, &mut crowds, &mut hats);
        for _ in 0..MAX_TRIALS {
            let at = match result {
                Err(RobotError::TurnsTooSharply { index, .. }) => Some(index),
                Ok(()) | Err(RobotError::BendsWithinRadius { .. }) => crowding,
                Err(_) => None,
            };
            let is_good = result.is_ok();
            good.clone_from(&crowds);
            if !at.is_some_and(|at| {
                sample_clusters::find(samples, radii, tangents, at, one_place, &mut crowds)
            }) {
                break;
            }
            (result, crowding) = self.lay_samples(&given, &mut crowds, &mut hats);
            if is_good && result.is_err() {
                crowds.clone_from(&good);
                (result, _) = self.lay_samples(&given, &mut crowds, &mut hats);
                break;
            }
        }
        (self.crowds, self.hats) = ([crowds, good], hats);
        if result.is_ok() {
            self.lay_long_segments(tangents);
        }
        result
    }

    /// Fills the tube with good samples, of which those that crowd are one. A sample around which
    /// there may be more that do is returned as well.
    fn lay_samples(
        &mut self,
        given: &InputSamples,
        crowds: &mut [SampleCluster],
        hats: &mut Vec<Hat>,
    ) -> (Result<(), RobotError>, Option<usize>) {
        // Nearly always nothing crowds, and a loop that need not look is faster.
        if crowds.is_empty() {
            self.lay::<false>(given, crowds, hats)
        } else {
            self.lay::<true>(given, crowds, hats)
        }
    }

    fn lay<const CROWD: bool>(
        &mut self,
        given: &InputSamples,
        crowds: &mut [SampleCluster],
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
        // The next crowd, and how far the curve may be from the last point.
        let (mut number, mut off) =
            (0, crowds.first().filter(|crowd| crowd.first == 0).map_or(0.0, |crowd| crowd.gap));
        let (mut result, mut crowding) = (Ok(()), None);
        for (k, (&sample, &radius)) in samples[1..].iter().zip(radii).enumerate() {
            let mut off_here = 0.0;
            if CROWD && let Some(crowd) = crowds.get(number) {
                if crowd.first < k + 1 && k < crowd.last {
                    number += usize::from(crowd.last == k + 1);
                    continue;
                }
                off_here = if crowd.first == k + 1 { crowd.gap } else { 0.0 };
            }
            // What is left out of the curve before it is unknown of its direction.
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
                    let so_far = SamplePrefix { points: &points, arcs: &arcs, crowds };
                    match done.close(last, rounding + widest_gap, &so_far, hats, &mut bounds) {
                        Ok((section, near)) => {
                            self.sections.push(section);
                            crowding = crowding.or(near);
                        }
                        Err(bend) => result = result.and(Err(bend.error(&segments))),
                    }
                }
            } else {
                open = OpenSection::new(0, 0.0, radius);
                if let Some([tangent, _]) = tangents {
                    open.bend_from(0, 0, tangent, &segment);
                }
            }
            arc += segment.length;
            segments[last] = k as u32;
            // Where it already is, unless points are repeated.
            last += 1;
            points[last] = sample;
            arcs[last] = arc;
            open.extend(last, &segment);
            before = Some(segment);
            off = off_here;
            if CROWD && off > 0.0 {
                crowds[number].point = last;
            }
        }
        if let (Some(segment), Some([_, tangent])) = (before, tangents) {
            open.bend_from(last, 1, tangent, &segment);
        }
        points.truncate(last + 1);
        arcs.truncate(last + 1);
        segments.truncate(last + 1);
        self.merged = self.merged.max(open.section.radius - open.least_radius) + widest_gap;
        self.merged += crowds.iter().fold(0.0, |widest: Real, crowd| widest.max(crowd.gap));
        let so_far = SamplePrefix { points: &points, arcs: &arcs, crowds };
        match open.close(last, rounding + widest_gap, &so_far, hats, &mut bounds) {
            Ok((section, near)) => {
                self.sections.push(section);
                crowding = crowding.or(near);
            }
            Err(bend) => result = result.and(Err(bend.error(&segments))),
        }
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
            result = self.stand_faces(&points, &bounds, unknown, given, crowds);
        }
        // The number of the sample in the input.
        let crowding = crowding
            .map(|at: usize| at.checked_sub(1).map_or(0, |before| segments[before] as usize + 1));
        self.curve = Curve::Samples(Samples { points, arcs, segments, bounds });
        (result, crowding)
    }

    /// Finds the flat ends of the sections and their directions. `points` are the samples without
    /// those repeated.
    fn stand_faces(
        &mut self,
        points: &[Vector],
        bounds: &[CurveBound],
        rounding: Real,
        given: &InputSamples,
        crowds: &[SampleCluster],
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
                        // In the order of their points.
                        let first = crowds.partition_point(|crowd| {
                            crowd.point.saturating_add(FACE_SAMPLES) < from
                        });
                        let near = crowds[first..]
                            .iter()
                            .take_while(|crowd| crowd.point <= from.saturating_add(FACE_SAMPLES));
                        let off = near.fold(0.0, |off: Real, crowd| off.max(2.0 * crowd.gap));
                        direction_at_end(ahead, stretch.len(), curvature, rounding + off)
                    }
                };
                tube.sections[number].faces[end] =
                    Some(EndFace { centre, outward, tilt, persistence: CapPersistence::Either });
            });
        }
        for section in &self.sections {
            super::check_faces(section, || given.position_of(section.first as usize, crowds))?;
        }
        self.mark_persistent_faces();
        Ok(())
    }
}

/// How much the first two segments at an end may bend.
fn bend_at_end(section: &Section, end: usize, bounds: &[CurveBound]) -> Real {
    if section.is_even {
        return section.curvature;
    }
    let own = &bounds[section.first as usize..section.last as usize];
    let two = if end == 0 { &own[..own.len().min(2)] } else { &own[own.len().saturating_sub(2)..] };
    two.iter().fold(0.0, |most: Real, bound| most.max(bound.curvature))
}

/// Samples as they were given.
struct InputSamples<'a> {
    samples: &'a [Vector],
    radii: &'a [Real],
    /// The directions of the curve at its ends, of unit length.
    tangents: Option<[Vector; 2]>,
    /// The largest coordinate.
    reach: Real,
    /// What is no farther apart than this is at one place.
    one_place: Real,
}

impl InputSamples<'_> {
    /// Where a point stood among the samples before those at one place were dropped.
    fn position_of(&self, point: usize, crowds: &[SampleCluster]) -> usize {
        let (mut last, mut count) = (0, 0);
        for (k, &sample) in self.samples.iter().enumerate().skip(1) {
            let is_apart = |segment: Segment| segment.length > self.one_place;
            let is_dropped = |crowd: &SampleCluster| crowd.first < k && k <= crowd.last;
            if count < point
                && !crowds.iter().any(is_dropped)
                && Segment::between(self.samples[last], sample, 0.0).is_some_and(is_apart)
            {
                (last, count) = (k, count + 1);
            }
        }
        last
    }
}
