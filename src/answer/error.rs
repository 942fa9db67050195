//! Why there is no answer. Each message names the value at fault and what to change.

use crate::robot::{RobotError, TooSharp};
#[cfg(feature = "gpu")]
use gpu_batch::DeviceFailure;
use parry3d_f64::math::Real;
use strum::IntoStaticStr;
use thiserror::Error;

/// Why a mesh cannot be queried.
#[derive(Clone, Copy, Debug, PartialEq, Error, IntoStaticStr)]
#[strum(serialize_all = "snake_case")]
#[non_exhaustive]
pub enum MeshError {
    /// A vertex has a coordinate that is NaN or infinite.
    #[error(
        "vertex {vertex} of the mesh has a coordinate that is not finite ({value}); repair its vertices"
    )]
    NotFinite {
        /// The vertex's position in the mesh.
        vertex: usize,
        /// The offending coordinate.
        value: Real,
    },
    /// A vertex lies so far out that squares of coordinates could overflow.
    #[error(
        "vertex {vertex} of the mesh has the coordinate {value}, beyond +-{limit:e}; choose a larger unit for its vertices"
    )]
    OutOfRange {
        /// The vertex's position in the mesh.
        vertex: usize,
        /// The offending coordinate.
        value: Real,
        /// The largest magnitude accepted.
        limit: Real,
    },
    /// New vertices must be as many as the old ones.
    #[error(
        "the mesh has {expected} vertices but {got} were given; build a new engine for a new mesh"
    )]
    VertexCount {
        /// How many vertices the mesh has.
        expected: usize,
        /// How many were given.
        got: usize,
    },
    /// A triangle names a vertex that the mesh does not have.
    #[error(
        "triangle {triangle} names vertex {vertex}, but there are {vertices} vertices; repair the mesh's triangles"
    )]
    NoSuchVertex {
        /// The triangle's position in the mesh.
        triangle: usize,
        /// The vertex that it names.
        vertex: u32,
        /// How many vertices there are.
        vertices: usize,
    },
    /// The mesh has no triangle, so nothing is closest.
    #[error("the mesh has no triangles")]
    Empty,
}

