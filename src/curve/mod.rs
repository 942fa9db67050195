//! The robot as a curve: a tube with given radii around a centreline of bounded curvature.

mod cap_persistence;
mod centreline;
mod constant_curvature;
mod curve_bound;
mod direction_at_end;
mod fit;
mod flat_ends;
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
#[cfg(feature = "robots")]
mod turns;
mod uncertainty;

pub(crate) use cap_persistence::Drift;
pub(crate) use curve_bound::CurveBound;
pub use function::TubeSection;
pub(crate) use section::{CapPersistence, EndFace, Section};
#[cfg(feature = "robots")]
pub(crate) use turns::{TooSharp, TubeTurns};

use crate::robot::{Cap, RobotError, direction, radius_for_all};
use centreline::{Curve, Foot, PlaceOnCurve};
use parry3d_f64::math::{Real, Vector};
use sample_clusters::SampleCluster;
use section_samples::Hat;

/// A continuum robot as a curve: all discs across a smooth centreline, with one radius per section.
///
/// A [`Chain`](crate::Chain) is a model of the robot; the number of its links decides the modelling
/// error. A tube is the robot itself. Each query names a tolerance, divides the tube only as finely
/// as that tolerance requires, and returns a lower and an upper bound.
///
/// A section is a range of the tube with one radius. The tube ends in a flat face at the robot's
/// two ends and on the wider side of each step in radius. A section that begins or ends about one
/// radius from such a face has flat ends too, where it joins the next one. Lengths are in one unit,
/// points in the robot's frame.
///
/// # Assumptions about the curve
/// - [`from_samples`](Self::from_samples): the curve passes through the samples. Each section bends
///   at most as much as its samples show. If samples lie unevenly, each segment bends at most as
///   much as the two samples before it and the two behind it show. Within that limit the curvature
///   may jump anywhere. A curve that turns more sharply between two samples than at any sample is
///   not covered: sample more densely.
/// - [`from_frames`](Self::from_frames): the curve passes through the points in the given
///   directions, and bends as these show.
/// - [`fit`](Self::fit): measured points. The curve is within the stated deviation of the fitted
///   curve, with any shape.
/// - [`from_function`](Self::from_function): the curve is the function. Its curvature in each
///   section is at most the stated one. [`verify`](Self::verify) tests this on samples.
/// - `Tube::from(&chain)`: straight sections with the chain's caps. Queries err by rounding alone.
///
/// [`with_error`](Self::with_error) adds errors of a sensor or of the kinematics.
///
/// ```
/// use parry_continuum::{Tube, parry::{math::{Pose, Vector}, shape::{Ball, TriMesh}}};
/// use parry_continuum::proximity::BvhSearch;
///
/// let (vertices, triangles) = Ball::new(50.0).to_trimesh(64, 32);
/// let mut search = BvhSearch::new(&TriMesh::new(vertices, triangles)?)?;
/// let arc: Vec<_> = (0..=60)
///     .map(|k| f64::from(k) / 60.0)
///     .map(|a| Vector::new(a.cos(), 0.0, a.sin()) * 30.0)
///     .collect();
/// let tube = Tube::from_samples(&arc, &[1.0; 60], None)?;
/// let found = search.clearance(&tube, &Pose::IDENTITY, 0.01)?;
/// assert!(found.upper - found.lower <= 0.01);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct Tube {
    curve: Curve,
    sections: Vec<Section>,
    /// Memory for the next samples. Measuring into it leaves the tube unchanged on an error.
    buffer: (Curve, Vec<Section>),
    /// The stated distance of the curve from the given one.
    error: Real,
    /// The stated error of directions near flat ends, rad; `None` if not stated.
    turn: Option<Real>,
    /// Upper bounds on the distance of a fitted curve from its points (`residual`), and of the true
    /// curve from the fitted one (`deviation`).
    residual: Real,
    deviation: Real,
    /// The distance of points treated as one, plus the difference of radii treated as equal.
    merged: Real,
    /// An upper bound on the coordinates of the centreline and on its length.
    reach: Real,
    /// Memory for clusters of samples.
    clusters: [Vec<SampleCluster>; 2],
    /// Memory for the bends that samples show.
    hats: Vec<Hat>,
    /// Memory for the ends and caps of the next links.
    ends: Vec<Vector>,
    caps: Vec<[Cap; 2]>,
}

impl Clone for Tube {
    fn clone(&self) -> Self {
        let mut tube = Self::empty();
        tube.clone_from(self);
        tube
    }

