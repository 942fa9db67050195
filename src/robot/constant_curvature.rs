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

use super::{COORDINATE_LIMIT, Chain, RobotError, check_radii, rotation_by};
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
    pub(crate) arcs: Vec<Arc>,
}

/// A section and its frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Arc {
    pub section: BendingSection,
    /// The arc length of the section's start.
    pub start: Real,
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
}

/// Checks sections of curves before they are used. Each is its length, its radius, and its
/// curvature.
///
/// # Errors
/// No section; a length that is not positive, a radius or a curvature that is negative, or a number
/// that is not finite.
pub(crate) fn check_sections(
    parameter: &'static str,
    sections: impl ExactSizeIterator<Item = [Real; 3]>,
) -> Result<(), RobotError> {
    if sections.len() == 0 {
        return Err(RobotError::NoSections { parameter });
    }
    for (index, [length, radius, curvature]) in sections.enumerate() {
        if !(length > 0.0 && length < Real::INFINITY) {
            return Err(RobotError::BadLength { parameter, index, value: length });
        }
        check_radii(parameter, &[radius]).map_err(|_| RobotError::BadRadius {
            parameter,
            index,
            value: radius,
            limit: COORDINATE_LIMIT,
        })?;
        if !(0.0..Real::INFINITY).contains(&curvature) {
            return Err(RobotError::BadCurvature { parameter, index, value: curvature });
        }
    }
    Ok(())
}

/// Checks sections of constant curvature before they are used.
///
/// # Errors
/// No section; a length that is not positive, a radius that is negative, or a number that is not
/// finite.
pub(crate) fn check_bending(
    parameter: &'static str,
    sections: &[BendingSection],
) -> Result<(), RobotError> {
    let numbers = |section: &BendingSection| [section.length, section.radius, section.curvature()];
    check_sections(parameter, sections.iter().map(numbers))
}

impl BendingSection {
    /// Returns the magnitude of the bend.
    pub(crate) fn curvature(&self) -> Real {
        let [x, y] = self.bend;
        Vector::new(x, y, 0.0).length()
    }
}

impl Arc {
    /// Returns the frame at an arc length of the robot.
    pub(crate) fn frame(&self, arc_length: Real) -> Pose {
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
