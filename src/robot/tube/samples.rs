//! A tube from samples: its sections, and how far the curve through the samples may be from the lines between them.
//!
//! Nobody knows the curve between two samples. It is taken to bend no more than the samples show: its curvature in a
//! section is at most the largest of turn / distance over the section's samples, where turn is the change of direction
//! (as the length of the difference of the unit vectors) between the two segments that meet in a sample, and distance is
//! half of their lengths together. For a circle that is its curvature exactly. A turn at a step in radius counts only for
//! a section that has fewer than two of its own. What means over two segments hide of a curvature that changes evenly is
//! added (`between_samples`). Where samples lie unevenly, those that are close together count only for the segments next to
//! them (`uneven`).
//!
//! With that curvature k, and h the length of a segment:
//! - a piece of curve over a chord of length c with k c <= 1 is at most (2 / k) asin(k c / 2) <= c (1 + (k c)^2 / 20)
//!   long (Schwarz: the chord of an arc of curvature k is the shortest; asin x <= x (1 + x^2 / 5) up to 1/2);
//! - it leaves the chord by at most k l^2 / 8, where l is its length.
//!
//! Samples at one place, but for rounding, are one. The first of them stays, and the curve goes on from within the gap: the
//! directions on either side are unknown by the gap over the length, and every point by the gap.
//!
//! Both hold whether or not the curvature jumps: the tangent t need only have |t'| <= k almost everywhere. Which way a
//! face stands is told in `direction_at_end`.

use super::Tube;
use super::curve::{Curve, CurveBound, Samples};
use super::direction_at_end::direction_at_end;
use super::lasting::Lasting;
use super::own_samples::{Bend, OwnSamples};
use super::section::{Face, Section, stretch};
use crate::distance::Scalar;
use crate::robot::RobotError;
use crate::robot::chain::check_segments;
use crate::robot::modified_cylinder::COORDINATE_LIMIT;
use crate::robot::steps::is_same;
use parry3d_f64::math::{Real, Vector};

/// A segment between two samples.
#[derive(Clone, Copy)]
pub(super) struct Segment {
    pub direction: Vector,
    pub length: Real,
    /// What the rounding of the samples can do to the direction.
    pub noise: Real,
}

impl Segment {
    /// None without a length.
    #[inline(always)]
    pub(super) fn between(from: Vector, to: Vector, rounding: Real) -> Option<Self> {
        let along = to - from;
        let length = along.length();
        if length > 0.0 {
            let inverse = 1.0 / length;
            Some(Self { direction: along * inverse, length, noise: rounding * inverse })
        } else {
            None
        }
    }
}

/// The curvature that the turn from one segment to the next shows.
pub(super) fn curvature_between(before: &Segment, segment: &Segment) -> Real {
    let turn = (segment.direction - before.direction).length() + segment.noise + before.noise;
    turn / (0.5 * (segment.length + before.length))
}

/// The curvature that the turn from the direction at an end to the segment next to it shows.
pub(super) fn curvature_from(direction: Vector, segment: &Segment) -> Real {
    let turn = (segment.direction - direction).length() + segment.noise;
    turn / (0.5 * segment.length)
}

/// Samples of a section are uneven where a segment is so many times as long as its neighbour.
const UNEVEN: Real = 4.0;

/// A section on its way.
struct Open {
    section: Section,
    longest: Real,
    /// The sample before its longest segment.
    longest_from: usize,
    /// The sample where it turns most.
    sharpest: usize,
    /// Whether one of two neighbouring segments is more than four times as long as the other.
    is_uneven: bool,
    /// How many turns it has inside.
    turns: usize,
    /// The curvature that the turns at steps in radius show.
    at_ends: Real,
    /// The directions of the curve at its ends, where they are given.
    tangents: [Option<Vector>; 2],
    /// The radii of its first and of its thinnest segment.
    first_radius: Real,
    least_radius: Real,
}

