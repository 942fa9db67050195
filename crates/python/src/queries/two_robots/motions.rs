//! Decisions about two robots that move at the same time.

use super::RobotPair;
use super::session::Session;
use crate::input::{object_of, of};
use crate::motions::{Motion, MotionPair, Moving};
use crate::output::{
    Enumeration, answer, array, array_or_number, decision_value, flat, members, reason_value,
};
use crate::threads::{Asked, answer_each};
use parry_continuum::parry::math::Vector;
use parry_continuum::proximity::{
    ProximityError, RobotMotionAnswer, RobotMotionClearance, RobotsInContact,
};
use pyo3::prelude::*;

#[pymethods]
impl RobotPair {
    /// Whether two robots that move at the same time keep more than a margin between them.
    ///
    /// ``Decision.CLEAR`` is proven for every time between, from the speeds of the motions. A robot
    /// at rest is a `RigidMotion` from a pose to the same pose.
    ///
    /// Parameters
    /// ----------
    /// a, b : Motion
    ///     A motion of either robot, both in one frame; or batches of as many, or a batch and one.
    /// margin : float
    ///     A length, at least 0.
    /// resolution : float
    ///     A length. The answer is undecided only where the robots come within this of the margin,
    ///     where an end turns from flat to round there, or where 65,536 shapes of each or a million
    ///     pairs of pieces do not decide it.
    ///
    /// Returns
    /// -------
    /// RobotMotionAnswer
    ///     Of two motions, or arrays with one entry for each pair.
    ///
    /// Raises
    /// ------
    /// ContinuumError
    ///     Margin or resolution are negative or NaN, the resolution is finer than rounding, one of
    ///     the shapes is no robot, or batches differ in size.
    ///
    /// Examples
    /// --------
    /// >>> import numpy as np
    /// >>> from parry_continuum import Decision, LinearMotion, RobotPair
    /// >>> left, right = np.array([[0, 0, -40], [-10, 0, 0]]), np.array([[0, 0, -40], [10, 0, 0]])
    /// >>> first = LinearMotion(left, right, 1.0)
    /// >>> second = LinearMotion(right + [0, 3, 0], left + [0, 3, 0], 1.0)
    /// >>> pair = RobotPair()
    /// >>> answer = pair.clears_motions(first, second, margin=0.9, resolution=1e-3)
    /// >>> answer.decision is Decision.CLEAR
    /// True
    /// >>> answer = pair.clears_motions(first, second, margin=1.5, resolution=1e-3)
    /// >>> answer.decision is Decision.CONTACT
    /// True
    #[pyo3(signature = (a, b, *, margin, resolution))]
    fn clears_motions<'py>(
        &self,
        py: Python<'py>,
        #[pyo3(from_py_with = object_of::a)] a: Bound<'py, Motion>,
        #[pyo3(from_py_with = object_of::b)] b: Bound<'py, Motion>,
        #[pyo3(from_py_with = of::margin)] margin: f64,
        #[pyo3(from_py_with = of::resolution)] resolution: f64,
    ) -> PyResult<Bound<'py, PyAny>> {
        let ask = move |session: &mut Session, a: &Moving, b: &Moving| {
            session.pair.clears_motions(a, b, margin, resolution)
        };
        self.decide(py, [&a, &b], ask)
    }

    /// When two robots that move at the same time first come as close to each other as a margin.
    ///
    /// The margin is kept until ``interval[0]``, which is proven, and not kept at ``interval[1]``.
    ///
    /// Parameters
    /// ----------
    /// a, b, margin, resolution
    ///     As for `clears_motions`.
    ///
    /// Returns
    /// -------
    /// RobotMotionAnswer
    ///
    /// Raises
    /// ------
    /// ContinuumError
    ///     As for `clears_motions`.
    ///
    /// Examples
    /// --------
    /// >>> import numpy as np
    /// >>> from parry_continuum import LinearMotion, RobotPair
    /// >>> needle = np.array([[0, 0, -40], [0, 0, 0]])
    /// >>> first = LinearMotion(needle, needle + [10, 0, 0], 1.0)
    /// >>> second = LinearMotion(needle + [22, 0, 0], needle + [12, 0, 0], 1.0)
    /// >>> found = RobotPair().time_of_contact(first, second, margin=5, resolution=1e-3)
    /// >>> bool(found.interval[0] <= 0.75 <= found.interval[1]) # 15 of 20
    /// True
    #[pyo3(signature = (a, b, *, margin, resolution))]
    fn time_of_contact<'py>(
        &self,
        py: Python<'py>,
        #[pyo3(from_py_with = object_of::a)] a: Bound<'py, Motion>,
        #[pyo3(from_py_with = object_of::b)] b: Bound<'py, Motion>,
        #[pyo3(from_py_with = of::margin)] margin: f64,
        #[pyo3(from_py_with = of::resolution)] resolution: f64,
    ) -> PyResult<Bound<'py, PyAny>> {
        let ask = move |session: &mut Session, a: &Moving, b: &Moving| {
            session.pair.time_of_contact(a, b, margin, resolution)
        };
        self.decide(py, [&a, &b], ask)
    }

    /// How near two robots that move at the same time come to each other, between proven bounds,
    /// and when.
    ///
    /// Parameters
    /// ----------
    /// a, b
    ///     As for `clears_motions`.
    /// tolerance : float
    ///     How far apart the bounds may be, at least 0.
    ///
    /// Returns
    /// -------
    /// RobotMotionClearance
    ///     Of two motions, or arrays with one entry for each pair.
    ///
    /// Raises
    /// ------
    /// ContinuumError
    ///     The tolerance is negative or NaN, one of the shapes is no robot, or batches differ in
    ///     size.
    ///
    /// Examples
    /// --------
    /// >>> import numpy as np
    /// >>> from parry_continuum import LinearMotion, RobotPair
    /// >>> left, right = np.array([[0, 0, -40], [-10, 0, 0]]), np.array([[0, 0, -40], [10, 0, 0]])
    /// >>> first = LinearMotion(left, right, 1.0)
    /// >>> second = LinearMotion(right + [0, 3, 0], left + [0, 3, 0], 1.0)
    /// >>> found = RobotPair().clearance_of_motion(first, second, tolerance=1e-3)
    /// >>> bool(found.lower <= 1 <= found.upper + 1e-9)
    /// True
    #[pyo3(signature = (a, b, *, tolerance))]
    fn clearance_of_motion<'py>(
        &self,
        py: Python<'py>,
        #[pyo3(from_py_with = object_of::a)] a: Bound<'py, Motion>,
        #[pyo3(from_py_with = object_of::b)] b: Bound<'py, Motion>,
        #[pyo3(from_py_with = of::tolerance)] tolerance: f64,
    ) -> PyResult<Bound<'py, PyAny>> {
        let motions = self.motions(py, [&a, &b])?;
        let all = answer_each(py, &self.0, &motions, |session: &mut Session, [a, b]| {
            Ok(session.pair.clearance_of_motion(*a, *b, tolerance)?)
        })?;
        let shape = |further: &[usize]| motions.shape(further);
        let numbers = |of: fn(&RobotMotionClearance) -> f64| {
            array_or_number(py, shape(&[]), all.iter().map(of).collect())
        };
        let points = |of: fn(&RobotMotionClearance) -> Vector| {
            array(py, shape(&[3]), flat(all.iter().map(of)))
        };
        let values = (
            numbers(|found| found.lower)?,
            numbers(|found| found.upper)?,
            array_or_number(py, shape(&[]), all.iter().map(|found| found.resolved).collect())?,
            numbers(|found| found.uncertainty)?,
            numbers(|found| found.t)?,
            points(|found| found.witness.on_first)?,
            points(|found| found.witness.on_second)?,
            array(py, shape(&[2]), all.iter().flat_map(|it| it.witness.arc_lengths).collect())?,
        );
        answer!(py, "RobotMotionClearance", values)
    }
}

