//! The robot as a curve: a tube of stated radii around a centreline of bounded curvature.

mod cap_persistence;
mod curve;
mod direction_at_end;
mod faces;
mod fit;
mod frames;
mod from_chain;
mod function;
mod hermite_segment;
mod long_segments;
mod open_section;
mod sample_clusters;
mod samples;
mod section;
mod section_samples;
mod segment;
mod smoothing_spline;
#[cfg(test)]
mod tests;
mod tube_builder;
mod turns;
mod uncertainty;
mod verify;

pub(crate) use cap_persistence::{CapPersistence, Drift};
pub use function::TubeSection;
pub(super) use function::check_sections;
pub(crate) use section::{EndFace, Section};
pub(crate) use turns::{TooSharp, TubeTurns};

use super::chain::radius_for_all;
use super::{Cap, RobotError};
pub(crate) use curve::CurveBound;
use curve::{Curve, Foot, PlaceOnCurve};
use parry3d_f64::math::{Real, Vector};
use sample_clusters::SampleCluster;
use section_samples::Hat;

/// A continuum robot as the curve that it is: all discs across a smooth centreline, with a radius
/// for each section.
///
/// Where a [`Chain`](crate::Chain) is a model of the robot, whose links decide how far it is from
/// the truth, a tube is the robot, and each query says what error it bears. The query divides the
/// tube only as finely as that takes, and its answer has bounds.
///
/// A section is a stretch with one radius. The tube ends in a flat face at the robot's two ends and
/// on the wider side of a step in radius. Sections that begin or end about a radius from such a
/// face have flat ends too, where they join the next one. Lengths are in one unit, points in the
/// robot's frame.
///
/// # What is known of the curve
/// - [`from_samples`](Self::from_samples): the curve goes through the samples, and each section
///   bends nowhere more than its samples show at most; where these lie unevenly, each segment no
///   more than the two samples before it and the two behind it show. Within that its curvature may
///   jump anywhere. A curve that turns more sharply between two samples than at any of them is not
///   covered: sample more densely.
/// - [`from_frames`](Self::from_frames): the curve goes through the points in the directions given,
///   and bends as these show.
/// - [`fit`](Self::fit): measured points. The curve is no farther from the fitted one than was
///   stated, whatever it does there.
/// - [`from_function`](Self::from_function): the curve is the function, and its curvature in each
///   section is at most what is stated. [`verify`](Self::verify) tries that on samples.
/// - `Tube::from(&chain)`: straight pieces with the chain's caps, whose queries have no error but
///   rounding.
///
/// Errors of a sensor or of the kinematics are added by [`with_error`](Self::with_error).
///
/// ```
/// use parry_continuum::{Tube, parry::{math::{Pose, Vector}, shape::{Ball, TriMesh}}};
/// use parry_continuum::proximity::BvhSearch;
///
/// let (vertices, triangles) = Ball::new(50.0).to_trimesh(64, 32);
/// let mut search = BvhSearch::new(&TriMesh::new(vertices, triangles)?)?;
/// let arc: Vec<_> = (0..=60).map(|k| f64::from(k) / 60.0).map(|a| Vector::new(a.cos(), 0.0, a.sin()) * 30.0).collect();
/// let tube = Tube::from_samples(&arc, &[1.0; 60], None)?;
/// let found = search.clearance(&tube, &Pose::IDENTITY, 0.01)?;
/// assert!(found.upper - found.lower <= 0.01);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct Tube {
    curve: Curve,
    sections: Vec<Section>,
    /// Memory for the next samples: what they are measured in, so that the tube stays as it was
    /// where they are refused.
    spare: (Curve, Vec<Section>),
    /// How far the curve may be from what was given.
    error: Real,
    /// How far the directions at flat ends may be from what was given; none if nobody said.
    turn: Option<Real>,
    /// How far it is from the points that it was fitted to, at most; and how far the curve may be
    /// from it.
    residual: Real,
    deviation: Real,
    /// By how much points that were taken for one lie apart, and radii that were taken for one
    /// differ.
    merged: Real,
    /// The largest coordinate of the centreline, or its length, or more.
    reach: Real,
    /// Memory for samples that crowd.
    crowds: [Vec<SampleCluster>; 2],
    /// Memory for what samples show.
    hats: Vec<Hat>,
    /// Memory for the next links: their ends and caps.
    ends: Vec<Vector>,
    caps: Vec<[Cap; 2]>,
}

