//! Errors of meshes and queries. Each message names the value at fault and what to change.

use crate::robot::{RobotError, number};
#[cfg(feature = "gpu")]
use gpu_batch::DeviceFailure;
use parry3d_f64::math::Real;
use strum::IntoStaticStr;
use thiserror::Error;

/// The reason why a mesh cannot be queried.
#[derive(Clone, Copy, Debug, PartialEq, Error, IntoStaticStr)]
#[strum(serialize_all = "snake_case")]
#[non_exhaustive]
pub enum MeshError {
    /// A vertex has a coordinate that is NaN or infinite.
    #[error(
        "vertex {vertex} of the mesh has a coordinate that is not finite ({value}); repair its vertices",
        value = number(.value)
    )]
    NotFinite {
        /// The vertex's index in the mesh.
        vertex: usize,
        /// The offending coordinate.
        value: Real,
    },
    /// A vertex is so far out that squares of coordinates could overflow.
    #[error(
        "vertex {vertex} of the mesh has the coordinate {value}, beyond +-{limit:e}; choose a larger unit for its vertices",
        value = number(.value)
    )]
    OutOfRange {
        /// The vertex's index in the mesh.
        vertex: usize,
        /// The offending coordinate.
        value: Real,
        /// The largest magnitude accepted.
        limit: Real,
    },
    /// The number of new vertices differs from the number of old ones.
    #[error(
        "the mesh has {expected} vertices but {got} were given; give as many, or build a new engine for a new mesh"
    )]
    VertexCount {
        /// The number of vertices of the mesh.
        expected: usize,
        /// The number of vertices that were given.
        got: usize,
    },
    /// A triangle names a vertex that the mesh does not have.
    #[error(
        "triangle {triangle} names vertex {vertex}, but there are {vertices} vertices; repair the mesh's triangles"
    )]
    NoSuchVertex {
        /// The triangle's index in the mesh.
        triangle: usize,
        /// The vertex that it names.
        vertex: u32,
        /// The number of vertices.
        vertices: usize,
    },
    /// The mesh has no triangle.
    #[error("the mesh has no triangles")]
    Empty,
}