impl RobotPair {
    /// The motions of a question. Warns once if they state different frames.
    fn motions(&self, py: Python<'_>, [a, b]: [&Bound<'_, Motion>; 2]) -> PyResult<MotionPair> {
        let motions = MotionPair::new(a, b)?;
        let frames = [a, b].map(|motion| motion.get().stated_frame());
        self.1.note_pair(py, ["a", "b"], frames)?;
        Ok(motions)
    }

    fn decide<'py>(
        &self,
        py: Python<'py>,
        [a, b]: [&Bound<'py, Motion>; 2],
        decide: impl Fn(&mut Session, &Moving, &Moving) -> Result<RobotMotionAnswer, ProximityError>
        + Sync,
    ) -> PyResult<Bound<'py, PyAny>> {
        let motions = self.motions(py, [a, b])?;
        let ask = |session: &mut Session, [a, b]: &[&Moving; 2]| Ok(decide(session, a, b)?);
        let all = answer_each(py, &self.0, &motions, ask)?;
        motion_answers(py, &all, |further| motions.shape(further))
    }
}

/// The answers, in the shape of the batch.
pub(super) fn motion_answers<'py>(
    py: Python<'py>,
    all: &[RobotMotionAnswer],
    shape: impl Fn(&[usize]) -> Vec<usize>,
) -> PyResult<Bound<'py, PyAny>> {
    let numbers = |of: fn(&RobotsInContact) -> f64| {
        let numbers = all.iter().map(|it| it.contact.as_ref().map_or(f64::NAN, of));
        array_or_number(py, shape(&[]), numbers.collect())
    };
    let points = |of: fn(&RobotsInContact) -> Vector| {
        let points = all.iter().map(|it| it.contact.as_ref().map_or(Vector::NAN, of));
        array(py, shape(&[3]), flat(points))
    };
    let decisions = all.iter().map(|it| decision_value(it.decision)).collect();
    let reasons = all.iter().map(|it| reason_value(it.reason)).collect();
    let intervals = all.iter().flat_map(|it| it.interval).collect();
    let lengths =
        all.iter().flat_map(|it| it.contact.map_or([f64::NAN; 2], |it| it.witness.arc_lengths));
    let values = (
        members(py, Enumeration::Decision, shape(&[]), decisions)?,
        array(py, shape(&[2]), intervals)?,
        numbers(|shapes| shapes.t)?,
        numbers(|shapes| shapes.upper)?,
        points(|shapes| shapes.witness.on_first)?,
        points(|shapes| shapes.witness.on_second)?,
        array(py, shape(&[2]), lengths.collect())?,
        members(py, Enumeration::UndecidedReason, shape(&[]), reasons)?,
    );
    answer!(py, "RobotMotionAnswer", values)
}
