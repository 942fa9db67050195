//! How near a curved tube is, between bounds.

use crate::error::Refused;
use crate::input::{Given, Robots, check_length, of};
use crate::mesh::Mesh;
use crate::output::{
    Enumeration, answer, array, array_or_number, decision_value, flat, members, statuses,
};
use crate::threads::{Asked, Session, answer_each_or_kind, ask_each};
use parry_continuum::parry::math::{Pose, Vector};
use parry_continuum::proximity::Clearance;
use parry_continuum::{RobotError, Tube};
use pyo3::prelude::*;

/// The errors that are stated for measured points.
#[derive(Clone, Copy)]
pub(crate) struct Stated {
    pub deviation: f64,
    pub turn: Option<f64>,
}

/// The directions at the two ends, where there are directions.
fn ends(robot: &Given<'_>) -> Option<[Vector; 2]> {
    match robot.more {
        [first, .., last] => Some([*first, *last]),
        _ => None,
    }
}

/// Whether there is a direction for each point, and not for the two ends alone.
fn has_frames(robot: &Given<'_>) -> bool {
    robot.more.len() == robot.points.len() && robot.points.len() > 2
}

/// The tube of a robot.
pub(crate) fn tube(robot: &Given<'_>, stated: Stated) -> Result<Tube, Refused> {
    made(robot, stated).map_err(|error| robot.names.apply(error))
}

fn made(robot: &Given<'_>, stated: Stated) -> Result<Tube, RobotError> {
    let (points, radii) = (robot.points, robot.radii);
    let tube = match stated.deviation {
        0.0 if has_frames(robot) => Tube::from_frames(points, robot.more, radii)?,
        0.0 => Tube::from_samples(points, radii, ends(robot))?,
        deviation => Tube::fit(points, radii, deviation)?,
    };
    Ok(match stated.turn {
        Some(turn) => tube.with_turn(turn)?,
        None => tube,
    })
}

impl Session {
    /// Makes the session's tube that of a robot, in the memory that it has where the robot is given
    /// by samples alone.
    fn set_tube(&mut self, robot: &Given<'_>, stated: Stated) -> Result<Pose, Refused> {
        let has_samples = stated.deviation == 0.0 && stated.turn.is_none() && !has_frames(robot);
        match &mut self.tube {
            Some(tube) if has_samples && self.has_samples => {
                tube.set_samples(robot.points, robot.radii, ends(robot))
                    .map_err(|error| robot.names.apply(error))?;
            }
            kept => {
                *kept = None;
                *kept = Some(tube(robot, stated)?);
            }
        }
        self.has_samples = has_samples;
        robot.pose()
    }
}

/// Points that are off need no directions.
pub(crate) fn tubes<'py>(
    robots: Robots<'py>,
    name: &'static str,
    tangents: Option<&Bound<'py, PyAny>>,
    stated: Stated,
) -> PyResult<Robots<'py>> {
    match tangents {
        Some(tangents) if stated.deviation != 0.0 => {
            let text = format!(
                "`{name}` and a deviation are given; points that may be off are fitted without directions, so give one"
            );
            Err(Refused::other("bad_type", text).raise(tangents.py(), None))
        }
        _ => robots.with_tangents(name, tangents),
    }
}

/// `set_tube` leaves one.
fn no_tube() -> Refused {
    Refused::other(
        "defect",
        "no tube was made; this is a defect of parry-continuum, please report it",
    )
}

