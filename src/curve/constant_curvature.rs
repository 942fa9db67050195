//! Robots of sections of constant curvature: from curvatures to points of the centreline.
//!
//! # Definitions
//! - Frame of a section: at its start, with z along the curve.
//! - `k`: curvature; `b`: unit vector across z towards which the section bends; `l`: arc length.
//!
//! # Formula
//! The section is an arc in the plane of z and b. After the arc length l
//!
//! - the frame has turned by the angle `k l` about `z x b`;
//! - the point is `z l sin(k l) / (k l) + b l (1 - cos(k l)) / (k l)`.
//!
//! The next section begins in that frame, carried along without twist. Source: Webster and Jones,
//! "Design and kinematic modeling of constant curvature continuum robots", 2010, equation 1.

use super::{Tube, TubeSection, check_sections};
use crate::robot::{Chain, RobotError, rotation_by};
use parry3d_f64::math::{Pose, Real, Vector};

/// A section of constant curvature, for [`ConstantCurvature`] and
/// [`BendingMotion`](crate::BendingMotion).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BendingSection {
    /// Arc length of the centreline, in the robot's unit.
    pub length: Real,
    /// Radius of the tube, in the same unit.
    pub radius: Real,
    /// Curvature towards x and y, in 1 / length, of the frame that is carried along without twist.
    /// At the base this is the robot's frame: the curve leaves the origin along z.
    pub bend: [Real; 2],
}

/// The centreline of a robot of constant-curvature sections, such as a tendon robot or concentric
/// tubes that do not twist.
///
/// The base is the origin, where the curve leaves along z. All lengths are in one unit; arc lengths
/// count from the base.
///
/// ```
/// use parry_continuum::{BendingSection, Chain, ConstantCurvature, simplify};
///
/// // A tendon robot in mm. Its second section bends by 0.05 / mm, 30 degrees from x.
/// let (sin, cos) = 30_f64.to_radians().sin_cos();
/// let first = BendingSection { length: 40.0, radius: 1.5, bend: [0.0, 0.02] };
/// let second = BendingSection { length: 30.0, radius: 1.0, bend: [0.05 * cos, 0.05 * sin] };
/// let robot = ConstantCurvature::new(&[first, second])?;
///
/// let tube = robot.tube()?; // the curve itself
/// let (points, radii) = robot.points(100); // or points along it,
/// let (few, radii) = simplify(&points, &radii, 0.05)?; // few suffice for 0.05 mm
/// let chain = Chain::from_centreline(&few, &radii)?;
/// # assert!(few.len() < points.len() / 2 && chain.links().len() + 1 == few.len());
/// # let end = chain.links().last().map(|link| link.end()).unwrap_or_default();
/// # assert!((end - robot.frame(70.0).translation).length() < 1e-12);
/// # drop(tube);
/// # Ok::<(), parry_continuum::RobotError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct ConstantCurvature {
    arcs: Vec<Arc>,
}

/// A section and its frame.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Arc {
    section: BendingSection,
    /// The arc length of the section's start.
    start: Real,
    /// The frame at the section's start, with z along the curve.
    frame: Pose,
}

impl ConstantCurvature {
    /// Builds the robot from its sections, base to tip.
    ///
    /// # Errors
    /// No section; a length that is not positive; a negative radius; a number that is not finite.
    pub fn new(sections: &[BendingSection]) -> Result<Self, RobotError> {
        check_bending("sections", sections)?;
        let (mut start, mut frame) = (0.0, Pose::IDENTITY);
        let place = |section: &BendingSection| {
            let arc = Arc { section: *section, start, frame };
            start += section.length;
            frame = arc.frame(start);
            arc
        };
        Ok(Self { arcs: sections.iter().map(place).collect() })
    }

    /// Returns the length of the centreline.
    pub fn length(&self) -> Real {
        self.arcs.last().map_or(0.0, |arc| arc.start + arc.section.length)
    }

