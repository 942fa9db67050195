//! Builds a tube along a curve that is known between its samples, with points as dense as its bends
//! require.

use super::Tube;
use super::centreline::{Curve, NextPoint, Samples};
use super::curve_bound::CurveBound;
use super::section::{CapPersistence, EndFace, Section};
use crate::distance::Scalar;
use crate::robot::{RobotError, is_same};
use parry3d_f64::math::{Real, Vector};

/// A tube under construction.
pub(super) struct TubeBuilder {
    samples: Samples,
    sections: Vec<Section>,
    /// The tangents of the curve at the ends of each section.
    tangents: Vec<[Vector; 2]>,
    first_radius: Real,
    least_radius: Real,
    /// The largest difference of radii that were treated as equal.
    merged: Real,
}

impl TubeBuilder {
    /// Begins at the first point, in the memory of a curve and sections.
    pub(super) fn begin(curve: Curve, mut sections: Vec<Section>, start: Vector) -> Self {
        let mut samples = curve.into_samples();
        samples.clear();
        sections.clear();
        samples.points.push(start);
        samples.arcs.push(0.0);
        let [first_radius, least_radius, merged] = [0.0; 3];
        Self { samples, sections, tangents: Vec::new(), first_radius, least_radius, merged }
    }

    /// Lays an input segment with the tangents at its start and its end.
    pub(super) fn lay(
        &mut self,
        segment: u32,
        radius: Real,
        tangents: [Vector; 2],
        points: impl Iterator<Item = NextPoint>,
    ) {
        let (first, start) = (self.samples.points.len() - 1, self.samples.length());
        let goes_on = !self.sections.is_empty() && is_same(self.first_radius, radius);
        if !goes_on {
            self.close();
            self.sections.push(Section::beginning(first, start, radius));
            self.tangents.push(tangents);
            [self.first_radius, self.least_radius] = [radius; 2];
        }
        for next in points {
            self.samples.push(segment, next);
        }
        self.least_radius = self.least_radius.min(radius);
        let (last, end) = (self.samples.points.len() - 1, self.samples.length());
        if let (Some(section), Some(own)) = (self.sections.last_mut(), self.tangents.last_mut()) {
            section.radius = section.radius.max(radius);
            (section.last, section.end) = (last as u32, end);
            own[1] = tangents[1];
        }
    }

    fn close(&mut self) {
        let Some(section) = self.sections.last_mut() else { return };
        let (first, last) = (section.first as usize, section.last as usize);
        section.bound_by(&self.samples.bounds[first..last], &self.samples.arcs[first..=last]);
        self.merged = self.merged.max(section.radius - self.least_radius);
    }

    /// Completes the tube.
    ///
    /// - `tilt`: uncertainty of the directions of faces, rad; infinite if unknown.
    /// - `stretch`: upper bound on the curve's true length over the laid length.
    /// - `gap`: distance of points that were merged.
    ///
    /// # Errors
    /// All points are equal, or a section bends within its radius next to a face.
    pub(super) fn finish(
        mut self,
        tube: &mut Tube,
        tilt: Real,
        stretch: Real,
        gap: Real,
    ) -> Result<(), RobotError> {
        self.close();
        let Self { mut samples, sections, tangents, merged, .. } = self;
        samples.segments.push(samples.segments.last().copied().unwrap_or(0));
        samples.bounds.push(CurveBound::default());
        let end = samples.length();
        tube.reach = samples
            .points
            .iter()
            .fold(end, |reach: Real, point| point.abs().max_element().max(reach));
        tube.merged = merged + gap;
        tube.sections = sections;
        for section in &mut tube.sections {
            section.stretch = section.stretch.max(stretch);
        }
        for end in [0, 1] {
            tube.walk(end, |tube, number, limit| {
                let section = &mut tube.sections[number];
                let centre =
                    samples.points[if end == 0 { section.first } else { section.last } as usize];
                let outward = if end == 0 { -tangents[number][0] } else { tangents[number][1] };
                let persistence = CapPersistence::Either;
                let tilt = tilt + 32.0 * Real::UNIT_ROUNDOFF;
                section.faces[end] = Some(EndFace { centre, outward, tilt, persistence });
                // A face of unknown direction says nothing about the space behind it.
                if tilt < Real::INFINITY && !tube.is_flat(end, number, limit, centre) {
                    tube.sections[number].faces[end] = None;
                }
            });
        }
        let input = |section: &Section| samples.segments[section.first as usize] as usize;
        let fit = tube
            .sections
            .iter()
            .try_for_each(|section| super::check_faces(section, || input(section)));
        let is_point = samples.points.len() < 2;
        tube.curve = Curve::Samples(samples);
        if is_point {
            return Err(RobotError::AllPointsEqual);
        }
        tube.mark_persistent_faces();
        fit
    }
}
