//! Whether a robot keeps a margin on all of its way.

use crate::error::Refused;
use crate::input::{Caps, Given, Robots};
use crate::mesh::Mesh;
use crate::output::{answer, array, array_or_number, decision_value, flat, members};
use crate::threads::{Session, ask_each};
use parry_continuum::parry::math::Vector;
use parry_continuum::proximity::{BvhSearch, MotionAnswer, ProximityError, ShapeInContact};
use parry_continuum::{LinearMotion, RobotError};
use pyo3::prelude::*;

/// A question about a motion: the margin and the resolution come last.
type Question = fn(&mut BvhSearch, &LinearMotion, f64, f64) -> Result<MotionAnswer, ProximityError>;

/// What makes a motion of two shapes and radii.
type Maker = fn(&[Vector], &[Vector], &[f64]) -> Result<LinearMotion, RobotError>;

pub(super) fn maker(py: Python<'_>, caps: Caps) -> PyResult<Maker> {
    match caps {
        Caps::Fitted => Ok(LinearMotion::chain),
        Caps::Capsules => Ok(LinearMotion::capsules),
        Caps::Cylinders => {
            let text = "`caps` is 'cylinders'; motions take 'fitted' or 'capsules'";
            Err(Refused::other("bad_caps", text).raise(py, None))
        }
    }
}

#[pymethods]
impl Mesh {
    /// Whether robots keep more than a margin away on all of their way from one shape to another.
    ///
    /// Every point of the centreline moves straight and evenly, from `start` at the time 0 to `end` at 1, in the mesh's frame.
    /// ``Decision.CLEAR`` is proven for every time between, so that no robot slips through a thin wall between two steps.
    ///
    /// Parameters
    /// ----------
    /// start, end : (N, 3) or (B, N, 3) arrays of one shape
    /// radii : float, (N - 1,) or (B, N - 1) array
    /// margin : float
    ///     A length, at least 0.
    /// resolution : float
    ///     A length. The answer is undecided only where some shape is farther away than the margin by no more than this, or where
    ///     an end turns from flat to round there.
    /// caps : {"fitted", "capsules"}
    ///
    /// Returns
    /// -------
    /// MotionAnswer
    ///     Of one motion, or arrays with one entry for each motion.
    ///
    /// Raises
    /// ------
    /// ContinuumError
    ///     Margin or resolution are negative or NaN, the resolution is finer than rounding, or one of the shapes is no robot.
    ///
    /// Examples
    /// --------
    /// >>> import numpy as np
    /// >>> from parry_continuum import Decision, Mesh
    /// >>> floor = Mesh([[-9, -9, 0], [9, -9, 0], [0, 9, 0]], [[0, 1, 2]])
    /// >>> above = np.array([[0, 0, 2], [1, 0, 2]])
    /// >>> below = above - [0, 0, 4]
    /// >>> floor.clears_motion(above, below, 0.1, margin=0, resolution=1e-3).decision is Decision.CONTACT
    /// True
    #[pyo3(signature = (start, end, radii, margin, resolution, *, caps = Caps::Fitted), text_signature = "($self, start, end, radii, margin, resolution, *, caps=\"fitted\")")]
    #[allow(clippy::too_many_arguments)] // they are named in Python
    fn clears_motion<'py>(
        &self,
        py: Python<'py>,
        start: &Bound<'py, PyAny>,
        end: &Bound<'py, PyAny>,
        radii: &Bound<'py, PyAny>,
        margin: f64,
        resolution: f64,
        caps: Caps,
    ) -> PyResult<Bound<'py, PyAny>> {
        self.ask_motion(
            py,
            [start, end],
            radii,
            [margin, resolution],
            caps,
            |search, motion, margin, resolution| search.clears_motion(motion, margin, resolution),
        )
    }

    /// When robots first come as close to the mesh as a margin, on their way from one shape to another.
    ///
    /// The margin is kept until ``interval[0]``, which is proven, and not kept at ``interval[1]``. Between the two the place
    /// that touches moves by no more than the resolution.
    ///
    /// Parameters
    /// ----------
    /// start, end, radii, margin, resolution, caps
    ///     As for `clears_motion`.
    ///
    /// Returns
    /// -------
    /// MotionAnswer
    ///     Of one motion, or arrays with one entry for each motion.
    ///
    /// Raises
    /// ------
    /// ContinuumError
    ///     As for `clears_motion`.
    ///
    /// Examples
    /// --------
    /// >>> import numpy as np
    /// >>> from parry_continuum import Mesh
    /// >>> floor = Mesh([[-9, -9, 0], [9, -9, 0], [0, 9, 0]], [[0, 1, 2]])
    /// >>> above = np.array([[0, 0, 2], [1, 0, 2]])
    /// >>> found = floor.time_of_contact(above, above - [0, 0, 4], 0.5, margin=0, resolution=1e-3)
    /// >>> bool(found.interval[0] <= 0.375 <= found.interval[1] + 1e-3) # after 1.5 of 4
    /// True
    #[pyo3(signature = (start, end, radii, margin, resolution, *, caps = Caps::Fitted), text_signature = "($self, start, end, radii, margin, resolution, *, caps=\"fitted\")")]
    #[allow(clippy::too_many_arguments)] // they are named in Python
    fn time_of_contact<'py>(
        &self,
        py: Python<'py>,
        start: &Bound<'py, PyAny>,
        end: &Bound<'py, PyAny>,
        radii: &Bound<'py, PyAny>,
        margin: f64,
        resolution: f64,
        caps: Caps,
    ) -> PyResult<Bound<'py, PyAny>> {
        self.ask_motion(
            py,
            [start, end],
            radii,
            [margin, resolution],
            caps,
            |search, motion, margin, resolution| search.time_of_contact(motion, margin, resolution),
        )
    }
}

