//! What Python raises: one exception for all that can be wrong with what was handed over.

use parry_continuum::proximity::{MeshError, PlacementFault, ProximityError, SceneError};
use parry_continuum::{MatrixError, RobotError};
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::{IntoPyDict, PyType};

/// What the library's messages call its own things, and what Python calls them.
const OF_RUST: [(&str, &str); 6] = [
    (" (`Tube::fit`)", ""),
    (
        "give frames at one place one direction; for a robot of straight links use a Chain",
        "give a point that stands twice one tangent; for a robot of straight links ask `distance` or `clears`",
    ),
    ("build a new engine for a new mesh", "make a new `Mesh`"),
    ("in `from` and `to`", "in `start` and `end`"),
    ("fill the tube in `Motion::shape`", "give points"),
    ("an engine on the CPU", "`device=\"cpu\"`"),
];

/// Why an input has no answer, before it becomes a Python exception.
#[derive(Clone, Debug)]
pub(crate) enum Refused {
    Robot(RobotError),
    Query(ProximityError),
    Mesh(MeshError),
    Matrix(MatrixError),
    /// What the crate has no word for: shapes and types of arrays, files, a defect.
    Other {
        kind: &'static str,
        text: String,
        index: Option<usize>,
        possible: Option<f64>,
    },
}

impl Refused {
    pub(crate) fn other(kind: &'static str, text: impl Into<String>) -> Self {
        Self::Other { kind, text: text.into(), index: None, possible: None }
    }

    /// The same, about the parameter of this name.
    pub(crate) fn of(self, parameter: &str) -> Self {
        let text = format!("`{parameter}`: {}", self.text());
        self.with_text(text)
    }

    /// The same, with what to do.
    pub(crate) fn with_advice(self, advice: &str) -> Self {
        let text = format!("{}; {advice}", self.text());
        self.with_text(text)
    }

    /// The same with another text.
    fn with_text(self, text: String) -> Self {
        Self::Other { kind: self.kind(), text, index: self.index(), possible: self.possible() }
    }

    /// The error of a scene. The robots of the query are the entries of the parameter `list`.
    pub(crate) fn of_scene(error: SceneError, list: &str) -> Self {
        match error {
            SceneError::Structure { name, error } => {
                let refused = Self::from(error);
                let text = format!("structure `{name}`: {}", refused.text());
                refused.with_text(text)
            }
            SceneError::Robot { robot, structure: None, error } => {
                Self::from(error).of(&format!("{list}[{robot}]"))
            }
            SceneError::Robot { robot, structure: Some(name), error } => {
                let refused = Self::from(error);
                let text =
                    format!("`{list}[{robot}]` beside structure `{name}`: {}", refused.text());
                refused.with_text(text)
            }
            SceneError::Robots { robots: [one, other], error } => {
                Self::from(error).of(&format!("{list}[{one}]` and `{list}[{other}]"))
            }
            SceneError::BetweenRobots(error) => Self::from(error).of("robot_margin"),
            SceneError::Query(error) => error.into(),
            error => Self::other(error.kind(), error.to_string()),
        }
    }

    /// The parameter that a robot's error names.
    pub(crate) fn parameter_mut(&mut self) -> Option<&mut &'static str> {
        if let Self::Robot(error) = self { parameter_of(error) } else { None }
    }

    pub(crate) fn kind(&self) -> &'static str {
        match self {
            Self::Robot(error) => error.kind(),
            Self::Query(error) => error.kind(),
            Self::Mesh(error) => error.kind(),
            Self::Matrix(error) => error.kind(),
            Self::Other { kind, .. } => kind,
        }
    }

    fn text(&self) -> String {
        let text = match self {
            Self::Robot(error) => error.to_string(),
            Self::Query(error) => error.to_string(),
            Self::Mesh(error) => error.to_string(),
            Self::Matrix(error) => error.to_string(),
            Self::Other { text, .. } => text.clone(),
        };
        OF_RUST.iter().fold(text, |text, (rust, python)| text.replace(rust, python))
    }

    /// The point, radius, vertex, face or the like that is at fault, counted from 0.
    fn index(&self) -> Option<usize> {
        match self {
            Self::Robot(error) | Self::Query(ProximityError::Motion(error)) => {
                index_in_robot(error)
            }
            Self::Mesh(error) | Self::Query(ProximityError::Mesh(error)) => index_in_mesh(error),
            Self::Query(ProximityError::Pose(PlacementFault::OutOfRange { link, .. })) => {
                Some(*link)
            }
            Self::Query(ProximityError::TooFast { section, .. }) => Some(*section),
            Self::Query(ProximityError::JointTooSharp { joint, .. }) => Some(*joint),
            Self::Query(_) | Self::Matrix(_) => None,
            Self::Other { index, .. } => *index,
        }
    }

    /// The least that can be asked for, where more was asked.
    fn possible(&self) -> Option<f64> {
        match self {
            Self::Query(ProximityError::ToleranceTooFine { possible, .. }) => Some(*possible),
            Self::Other { possible, .. } => *possible,
            _ => None,
        }
    }

    /// The exception, which names the robot of a batch.
    pub(crate) fn raise(self, py: Python<'_>, robot: Option<usize>) -> PyErr {
        let text = match robot {
            Some(robot) => format!("robot {robot}: {}", self.text()),
            None => self.text(),
        };
        let make = || -> PyResult<PyErr> {
            let details = [
                ("kind", self.kind().into_pyobject(py)?.into_any()),
                ("robot", robot.into_pyobject(py)?),
                ("index", self.index().into_pyobject(py)?),
                ("possible", self.possible().into_pyobject(py)?),
            ];
            let error = class(py)?.call((text,), Some(&details.into_py_dict(py)?))?;
            Ok(PyErr::from_value(error))
        };
        make().unwrap_or_else(|error| error)
    }
}

