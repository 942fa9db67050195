//! A robot against another, and against itself, each question by itself.

use super::{Pairs, pairs};
use crate::input::{Caps, Names, Robots, of};
use pyo3::prelude::*;

/// The distance between two robots, and the two points that are closest.
///
/// It is 0 where they touch or overlap. Where one of the two is a batch and the other is not, that one is asked about beside
/// each of the batch.
///
/// Parameters
/// ----------
/// points_a, points_b : (N, 3) or (B, N, 3) arrays
/// radii_a, radii_b : float, (N - 1,) or (B, N - 1) arrays
/// pose_a, pose_b : (4, 4) or (B, 4, 4) arrays, optional
///     To one frame for both, in which the answer is.
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
/// >>> from parry_continuum import between
/// >>> found = between([[0, 0, 0], [0, 0, 9]], 0.5, [[3, -5, 4], [3, 5, 4]], 0.5)
/// >>> found.distance, found.arc_lengths
/// (2.0, array([4., 5.]))
#[pyfunction]
#[pyo3(signature = (points_a, radii_a, points_b, radii_b, *, pose_a = None, pose_b = None, caps = Caps::Fitted), text_signature = "(points_a, radii_a, points_b, radii_b, *, pose_a=None, pose_b=None, caps=\"fitted\")")]
#[allow(clippy::too_many_arguments)] // they are named in Python
pub(crate) fn between<'py>(
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
    Pairs::default().minimum(py, &robots, caps)
}

/// Whether two robots keep more than a margin from each other: exactly ``between(...).distance > margin``, for less work.
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
///
/// Examples
/// --------
/// >>> from parry_continuum import clears_between
/// >>> clears_between([[0, 0, 0], [0, 0, 9]], 0.5, [[3, -5, 4], [3, 5, 4]], 0.5, margin=1.9)
/// True
#[pyfunction]
#[pyo3(signature = (points_a, radii_a, points_b, radii_b, margin, *, pose_a = None, pose_b = None, caps = Caps::Fitted), text_signature = "(points_a, radii_a, points_b, radii_b, margin, *, pose_a=None, pose_b=None, caps=\"fitted\")")]
#[allow(clippy::too_many_arguments)] // they are named in Python
pub(crate) fn clears_between<'py>(
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
    Pairs::default().clears(py, &robots, margin, caps)
}

/// The least distance between parts of a robot that could meet: those between which its curve turns by at least half a turn.
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
///     Where no parts could meet, the distance is infinite and the segments are -1.
///
/// Raises
/// ------
/// ContinuumError
///     Points or radii are no robot, or a joint is so sharp that its links overlap over more than half of the shorter one.
///
/// Examples
/// --------
/// >>> from parry_continuum import self_minimum
/// >>> hook = [[0, 0, 0], [0, 0, 9], [2, 0, 11], [4, 0, 9], [4, 0, 0]]
/// >>> self_minimum(hook, 0.5).distance
/// 3.0
/// >>> self_minimum(hook[:3], 0.5).distance
/// inf
#[pyfunction]
#[pyo3(signature = (points, radii, *, caps = Caps::Fitted), text_signature = "(points, radii, *, caps=\"fitted\")")]
pub(crate) fn self_minimum<'py>(
    py: Python<'py>,
    points: &Bound<'py, PyAny>,
    radii: &Bound<'py, PyAny>,
    caps: Caps,
) -> PyResult<Bound<'py, PyAny>> {
    Pairs::default().self_minimum(
        py,
        &Robots::new(Names::one("points"), points, radii, None)?,
        caps,
    )
}

/// Whether the parts of a robot that could meet keep more than a margin: ``self_minimum(...).distance > margin``.
///
/// Parameters
/// ----------
/// points, radii, caps
///     As for `self_minimum`.
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
///     The margin is negative or NaN, or as for `self_minimum`.
#[pyfunction]
#[pyo3(signature = (points, radii, margin, *, caps = Caps::Fitted), text_signature = "(points, radii, margin, *, caps=\"fitted\")")]
pub(crate) fn self_clears<'py>(
    py: Python<'py>,
    points: &Bound<'py, PyAny>,
    radii: &Bound<'py, PyAny>,
    #[pyo3(from_py_with = of::margin)] margin: f64,
    caps: Caps,
) -> PyResult<Bound<'py, PyAny>> {
    Pairs::default().self_clears(
        py,
        &Robots::new(Names::one("points"), points, radii, None)?,
        margin,
        caps,
    )
}
