//! Whether a robot keeps a margin all along a planner's own shapes.

use super::motion_answer::motion_answer;
use crate::error::Refused;
use crate::input::{Given, Robots, of};
use crate::mesh::Mesh;
use crate::threads::{Session, ask_each};
use parry_continuum::Chain;
use parry_continuum::proximity::MotionAnswer;
use pyo3::prelude::*;

#[pymethods]
impl Mesh {
    /// Whether robots keep more than a margin away all along a planner's own shapes, where nobody
    /// states a speed.
    ///
    /// The shapes are the robot at the planner's steps, in the mesh's frame. From one to the next
    /// every point moves straight and evenly. At every moment the robot is some smooth tube whose
    /// centreline is within the deviation of that, place by place: the deviation counts how far
    /// segments leave the curve, how far the robot's way leaves the straight one between two steps,
    /// and what the kinematics or a sensor errs.
    ///
    /// ``Decision.CLEAR`` is proven for every such tube at every time. ``Decision.CONTACT`` says
    /// that every such tube is at most the margin away at the time that is named: of S shapes the
    /// first one is at 0, the next at 1 / (S - 1). The deviation says nothing of how a flat end is
    /// turned. So for ``CLEAR`` a flat end counts as a whole ball, and for ``CONTACT`` as its
    /// centre.
    ///
    /// Parameters
    /// ----------
    /// shapes : (S, N, 3) or (B, S, N, 3) array
    ///     The centrelines of one path, or of B paths.
    /// radii : float, (N - 1,) or (B, N - 1) array
    ///     One radius for each segment.
    /// deviation : float
    ///     A length, at least 0.
    /// margin : float
    ///     A length, at least 0.
    /// resolution : float
    ///     A length. The answer is undecided only where it depends on the tube, or on less than
    ///     this.
    ///
    /// Returns
    /// -------
    /// MotionAnswer
    ///     Of one path, or arrays with one entry for each path.
    ///
    /// Raises
    /// ------
    /// ContinuumError
    ///     A number is negative or NaN, the resolution is finer than rounding, there are no shapes,
    ///     one is no robot, or segments without length are others in one shape than in the first.
    ///
    /// Examples
    /// --------
    /// >>> import numpy as np
    /// >>> from parry_continuum import Decision, Mesh
    /// >>> floor = Mesh([[-90, -90, 0], [90, -90, 0], [0, 90, 0]], [[0, 1, 2]])
    /// >>> needle = np.array([[0, 0, 9.0], [0, 4, 9]])
    /// >>> steps = np.stack([needle - [0, 0, depth] for depth in range(7)])  # to a height of 3
    /// >>> answer = floor.clears_path(steps, 0.5, deviation=0.1, margin=2.0, resolution=0.01)
    /// >>> answer.decision is Decision.CLEAR
    /// True
    #[pyo3(signature = (shapes, radii, deviation, *, margin, resolution))]
    fn clears_path<'py>(
        &self,
        py: Python<'py>,
        shapes: &Bound<'py, PyAny>,
        radii: &Bound<'py, PyAny>,
        #[pyo3(from_py_with = of::deviation)] deviation: f64,
        #[pyo3(from_py_with = of::margin)] margin: f64,
        #[pyo3(from_py_with = of::resolution)] resolution: f64,
    ) -> PyResult<Bound<'py, PyAny>> {
        let paths = Robots::paths("shapes", shapes, radii)?;
        self.note_frame("shapes", shapes)?;
        let mut all: Vec<MotionAnswer> = Vec::new();
        let ask = |session: &mut Session, path: &Given<'_>, row: &mut [Option<MotionAnswer>]| {
            // How the links end does not matter.
            let shape = |(number, points)| {
                Chain::capsules(points, path.radii)
                    .map_err(|error| Refused::from(error).of(&format!("shapes[{number}]")))
            };
            let shapes = path.points.chunks_exact(paths.points_each.max(1)).enumerate();
            let shapes = shapes.map(shape).collect::<Result<Vec<_>, _>>()?;
            row[0] = Some(session.search.clears_path(&shapes, deviation, margin, resolution)?);
            Ok(())
        };
        ask_each(py, &self.engine(py), &paths, (None, 1), ask, |_, found| {
            all.extend(found.iter().flatten())
        })?;
        motion_answer(py, paths.count, &all)
    }
}