impl Mesh {
    fn ask_motion<'py>(
        &self,
        py: Python<'py>,
        [start, end]: [&Bound<'py, PyAny>; 2],
        radii: &Bound<'py, PyAny>,
        [margin, resolution]: [f64; 2],
        caps: Caps,
        question: Question,
    ) -> PyResult<Bound<'py, PyAny>> {
        let make = maker(py, caps)?;
        let robots = Robots::new("start", start, radii, None)?.with_as_many("end", end, "start")?;
        let mut all: Vec<MotionAnswer> = Vec::with_capacity(robots.len());
        let ask = |session: &mut Session, robot: &Given<'_>, row: &mut [Option<MotionAnswer>]| {
            let motion = make(robot.points, robot.more, robot.radii)?;
            row[0] = Some(question(&mut session.search, &motion, margin, resolution)?);
            Ok(())
        };
        ask_each(py, &self.engine(py), &robots, (None, 1), ask, |_, found| {
            all.extend(found.iter().flatten())
        })?;
        let shape = || robots.shape(&[]);
        let numbers = |of: fn(&ShapeInContact) -> f64| {
            let numbers = all.iter().map(|it| it.contact.as_ref().map_or(f64::NAN, of));
            array_or_number(py, shape(), numbers.collect())
        };
        let places = |of: fn(&ShapeInContact) -> u32| {
            let places = all.iter().map(|it| it.contact.as_ref().map_or(-1, |it| of(it).into()));
            array_or_number(py, shape(), places.collect::<Vec<i64>>())
        };
        let points = |of: fn(&ShapeInContact) -> Vector| {
            let points = all.iter().map(|it| it.contact.as_ref().map_or(Vector::NAN, of));
            array(py, robots.shape(&[3]), flat(points))
        };
        let decisions = all.iter().map(|it| decision_value(it.decision)).collect();
        let intervals = all.iter().flat_map(|it| it.interval).collect();
        let values = (
            members(py, "Decision", shape(), decisions)?,
            array(py, robots.shape(&[2]), intervals)?,
            numbers(|shape| shape.t)?,
            numbers(|shape| shape.upper)?,
            points(|shape| shape.on_robot)?,
            points(|shape| shape.on_mesh)?,
            places(|shape| shape.segment)?,
            numbers(|shape| shape.arc_length)?,
            places(|shape| shape.triangle)?,
        );
        answer(py, "MotionAnswer", values)
    }
}