    /// Reuses the tube's memory; the buffers are not copied.
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
    /// Builds the tube around a smooth curve through `points`, with one radius per segment.
    ///
    /// - `points`: samples of the centreline, base to tip, in the robot's frame.
    /// - `segment_radii`: one radius per segment, in the unit of the points.
    /// - `end_tangents`: directions of the curve at the first and the last point, towards the tip,
    ///   of any length. Without them, and at steps in radius, samples alone determine the direction
    ///   of a flat face: up to half of the section's curvature times the first segment, or better
    ///   if the section bends there as much as anywhere. This uncertainty times the radius widens
    ///   the bounds of every answer near the face.
    ///
    /// **Curvature.** The curvature of a section is the largest that its samples show: turn over
    /// distance between neighbouring segments. A section of one segment shows none; the turns at
    /// its two ends count, which its neighbours share. If samples lie unevenly, each segment bends
    /// at most as much as the two samples before it and the two behind it show. The curvature may
    /// jump anywhere. A bend that turns about the curve by the share q of itself per sample, as in
    /// a helix, shows q^2 / 12 too small: sample it densely.
    ///
    /// **Repeated points.** Points closer than the rounding of coordinates (2^-48 of the largest)
    /// are one point, for example where one section ends and the next begins. The radius of the
    /// segment between them is dropped. Radii that differ by less than 2^-32 of a section's first
    /// one form one section with the largest of them. All bounds include these changes.
    ///
    /// **Samples taken twice.** Two samples a little apart may show a bend that no smooth curve
    /// has. They count as one if they are 32 times nearer to each other than to the samples before
    /// and behind them. The bounds allow for both curves: through both samples, if the curve then
    /// turns by at most 1 rad to the next sample, and past the first sample within their distance.
    /// The `uncertainty` of answers includes this distance.
    ///
    /// # Errors
    /// - As [`Chain::from_centreline`](crate::Chain::from_centreline);
    /// - a tangent that is zero or not finite;
    /// - samples so far apart that the curve could turn by more than 1 rad from one to the next;
    /// - a section with a flat end whose curvature times radius is 1 or more: its discs would stick
    ///   out of the face.
    pub fn from_samples(
        points: &[Vector],
        segment_radii: &[Real],
        end_tangents: Option<[Vector; 2]>,
    ) -> Result<Self, RobotError> {
        let mut tube = Self::empty();
        tube.set_samples(points, segment_radii, end_tangents)?;
        Ok(tube)
    }

    /// Builds the tube of constant radius around a smooth curve through `points`.
    ///
    /// As [`from_samples`](Self::from_samples) with `radius` for all segments.
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

    /// Replaces the samples, as [`from_samples`](Self::from_samples), in the same memory.
    ///
    /// A control loop whose robot keeps its number of points allocates nothing. An error stated by
    /// [`with_error`](Self::with_error) stays.
    ///
    /// # Errors
    /// As [`from_samples`](Self::from_samples). The tube is then unchanged.
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

    /// Returns the length of the centreline; for samples, of the polyline through them.
    pub fn length(&self) -> Real {
        self.sections.last().map_or(0.0, |section| section.end)
    }

    pub(crate) fn sections(&self) -> &[Section] {
        &self.sections
    }

    /// Returns an upper bound on the absolute coordinates of the centreline.
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

    /// Returns the bounds on the curve between two ticks of a section.
    pub(crate) fn bound(&self, section: &Section, ticks: [u32; 2]) -> CurveBound {
        self.curve.bound(section, ticks)
    }

    /// Returns the input segment at an arc length of a section, or the section's number if the
    /// curve is a function.
    pub(crate) fn segment(&self, number: u32, arc: Real) -> u32 {
        self.curve.segment(&self.sections[number as usize], arc).unwrap_or(number)
    }

    pub(crate) fn foot(&self, section: &Section, arc: Real, point: Vector) -> Foot {
        self.curve.foot(section, arc, point)
    }

    /// Returns the place of a tick as a share of its section's length.
    pub(crate) fn share(&self, section: &Section, tick: u32) -> Real {
        self.curve.share(section, tick)
    }

    /// Returns the smallest range of ticks that contains two shares of a section.
    pub(crate) fn ticks_around(&self, section: &Section, shares: [Real; 2]) -> [u32; 2] {
        self.curve.ticks_around(section, shares)
    }

    /// Returns the place at a share of a section.
    pub(crate) fn at_share(&self, section: &Section, share: Real) -> PlaceOnCurve {
        self.curve.at_share(section, share)
    }

    /// Whether the curve is a function.
    #[cfg(feature = "robots")]
    pub(crate) fn is_function(&self) -> bool {
        matches!(self.curve, Curve::Function(_))
    }

    /// Returns the shares of the two samples around a share of a section; `None` if the curve is a
    /// function.
    pub(crate) fn samples_around(&self, section: &Section, share: Real) -> Option<[Real; 2]> {
        let Curve::Samples(_) = self.curve else { return None };
        Some(self.ticks_around(section, [share; 2]).map(|tick| self.share(section, tick)))
    }

    /// Swaps `curve` and `sections` with `buffer`.
    fn exchange(&mut self) {
        std::mem::swap(&mut self.curve, &mut self.buffer.0);
        std::mem::swap(&mut self.sections, &mut self.buffer.1);
    }

    pub(crate) fn empty() -> Self {
        Self {
            curve: Curve::default(),
            sections: Vec::new(),
            buffer: (Curve::default(), Vec::new()),
            error: 0.0,
            turn: None,
            residual: 0.0,
            deviation: 0.0,
            merged: 0.0,
            reach: 0.0,
            clusters: Default::default(),
            hats: Vec::new(),
            ends: Vec::new(),
            caps: Vec::new(),
        }
    }
}

/// Checks that no disc behind a flat face sticks out of it: the centreline must not bend within a
/// radius there. A face of unknown direction is not checked.
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
    let unit = tangents.map(direction);
    match unit.iter().position(|tangent| !tangent.is_finite() || *tangent == Vector::ZERO) {
        Some(index) => {
            Err(RobotError::BadTangent { parameter: "end_tangents", index, value: tangents[index] })
        }
        None => Ok(unit),
    }
}