    /// Returns the frame at an arc length: its translation is the centreline point, its z axis the
    /// tangent. Beyond either end the last arc continues.
    pub fn frame(&self, arc_length: Real) -> Pose {
        let number = self.arcs.partition_point(|arc| arc.start < arc_length).max(1) - 1;
        self.arcs.get(number).map_or(Pose::IDENTITY, |arc| arc.frame(arc_length))
    }

    /// Returns the point at `share` (0 to 1) of a section, or the base if there is no such section.
    pub(crate) fn at_share(&self, section: usize, share: Real) -> Vector {
        let point = |arc: &Arc| arc.frame(arc.start + arc.section.length * share).translation;
        self.arcs.get(section).map_or(Vector::ZERO, point)
    }

    /// Returns points along the centreline and the radii of the segments between them.
    ///
    /// Each section is divided into `segments` segments of equal length, at least one. The result
    /// fits every constructor of a [`Chain`](crate::Chain), and [`simplify`](crate::simplify). A
    /// segment of length l deviates from an arc of curvature k by `k l^2 / 8`.
    pub fn points(&self, segments: usize) -> (Vec<Vector>, Vec<Real>) {
        let segments = segments.max(1);
        let along = |arc: Arc| {
            let share = move |step: usize| step as Real / segments as Real;
            (1..=segments).map(move |step| {
                arc.frame(arc.start + arc.section.length * share(step)).translation
            })
        };
        let points = std::iter::once(Vector::ZERO).chain(self.arcs.iter().copied().flat_map(along));
        let radii =
            self.arcs.iter().flat_map(|arc| std::iter::repeat_n(arc.section.radius, segments));
        (points.collect(), radii.collect())
    }

    /// Returns the robot as a chain through [`points`](Self::points).
    ///
    /// # Errors
    /// As [`Chain::from_centreline`].
    pub(crate) fn chain(&self, segments: usize) -> Result<Chain, RobotError> {
        let (points, radii) = self.points(segments);
        Chain::from_centreline(&points, &radii)
    }

    /// Returns the robot as a curve.
    ///
    /// # Errors
    /// A section with a flat end whose curvature times radius is 1 or more; a section that ends out
    /// of range.
    pub fn tube(&self) -> Result<Tube, RobotError> {
        self.clone().into_tube()
    }

    pub(crate) fn into_tube(self) -> Result<Tube, RobotError> {
        let sections: Vec<_> = self.arcs.iter().map(|arc| stated(&arc.section)).collect();
        Tube::from_function(&sections, move |arc_length| {
            let frame = self.frame(arc_length);
            (frame.translation, frame.rotation * Vector::Z)
        })
    }
}

/// Checks sections before they are used.
///
/// # Errors
/// No section; a length that is not positive, a radius that is negative, or a number that is not
/// finite.
pub(crate) fn check_bending(
    parameter: &'static str,
    sections: &[BendingSection],
) -> Result<(), RobotError> {
    check_sections(parameter, &sections.iter().map(stated).collect::<Vec<_>>())
}

/// Returns the section in the form that a tube takes: curvature without direction.
fn stated(section: &BendingSection) -> TubeSection {
    let [x, y] = section.bend;
    TubeSection {
        length: section.length,
        radius: section.radius,
        curvature: Vector::new(x, y, 0.0).length(),
    }
}

impl Arc {
    fn frame(&self, arc_length: Real) -> Pose {
        let [x, y] = self.section.bend;
        let length = arc_length - self.start;
        // The rotation vector per unit of length, which bends z towards `bend`.
        let turn = Vector::new(-y, x, 0.0);
        let angle = turn.length() * length;
        let sinc = |x: Real| if x == 0.0 { 1.0 } else { libm::sin(x) / x };
        // `1 - cos` would lose half of its digits for small angles.
        let across = 0.5 * length * length * sinc(0.5 * angle) * sinc(0.5 * angle);
        let point = Vector::Z * (length * sinc(angle)) + Vector::new(x, y, 0.0) * across;
        self.frame * Pose::from_parts(point, rotation_by(turn * length))
    }
}
