//! Whether a moving robot keeps a margin from a mesh that moves too.

use super::motion_answer::motion_answer;
use super::way::{Arguments, Question};
use crate::input::{Caps, of};
use crate::mesh::Mesh;
use crate::threads::Session;
use parry_continuum::Motion;
use parry_continuum::parry::math::Vector;
use parry_continuum::proximity::{MotionAnswer, ProximityError};
use pyo3::prelude::*;

struct While {
    to: Vec<Vector>,
    margin: f64,
    resolution: f64,
}

impl Question<MotionAnswer> for While {
    fn ask(
        &self,
        session: &mut Session,
        motion: &impl Motion,
    ) -> Result<MotionAnswer, ProximityError> {
        session.search.clears_motion_while(&self.to, motion, self.margin, self.resolution)
    }
}

#[pymethods]
impl Mesh {
    /// Whether robots keep more than a margin away from the mesh on their way, while each vertex
    /// moves straight and evenly to another place in the same time: an organ that breathes, a
    /// registration that is corrected, a step of a simulation of tissue.
    ///
    /// With `start`, `end` and `radii`, the robot's points move straight and evenly. A `Motion`
    /// after `to` is any other motion. A robot at rest is a `RigidMotion` from a pose to the same
    /// pose. The mesh stays where it was; `set_vertices` moves it. Each motion goes once through
    /// all triangles.
    ///
    /// Parameters
    /// ----------
    /// to : (V, 3) array of any number type
    ///     Where the vertices are at the time 1.
    /// start, end, radii, margin, resolution, caps
    ///     As for `clears_motion`.
    ///
    /// Returns
    /// -------
    /// MotionAnswer
    ///     Of one motion, or arrays with one entry for each motion. The points of robot and mesh
    ///     are their positions at the time of the answer.
    ///
    /// Raises
    /// ------
    /// ContinuumError
    ///     There are more or fewer vertices than the mesh has, one is not finite or out of range,
    ///     or as for `clears_motion`.
    ///
    /// Examples
    /// --------
    /// >>> import numpy as np
    /// >>> from parry_continuum import Decision, Mesh, RigidMotion
    /// >>> floor = Mesh([[-90, -90, 0], [90, -90, 0], [0, 90, 0]], [[0, 1, 2]])
    /// >>> at_rest = RigidMotion([[0, 0, 5], [4, 0, 5]], 0.5, np.eye(4), np.eye(4))
    /// >>> risen = floor.vertices + [0, 0, 3]
    /// >>> answer = floor.clears_motion_while(risen, at_rest, margin=1, resolution=1e-3)
    /// >>> answer.decision is Decision.CLEAR
    /// True
    /// >>> answer = floor.clears_motion_while(risen, at_rest, margin=2, resolution=1e-3)
    /// >>> answer.decision is Decision.CONTACT
    /// True
    #[pyo3(signature = (to, start, end = None, radii = None, *, margin, resolution, caps = None), text_signature = "($self, to, start, end=None, radii=None, *, margin, resolution, caps=\"fitted\")")]
    #[allow(clippy::too_many_arguments)] // they are named in Python
    fn clears_motion_while<'py>(
        &self,
        py: Python<'py>,
        to: &Bound<'py, PyAny>,
        start: &Bound<'py, PyAny>,
        end: Option<&Bound<'py, PyAny>>,
        radii: Option<&Bound<'py, PyAny>>,
        #[pyo3(from_py_with = of::margin)] margin: f64,
        #[pyo3(from_py_with = of::resolution)] resolution: f64,
        caps: Option<Caps>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let way = self.way(&Arguments { start, end, radii, caps })?;
        let question = While { to: self.moved_vertices(to, "to")?, margin, resolution };
        motion_answer(py, way.count(), &way.ask(py, &self.engine(py), &question)?)
    }
}