impl Open {
    fn new(first: usize, start: Real, radius: Real) -> Self {
        let section = Section::beginning(first, start, radius);
        let [first_radius, least_radius] = [radius; 2];
        Self {
            section,
            longest: 0.0,
            longest_from: first,
            sharpest: first,
            is_uneven: false,
            turns: 0,
            at_ends: 0.0,
            tangents: [None; 2],
            first_radius,
            least_radius,
        }
    }

    /// Whether a segment with this radius belongs to it; then takes note of the radius.
    #[inline(always)]
    fn takes(&mut self, radius: Real) -> bool {
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
    fn bend(&mut self, at: usize, before: &Segment, segment: &Segment) {
        self.turns += 1;
        self.is_uneven |= before.length > UNEVEN * segment.length || segment.length > UNEVEN * before.length;
        let squared = (segment.direction - before.direction).length_squared();
        let noise = segment.noise + before.noise;
        // Most turns are no larger than the largest so far, which is seen without a root and a division.
        let known = self.section.curvature * (0.5 * (segment.length + before.length)) - noise;
        if known < 0.0 || squared > known * known {
            self.raise(at, curvature_between(before, segment));
        }
    }

    /// Takes note of the direction at an end.
    fn bend_from(&mut self, at: usize, end: usize, tangent: Vector, segment: &Segment) {
        self.tangents[end] = Some(tangent);
        self.raise(at, curvature_from(tangent, segment));
    }

    fn raise(&mut self, at: usize, curvature: Real) {
        if curvature > self.section.curvature {
            (self.section.curvature, self.sharpest) = (curvature, at);
        }
    }

    /// Ends it at a sample. `points` and `arcs` are all samples so far; `bounds` are those of the segments, if any.
    fn close(
        mut self,
        last: usize,
        rounding: Real,
        points: &[Vector],
        arcs: &[Real],
        bounds: &mut Vec<CurveBound>,
    ) -> Result<Section, Bend> {
        let first = self.section.first as usize;
        (self.section.last, self.section.end) = (last as u32, arcs[last]);
        let own = OwnSamples {
            points: &points[first..=last],
            arcs: &arcs[first..=last],
            tangents: self.tangents,
            rounding,
            shortest: 0.0,
        };
        let mut sharpest = None;
        if self.is_uneven {
            bounds.resize(first, CurveBound::default());
            sharpest = own.bound_unevenly(if self.turns < 2 { self.at_ends } else { 0.0 }, bounds);
            self.section.bound_by(&bounds[first..], &arcs[first..=last]);
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
                sharpest =
                    Some(Bend { at: self.sharpest - first, from: self.longest_from - first, turn: bend });
            }
        }
        match sharpest {
            Some(Bend { at, from, turn }) => Err(Bend { at: first + at, from: first + from, turn }),
            None => Ok(self.section),
        }
    }
}