impl Clone for Tube {
    fn clone(&self) -> Self {
        let mut tube = Self::empty();
        tube.clone_from(self);
        tube
    }

    /// In the memory that it has. What is kept for the next links stays.
    fn clone_from(&mut self, source: &Self) {
        self.curve.clone_from(&source.curve);
        self.sections.clone_from(&source.sections);
        (self.error, self.merged, self.reach) = (source.error, source.merged, source.reach);
        (self.turn, self.residual, self.deviation) =
            (source.turn, source.residual, source.deviation);
    }
}

impl std::fmt::Debug for Tube {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Tube").field("sections", &self.sections).finish_non_exhaustive()
    }
}

impl Tube {
    /// The tube around a smooth curve through `points`, with one radius for each segment between
    /// them.
    ///
    /// `end_tangents` are the curve's directions at the first and the last point, towards the tip,
    /// of any length. Without them, and at steps in radius, the direction of a flat face is
    /// known from the samples alone: to half of the section's curvature times the first
    /// segment, or better where the section bends there as much as anywhere. What that
    /// leaves open, times the radius, widens the bounds of every answer near the face.
    ///
    /// The curvature of a section is the largest that its samples show: turn / distance between
    /// neighbouring segments. A section of one segment shows nothing of its own; the turns at
    /// its two ends count, which its neighbours share. Where samples lie unevenly, each segment
    /// bends no more than the two samples before it and the two behind it show. Points at one
    /// place, but for the rounding of coordinates so large (2^-48 of the largest), are one, as
    /// where the points of one section end and those of the next begin; the radius of the
    /// segment between them is dropped. Radii that differ by less than 2^-32 of a section's
    /// first are one section, with the largest of them. What that changes counts in all bounds.
    ///
    /// Where a sample was taken twice, a little apart, the two may show a bend that no smooth curve
    /// has. If they are 32 times nearer to each other than to the samples before and behind
    /// them, they are one too: the curve passes the first of them as closely as the other one
    /// does, which counts in all bounds and in the `uncertainty` of answers.
    ///
    /// # Errors
    /// As [`Chain::from_centreline`](crate::Chain::from_centreline); a tangent that is zero or not
    /// finite; samples so far apart that the curve could turn by more than 1 rad from one to
    /// the next; or a section with a flat end whose curvature times its radius is 1 or more, so
    /// that its discs would stick out of the face.
    pub fn from_samples(
        points: &[Vector],
        segment_radii: &[Real],
        end_tangents: Option<[Vector; 2]>,
    ) -> Result<Self, RobotError> {
        let mut tube = Self::empty();
        tube.set_samples(points, segment_radii, end_tangents)?;
        Ok(tube)
    }

    /// The tube of the same radius everywhere around a smooth curve through `points`:
    /// [`from_samples`](Self::from_samples) with one radius for all segments.
    ///
    /// # Errors
    /// As [`from_samples`](Self::from_samples).
    pub fn with_constant_radius(
        points: &[Vector],
        radius: Real,
        end_tangents: Option<[Vector; 2]>,
    ) -> Result<Self, RobotError> {
        Self::from_samples(points, &radius_for_all(points, radius)?, end_tangents)
    }

    /// Makes this tube what [`from_samples`](Self::from_samples) makes of the arguments, in the
    /// memory that it has: a control loop whose robot keeps its number of points allocates
    /// nothing. An error stated by [`with_error`](Self::with_error) stays.
    ///
    /// # Errors
    /// As [`from_samples`](Self::from_samples). The tube is then what it was before.
    pub fn set_samples(
        &mut self,
        points: &[Vector],
        segment_radii: &[Real],
        end_tangents: Option<[Vector; 2]>,
    ) -> Result<(), RobotError> {
        let before = (self.reach, self.merged);
        self.exchange();
        let measured = self.measure(points, segment_radii, end_tangents);
        if measured.is_err() {
            self.exchange();
            (self.reach, self.merged) = before;
        } else {
            (self.residual, self.deviation) = (0.0, 0.0);
        }
        measured
    }