/// The exception of this package with a text before its own; another exception as it is.
pub(crate) fn with_prefix(py: Python<'_>, error: PyErr, prefix: &str) -> PyErr {
    let prefixed = || -> PyResult<()> {
        let value = error.value(py);
        if value.is_instance(class(py)?)? {
            value.setattr("args", (format!("{prefix}{}", value.str()?),))?;
        }
        Ok(())
    };
    match prefixed() {
        Ok(()) => error,
        Err(other) => other,
    }
}

fn index_in_robot(error: &RobotError) -> Option<usize> {
    match error {
        RobotError::PointNotFinite { index, .. }
        | RobotError::PointOutOfRange { index, .. }
        | RobotError::BadRadius { index, .. }
        | RobotError::FlatCapWithoutAxis { index }
        | RobotError::HidesLength { index, .. }
        | RobotError::BadLength { index, .. }
        | RobotError::BadCurvature { index, .. }
        | RobotError::SectionsDiffer { index }
        | RobotError::ShapesDiffer { index }
        | RobotError::MotionsApart { index, .. }
        | RobotError::BadTangent { index, .. }
        | RobotError::TurnsTooSharply { index, .. }
        | RobotError::BendsWithinRadius { index, .. } => Some(*index),
        _ => None,
    }
}

fn index_in_mesh(error: &MeshError) -> Option<usize> {
    match error {
        MeshError::NotFinite { vertex, .. } | MeshError::OutOfRange { vertex, .. } => Some(*vertex),
        MeshError::NoSuchVertex { triangle, .. } => Some(*triangle),
        _ => None,
    }
}

/// `ContinuumError`, which is written in Python.
fn class(py: Python<'_>) -> PyResult<&Bound<'_, PyType>> {
    static CLASS: PyOnceLock<Py<PyType>> = PyOnceLock::new();
    CLASS.import(py, "parry_continuum._errors", "ContinuumError")
}

/// The parameter of a robot, not of its pose, that an error names.
fn parameter_of(error: &mut RobotError) -> Option<&mut &'static str> {
    match error {
        RobotError::LengthsDiffer { parameter, .. }
        | RobotError::BadRadius { parameter, .. }
        | RobotError::HidesLength { parameter, .. }
        | RobotError::PointNotFinite { parameter, .. }
        | RobotError::PointOutOfRange { parameter, .. }
        | RobotError::BadTangent { parameter, .. }
        | RobotError::BadLength { parameter, .. }
        | RobotError::BadCurvature { parameter, .. }
        | RobotError::NoSections { parameter, .. }
        | RobotError::TooFewPoints { parameter, .. }
        | RobotError::Negative { parameter, .. } => Some(parameter),
        _ => None,
    }
}

/// Robots are given as `points` and `radii`, so these are the names in their errors.
impl From<RobotError> for Refused {
    fn from(mut error: RobotError) -> Self {
        match &mut error {
            // Sections have their radii beside them in Python.
            RobotError::BadRadius {
                parameter: parameter @ ("from" | "to" | "sections"), ..
            } => *parameter = "radii",
            RobotError::BadPose { parameter, .. } | RobotError::PoseNotRigid { parameter, .. } => {
                *parameter = match *parameter {
                    "from" => "start_pose",
                    "to" => "end_pose",
                    other => other,
                };
            }
            error => {
                if let Some(parameter) = parameter_of(error) {
                    *parameter = match *parameter {
                        "segment_radii" => "radii",
                        "end_tangents" => "tangents",
                        "from" => "start",
                        "to" => "end",
                        other => other,
                    };
                }
            }
        }
        Self::Robot(error)
    }
}

impl From<ProximityError> for Refused {
    fn from(error: ProximityError) -> Self {
        match error {
            ProximityError::Motion(error) => error.into(),
            other => Self::Query(other),
        }
    }
}

impl From<MeshError> for Refused {
    fn from(error: MeshError) -> Self {
        Self::Mesh(error)
    }
}

impl From<MatrixError> for Refused {
    fn from(error: MatrixError) -> Self {
        Self::Matrix(error)
    }
}

/// Its text names the structure, or the entry of the parameter `robots`.
impl From<SceneError> for Refused {
    fn from(error: SceneError) -> Self {
        Self::of_scene(error, "robots")
    }
}
