//! Two robots that are asked about again and again.

use super::{Pairs, pairs};
use crate::input::{Caps, Names, Robots, of};
use pyo3::prelude::*;
use pyo3::types::{PyTuple, PyType};

/// Questions about two robots, or about one and itself.
///
/// It remembers what was nearest, which bounds the next query: small motions are answered fastest, and any robots may follow.
/// Answers do not depend on it. Any number of threads may ask one `RobotPair`. `between`, `clears_between`, `self_minimum` and
/// `self_clears` are the same without a memory.
///
/// Examples
/// --------
/// >>> from parry_continuum import RobotPair
/// >>> pair = RobotPair()
/// >>> a, b = [[0, 0, 0], [0, 0, 4], [0, 0, 9]], [[3, -5, 3], [3, 5, 3]]
/// >>> pair.minimum(a, 0.5, b, 0.5).distance
/// 2.0
/// >>> pair.per_link(a, 0.5, b, 0.5).distance.round(3)
/// array([2.   , 2.162])
/// >>> pair.contacts_within(a, 0.5, b, 0.5, margin=3).segments
/// array([[0, 0]])
#[pyclass(frozen, module = "parry_continuum", weakref)]
pub(crate) struct RobotPair(pub(super) Pairs);

#[pymethods]
impl RobotPair {
    #[new]
    fn new() -> Self {
        Self(Pairs::default())
    }

    /// A new one: what it remembers only makes answers faster.
    fn __copy__(&self) -> Self {
        Self::new()
    }

