//! Motions one after another.

use super::{Motion, Moving, Recipe, Size, at, together};
use crate::input::object_of;
use pyo3::prelude::*;
use pyo3::types::PyList;

/// Motions one after another, each with the same share of the time. Of n motions the first one
/// takes the time from 0 to 1 / n, the next one until 2 / n, and so on.
///
/// Each begins where the one before ends, and all have the same sections with the same radii.
/// `Mesh.clearance_of_motion` looks closely only at the motions that may come nearest.
///
/// Parameters
/// ----------
/// motions : list of Motion
///     Of batches, which have as many each, the paths are a batch.
///
/// Raises
/// ------
/// ContinuumError
///     The list is empty, the batches differ in how many motions they have, motions have different
///     sections, or one begins farther from the end of the one before than rounding and stated
///     deviations explain: ``index`` is its place in the list.
///
/// Examples
/// --------
/// >>> import numpy as np
/// >>> from parry_continuum import LinearMotion, Mesh, MotionPath
/// >>> floor = Mesh([[-9, -9, 0], [9, -9, 0], [0, 9, 0]], [[0, 1, 2]])
/// >>> robot = np.array([[0, 0, 4.0], [1, 0, 4]])
/// >>> low, middle = robot - [0, 0, 2], robot - [0, 0, 1]
/// >>> steps = [LinearMotion(robot, low, 0.5), LinearMotion(low, middle, 0.5)]
/// >>> found = floor.clearance_of_motion(MotionPath(steps), tolerance=0.001)
/// >>> bool(found.lower <= 1.5 <= found.upper), bool(abs(found.t - 0.5) < 0.001)
/// (True, True)
#[pyclass(frozen, extends = Motion, module = "parry_continuum")]
pub(crate) struct MotionPath;

#[pymethods]
impl MotionPath {
    #[new]
    fn new(
        py: Python<'_>,
        #[pyo3(from_py_with = object_of::motions)] motions: Vec<Bound<'_, Motion>>,
    ) -> PyResult<PyClassInitializer<Self>> {
        let parts: Vec<_> = motions.iter().map(|motion| motion.get().parts()).collect();
        let count = together(py, parts.iter().map(|(count, _)| ("motions", *count)))?;
        let size = Size::of(py, motions.iter().map(|motion| motion.get().size))?;
        let motion = Motion::new(py, count, |place| {
            let legs = parts.iter().map(|(_, motions)| at(motions, place).clone());
            Ok(Moving::Path(parry_continuum::MotionPath::new(legs.collect())?))
        })?;
        let frame = motions.iter().find_map(|motion| motion.get().stated_frame());
        let motion = motion.with_frame(frame);
        let given = PyList::new(py, &motions)?;
        let recipe = Recipe::new(py, None, &[given.as_any()], &[])?;
        Ok(motion.of(size).with_recipe(recipe).into_class(Self))
    }
}
