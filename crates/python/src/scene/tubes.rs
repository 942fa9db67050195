//! Queries about curved tubes in a scene.

use super::Scene;
use super::bounds::{Bounds, bounds};
use super::snapshot::Session;
use crate::error::Refused;
use crate::input::{Given, check_length, object_of, of};
use crate::output::{Enumeration, decision_value, members};
use crate::queries::clearance::{Stated, tube};
use crate::threads::{Asked, answer_each, answer_each_or_kind};
use parry_continuum::Tube;
use parry_continuum::parry::math::Pose;
use pyo3::prelude::*;

/// The tubes of a set of robots, with their poses.
fn placed(robot: &Given<'_>) -> Result<Vec<(Tube, Pose)>, Refused> {
    let stated = Stated { deviation: 0.0, turn: None };
    robot.all().map(|robot| Ok((tube(&robot, stated)?, robot.pose()?))).collect()
}

fn each(placed: &[(Tube, Pose)]) -> Vec<(&Tube, Pose)> {
    placed.iter().map(|(tube, pose)| (tube, *pose)).collect()
}

#[pymethods]
impl Scene {
    /// Whether smooth tubes through the robots' points keep all margins: from structures, from one
    /// another, and each from itself.
    ///
    /// Each robot is a smooth tube with flat ends, as `Mesh.clears_tube` takes it.
    ///
    /// Parameters
    /// ----------
    /// robots
    ///     As for `clears`.
    /// resolution : float
    ///     A length. The answer is undecided only where a clearance is within this of its margin,
    ///     or at a limit of work.
    ///
    /// Returns
    /// -------
    /// Decision or Decisions
    ///     Clear, contact, both proven, or undecided. A batch returns an array of `Decision`, (B,).
    ///
    /// Raises
    /// ------
    /// ContinuumError
    ///     Nothing has a margin, the resolution is negative or NaN, or finer than the points allow;
    ///     a tube bends within its radius and has a margin to itself; or as for `clears`.
    #[pyo3(signature = (robots, *, resolution))]
    fn clears_tube<'py>(
        &self,
        py: Python<'py>,
        #[pyo3(from_py_with = object_of::robots)] robots: Vec<Bound<'py, PyAny>>,
        #[pyo3(from_py_with = of::resolution)] resolution: f64,
    ) -> PyResult<Bound<'py, PyAny>> {
        check_length(py, "resolution", resolution)?;
        let robots = self.robots_apart(py, robots)?;
        let ask = |session: &mut Session, robot: &Given<'_>| {
            let placed = placed(robot)?;
            Ok(decision_value(session.scene.clears_tube(&each(&placed), resolution)?))
        };
        let all = answer_each(py, &self.snapshot(py), &robots, ask)?;
        members(py, Enumeration::Decision, robots.shape(&[]), all)
    }

    /// The least slack of smooth tubes through the robots' points, between proven bounds: of the
    /// tubes and the structures with a margin, and between tubes.
    ///
    /// A set that is refused does not fail its batch: its bounds are NaN, and its ``status`` is the
    /// ``kind`` of its error.
    ///
    /// Parameters
    /// ----------
    /// robots
    ///     As for `clears`. Each robot is a smooth tube with flat ends, as `Mesh.clearance` takes
    ///     it.
    /// tolerance : float
    ///     How far apart the bounds may be, at least 0.
    ///
    /// Returns
    /// -------
    /// SceneClearance
    ///     Of one set of robots, or arrays with one entry for each.
    ///
    /// Raises
    /// ------
    /// ContinuumError
    ///     The tolerance is negative or NaN. Of one set: points turn too sharply for a tube, or as
    ///     for `tightest`.
    ///
    /// Examples
    /// --------
    /// >>> from parry_continuum import Mesh, Scene
    /// >>> floor = Mesh([[-9, -9, 0], [9, -9, 0], [0, 9, 0]], [[0, 1, 2]])
    /// >>> scene = Scene()
    /// >>> scene.add("floor", floor, margin=1.0)
    /// 0
    /// >>> found = scene.clearance([([[0, 0, 2], [1, 0, 2]], 0.5)], tolerance=0.01)
    /// >>> bool(found.lower <= 0.5 <= found.upper), found.robots
    /// (True, array([ 0, -1]))
    #[pyo3(signature = (robots, *, tolerance))]
    fn clearance<'py>(
        &self,
        py: Python<'py>,
        #[pyo3(from_py_with = object_of::robots)] robots: Vec<Bound<'py, PyAny>>,
        #[pyo3(from_py_with = of::tolerance)] tolerance: f64,
    ) -> PyResult<Bound<'py, PyAny>> {
        check_length(py, "tolerance", tolerance)?;
        let robots = self.robots_apart(py, robots)?;
        let ask = |session: &mut Session, robot: &Given<'_>| {
            let placed = placed(robot)?;
            let found = session.scene.clearance(&each(&placed), tolerance)?;
            Ok(found.map_or(Bounds::WITHOUT_MARGIN, Bounds::of_tubes))
        };
        let structures = self.snapshot(py);
        let all = answer_each_or_kind(py, &structures, &robots, ask)?;
        bounds(py, &robots, &structures, &all, false)
    }
}
