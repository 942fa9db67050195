//! A robot that keeps its shape and moves.

use super::way::Way;
use super::{Motion, Moving, Recipe, place_in};
use crate::error::Refused;
use crate::input::{Block, Caps, Given, Names, Robots, of, stated_frame};
use crate::queries::chains::set_chain;
use crate::queries::clearance::{Stated, tube, tubes};
use crate::threads::Asked;
use parry_continuum::Tube;
use pyo3::IntoPyObjectExt;
use pyo3::prelude::*;

/// The motion of a robot that does not change its shape, evenly from one pose to another.
///
/// The robot's origin moves straight while the robot turns evenly about one axis, by the lesser
/// angle. From a pose to the same pose it is a robot at rest, for `Mesh.clears_motion_while`. The
/// robot is made of links; `of_curve` takes it for a smooth tube.
///
/// Parameters
/// ----------
/// points : (N, 3) or (B, N, 3) array
///     The centreline, in the robot's frame.
/// radii : float, (N - 1,) or (B, N - 1) array
///     One radius for each segment.
/// start_pose, end_pose : (4, 4) or (B, 4, 4) arrays
///     From the robot's frame to the mesh's, at the times 0 and 1. One robot may have many poses.
/// caps : {"fitted", "capsules", "cylinders"}
///
/// Raises
/// ------
/// ContinuumError
///     Points or radii are no robot, a pose is not rigid or out of range, or the numbers of robots
///     and poses differ.
///
/// Examples
/// --------
/// >>> import numpy as np
/// >>> from parry_continuum import Mesh, RigidMotion
/// >>> floor = Mesh([[-90, -90, 0], [90, -90, 0], [0, 90, 0]], [[0, 1, 2]])
/// >>> start, end = np.eye(4), np.eye(4)
/// >>> start[2, 3], end[2, 3] = 20, 5
/// >>> needle = [[0, 0, 0], [40, 0, 0]]
/// >>> found = floor.clearance_of_motion(RigidMotion(needle, 0.5, start, end), tolerance=0.001)
/// >>> bool(found.lower <= 4.5 <= found.upper)
/// True
#[pyclass(frozen, extends = Motion, module = "parry_continuum")]
pub(crate) struct RigidMotion;

#[pymethods]
impl RigidMotion {
    #[new]
    #[pyo3(signature = (points, radii, start_pose, end_pose, *, caps = Caps::Fitted), text_signature = "(points, radii, start_pose, end_pose, *, caps=\"fitted\")")]
    fn new(
        points: &Bound<'_, PyAny>,
        radii: &Bound<'_, PyAny>,
        start_pose: &Bound<'_, PyAny>,
        end_pose: &Bound<'_, PyAny>,
        caps: Caps,
    ) -> PyResult<PyClassInitializer<Self>> {
        let robots = Robots::new(Names::one("points"), points, radii, None)?;
        let way = Way::new(start_pose, end_pose)?;
        let motion = rigid(points.py(), &robots, &way, |robot| {
            Ok(Tube::from(set_chain(&mut None, robot, caps)?))
        })?;
        let motion = motion.with_frame(way.frame(stated_frame(points)?));
        let py = points.py();
        let caps = caps.name().into_bound_py_any(py)?;
        let given = [points, radii, start_pose, end_pose];
        let recipe = Recipe::new(py, None, &given, &[("caps", Some(caps))])?;
        Ok(motion.with_recipe(recipe).into_class(Self))
    }

    /// The same of smooth tubes, as `Mesh.clearance` takes them.
    ///
    /// Parameters
    /// ----------
    /// points, radii, start_pose, end_pose
    ///     As for the class.
    /// tangents, deviation, turn
    ///     As for `Mesh.clearance`.
    ///
    /// Raises
    /// ------
    /// ContinuumError
    ///     The points turn too sharply for a tube, or as for the class.
    #[staticmethod]
    #[pyo3(signature = (points, radii, start_pose, end_pose, *, tangents = None, deviation = 0.0, turn = None))]
    fn of_curve<'py>(
        points: &Bound<'py, PyAny>,
        radii: &Bound<'py, PyAny>,
        start_pose: &Bound<'py, PyAny>,
        end_pose: &Bound<'py, PyAny>,
        tangents: Option<&Bound<'py, PyAny>>,
        #[pyo3(from_py_with = of::deviation)] deviation: f64,
        #[pyo3(from_py_with = of::optional::turn)] turn: Option<f64>,
    ) -> PyResult<Py<Self>> {
        let stated = Stated { deviation, turn };
        let robots = tubes(
            Robots::new(Names::one("points"), points, radii, None)?,
            "tangents",
            tangents,
            stated,
        )?;
        let way = Way::new(start_pose, end_pose)?;
        let motion = rigid(points.py(), &robots, &way, |robot| tube(robot, stated))?;
        let motion = motion.with_frame(way.frame(stated_frame(points)?));
        let py = points.py();
        let more = [
            ("tangents", tangents.cloned()),
            ("deviation", Some(deviation.into_bound_py_any(py)?)),
            ("turn", turn.map(|turn| turn.into_bound_py_any(py)).transpose()?),
        ];
        let given = [points, radii, start_pose, end_pose];
        let recipe = Recipe::new(py, Some("of_curve"), &given, &more)?;
        Py::new(py, motion.with_recipe(recipe).into_class(Self))
    }
}

/// The motion of each robot of a batch, or of one for all.
fn rigid(
    py: Python<'_>,
    robots: &Robots<'_>,
    way: &Way,
    shape: impl Fn(&Given<'_>) -> Result<Tube, Refused> + Sync,
) -> PyResult<Motion> {
    let (count, mut block) = (robots.count, Block::default());
    robots.copy(0..robots.len(), &mut block).map_err(|refused| refused.raise(py, None))?;
    Motion::new(py, way.count(py, "points", count)?, |place| {
        let tube = shape(&block.robot(place_in(count, place)))?;
        let motion = parry_continuum::RigidMotion::new(tube, way.poses(place)?)?;
        Ok(Moving::Rigid(Box::new(motion)))
    })
}
