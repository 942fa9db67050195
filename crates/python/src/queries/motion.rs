//! Whether a robot keeps a margin on all of its way, and until when.

use super::motion_answer::motion_answer;
use super::way::{Arguments, Question};
use crate::input::{Caps, of};
use crate::mesh::Mesh;
use crate::threads::Session;
use parry_continuum::Motion;
use parry_continuum::proximity::{MotionAnswer, ProximityError};
use pyo3::prelude::*;

struct Clears {
    margin: f64,
    resolution: f64,
}

impl Question<MotionAnswer> for Clears {
    fn ask(
        &self,
        session: &mut Session,
        motion: &impl Motion,
    ) -> Result<MotionAnswer, ProximityError> {
        session.search.clears_motion(motion, self.margin, self.resolution)
    }
}

struct FirstContact {
    margin: f64,
    resolution: f64,
}

impl Question<MotionAnswer> for FirstContact {
    fn ask(
        &self,
        session: &mut Session,
        motion: &impl Motion,
    ) -> Result<MotionAnswer, ProximityError> {
        session.search.time_of_contact(motion, self.margin, self.resolution)
    }
}

#[pymethods]
impl Mesh {
    /// Whether robots keep more than a margin away on all of their way.
    ///
    /// With `start`, `end` and `radii`, every point of the centreline moves straight and evenly,
    /// from `start` at the time 0 to `end` at the time 1, in the mesh's frame. A `Motion` as the
    /// only positional argument is any other motion: a `RigidMotion`, a `BendingMotion`, a
    /// `MovingBase` or a `MotionPath`.
    ///
    /// ``Decision.CLEAR`` is proven for every time between, so that no robot slips through a thin
    /// wall between two steps.
    ///
    /// Parameters
    /// ----------
    /// start, end : (N, 3) or (B, N, 3) arrays
    ///     With as many points each; of a batch and one, the one stands for all. Or a `Motion`, or
    ///     a batch of them, as `start` alone.
    /// radii : float, (N - 1,) or (B, N - 1) array
    ///     One radius for each segment.
    /// margin : float
    ///     A length, at least 0.
    /// resolution : float
    ///     A length. The answer is undecided only where some shape is farther away than the margin
    ///     by at most this length, where an end turns from flat to round there, or where 65,536
    ///     shapes do not decide it.
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
    ///     Margin or resolution are negative or NaN, the resolution is finer than rounding, or one
    ///     of the shapes is no robot.
    ///
    /// Examples
    /// --------
    /// >>> import numpy as np
    /// >>> from parry_continuum import Decision, Mesh
    /// >>> floor = Mesh([[-9, -9, 0], [9, -9, 0], [0, 9, 0]], [[0, 1, 2]])
    /// >>> above = np.array([[0, 0, 2], [1, 0, 2]])
    /// >>> below = above - [0, 0, 4]
    /// >>> answer = floor.clears_motion(above, below, 0.1, margin=0, resolution=1e-3)
    /// >>> answer.decision is Decision.CONTACT
    /// True
    #[pyo3(signature = (start, end = None, radii = None, *, margin, resolution, caps = None), text_signature = "($self, start, end=None, radii=None, *, margin, resolution, caps=\"fitted\")")]
    #[allow(clippy::too_many_arguments)] // they are named in Python
    fn clears_motion<'py>(
        &self,
        py: Python<'py>,
        start: &Bound<'py, PyAny>,
        end: Option<&Bound<'py, PyAny>>,
        radii: Option<&Bound<'py, PyAny>>,
        #[pyo3(from_py_with = of::margin)] margin: f64,
        #[pyo3(from_py_with = of::resolution)] resolution: f64,
        caps: Option<Caps>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let way = self.way(&Arguments { start, end, radii, caps })?;
        let question = Clears { margin, resolution };
        motion_answer(py, way.count(), &way.ask(py, &self.engine(py), &question)?)
    }

    /// When robots first come as close to the mesh as a margin, on their way.
    ///
    /// The margin is kept until ``interval[0]``, which is proven, and not kept at ``interval[1]``.
    /// Between the two times the place that touches moves by at most the resolution.
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
    #[pyo3(signature = (start, end = None, radii = None, *, margin, resolution, caps = None), text_signature = "($self, start, end=None, radii=None, *, margin, resolution, caps=\"fitted\")")]
    #[allow(clippy::too_many_arguments)] // they are named in Python
    fn time_of_contact<'py>(
        &self,
        py: Python<'py>,
        start: &Bound<'py, PyAny>,
        end: Option<&Bound<'py, PyAny>>,
        radii: Option<&Bound<'py, PyAny>>,
        #[pyo3(from_py_with = of::margin)] margin: f64,
        #[pyo3(from_py_with = of::resolution)] resolution: f64,
        caps: Option<Caps>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let way = self.way(&Arguments { start, end, radii, caps })?;
        let question = FirstContact { margin, resolution };
        motion_answer(py, way.count(), &way.ask(py, &self.engine(py), &question)?)
    }
}