    /// The length of the centreline; between samples, of the lines that join them.
    pub fn length(&self) -> Real {
        self.sections.last().map_or(0.0, |section| section.end)
    }

    pub(crate) fn sections(&self) -> &[Section] {
        &self.sections
    }

    /// The largest coordinate of the tube in its frame, or more.
    pub(crate) fn reach(&self) -> Real {
        self.reach
    }

    pub(crate) fn point(&self, section: &Section, tick: u32) -> Vector {
        self.curve.point(section, tick)
    }

    pub(crate) fn arc(&self, section: &Section, tick: u32) -> Real {
        self.curve.arc(section, tick)
    }

    pub(crate) fn tick(&self, section: &Section, arc: Real) -> u32 {
        self.curve.tick(section, arc)
    }

    /// What is known of the curve between two ticks of a section.
    pub(crate) fn bound(&self, section: &Section, ticks: [u32; 2]) -> CurveBound {
        self.curve.bound(section, ticks)
    }

    /// The segment of the input at an arc length of a section; the section's number where the curve
    /// is a function.
    pub(crate) fn segment(&self, number: u32, arc: Real) -> u32 {
        self.curve.segment(&self.sections[number as usize], arc).unwrap_or(number)
    }

    pub(crate) fn foot(&self, section: &Section, arc: Real, point: Vector) -> Foot {
        self.curve.foot(section, arc, point)
    }

    /// The place of a tick as a share of its section's length.
    pub(crate) fn share(&self, section: &Section, tick: u32) -> Real {
        self.curve.share(section, tick)
    }

    /// The ticks next to two shares of a section, outside of what is between them.
    pub(crate) fn ticks_around(&self, section: &Section, shares: [Real; 2]) -> [u32; 2] {
        self.curve.ticks_around(section, shares)
    }

    /// The place at a share of a section.
    pub(crate) fn at_share(&self, section: &Section, share: Real) -> PlaceOnCurve {
        self.curve.at_share(section, share)
    }

    /// The shares of the two samples around a share of a section; none where the curve is a
    /// function.
    pub(crate) fn samples_around(&self, section: &Section, share: Real) -> Option<[Real; 2]> {
        let Curve::Samples(_) = self.curve else { return None };
        Some(self.ticks_around(section, [share; 2]).map(|tick| self.share(section, tick)))
    }

    /// Exchanges curve and sections for the spare ones.
    fn exchange(&mut self) {
        std::mem::swap(&mut self.curve, &mut self.spare.0);
        std::mem::swap(&mut self.sections, &mut self.spare.1);
    }

    pub(crate) fn empty() -> Self {
        Self {
            curve: Curve::default(),
            sections: Vec::new(),
            spare: (Curve::default(), Vec::new()),
            error: 0.0,
            turn: None,
            residual: 0.0,
            deviation: 0.0,
            merged: 0.0,
            reach: 0.0,
            crowds: Default::default(),
            hats: Vec::new(),
            ends: Vec::new(),
            caps: Vec::new(),
        }
    }
}

/// Discs behind a flat face must not stick out of it, which they would where the centreline bends
/// within a radius. Of a face whose direction nobody knows nothing is said.
fn check_faces(section: &Section, index: impl FnOnce() -> usize) -> Result<(), RobotError> {
    let Section { shown_at, radius, faces, .. } = *section;
    let is_known = |face: &Option<EndFace>| face.is_some_and(|face| face.tilt < Real::INFINITY);
    match faces
        .iter()
        .zip(shown_at)
        .find(|(face, curvature)| is_known(face) && curvature * radius >= 1.0)
    {
        Some((_, curvature)) => {
            Err(RobotError::BendsWithinRadius { index: index(), curvature, radius })
        }
        None => Ok(()),
    }
}

fn unit_tangents(tangents: [Vector; 2]) -> Result<[Vector; 2], RobotError> {
    let unit = tangents.map(super::scale::direction);
    match unit.iter().position(|tangent| !tangent.is_finite() || *tangent == Vector::ZERO) {
        Some(index) => {
            Err(RobotError::BadTangent { parameter: "end_tangents", index, value: tangents[index] })
        }
        None => Ok(unit),
    }
}
