//! A motion whose points move straight and evenly.

use super::{Motion, Moving, Recipe};
use crate::error::Refused;
use crate::input::{Block, Caps, HasWarned, Names, Robots, stated_frame};
use crate::threads::Asked;
use parry_continuum::RobotError;
use parry_continuum::parry::math::Vector;
use pyo3::IntoPyObjectExt;
use pyo3::prelude::*;

/// What makes a motion of two shapes and radii.
pub(crate) type Maker =
    fn(&[Vector], &[Vector], &[f64]) -> Result<parry_continuum::LinearMotion, RobotError>;

pub(crate) fn maker(py: Python<'_>, caps: Caps) -> PyResult<Maker> {
    match caps {
        Caps::Fitted => Ok(parry_continuum::LinearMotion::chain),
        Caps::Capsules => Ok(parry_continuum::LinearMotion::capsules),
        Caps::Cylinders => {
            let text = "`caps` is 'cylinders'; motions take 'fitted' or 'capsules'";
            Err(Refused::other("bad_caps", text).raise(py, None))
        }
    }
}

/// The motion of a robot each of whose points moves straight and evenly, from one place to another.
///
/// `Mesh.clears_motion(start, end, radii, ...)` asks about it without such an object. It is a part
/// of a `MovingBase` or of a `MotionPath`.
///
/// Parameters
/// ----------
/// start, end : (N, 3) or (B, N, 3) arrays
///     With as many points each; of a batch and one, the one stands for all. The centreline at the
///     times 0 and 1, in the mesh's frame, or in that of a moving base.
/// radii : float, (N - 1,) or (B, N - 1) array
///     One radius for each segment.
/// caps : {"fitted", "capsules"}
///
/// Raises
/// ------
/// ContinuumError
///     A point or a radius is no robot's, the two shapes differ in their number of points, or no
///     segment has a length at the start or the end. (A robot may grow out of a single point.)
///
/// Examples
/// --------
/// >>> import numpy as np
/// >>> from parry_continuum import Decision, LinearMotion, Mesh
/// >>> floor = Mesh([[-9, -9, 0], [9, -9, 0], [0, 9, 0]], [[0, 1, 2]])
/// >>> above = np.array([[0, 0, 2], [1, 0, 2]])
/// >>> motion = LinearMotion(above, above - [0, 0, 4], 0.1)
/// >>> floor.clears_motion(motion, margin=0, resolution=1e-3).decision is Decision.CONTACT
/// True
#[pyclass(frozen, extends = Motion, module = "parry_continuum")]
pub(crate) struct LinearMotion;

#[pymethods]
impl LinearMotion {
    #[new]
    #[pyo3(signature = (start, end, radii, *, caps = Caps::Fitted), text_signature = "(start, end, radii, *, caps=\"fitted\")")]
    fn new(
        py: Python<'_>,
        start: &Bound<'_, PyAny>,
        end: &Bound<'_, PyAny>,
        radii: &Bound<'_, PyAny>,
        caps: Caps,
    ) -> PyResult<PyClassInitializer<Self>> {
        let make = maker(py, caps)?;
        let robots = Robots::new(Names::one("start"), start, radii, None)?
            .with_as_many("end", end, "start")?;
        let mut block = Block::default();
        robots.copy(0..robots.len(), &mut block).map_err(|refused| refused.raise(py, None))?;
        let motion = Motion::new(py, robots.count, |place| {
            let robot = block.robot(place);
            Ok(Moving::Linear(make(robot.points, robot.more, robot.radii)?))
        })?;
        let frames = [stated_frame(start)?, stated_frame(end)?];
        HasWarned::default().note_pair(py, ["start", "end"], frames)?;
        let motion = motion.with_frame(frames[0].or(frames[1]));
        let caps = caps.name().into_bound_py_any(py)?;
        let recipe = Recipe::new(py, None, &[start, end, radii], &[("caps", Some(caps))])?;
        Ok(motion.with_recipe(recipe).into_class(Self))
    }
}
