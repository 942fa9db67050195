//! The class `RobotPair`: queries about two robots.

use super::session::Pairs;
use crate::input::{Caps, HasWarned, of};
use pyo3::prelude::*;
use pyo3::types::{PyTuple, PyType};

/// Exact queries about two robots.
///
/// The last answers warm-start the next query. Any robots may follow; small motions are answered
/// fastest. The warm start never changes an answer. Any number of threads may use one `RobotPair`.
/// A copy starts without a warm start. For one robot and itself see `SelfQuery`.
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
pub(crate) struct RobotPair(pub(super) Pairs, pub(super) HasWarned);

#[pymethods]
impl RobotPair {
    #[new]
    fn new() -> Self {
        Self(Pairs::default(), HasWarned::default())
    }

    /// The copy has no warm start, which only makes answers faster.
    fn __copy__(&self) -> Self {
        Self::new()
    }

    fn __deepcopy__(&self, _memo: &Bound<'_, PyAny>) -> Self {
        Self::new()
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> (Bound<'py, PyType>, Bound<'py, PyTuple>) {
        (slf.get_type(), PyTuple::empty(slf.py()))
    }

    /// Forgets the last answers: the next query starts without a warm start.
    fn forget(&self, py: Python<'_>) {
        self.0.forget(py);
    }

    /// The distance between two robots, and the two closest points.
    ///
    /// The distance is 0 where the robots touch or overlap. If one argument is a batch and the
    /// other is one robot, that robot is paired with each robot of the batch.
    ///
    /// Parameters
    /// ----------
    /// points_a, points_b : (N, 3) or (B, N, 3) arrays
    /// radii_a, radii_b : float, (N - 1,) or (B, N - 1) arrays
    /// pose_a, pose_b : (4, 4) or (B, 4, 4) arrays, optional
    ///     From the frame of each robot to one frame for both. The answer is in that frame.
    /// caps : {"fitted", "capsules", "cylinders"}
    ///
    /// Returns
    /// -------
    /// RobotProximity
    ///
    /// Raises
    /// ------
    /// ContinuumError
    ///     Points or radii are no robot, or a pose is not rigid.
    ///
    /// Examples
    /// --------
    /// >>> from parry_continuum import RobotPair
    /// >>> found = RobotPair().minimum([[0, 0, 0], [0, 0, 9]], 0.5, [[3, -5, 4], [3, 5, 4]], 0.5)
    /// >>> found.distance, found.arc_lengths
    /// (2.0, array([4., 5.]))
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
        let robots = self.robots([points_a, radii_a, points_b, radii_b], [pose_a, pose_b])?;
        self.0.minimum(py, &robots, caps)
    }

    /// Of each segment of the first robot, the closest link of the second.
    ///
    /// Parameters
    /// ----------
    /// points_a, radii_a, points_b, radii_b, pose_a, pose_b, caps
    ///     As for `minimum`.
    ///
    /// Returns
    /// -------
    /// RobotProximity
    ///     Arrays of the shape (N - 1, ...), or (B, N - 1, ...) of a batch. Of a segment of the
    ///     first robot without length the distance is NaN, and the segments are -1.
    ///
    /// Raises
    /// ------
    /// ContinuumError
    ///     As for `minimum`.
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
        let robots = self.robots([points_a, radii_a, points_b, radii_b], [pose_a, pose_b])?;
        self.0.per_link(py, &robots, caps)
    }

    /// Every place where the robots are at most a margin apart, in the order of the segments.
    ///
    /// A place is a pair of segments that is as close as its neighbours or closer. Neighbours are
    /// one segment apart along either robot or both. Equally close neighbours count as one place,
    /// at the lowest segments.
    ///
    /// Parameters
    /// ----------
    /// points_a, radii_a, points_b, radii_b, pose_a, pose_b, caps
    ///     As for `minimum`.
    /// margin : float
    ///     A length, at least 0.
    ///
    /// Returns
    /// -------
    /// RobotContacts
    ///     Arrays of one length, with a row for each place. The rows of pair k are
    ///     ``offsets[k]:offsets[k + 1]``.
    ///
    /// Raises
    /// ------
    /// ContinuumError
    ///     The margin is negative or NaN, or as for `minimum`.
    #[pyo3(signature = (points_a, radii_a, points_b, radii_b, *, margin, pose_a = None, pose_b = None, caps = Caps::Fitted), text_signature = "($self, points_a, radii_a, points_b, radii_b, *, margin, pose_a=None, pose_b=None, caps=\"fitted\")")]
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
        let robots = self.robots([points_a, radii_a, points_b, radii_b], [pose_a, pose_b])?;
        self.0.contacts_within(py, &robots, margin, caps)
    }

    /// Whether the distance between two robots is more than a margin.
    ///
    /// The answer equals ``minimum(...).distance > margin`` and takes less work.
    ///
    /// Parameters
    /// ----------
    /// points_a, radii_a, points_b, radii_b, pose_a, pose_b, caps
    ///     As for `minimum`.
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
    ///     The margin is negative or NaN, or as for `minimum`.
    ///
    /// Examples
    /// --------
    /// >>> from parry_continuum import RobotPair
    /// >>> robots = ([[0, 0, 0], [0, 0, 9]], 0.5, [[3, -5, 4], [3, 5, 4]], 0.5)
    /// >>> RobotPair().clears(*robots, margin=1.9)
    /// True
    #[pyo3(signature = (points_a, radii_a, points_b, radii_b, *, margin, pose_a = None, pose_b = None, caps = Caps::Fitted), text_signature = "($self, points_a, radii_a, points_b, radii_b, *, margin, pose_a=None, pose_b=None, caps=\"fitted\")")]
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
        let robots = self.robots([points_a, radii_a, points_b, radii_b], [pose_a, pose_b])?;
        self.0.clears(py, &robots, margin, caps)
    }
}
