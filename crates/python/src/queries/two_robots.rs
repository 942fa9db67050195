//! A robot against another, and against itself.

use super::distance::{no_chain, set_chain};
use crate::error::Refused;
use crate::input::{Caps, Given, Robots};
use crate::output::{answer, array, array_or_number, flat};
use crate::threads::{Lender, ask_each};
use parry_continuum::Chain;
use parry_continuum::parry::math::{Pose, Vector};
use parry_continuum::proximity::{RobotPair, RobotProximity};
use pyo3::prelude::*;

/// Needs no mesh: each thread has a session of its own, for as long as it asks.
struct Pairs;

#[derive(Default)]
struct Session {
    pair: RobotPair,
    chains: [Option<Chain>; 2],
}

impl Lender for Pairs {
    type Session = Session;

    fn lend(&self, _: Python<'_>) -> PyResult<Session> {
        Ok(Session::default())
    }

    fn take_back(&self, _: Python<'_>, _: usize, _: impl IntoIterator<Item = Session>) {}
}

impl Session {
    fn place(&mut self, robot: &Given<'_>, caps: Caps) -> Result<[Pose; 2], Refused> {
        let other = robot.other().ok_or_else(no_chain)?;
        let [first, second] = &mut self.chains;
        set_chain(first, robot, caps)?;
        set_chain(second, &other, caps)?;
        Ok([robot.pose()?, other.pose()?])
    }

    fn chains(&mut self) -> Result<(&mut RobotPair, [&Chain; 2]), Refused> {
        match (&mut self.pair, &self.chains) {
            (pair, [Some(first), Some(second)]) => Ok((pair, [first, second])),
            (pair, [Some(first), None]) => Ok((pair, [first, first])),
            _ => Err(no_chain()),
        }
    }
}

/// What there is of one pair of robots.
#[derive(Clone, Copy)]
struct Row {
    found: RobotProximity,
    segments: [i64; 2],
}

impl Row {
    fn new(found: RobotProximity, chains: [&Chain; 2], points: [&[Vector]; 2]) -> Self {
        let segments = std::array::from_fn(|k| segment_of(chains[k], points[k], found.links[k] as usize));
        Self { found, segments }
    }
}

/// The segment of the input that a link is: of those that it stands for, the one with its ends.
pub(crate) fn segment_of(chain: &Chain, points: &[Vector], link: usize) -> i64 {
    let has_its_ends = |&segment: &usize| {
        chain.links()[link].start() == points[segment] && chain.links()[link].end() == points[segment + 1]
    };
    chain.segments_of(link).find(has_its_ends).map_or(-1, |segment| segment as i64)
}

/// Two robots or two batches, or one robot and a batch.
fn pairs<'py>(
    [points_a, radii_a, points_b, radii_b]: [&Bound<'py, PyAny>; 4],
    [pose_a, pose_b]: [Option<&Bound<'py, PyAny>>; 2],
) -> PyResult<Robots<'py>> {
    let others = Robots::new("points_b", points_b, radii_b, pose_b)?;
    Robots::new("points_a", points_a, radii_a, pose_a)?.with_others(points_a.py(), others)
}

/// The tuple of that name. Where no parts could meet the distance is infinite.
fn robot_proximity<'py>(
    py: Python<'py>,
    robots: &Robots<'py>,
    rows: &[Option<Row>],
) -> PyResult<Bound<'py, PyAny>> {
    let points = |of: fn(&RobotProximity) -> Vector| {
        let points = rows.iter().map(|row| row.map_or(Vector::NAN, |row| of(&row.found)));
        array(py, robots.shape(&[3]), flat(points))
    };
    let distances = rows.iter().map(|row| row.map_or(f64::INFINITY, |row| row.found.distance)).collect();
    let segments = rows.iter().flat_map(|row| row.map_or([-1; 2], |row| row.segments)).collect();
    let lengths =
        rows.iter().flat_map(|row| row.map_or([f64::NAN; 2], |row| row.found.arc_lengths)).collect();
    let values = (
        array_or_number(py, robots.shape(&[]), distances)?,
        points(|found| found.on_first)?,
        points(|found| found.on_second)?,
        array(py, robots.shape(&[2]), segments)?,
        array(py, robots.shape(&[2]), lengths)?,
    );
    answer(py, "RobotProximity", values)
}

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
    let mut rows = Vec::with_capacity(robots.len());
    let ask = |session: &mut Session, robot: &Given<'_>, row: &mut [Option<Row>]| {
        let poses = session.place(robot, caps)?;
        let other = robot.other().ok_or_else(no_chain)?;
        let (pair, chains) = session.chains()?;
        let found = pair.minimum(chains[0], &poses[0], chains[1], &poses[1])?;
        row[0] = Some(Row::new(found, chains, [robot.points, other.points]));
        Ok(())
    };
    ask_each(py, &Pairs, &robots, (None, 1), ask, |_, found| rows.extend_from_slice(found))?;
    robot_proximity(py, &robots, &rows)
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
    margin: f64,
    pose_a: Option<&Bound<'py, PyAny>>,
    pose_b: Option<&Bound<'py, PyAny>>,
    caps: Caps,
) -> PyResult<Bound<'py, PyAny>> {
    let robots = pairs([points_a, radii_a, points_b, radii_b], [pose_a, pose_b])?;
    let mut all: Vec<bool> = Vec::with_capacity(robots.len());
    let ask = |session: &mut Session, robot: &Given<'_>, row: &mut [bool]| {
        let poses = session.place(robot, caps)?;
        let (pair, chains) = session.chains()?;
        row[0] = pair.clears(chains[0], &poses[0], chains[1], &poses[1], margin)?;
        Ok(())
    };
    ask_each(py, &Pairs, &robots, (false, 1), ask, |_, found| all.extend(found))?;
    array_or_number(py, robots.shape(&[]), all)
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
    let robots = Robots::new("points", points, radii, None)?;
    let mut rows = Vec::with_capacity(robots.len());
    let ask = |session: &mut Session, robot: &Given<'_>, row: &mut [Option<Row>]| {
        set_chain(&mut session.chains[0], robot, caps)?;
        let (pair, chains) = session.chains()?;
        row[0] =
            pair.self_minimum(chains[0])?.map(|found| Row::new(found, [chains[0]; 2], [robot.points; 2]));
        Ok(())
    };
    ask_each(py, &Pairs, &robots, (None, 1), ask, |_, found| rows.extend_from_slice(found))?;
    robot_proximity(py, &robots, &rows)
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
    margin: f64,
    caps: Caps,
) -> PyResult<Bound<'py, PyAny>> {
    let robots = Robots::new("points", points, radii, None)?;
    let mut all: Vec<bool> = Vec::with_capacity(robots.len());
    let ask = |session: &mut Session, robot: &Given<'_>, row: &mut [bool]| {
        set_chain(&mut session.chains[0], robot, caps)?;
        let (pair, chains) = session.chains()?;
        row[0] = pair.self_clears(chains[0], margin)?;
        Ok(())
    };
    ask_each(py, &Pairs, &robots, (false, 1), ask, |_, found| all.extend(found))?;
    array_or_number(py, robots.shape(&[]), all)
}