impl Tube {
    /// Fills the tube; see [`Tube::set_samples`].
    pub(super) fn measure(
        &mut self,
        samples: &[Vector],
        radii: &[Real],
        end_tangents: Option<[Vector; 2]>,
    ) -> Result<(), RobotError> {
        // In one sweep without branches; what it does not find good is looked at closely.
        let (mut reach, mut is_good) = ([0.0; 3], samples.len() >= 2 && radii.len() + 1 == samples.len());
        for point in samples {
            for (reach, value) in reach.iter_mut().zip(point.abs().to_array()) {
                // NaN is not larger, but not good either.
                *reach = if value > *reach { value } else { *reach };
                is_good &= value <= COORDINATE_LIMIT;
            }
        }
        is_good &= radii.iter().fold(true, |good, &radius| good & (0.0..=COORDINATE_LIMIT).contains(&radius));
        if !is_good {
            check_segments(samples, radii)?;
        }
        let reach = reach.into_iter().fold(0.0, Real::max);
        let tangents = end_tangents.map(super::unit_tangents).transpose()?;

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
        // Coordinates that were computed in two ways may differ by so much.
        let one_place = 32.0 * Real::UNIT_ROUNDOFF * reach;
        let (mut gap, mut widest_gap): (Real, Real) = (0.0, 0.0);
        self.merged = 0.0;
        let (mut arc, mut before, mut last) = (0.0, None::<Segment>, 0);
        let mut open = Open::new(0, 0.0, radii[0]);
        let mut result = Ok(());
        for (k, (&sample, &radius)) in samples[1..].iter().zip(radii).enumerate() {
            // What is left out of the curve before it is unknown of its direction.
            let Some(segment) = Segment::between(points[last], sample, rounding + gap) else { continue };
            if segment.length <= one_place {
                gap = gap.max(segment.length);
                widest_gap = widest_gap.max(gap);
                continue;
            }
            gap = 0.0;
            if let Some(before) = &before {
                if open.takes(radius) {
                    open.bend(last, before, &segment);
                } else {
                    let turn = curvature_between(before, &segment);
                    open.at_ends = open.at_ends.max(turn);
                    let next = Open { at_ends: turn, ..Open::new(last, arc, radius) };
                    let done = std::mem::replace(&mut open, next);
                    self.merged = self.merged.max(done.section.radius - done.least_radius);
                    match done.close(last, rounding + widest_gap, &points, &arcs, &mut bounds) {
                        Ok(section) => self.sections.push(section),
                        Err(bend) => result = result.and(Err(bend.error(&segments))),
                    }
                }
            } else {
                open = Open::new(0, 0.0, radius);
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
            if segment.length > open.longest {
                (open.longest, open.longest_from) = (segment.length, last - 1);
            }
            before = Some(segment);
        }
        if let (Some(segment), Some([_, tangent])) = (before, tangents) {
            open.bend_from(last, 1, tangent, &segment);
        }
        points.truncate(last + 1);
        arcs.truncate(last + 1);
        segments.truncate(last + 1);
        self.merged = self.merged.max(open.section.radius - open.least_radius) + widest_gap;
        match open.close(last, rounding + widest_gap, &points, &arcs, &mut bounds) {
            Ok(section) => self.sections.push(section),
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
            result = self.stand_faces(&points, &bounds, tangents, rounding + widest_gap, one_place, samples);
        }
        self.curve = Curve::Samples(Samples { points, arcs, segments, bounds });
        result
    }

    /// Finds the flat ends of the sections and their directions. `points` are the samples without those repeated.
    fn stand_faces(
        &mut self,
        points: &[Vector],
        bounds: &[CurveBound],
        tangents: Option<[Vector; 2]>,
        rounding: Real,
        one_place: Real,
        samples: &[Vector],
    ) -> Result<(), RobotError> {
        let last = self.sections.len() - 1;
        for end in [0, 1] {
            self.walk(end, |tube, number, limit| {
                let section = &tube.sections[number];
                let stretch = &points[section.first as usize..=section.last as usize];
                let ahead = |k: usize| if end == 0 { stretch[k] } else { stretch[stretch.len() - 1 - k] };
                let centre = ahead(0);
                if !tube.is_flat(end, number, limit, centre) {
                    return;
                }
                let given = match (end, tangents) {
                    (0, Some([tangent, _])) if number == 0 => Some(-tangent),
                    (1, Some([_, tangent])) if number == last => Some(tangent),
                    _ => None,
                };
                let (outward, tilt) = match given {
                    Some(outward) => (outward, 0.0),
                    None => {
                        let curvature = bend_at_end(section, end, bounds);
                        direction_at_end(ahead, stretch.len(), curvature, rounding)
                    }
                };
                tube.sections[number].faces[end] =
                    Some(Face { centre, outward, tilt, lasting: Lasting::Either });
            });
        }
        for section in &self.sections {
            super::check_faces(section, || position_of(section.first as usize, samples, one_place))?;
        }
        self.mark_lasting_faces();
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

/// Where a point stood among the samples before those at one place were dropped.
fn position_of(point: usize, samples: &[Vector], one_place: Real) -> usize {
    let (mut last, mut count) = (0, 0);
    for k in 1..samples.len() {
        let is_apart = |segment: Segment| segment.length > one_place;
        if count < point && Segment::between(samples[last], samples[k], 0.0).is_some_and(is_apart) {
            (last, count) = (k, count + 1);
        }
    }
    last
}
