//! How near a robot comes on its way.

use super::motion::maker;
use crate::input::{Caps, Given, Robots};
use crate::mesh::Mesh;
use crate::output::{answer, array, array_or_number, flat};
use crate::threads::{Session, ask_each};
use parry_continuum::parry::math::Vector;
use parry_continuum::proximity::MotionClearance;
use pyo3::prelude::*;

#[pymethods]
impl Mesh {
    /// How near robots come to the mesh on their way from one shape to another, between proven bounds, and when.
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
    #[pyo3(signature = (start, end, radii, tolerance, *, caps = Caps::Fitted), text_signature = "($self, start, end, radii, tolerance, *, caps=\"fitted\")")]
    fn clearance_of_motion<'py>(
        &self,
        py: Python<'py>,
        start: &Bound<'py, PyAny>,
        end: &Bound<'py, PyAny>,
        radii: &Bound<'py, PyAny>,
        tolerance: f64,
        caps: Caps,
    ) -> PyResult<Bound<'py, PyAny>> {
        let make = maker(py, caps)?;
        let robots = Robots::new("start", start, radii, None)?.with_as_many("end", end, "start")?;
        let mut all: Vec<MotionClearance> = Vec::with_capacity(robots.len());
        let ask = |session: &mut Session, robot: &Given<'_>, row: &mut [Option<MotionClearance>]| {
            let motion = make(robot.points, robot.more, robot.radii)?;
            row[0] = Some(session.search.clearance_of_motion(&motion, tolerance)?);
            Ok(())
        };
        ask_each(py, &self.engine(py), &robots, (None, 1), ask, |_, found| {
            all.extend(found.iter().flatten())
        })?;
        let shape = || robots.shape(&[]);
        let numbers =
            |of: fn(&MotionClearance) -> f64| array_or_number(py, shape(), all.iter().map(of).collect());
        let places = |of: fn(&MotionClearance) -> u32| {
            array_or_number(py, shape(), all.iter().map(|it| of(it).into()).collect::<Vec<i64>>())
        };
        let points =
            |of: fn(&MotionClearance) -> Vector| array(py, robots.shape(&[3]), flat(all.iter().map(of)));
        let values = (
            numbers(|found| found.lower)?,
            numbers(|found| found.upper)?,
            array_or_number(py, shape(), all.iter().map(|found| found.resolved).collect())?,
            numbers(|found| found.uncertainty)?,
            numbers(|found| found.t)?,
            points(|found| found.on_robot)?,
            points(|found| found.on_mesh)?,
            places(|found| found.segment)?,
            numbers(|found| found.arc_length)?,
            places(|found| found.triangle)?,
        );
        answer(py, "MotionClearance", values)
    }
}