/// Why a query has no answer.
#[derive(Clone, Copy, Debug, PartialEq, Error, IntoStaticStr)]
#[strum(serialize_all = "snake_case")]
#[non_exhaustive]
pub enum ProximityError {
    /// The robot's pose has a component that is NaN or infinite.
    #[error("the robot's pose is not finite; check its translation and rotation")]
    PoseNotFinite,
    /// The rotation of the robot's pose scales: the length of its quaternion is not 1, even for
    /// single precision.
    #[error("the robot's pose has a quaternion of length {length}; normalise its rotation")]
    PoseNotRigid {
        /// The length of the quaternion.
        length: Real,
    },
    /// The pose carries a link beyond the range in which squares of coordinates are finite.
    #[error("the pose moves link {link} beyond +-{limit:e}; choose a larger unit")]
    OutOfRange {
        /// The link's position in the chain.
        link: usize,
        /// The largest magnitude accepted.
        limit: Real,
    },
    /// One of two robots cannot be placed.
    #[error("`{parameter}`: {fault}")]
    Placement {
        /// The robot's pose, as the function that was called names it.
        parameter: &'static str,
        /// What is wrong with it.
        fault: PlacementFault,
    },
    /// A joint is so sharp that its links overlap over more than half of the shorter one, which
    /// leaves no saying which parts of the robot are neighbours.
    #[error(
        "joint {joint} bends by {angle} rad between links of radius {radius}, the shorter of which has the length {length}; \
         make the radius smaller, or spread the bend over more points"
    )]
    JointTooSharp {
        /// The joint before the link with this number.
        joint: usize,
        /// By how much it bends, rad.
        angle: Real,
        /// The larger radius of its links.
        radius: Real,
        /// The length of the shorter link.
        length: Real,
    },
    /// A tube bends within its own radius, or may do so as far as its curvature is known, which
    /// leaves no saying which parts of it are neighbours.
    #[error(
        "near the arc length {arc_length} the tube has the curvature {curvature} and the radius {radius}; their product must be \
         below 1, so check the unit of length; if the points are measured, fit them with a `deviation` as large as their noise \
         (`Tube::fit`)"
    )]
    BendsWithinRadius {
        /// Where it may bend so sharply: from there on.
        arc_length: Real,
        /// Its curvature there at most.
        curvature: Real,
        /// Its radius.
        radius: Real,
    },
    /// The pose carries a tube beyond that range.
    #[error("the pose moves the tube beyond +-{limit:e}; choose a larger unit")]
    TubeOutOfRange {
        /// The largest magnitude accepted.
        limit: Real,
    },
    /// A margin, a tolerance or a resolution must be a number that is at least 0.
    #[error("`{parameter}` is {value}; it must be at least 0")]
    Negative {
        /// The parameter, as the function that was called names it.
        parameter: &'static str,
        /// The offending number.
        value: Real,
    },
    /// A bound must be a number, of either sign.
    #[error("`{parameter}` is NaN; it must be a number")]
    NotANumber {
        /// The parameter, as the function that was called names it.
        parameter: &'static str,
    },
    /// The bounds of a tube cannot come as close as was asked for.
    #[error(
        "the bounds are {possible} apart at best, not {tolerance}; give a larger {parameter}; of a curve through samples, give more of \
         them and the tangents at the ends; if coordinates are so large that rounding is {possible}, move the origin to the robot"
    )]
    ToleranceTooFine {
        /// The parameter, as the function that was called names it: a tolerance or a resolution.
        parameter: &'static str,
        /// What was asked for.
        tolerance: Real,
        /// What the samples and the stated error allow here.
        possible: Real,
    },
    /// A motion left its tube empty.
    #[error("the motion gave a tube without points; fill the tube in `Motion::shape`")]
    EmptyTube,
    /// The curve of a tube has a coordinate that is NaN or infinite.
    #[error("the tube's curve is not finite near the arc length {arc_length}; repair the function")]
    CurveNotFinite {
        /// Where it is not.
        arc_length: Real,
    },
    /// A motion has no shape at some time, or breaks a promise.
    #[error(transparent)]
    Motion(#[from] RobotError),
    /// One of two motions has no shape at some time, or breaks a promise.
    #[error("`{parameter}`: {fault}")]
    OneMotion {
        /// The motion, as the function that was called names it.
        parameter: &'static str,
        /// What is wrong with it.
        fault: RobotError,
    },
    /// A motion is so fast that time cannot be divided finely enough.
    #[error(
        "section {section} moves at the speed {speed}: time cannot be divided so finely that it moves by {resolution} \
         alone; ask for a coarser resolution"
    )]
    TooFast {
        /// The section, counted from the base.
        section: usize,
        /// The speed that the motion states for it.
        speed: Real,
        /// What was asked for.
        resolution: Real,
    },
    /// A direction turns so fast that time cannot be divided finely enough.
    #[error(
        "section {section} turns at {turn} rad, more than {limit:e}, in the motion's time; state a smaller turn, or give links that \
         turn less"
    )]
    TurnsTooFast {
        /// The section, counted from the base.
        section: usize,
        /// The turn that the motion states for it.
        turn: Real,
        /// The largest that is accepted.
        limit: Real,
    },
    /// An answer names a link that the robot does not have.
    #[error(
        "the answer is about link {link}, but the robot has {links} links; give the robot that was asked about"
    )]
    NoSuchLink {
        /// The answer's link.
        link: usize,
        /// How many links the robot has.
        links: usize,
    },
    /// An answer names a triangle that the mesh does not have.
    #[error(
        "the answer is about triangle {triangle}, but the mesh has {triangles}; give the mesh that was asked about"
    )]
    NoSuchTriangle {
        /// The answer's triangle.
        triangle: usize,
        /// How many triangles the mesh has.
        triangles: usize,
    },
    /// An answer is not that of the link and the triangle that it names, as they are now.
    #[error(
        "the answer about link {link} and triangle {triangle} does not fit them: its `{field}` is off by {off:e}, of which \
         rounding explains {limit:e}; ask again where robot, pose or mesh have changed"
    )]
    AnswerDoesNotFit {
        /// The answer's link.
        link: usize,
        /// The answer's triangle.
        triangle: usize,
        /// The field of the answer that is off: a point that is not in its shape, or the distance.
        field: &'static str,
        /// How far it is off.
        off: Real,
        /// How far rounding may put it off.
        limit: Real,
    },
    /// An answer about two robots is not that of the links that it names, as they are now.
    #[error(
        "the answer about the links {links:?} does not fit them: its `{field}` is off by {off:e}, of which rounding explains \
         {limit:e}; ask again where robots or poses have changed"
    )]
    LinksDoNotFit {
        /// The answer's links.
        links: [u32; 2],
        /// The field of the answer that is off: a point that is not in its link, or the distance.
        field: &'static str,
        /// How far it is off.
        off: Real,
        /// How far rounding may put it off.
        limit: Real,
    },
    /// A vertex of the mesh cannot be used.
    #[error(transparent)]
    Mesh(#[from] MeshError),
    /// The GPU that was asked failed.
    #[cfg(feature = "gpu")]
    #[error(transparent)]
    Device(#[from] DeviceFailure),
}

/// Why a robot cannot be placed at its pose.
#[derive(Clone, Copy, Debug, PartialEq, Error, IntoStaticStr)]
#[strum(serialize_all = "snake_case")]
#[non_exhaustive]
pub enum PlacementFault {
    /// The pose has a component that is NaN or infinite.
    #[error("the pose is not finite; check its translation and rotation")]
    PoseNotFinite,
    /// The rotation scales: the length of its quaternion is not 1, even for single precision.
    #[error("the pose has a quaternion of length {length}; normalise its rotation")]
    PoseNotRigid {
        /// The length of the quaternion.
        length: Real,
    },
    /// The pose carries a link beyond the range in which squares of coordinates are finite.
    #[error("the pose moves link {link} beyond +-{limit:e}; choose a larger unit")]
    OutOfRange {
        /// The link's position in the chain.
        link: usize,
        /// The largest magnitude accepted.
        limit: Real,
    },
    /// The pose carries a tube beyond that range.
    #[error("the pose moves the tube beyond +-{limit:e}; choose a larger unit")]
    TubeOutOfRange {
        /// The largest magnitude accepted.
        limit: Real,
    },
}

impl PlacementFault {
    /// What went wrong in one word, the same in Rust and Python: the variant in snake case.
    pub fn kind(&self) -> &'static str {
        self.into()
    }
}

