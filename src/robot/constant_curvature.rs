//! Robots of sections of constant curvature: from curvatures to the places along the centreline.
//!
//! In the frame at the beginning of a section, z is along the curve. A section of the curvature k
//! towards the direction b across z is an arc in the plane of both: after the length l it has
//! turned by the angle k l about z x b, and gone l sin(k l) / (k l) along z and l (1 - cos(k l)) /
//! (k l) along b (Webster and Jones, "Design and kinematic modeling of constant curvature continuum
//! robots", 2010, equation 1). The next section begins in the frame that this one has
//! carried along, without twist.

use super::rigid_pose::rotation_by;
use super::tube::check_sections;
use super::{RobotError, Tube, TubeSection};
use parry3d_f64::math::{Pose, Real, Vector};

/// A stretch of constant curvature, for [`ConstantCurvature`] and
/// [`BendingMotion`](crate::BendingMotion).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BendingSection {
    /// Arc length of the centreline.
    pub length: Real,
    /// Radius of the tube.
    pub radius: Real,
    /// Its curvature, 1 / length, towards x and y of the frame that is carried along the curve
    /// without twist; at the base that is the robot's, whose curve leaves the origin along z.
    pub bend: [Real; 2],
}

/// The centreline of a robot of sections of constant curvature: of a tendon robot, or of concentric
/// tubes that do not twist.
///
/// The base is the origin, where the curve leaves along z. Lengths are in one unit, arc lengths
/// begin at the base.
///
/// ```
/// use parry_continuum::{BendingSection, Chain, ConstantCurvature, stations};
///
/// // A tendon robot of two sections, in mm: the second bends by 0.05 / mm towards 30 degrees from x.
/// let (sin, cos) = 30_f64.to_radians().sin_cos();
/// let first = BendingSection { length: 40.0, radius: 1.5, bend: [0.0, 0.02] };
/// let second = BendingSection { length: 30.0, radius: 1.0, bend: [0.05 * cos, 0.05 * sin] };
/// let robot = ConstantCurvature::new(&[first, second])?;
///
/// let tube = robot.tube()?; // the curve itself
/// let (points, radii) = robot.points(100); // or as many points as one likes,
/// let (few, radii) = stations(&points, &radii, 0.05)?; // of which few are needed for 0.05 mm
/// let chain = Chain::from_centreline(&few, &radii)?;
/// # assert!(few.len() < points.len() / 2 && chain.links().len() + 1 == few.len());
/// # assert!((chain.links().last().map(|link| link.end()).unwrap_or_default() - robot.frame(70.0).translation).length() < 1e-12);
/// # drop(tube);
/// # Ok::<(), parry_continuum::RobotError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct ConstantCurvature {
    arcs: Vec<Arc>,
}

/// A section in its place.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Arc {
    section: BendingSection,
    /// The arc length at which it begins.
    start: Real,
    /// The frame there, with z along the curve.
    frame: Pose,
}

impl ConstantCurvature {
    /// The robot of these sections, from its base to its tip.
    ///
    /// # Errors
    /// No section; a length that is not positive, a radius that is negative, or a number that is
    /// not finite.
    pub fn new(sections: &[BendingSection]) -> Result<Self, RobotError> {
        check("sections", sections)?;
        let (mut start, mut frame) = (0.0, Pose::IDENTITY);
        let place = |section: &BendingSection| {
            let arc = Arc { section: *section, start, frame };
            start += section.length;
            frame = arc.frame(start);
            arc
        };
        Ok(Self { arcs: sections.iter().map(place).collect() })
    }

    /// The length of the centreline.
    pub fn length(&self) -> Real {
        self.arcs.last().map_or(0.0, |arc| arc.start + arc.section.length)
    }

    /// The frame at an arc length: its translation is the point of the centreline, its z axis the
    /// direction of the curve. Beyond either end the curve goes on as it is there.
    pub fn frame(&self, arc_length: Real) -> Pose {
        let number = self.arcs.partition_point(|arc| arc.start < arc_length).max(1) - 1;
        self.arcs.get(number).map_or(Pose::IDENTITY, |arc| arc.frame(arc_length))
    }

    /// The point at a share of a section; the base's if there is no such section.
    pub(super) fn at_share(&self, section: usize, share: Real) -> Vector {
        let point = |arc: &Arc| arc.frame(arc.start + arc.section.length * share).translation;
        self.arcs.get(section).map_or(Vector::ZERO, point)
    }

    /// Points along the centreline and the radii of the segments between them, ready for any
    /// constructor of a [`Chain`](crate::Chain) and for [`stations`](crate::stations): each
    /// section in so many segments of equal length, and at least one.
    ///
    /// Segments of the length l leave an arc of the curvature k by k l^2 / 8.
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

    /// The robot as a curve.
    ///
    /// # Errors
    /// A section with a flat end whose curvature times its radius is 1 or more; a section that ends
    /// out of range.
    pub fn tube(&self) -> Result<Tube, RobotError> {
        self.clone().into_tube()
    }

    pub(super) fn into_tube(self) -> Result<Tube, RobotError> {
        let sections: Vec<_> = self.arcs.iter().map(|arc| stated(&arc.section)).collect();
        Tube::from_function(&sections, move |arc_length| {
            let frame = self.frame(arc_length);
            (frame.translation, frame.rotation * Vector::Z)
        })
    }
}

/// # Errors
/// No section; a length that is not positive, a radius that is negative, or a number that is not
/// finite.
pub(super) fn check(
    parameter: &'static str,
    sections: &[BendingSection],
) -> Result<(), RobotError> {
    check_sections(parameter, &sections.iter().map(stated).collect::<Vec<_>>())
}

/// A section as a tube states it.
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
        // Turning about this vector bends z towards `bend`.
        let turn = Vector::new(-y, x, 0.0);
        let angle = turn.length() * length;
        let sinc = |x: Real| if x == 0.0 { 1.0 } else { libm::sin(x) / x };
        // Not 1 - cos, which loses half of the digits where the angle is small.
        let across = 0.5 * length * length * sinc(0.5 * angle) * sinc(0.5 * angle);
        let point = Vector::Z * (length * sinc(angle)) + Vector::new(x, y, 0.0) * across;
        self.frame * Pose::from_parts(point, rotation_by(turn * length))
    }
}
