//! A tube from samples: its sections, and how far the curve through the samples may be from the lines between them.
//!
//! Nobody knows the curve between two samples. It is taken to bend no more than the samples show: its curvature in a
//! section is at most the largest of turn / distance over the section's samples, where turn is the change of direction
//! (as the length of the difference of the unit vectors) between the two segments that meet in a sample, and distance is
//! half of their lengths together. For a circle that is its curvature exactly. A turn at a step in radius counts only for
//! a section that has fewer than two of its own.
//!
//! With that curvature k, and h the longest segment:
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
use super::curve::Curve;
use super::direction_at_end::direction_at_end;
use super::lasting::Lasting;
use super::section::{Face, Section};
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
fn curvature_between(before: &Segment, segment: &Segment) -> Real {
    let turn = (segment.direction - before.direction).length() + segment.noise + before.noise;
    turn / (0.5 * (segment.length + before.length))
}

/// A section on its way.
struct Open {
    section: Section,
    longest: Real,
    /// The sample before its longest segment.
    longest_from: usize,
    /// How many turns it has inside.
    turns: usize,
    /// The curvature that the turns at steps in radius show.
    at_ends: Real,
    /// The radii of its first and of its thinnest segment.
    first_radius: Real,
    least_radius: Real,
}

impl Open {
    fn new(first: usize, start: Real, radius: Real) -> Self {
        let section = Section {
            first: first as u32,
            last: first as u32,
            start,
            end: start,
            radius,
            curvature: 0.0,
            stretch: 1.0,
            deviation: 0.0,
            faces: [None; 2],
        };
        let [first_radius, least_radius] = [radius; 2];
        Self {
            section,
            longest: 0.0,
            longest_from: first,
            turns: 0,
            at_ends: 0.0,
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

    /// Takes note of the turn from one segment to the next.
    #[inline(always)]
    fn bend(&mut self, before: &Segment, segment: &Segment) {
        self.turns += 1;
        let squared = (segment.direction - before.direction).length_squared();
        let noise = segment.noise + before.noise;
        // Most turns are no larger than the largest so far, which is seen without a root and a division.
        let known = self.section.curvature * (0.5 * (segment.length + before.length)) - noise;
        if known < 0.0 || squared > known * known {
            self.raise(curvature_between(before, segment));
        }
    }

    /// Takes note of the turn between a segment and the direction at one of its ends.
    fn bend_from(&mut self, direction: Vector, segment: &Segment) {
        let turn = (segment.direction - direction).length() + segment.noise;
        self.raise(turn / (0.5 * segment.length));
    }

    fn raise(&mut self, curvature: Real) {
        if curvature > self.section.curvature {
            self.section.curvature = curvature;
        }
    }

    fn close(mut self, last: usize, end: Real) -> Result<Section, RobotError> {
        if self.turns < 2 {
            self.raise(self.at_ends);
        }
        let section = &mut self.section;
        (section.last, section.end) = (last as u32, end);
        let bend = section.curvature * self.longest;
        if bend > 1.0 {
            return Err(RobotError::TurnsTooSharply { index: self.longest_from, turn: bend });
        }
        section.stretch = 1.0 + bend * bend / 20.0 + 8.0 * Real::UNIT_ROUNDOFF;
        let longest = self.longest * section.stretch;
        section.deviation = section.curvature * longest * longest / 8.0;
        Ok(self.section)
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

        let (mut points, mut arcs, mut segments) = std::mem::take(&mut self.curve).into_samples();
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
                    open.bend(before, &segment);
                } else {
                    let turn = curvature_between(before, &segment);
                    open.at_ends = open.at_ends.max(turn);
                    let next = Open { at_ends: turn, ..Open::new(last, arc, radius) };
                    let done = std::mem::replace(&mut open, next);
                    self.merged = self.merged.max(done.section.radius - done.least_radius);
                    match done.close(last, arc) {
                        Ok(section) => self.sections.push(section),
                        Err(error) => result = result.and(Err(error)),
                    }
                }
            } else {
                open = Open::new(0, 0.0, radius);
                if let Some([tangent, _]) = tangents {
                    open.bend_from(tangent, &segment);
                }
            }
            arc += segment.length;
            segments[last] = k as u32;
            // Where it already is, unless points are repeated.
            last += 1;
            points[last] = sample;
            arcs[last] = arc;
            if segment.length > open.longest {
                (open.longest, open.longest_from) = (segment.length, k);
            }
            before = Some(segment);
        }
        if let (Some(segment), Some([_, tangent])) = (before, tangents) {
            open.bend_from(tangent, &segment);
        }
        points.truncate(last + 1);
        arcs.truncate(last + 1);
        segments.truncate(last + 1);
        self.merged = self.merged.max(open.section.radius - open.least_radius) + widest_gap;
        match open.close(last, arc) {
            Ok(section) => self.sections.push(section),
            Err(error) => result = result.and(Err(error)),
        }
        // Lengths along the tube are rounded too.
        self.reach = reach.max(arc);
        if last == 0 {
            result = Err(RobotError::AllPointsEqual);
        }
        if result.is_ok() {
            result = self.stand_faces(&points, tangents, rounding + widest_gap, one_place, samples);
        }
        self.curve = Curve::Samples { points, arcs, segments };
        result
    }

    /// Finds the flat ends of the sections and their directions. `points` are the samples without those repeated.
    fn stand_faces(
        &mut self,
        points: &[Vector],
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
                    None => direction_at_end(ahead, stretch.len(), section.curvature, rounding),
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