impl MeshError {
    /// What went wrong in one word, the same in Rust and Python: the variant in snake case.
    pub fn kind(&self) -> &'static str {
        self.into()
    }
}

impl From<TooSharp> for ProximityError {
    fn from(too_sharp: TooSharp) -> Self {
        match too_sharp {
            TooSharp::Joint { joint, angle, radius, length } => {
                Self::JointTooSharp { joint, angle, radius, length }
            }
            TooSharp::Bend { arc_length, curvature, radius } => {
                Self::BendsWithinRadius { arc_length, curvature, radius }
            }
        }
    }
}

impl ProximityError {
    /// The same of one of two robots, whose pose or motion the function that was called names so.
    pub(crate) fn of_robot(self, parameter: &'static str) -> Self {
        let fault = match self {
            Self::PoseNotFinite => PlacementFault::PoseNotFinite,
            Self::PoseNotRigid { length } => PlacementFault::PoseNotRigid { length },
            Self::OutOfRange { link, limit } => PlacementFault::OutOfRange { link, limit },
            Self::TubeOutOfRange { limit } => PlacementFault::TubeOutOfRange { limit },
            Self::Motion(fault) => return Self::OneMotion { parameter, fault },
            other => return other,
        };
        Self::Placement { parameter, fault }
    }

    /// What went wrong in one word, the same in Rust and Python: the variant in snake case, or that
    /// of the error that it passes on.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Motion(error) | Self::OneMotion { fault: error, .. } => error.kind(),
            Self::Mesh(error) => error.kind(),
            Self::Placement { fault, .. } => fault.kind(),
            #[cfg(feature = "gpu")]
            Self::Device(error) => error.kind(),
            other => other.into(),
        }
    }
}
