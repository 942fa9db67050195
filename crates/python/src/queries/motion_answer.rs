//! The tuple `MotionAnswer`.

use crate::output::{
    Enumeration, answer, array, array_or_number, decision_value, flat, members, reason_value,
};
use parry_continuum::parry::math::Vector;
use parry_continuum::proximity::{MotionAnswer, ShapeInContact};
use pyo3::prelude::*;

/// The tuple of one answer, or of as many as `count` says.
pub(super) fn motion_answer<'py>(
    py: Python<'py>,
    count: Option<usize>,
    all: &[MotionAnswer],
) -> PyResult<Bound<'py, PyAny>> {
    let shape = |last: &[usize]| count.iter().chain(last).copied().collect::<Vec<_>>();
    let numbers = |of: fn(&ShapeInContact) -> f64| {
        let numbers = all.iter().map(|it| it.contact.as_ref().map_or(f64::NAN, of));
        array_or_number(py, shape(&[]), numbers.collect())
    };
    let places = |of: fn(&ShapeInContact) -> u32| {
        let places = all.iter().map(|it| it.contact.as_ref().map_or(-1, |it| of(it).into()));
        array_or_number(py, shape(&[]), places.collect::<Vec<i64>>())
    };
    let points = |of: fn(&ShapeInContact) -> Vector| {
        let points = all.iter().map(|it| it.contact.as_ref().map_or(Vector::NAN, of));
        array(py, shape(&[3]), flat(points))
    };
    let decisions = all.iter().map(|it| decision_value(it.decision)).collect();
    let reasons = all.iter().map(|it| reason_value(it.reason)).collect();
    let intervals = all.iter().flat_map(|it| it.interval).collect();
    let values = (
        members(py, Enumeration::Decision, shape(&[]), decisions)?,
        array(py, shape(&[2]), intervals)?,
        numbers(|shape| shape.t)?,
        numbers(|shape| shape.upper)?,
        points(|shape| shape.witness.on_robot)?,
        points(|shape| shape.witness.on_mesh)?,
        places(|shape| shape.witness.segment)?,
        numbers(|shape| shape.witness.arc_length)?,
        places(|shape| shape.witness.triangle)?,
        members(py, Enumeration::UndecidedReason, shape(&[]), reasons)?,
    );
    answer!(py, "MotionAnswer", values)
}