#[pymethods]
impl Mesh {
    /// The clearance of curved tubes, between proven bounds.
    ///
    /// A robot is modelled as a smooth tube through its points, with flat ends. Between two points
    /// the tube bends at most as much as the points show. ``lower <= clearance <= upper`` always
    /// holds, rounding included.
    ///
    /// A robot that is refused does not fail its batch: its bounds are NaN, and its ``status`` is
    /// the ``kind`` of its error. All other robots have the empty string as ``status``.
    ///
    /// Parameters
    /// ----------
    /// points, radii, pose
    ///     As for `distance`.
    /// tolerance : float
    ///     How far apart the bounds may be, at least 0.
    /// tangents : (2, 3), (N, 3), (B, 2, 3) or (B, N, 3) array, optional
    ///     The directions of the curve at its two ends or at all points, towards the tip, of any
    ///     length. Directions at the ends state how the flat ends are turned. Directions at all
    ///     points also state how the curve bends between the points. Without tangents the bounds
    ///     are as wide as the points leave these directions open. A point that is given twice needs
    ///     one direction. The directions of one robot stand for all.
    /// deviation : float
    ///     How far a point may be from the curve, for points that are measured: a smooth curve is
    ///     fitted within that, and the bounds hold for every tube whose centreline is so near to
    ///     it. It is for points without tangents.
    /// turn : float, optional
    ///     The largest angle, in rad, between the robot's true direction and the curve's at flat
    ///     ends: its two ends, and steps in radius. Without it, a ``deviation`` leaves the bounds a
    ///     radius apart there.
    ///
    /// Returns
    /// -------
    /// Clearance
    ///     Numbers and points of one robot, or arrays with one for each robot. ``resolved`` says
    ///     whether the bounds are as close as was asked for.
    ///
    /// Raises
    /// ------
    /// ContinuumError
    ///     The tolerance is negative or NaN. Of one robot: the turn is negative or not finite, its
    ///     points turn too sharply for a tube, or as for `distance`.
    ///
    /// Examples
    /// --------
    /// >>> import numpy as np
    /// >>> from parry_continuum import Mesh
    /// >>> floor = Mesh([[-9, -9, 0], [9, -9, 0], [0, 9, 0]], [[0, 1, 2]])
    /// >>> angle = np.linspace(0, 1, 20)
    /// >>> arc = np.stack([3 * np.sin(angle), 0 * angle, 2 + 3 * np.cos(angle)], 1)
    /// >>> found = floor.clearance(arc, 0.5, tolerance=0.01)
    /// >>> bool(found.resolved), bool(found.lower <= found.upper <= found.lower + 0.01)
    /// (True, True)
    #[pyo3(signature = (points, radii, *, tolerance, tangents = None, deviation = 0.0, turn = None, pose = None))]
    #[allow(clippy::too_many_arguments)] // they are named in Python
    fn clearance<'py>(
        &self,
        py: Python<'py>,
        points: &Bound<'py, PyAny>,
        radii: &Bound<'py, PyAny>,
        #[pyo3(from_py_with = of::tolerance)] tolerance: f64,
        tangents: Option<&Bound<'py, PyAny>>,
        #[pyo3(from_py_with = of::deviation)] deviation: f64,
        #[pyo3(from_py_with = of::optional::turn)] turn: Option<f64>,
        pose: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let stated = Stated { deviation, turn };
        let robots = tubes(self.robots(points, radii, pose)?, "tangents", tangents, stated)?;
        check_length(py, "tolerance", tolerance)?;
        let ask = |session: &mut Session, robot: &Given<'_>| {
            let pose = session.set_tube(robot, stated)?;
            let tube = session.tube.as_ref().ok_or_else(no_tube)?;
            Ok(session.search.clearance(tube, &pose, tolerance)?)
        };
        let all = answer_each_or_kind(py, &self.engine(py), &robots, ask)?;
        let shape = || robots.shape(&[]);
        let numbers = |of: fn(&Clearance) -> f64| {
            array_or_number(
                py,
                shape(),
                all.iter().map(|it| it.as_ref().map_or(f64::NAN, of)).collect(),
            )
        };
        let places = |of: fn(&Clearance) -> u32| {
            let places = all.iter().map(|it| it.as_ref().map_or(-1, |it| of(it).into()));
            array_or_number(py, shape(), places.collect::<Vec<i64>>())
        };
        let points = |of: fn(&Clearance) -> Vector| {
            array(
                py,
                robots.shape(&[3]),
                flat(all.iter().map(|it| it.as_ref().map_or(Vector::NAN, of))),
            )
        };
        let resolved = all.iter().map(|it| it.as_ref().is_ok_and(|it| it.resolved)).collect();
        let values = (
            numbers(|found| found.lower)?,
            numbers(|found| found.upper)?,
            array_or_number(py, shape(), resolved)?,
            numbers(|found| found.uncertainty)?,
            points(|found| found.witness.on_robot)?,
            points(|found| found.witness.on_mesh)?,
            places(|found| found.witness.segment)?,
            numbers(|found| found.witness.arc_length)?,
            places(|found| found.witness.triangle)?,
            statuses(py, &all, robots.count.is_some())?,
        );
        answer!(py, "Clearance", values)
    }

    /// Whether curved tubes keep more than a margin away.
    ///
    /// Parameters
    /// ----------
    /// points, radii, tangents, deviation, turn, pose
    ///     As for `clearance`.
    /// margin : float
    ///     A length, at least 0.
    /// resolution : float
    ///     The answer is undecided only where the clearance is within this of the margin, or where
    ///     65,536 pieces do not decide it.
    ///
    /// Returns
    /// -------
    /// Decision or Decisions
    ///     Clear, contact (at most the margin away), both proven, or undecided. A batch returns an
    ///     array of `Decision`, (B,). Ask for ``is_clear``: neither has a truth value.
    ///
    /// Raises
    /// ------
    /// ContinuumError
    ///     The margin or the resolution is negative or NaN, or the resolution is finer than the
    ///     points allow: ``possible`` says what can be had. Of a batch, ``robot`` is the first that
    ///     is refused.
    #[pyo3(signature = (points, radii, *, margin, resolution, tangents = None, deviation = 0.0, turn = None, pose = None))]
    #[allow(clippy::too_many_arguments)] // they are named in Python
    fn clears_tube<'py>(
        &self,
        py: Python<'py>,
        points: &Bound<'py, PyAny>,
        radii: &Bound<'py, PyAny>,
        #[pyo3(from_py_with = of::margin)] margin: f64,
        #[pyo3(from_py_with = of::resolution)] resolution: f64,
        tangents: Option<&Bound<'py, PyAny>>,
        #[pyo3(from_py_with = of::deviation)] deviation: f64,
        #[pyo3(from_py_with = of::optional::turn)] turn: Option<f64>,
        pose: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let stated = Stated { deviation, turn };
        let robots = tubes(self.robots(points, radii, pose)?, "tangents", tangents, stated)?;
        let mut all: Vec<i8> = Vec::with_capacity(robots.len());
        let ask = |session: &mut Session, robot: &Given<'_>, row: &mut [i8]| {
            let pose = session.set_tube(robot, stated)?;
            let tube = session.tube.as_ref().ok_or_else(no_tube)?;
            row[0] = decision_value(session.search.clears_tube(tube, &pose, margin, resolution)?);
            Ok(())
        };
        ask_each(py, &self.engine(py), &robots, (0, 1), ask, |_, found| all.extend(found))?;
        members(py, Enumeration::Decision, robots.shape(&[]), all)
    }
}