    fn __deepcopy__(&self, _memo: &Bound<'_, PyAny>) -> Self {
        Self::new()
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> (Bound<'py, PyType>, Bound<'py, PyTuple>) {
        (slf.get_type(), PyTuple::empty(slf.py()))
    }

    /// Forgets the last answers, as if it were new.
    fn forget(&self, py: Python<'_>) {
        let sessions = self.0.0.with(py, std::mem::take);
        drop(sessions); // not under the lock
    }

    /// The distance between two robots, and the two points that are closest: as `between`.
    ///
    /// Parameters
    /// ----------
    /// points_a, radii_a, points_b, radii_b, pose_a, pose_b, caps
    ///     As for `between`.
    ///
    /// Returns
    /// -------
    /// RobotProximity
    ///
    /// Raises
    /// ------
    /// ContinuumError
    ///     As for `between`.
    #[pyo3(signature = (points_a, radii_a, points_b, radii_b, *, pose_a = None, pose_b = None, caps = Caps::Fitted), text_signature = "($self, points_a, radii_a, points_b, radii_b, *, pose_a=None, pose_b=None, caps=\"fitted\")")]
    #[allow(clippy::too_many_arguments)] // they are named in Python
    fn minimum<'py>(
        &self,
        py: Python<'py>,
        points_a: &Bound<'py, PyAny>,
        radii_a: &Bound<'py, PyAny>,
        points_b: &Bound<'py, PyAny>,
        radii_b: &Bound<'py, PyAny>,
        pose_a: Option<&Bound<'py, PyAny>>,
        pose_b: Option<&Bound<'py, PyAny>>,
        caps: Caps,
    ) -> PyResult<Bound<'py, PyAny>> {
        let robots = pairs([points_a, radii_a, points_b, radii_b], [pose_a, pose_b])?;
        self.0.minimum(py, &robots, caps)
    }

    /// Of each segment of the first robot, the closest link of the second.
    ///
    /// Parameters
    /// ----------
    /// points_a, radii_a, points_b, radii_b, pose_a, pose_b, caps
    ///     As for `between`.
    ///
    /// Returns
    /// -------
    /// RobotProximity
    ///     Arrays of the shape (N - 1, ...), or (B, N - 1, ...) of a batch. Of a segment of the first robot without length the distance
    ///     is NaN, and the segments are -1.
    ///
    /// Raises
    /// ------
    /// ContinuumError
    ///     As for `between`.
    #[pyo3(signature = (points_a, radii_a, points_b, radii_b, *, pose_a = None, pose_b = None, caps = Caps::Fitted), text_signature = "($self, points_a, radii_a, points_b, radii_b, *, pose_a=None, pose_b=None, caps=\"fitted\")")]
    #[allow(clippy::too_many_arguments)] // they are named in Python
    fn per_link<'py>(
        &self,
        py: Python<'py>,
        points_a: &Bound<'py, PyAny>,
        radii_a: &Bound<'py, PyAny>,
        points_b: &Bound<'py, PyAny>,
        radii_b: &Bound<'py, PyAny>,
        pose_a: Option<&Bound<'py, PyAny>>,
        pose_b: Option<&Bound<'py, PyAny>>,
        caps: Caps,
    ) -> PyResult<Bound<'py, PyAny>> {
        let robots = pairs([points_a, radii_a, points_b, radii_b], [pose_a, pose_b])?;
        self.0.per_link(py, &robots, caps)
    }

    /// Every place where the robots are at most a margin apart, in the order of the segments.
    ///
    /// A place is a pair of segments of which no neighbours, one segment on along either robot or both, are closer. Neighbours that are
    /// as close count as one place, at the lowest segments.
    ///
    /// Parameters
    /// ----------
    /// points_a, radii_a, points_b, radii_b, pose_a, pose_b, caps
    ///     As for `between`.
    /// margin : float
    ///     A length, at least 0.
    ///
    /// Returns
    /// -------
    /// RobotContacts
    ///     Arrays of one length, with a row for each place. Those of pair k are ``offsets[k]:offsets[k + 1]``.
    ///
    /// Raises
    /// ------
    /// ContinuumError
    ///     The margin is negative or NaN, or as for `between`.
    #[pyo3(signature = (points_a, radii_a, points_b, radii_b, margin, *, pose_a = None, pose_b = None, caps = Caps::Fitted), text_signature = "($self, points_a, radii_a, points_b, radii_b, margin, *, pose_a=None, pose_b=None, caps=\"fitted\")")]
    #[allow(clippy::too_many_arguments)] // they are named in Python
    fn contacts_within<'py>(
        &self,
        py: Python<'py>,
        points_a: &Bound<'py, PyAny>,
        radii_a: &Bound<'py, PyAny>,
        points_b: &Bound<'py, PyAny>,
        radii_b: &Bound<'py, PyAny>,
        #[pyo3(from_py_with = of::margin)] margin: f64,
        pose_a: Option<&Bound<'py, PyAny>>,
        pose_b: Option<&Bound<'py, PyAny>>,
        caps: Caps,
    ) -> PyResult<Bound<'py, PyAny>> {
        let robots = pairs([points_a, radii_a, points_b, radii_b], [pose_a, pose_b])?;
        self.0.contacts_within(py, &robots, margin, caps)
    }

    /// Whether two robots keep more than a margin from each other: as `clears_between`.
    ///
    /// Parameters
    /// ----------
    /// points_a, radii_a, points_b, radii_b, pose_a, pose_b, caps
    ///     As for `between`.
    /// margin : float
    ///     A length, at least 0.
    ///
    /// Returns
    /// -------
    /// bool or (B,) array of bool
    ///
    /// Raises
    /// ------
    /// ContinuumError
    ///     The margin is negative or NaN, or as for `between`.
    #[pyo3(signature = (points_a, radii_a, points_b, radii_b, margin, *, pose_a = None, pose_b = None, caps = Caps::Fitted), text_signature = "($self, points_a, radii_a, points_b, radii_b, margin, *, pose_a=None, pose_b=None, caps=\"fitted\")")]
    #[allow(clippy::too_many_arguments)] // they are named in Python
    fn clears<'py>(
        &self,
        py: Python<'py>,
        points_a: &Bound<'py, PyAny>,
        radii_a: &Bound<'py, PyAny>,
        points_b: &Bound<'py, PyAny>,
        radii_b: &Bound<'py, PyAny>,
        #[pyo3(from_py_with = of::margin)] margin: f64,
        pose_a: Option<&Bound<'py, PyAny>>,
        pose_b: Option<&Bound<'py, PyAny>>,
        caps: Caps,
    ) -> PyResult<Bound<'py, PyAny>> {
        let robots = pairs([points_a, radii_a, points_b, radii_b], [pose_a, pose_b])?;
        self.0.clears(py, &robots, margin, caps)
    }

    /// The least distance between parts of a robot that could meet: as `parry_continuum.self_minimum`.
    ///
    /// Parameters
    /// ----------
    /// points : (N, 3) or (B, N, 3) array
    /// radii : float, (N - 1,) or (B, N - 1) array
    /// caps : {"fitted", "capsules", "cylinders"}
    ///
    /// Returns
    /// -------
    /// RobotProximity
    ///
    /// Raises
    /// ------
    /// ContinuumError
    ///     As for `parry_continuum.self_minimum`.
    #[pyo3(signature = (points, radii, *, caps = Caps::Fitted), text_signature = "($self, points, radii, *, caps=\"fitted\")")]
    fn self_minimum<'py>(
        &self,
        py: Python<'py>,
        points: &Bound<'py, PyAny>,
        radii: &Bound<'py, PyAny>,
        caps: Caps,
    ) -> PyResult<Bound<'py, PyAny>> {
        self.0.self_minimum(py, &Robots::new(Names::one("points"), points, radii, None)?, caps)
    }

    /// Whether the parts of a robot that could meet keep more than a margin: as `parry_continuum.self_clears`.
    ///
    /// Parameters
    /// ----------
    /// points : (N, 3) or (B, N, 3) array
    /// radii : float, (N - 1,) or (B, N - 1) array
    /// margin : float
    ///     A length, at least 0.
    /// caps : {"fitted", "capsules", "cylinders"}
    ///
    /// Returns
    /// -------
    /// bool or (B,) array of bool
    ///
    /// Raises
    /// ------
    /// ContinuumError
    ///     The margin is negative or NaN, or as for `parry_continuum.self_minimum`.
    #[pyo3(signature = (points, radii, margin, *, caps = Caps::Fitted), text_signature = "($self, points, radii, margin, *, caps=\"fitted\")")]
    fn self_clears<'py>(
        &self,
        py: Python<'py>,
        points: &Bound<'py, PyAny>,
        radii: &Bound<'py, PyAny>,
        #[pyo3(from_py_with = of::margin)] margin: f64,
        caps: Caps,
    ) -> PyResult<Bound<'py, PyAny>> {
        self.0.self_clears(
            py,
            &Robots::new(Names::one("points"), points, radii, None)?,
            margin,
            caps,
        )
    }
}
