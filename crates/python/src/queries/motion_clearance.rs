//! How near a robot comes on its way.

use super::way::{Arguments, Question};
use crate::input::{Caps, of};
use crate::mesh::Mesh;
use crate::output::{answer, array, array_or_number, flat};
use crate::threads::Session;
use parry_continuum::Motion;
use parry_continuum::parry::math::Vector;
use parry_continuum::proximity::{MotionClearance, ProximityError};
use pyo3::prelude::*;

struct Least {
    tolerance: f64,
}

impl Question<MotionClearance> for Least {
    fn ask(
        &self,
        session: &mut Session,
        motion: &impl Motion,
    ) -> Result<MotionClearance, ProximityError> {
        session.search.clearance_of_motion(motion, self.tolerance)
    }
}

#[pymethods]
impl Mesh {
    /// How near robots come to the mesh on their way, between proven bounds, and when.
    ///
    /// As for `clears_motion`, a `Motion` may take the place of `start`, `end` and `radii`.
    ///
    /// Parameters
    /// ----------
    /// start, end, radii, caps
    ///     As for `clears_motion`.
    /// tolerance : float
    ///     How far apart the bounds may be, at least 0.
    ///
    /// Returns
    /// -------
    /// MotionClearance
    ///     Of one motion, or arrays with one entry for each motion.
    ///
    /// Raises
    /// ------
    /// ContinuumError
    ///     The tolerance is negative or NaN, or one of the shapes is no robot.
    ///
    /// Examples
    /// --------
    /// >>> import numpy as np
    /// >>> from parry_continuum import Mesh
    /// >>> floor = Mesh([[-9, -9, 0], [9, -9, 0], [0, 9, 0]], [[0, 1, 2]])
    /// >>> high = np.array([[0, 0, 4], [1, 0, 4]])
    /// >>> found = floor.clearance_of_motion(high, high - [0, 0, 2], 0.5, tolerance=0.01)
    /// >>> bool(found.lower <= 1.5 <= found.upper), bool(found.t > 0.99)
    /// (True, True)
    #[pyo3(signature = (start, end = None, radii = None, *, tolerance, caps = None), text_signature = "($self, start, end=None, radii=None, *, tolerance, caps=\"fitted\")")]
    fn clearance_of_motion<'py>(
        &self,
        py: Python<'py>,
        start: &Bound<'py, PyAny>,
        end: Option<&Bound<'py, PyAny>>,
        radii: Option<&Bound<'py, PyAny>>,
        #[pyo3(from_py_with = of::tolerance)] tolerance: f64,
        caps: Option<Caps>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let way = self.way(&Arguments { start, end, radii, caps })?;
        let all = way.ask(py, &self.engine(py), &Least { tolerance })?;
        let shape = |last: &[usize]| way.count().iter().chain(last).copied().collect::<Vec<_>>();
        let numbers = |of: fn(&MotionClearance) -> f64| {
            array_or_number(py, shape(&[]), all.iter().map(of).collect())
        };
        let places = |of: fn(&MotionClearance) -> u32| {
            array_or_number(
                py,
                shape(&[]),
                all.iter().map(|it| of(it).into()).collect::<Vec<i64>>(),
            )
        };
        let points =
            |of: fn(&MotionClearance) -> Vector| array(py, shape(&[3]), flat(all.iter().map(of)));
        let values = (
            numbers(|found| found.lower)?,
            numbers(|found| found.upper)?,
            array_or_number(py, shape(&[]), all.iter().map(|found| found.resolved).collect())?,
            numbers(|found| found.uncertainty)?,
            numbers(|found| found.t)?,
            points(|found| found.witness.on_robot)?,
            points(|found| found.witness.on_mesh)?,
            places(|found| found.witness.segment)?,
            numbers(|found| found.witness.arc_length)?,
            places(|found| found.witness.triangle)?,
        );
        answer!(py, "MotionClearance", values)
    }
}
