//! Decisions about two robots that move at the same time.

use super::{RobotPair, Session};
use crate::input::of;
use crate::motions::{Motion, MotionPair, Moving};
use crate::output::{
    Enumeration, answer, array, array_or_number, decision_value, flat, members, reason_value,
};
use crate::threads::{Asked, ask_each};
use parry_continuum::parry::math::Vector;
use parry_continuum::proximity::{RobotMotionAnswer, RobotsInContact};
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
    /// >>> pair.clears_motions(first, second, margin=0.9, resolution=1e-3).decision is Decision.CLEAR
    /// True
    /// >>> pair.clears_motions(first, second, margin=1.5, resolution=1e-3).decision is Decision.CONTACT
    /// True
    #[pyo3(signature = (a, b, *, margin, resolution))]
    fn clears_motions<'py>(
        &self,
        py: Python<'py>,
        a: &Bound<'py, Motion>,
        b: &Bound<'py, Motion>,
        #[pyo3(from_py_with = of::margin)] margin: f64,
        #[pyo3(from_py_with = of::resolution)] resolution: f64,
    ) -> PyResult<Bound<'py, PyAny>> {
        let motions = MotionPair::new(a, b)?;
        let mut all: Vec<RobotMotionAnswer> = Vec::with_capacity(motions.len());
        let ask = |session: &mut Session,
                   [a, b]: &[&Moving; 2],
                   row: &mut [Option<RobotMotionAnswer>]| {
            row[0] = Some(session.pair.clears_motions(*a, *b, margin, resolution)?);
            Ok(())
        };
        ask_each(py, &self.0, &motions, (None, 1), ask, |_, found| {
            all.extend(found.iter().flatten())
        })?;
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
