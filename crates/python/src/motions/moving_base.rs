//! A motion whose base moves as well.

use super::way::Way;
use super::{Motion, Moving, Recipe, Size, at};
use crate::input::object_of;
use pyo3::prelude::*;

/// A motion whose base is moved at the same time, evenly from one pose to another: a robot that is
/// pushed or rolled while its sections bend and grow.
///
/// The motion is in the frame of the base. The base's origin moves straight while the base turns
/// evenly about one axis, by the lesser angle.
///
/// Parameters
/// ----------
/// motion : Motion
///     Any motion without a jump, or a batch.
/// start_pose, end_pose : (4, 4) or (B, 4, 4) arrays
///     From the frame of the base to the mesh's, at the times 0 and 1.
///
/// Raises
/// ------
/// ContinuumError
///     A pose is not rigid or out of range, the numbers of motions and poses differ, or the motion
///     has no shape at some time.
///
/// Examples
/// --------
/// >>> import numpy as np
/// >>> from parry_continuum import BendingMotion, Mesh, MovingBase
/// >>> floor = Mesh([[-90, -90, 0], [90, -90, 0], [0, 90, 0]], [[0, 1, 2]])
/// >>> bending = BendingMotion([[30, 0, 0]], [[32, 0.03, 0.01]], 1.0)  # lengthens and bends
/// >>> start = np.eye(4)
/// >>> start[2, 3] = 2
/// >>> end = start.copy()
/// >>> end[:2, :2] = [[np.cos(1), -np.sin(1)], [np.sin(1), np.cos(1)]]  # rolled by 1 rad
/// >>> end[2, 3] = 7                                                    # and pushed by 5
/// >>> found = floor.clearance_of_motion(MovingBase(bending, start, end), tolerance=0.001)
/// >>> bool(found.lower <= 2 <= found.upper), bool(found.t < 0.001)     # its base is flat, 2 above
/// (True, True)
#[pyclass(frozen, extends = Motion, module = "parry_continuum")]
pub(crate) struct MovingBase;

#[pymethods]
impl MovingBase {
    #[new]
    fn new(
        py: Python<'_>,
        #[pyo3(from_py_with = object_of::motion)] motion: Bound<'_, Motion>,
        start_pose: &Bound<'_, PyAny>,
        end_pose: &Bound<'_, PyAny>,
    ) -> PyResult<PyClassInitializer<Self>> {
        let way = Way::new(start_pose, end_pose)?;
        let (count, motions) = motion.get().parts();
        let count = way.count(py, "motion", count)?;
        let size = Size::of(py, std::iter::once(motion.get().size))?;
        let moved = Motion::new(py, count, |place| {
            let motion = at(&motions, place).clone();
            let moved = parry_continuum::MovingBase::new(motion, way.poses(place)?)?;
            Ok(Moving::OnBase(Box::new(moved)))
        })?;
        let moved = moved.with_frame(way.frame(motion.get().stated_frame()));
        let given = [motion.as_any(), start_pose, end_pose];
        let recipe = Recipe::new(py, None, &given, &[])?;
        Ok(moved.of(size).with_recipe(recipe).into_class(Self))
    }
}