/// The reason why a query has no answer.
#[derive(Clone, Copy, Debug, PartialEq, Error, IntoStaticStr)]
#[strum(serialize_all = "snake_case")]
#[non_exhaustive]
pub enum ProximityError {
    /// A robot or a structure cannot be placed at its pose.
    #[error(transparent)]
    Pose(#[from] PlacementFault),
    /// One of two robots cannot be placed.
    #[error("`{parameter}`: {fault}")]
    Placement {
        /// The robot's pose, in the words of the function that was called.
        parameter: &'static str,
        /// What is wrong with the pose.
        fault: PlacementFault,
    },
    /// A joint is so sharp that its links overlap over more than half of the shorter one.
    /// Neighbouring parts of the robot then cannot be identified.
    #[error(
        "joint {joint} bends by {angle} rad between two links; the thinner has the radius {radius}, the shorter the length {length}; \
         make that radius smaller, or spread the bend over more points",
        angle = number(.angle),
        radius = number(.radius),
        length = number(.length)
    )]
    JointTooSharp {
        /// The joint before the link of this index.
        joint: usize,
        /// The angle of the joint, rad.
        angle: Real,
        /// The radius of the thinner link.
        radius: Real,
        /// The length of the shorter link.
        length: Real,
    },
    /// A tube bends within its own radius, or may do so for the curvature that is known.
    /// Neighbouring parts of the tube then cannot be identified.
    #[error(
        "near the arc length {arc_length} the tube has the curvature {curvature} and the radius {radius}; their product must be \
         below 1, so check the unit of length; if the points are measured, fit them with a `deviation` as large as their noise \
         (`Tube::fit`)",
        arc_length = number(.arc_length),
        curvature = number(.curvature),
        radius = number(.radius)
    )]
    BendsWithinRadius {
        /// The arc length from which the tube may bend so sharply.
        arc_length: Real,
        /// Upper bound on its curvature there.
        curvature: Real,
        /// Its radius.
        radius: Real,
    },
    /// A margin, a tolerance or a resolution is negative or NaN.
    #[error("`{parameter}` is {value}; it must be at least 0", value = number(.value))]
    Negative {
        /// The parameter, in the words of the function that was called.
        parameter: &'static str,
        /// The offending number.
        value: Real,
    },
    /// A bound is NaN. It may have either sign.
    #[error("`{parameter}` is NaN; it must be a number")]
    NotANumber {
        /// The parameter, in the words of the function that was called.
        parameter: &'static str,
    },
    /// The bounds of a tube cannot meet the tolerance.
    #[error(
        "the bounds are {possible} apart at best, not {tolerance}; give a larger {parameter}; of a curve through samples, give more of \
         them and the tangents at the ends; if coordinates are so large that rounding is {possible}, move the origin to the robot",
        tolerance = number(.tolerance),
        possible = number(.possible)
    )]
    ToleranceTooFine {
        /// The parameter, in the words of the function that was called: a tolerance or a
        /// resolution.
        parameter: &'static str,
        /// The value that was given.
        tolerance: Real,
        /// The least gap that the samples and the stated error allow.
        possible: Real,
    },
    /// A motion returned a tube without points.
    #[error("the motion gave a tube without points; fill the tube in `Motion::shape`")]
    EmptyTube,
    /// The curve of a tube has a coordinate that is NaN or infinite.
    #[error(
        "the tube's curve is not finite near the arc length {arc_length}; repair the function",
        arc_length = number(.arc_length)
    )]
    CurveNotFinite {
        /// The arc length near which the curve is not finite.
        arc_length: Real,
    },
    /// A motion has no shape at some time, or violates one of its stated properties; or sections of
    /// constant curvature are no robot.
    #[error(transparent)]
    Motion(#[from] RobotError),
    /// One of two motions has no shape at some time, or violates one of its stated properties.
    #[error("`{parameter}`: {fault}")]
    OneMotion {
        /// The motion, in the words of the function that was called.
        parameter: &'static str,
        /// What is wrong with the motion.
        fault: RobotError,
    },
    /// A motion is so fast that time cannot be divided finely enough.
    #[error(
        "section {section} moves at the speed {speed}: time cannot be divided so finely that it moves by {resolution} \
         alone; ask for a coarser resolution",
        speed = number(.speed),
        resolution = number(.resolution)
    )]
    TooFast {
        /// The section, counted from the base.
        section: usize,
        /// The speed that the motion states for it.
        speed: Real,
        /// The resolution that was given.
        resolution: Real,
    },
    /// A direction turns so fast that time cannot be divided finely enough.
    #[error(
        "section {section} turns at {turn} rad, more than {limit:e}, in the motion's time; state a smaller turn, or give links that \
         turn less and keep their length",
        turn = number(.turn)
    )]
    TurnsTooFast {
        /// The section, counted from the base.
        section: usize,
        /// The turn that the motion states for it.
        turn: Real,
        /// The largest accepted turn.
        limit: Real,
    },
    /// An answer names a link that the robot does not have.
    #[error(
        "the answer is about link {link}, but the robot has {links} links; give the robot that was asked about"
    )]
    NoSuchLink {
        /// The answer's link.
        link: usize,
        /// The number of links of the robot.
        links: usize,
    },
    /// An answer names a triangle that the mesh does not have.
    #[error(
        "the answer is about triangle {triangle}, but the mesh has {triangles}; give the mesh that was asked about"
    )]
    NoSuchTriangle {
        /// The answer's triangle.
        triangle: usize,
        /// The number of triangles of the mesh.
        triangles: usize,
    },
    /// An answer does not fit the link and the triangle that it names, as they are now.
    #[error(
        "the answer about link {link} and triangle {triangle} does not fit them: its `{field}` is off by {off:.1e}, of which \
         rounding explains {limit:.1e}; ask again where robot, pose or mesh have changed"
    )]
    AnswerDoesNotFit {
        /// The answer's link.
        link: usize,
        /// The answer's triangle.
        triangle: usize,
        /// The field at fault: a point that is not in its shape, or the distance.
        field: &'static str,
        /// The error of the field.
        off: Real,
        /// The largest error that rounding explains.
        limit: Real,
    },
    /// An answer about two robots does not fit the links that it names, as they are now.
    #[error(
        "the answer about the links {links:?} does not fit them: its `{field}` is off by {off:.1e}, of which rounding explains \
         {limit:.1e}; ask again where robots or poses have changed"
    )]
    LinksDoNotFit {
        /// The answer's links.
        links: [u32; 2],
        /// The field at fault: a point that is not in its link, or the distance.
        field: &'static str,
        /// The error of the field.
        off: Real,
        /// The largest error that rounding explains.
        limit: Real,
    },
    /// A vertex of the mesh cannot be used.
    #[error(transparent)]
    Mesh(#[from] MeshError),
    /// The GPU failed.
    #[cfg(feature = "gpu")]
    #[error(transparent)]
    Device(#[from] DeviceFailure),
}

/// The reason why a robot or a structure cannot be placed at its pose.
#[derive(Clone, Copy, Debug, PartialEq, Error, IntoStaticStr)]
#[strum(serialize_all = "snake_case")]
#[non_exhaustive]
pub enum PlacementFault {
    /// The pose has a component that is NaN or infinite.
    #[error("the pose is not finite; check its translation and rotation")]
    PoseNotFinite,
    /// The rotation scales: the length of its quaternion is not 1, even within single precision.
    #[error(
        "the pose has a quaternion of length {length}; normalise its rotation",
        length = number(.length)
    )]
    PoseNotRigid {
        /// The length of the quaternion.
        length: Real,
    },
    /// The pose moves a link out of the range in which squares of coordinates are finite.
    #[error("the pose moves link {link} beyond +-{limit:e}; choose a larger unit")]
    OutOfRange {
        /// The link's index in the chain.
        link: usize,
        /// The largest magnitude accepted.
        limit: Real,
    },
    /// The pose moves a tube out of that range.
    #[error("the pose moves the tube beyond +-{limit:e}; choose a larger unit")]
    TubeOutOfRange {
        /// The largest magnitude accepted.
        limit: Real,
    },
}

impl PlacementFault {
    /// The error in one word, the same in Rust and Python: the variant in snake case.
    pub fn kind(&self) -> &'static str {
        self.into()
    }
}

impl MeshError {
    /// The error in one word, the same in Rust and Python: the variant in snake case.
    pub fn kind(&self) -> &'static str {
        self.into()
    }
}

impl ProximityError {
    /// Attributes the error to one of two robots, whose pose or motion has this parameter name.
    #[cfg(feature = "robots")]
    pub(crate) fn of_robot(self, parameter: &'static str) -> Self {
        match self {
            Self::Pose(fault) => Self::Placement { parameter, fault },
            Self::Motion(fault) => Self::OneMotion { parameter, fault },
            other => other,
        }
    }

    /// The error in one word, the same in Rust and Python: the variant in snake case; for a wrapped
    /// error, the word of that error.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Motion(error) | Self::OneMotion { fault: error, .. } => error.kind(),
            Self::Mesh(error) => error.kind(),
            Self::Pose(fault) | Self::Placement { fault, .. } => fault.kind(),
            #[cfg(feature = "gpu")]
            Self::Device(error) => error.kind(),
            other => other.into(),
        }
    }
}
