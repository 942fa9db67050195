//! The tuples `SceneClearance` and `SceneMotionClearance`.

use crate::output::{answer, array, array_or_number, flat, statuses};
use parry_continuum::parry::math::Vector;
use parry_continuum::proximity::{SceneClearance, SceneMotionClearance, ScenePlace};
use pyo3::prelude::*;

/// The bounds of one set of robots.
#[derive(Clone, Copy)]
pub(super) struct Bounds {
    lower: f64,
    upper: f64,
    resolved: bool,
    uncertainty: f64,
    pub t: f64,
    structure: i64,
    robots: [i64; 2],
    points: [Vector; 2],
    arc_lengths: [f64; 2],
    triangle: i64,
    status: &'static str,
}

impl Bounds {
    /// Nothing has a margin.
    pub(super) const WITHOUT_MARGIN: Self = Self {
        lower: f64::INFINITY,
        upper: f64::INFINITY,
        resolved: true,
        uncertainty: 0.0,
        t: f64::NAN,
        structure: -1,
        robots: [-1; 2],
        points: [Vector::NAN; 2],
        arc_lengths: [f64::NAN; 2],
        triangle: -1,
        status: "",
    };

    pub(super) fn refused(status: &'static str) -> Self {
        let (lower, upper) = (f64::NAN, f64::NAN);
        Self { lower, upper, resolved: false, status, ..Self::WITHOUT_MARGIN }
    }

    pub(super) fn of_motion(found: SceneMotionClearance) -> Self {
        let SceneMotionClearance { lower, upper, resolved, uncertainty, t, place, .. } = found;
        Self { lower, upper, resolved, uncertainty, t, ..Self::at(&place) }
    }

    pub(super) fn of_tubes(found: SceneClearance) -> Self {
        let SceneClearance { lower, upper, resolved, uncertainty, place, .. } = found;
        Self { lower, upper, resolved, uncertainty, ..Self::at(&place) }
    }

    fn at(place: &ScenePlace) -> Self {
        match place {
            ScenePlace::Structure { structure, robot, witness, .. } => Self {
                structure: (*structure).into(),
                robots: [(*robot).into(), -1],
                points: [witness.on_robot, witness.on_mesh],
                arc_lengths: [witness.arc_length, f64::NAN],
                triangle: witness.triangle.into(),
                ..Self::WITHOUT_MARGIN
            },
            ScenePlace::Robots { robots, witness, .. } => Self {
                robots: robots.map(i64::from),
                points: [witness.on_first, witness.on_second],
                arc_lengths: witness.arc_lengths,
                ..Self::WITHOUT_MARGIN
            },
            _ => Self::WITHOUT_MARGIN,
        }
    }
}

/// The tuple of one answer, or of a batch; with the times of motions.
pub(super) fn bounds<'py>(
    py: Python<'py>,
    all: &[Bounds],
    shape: impl Fn(&[usize]) -> Vec<usize>,
    is_batch: bool,
    times: Option<Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyAny>> {
    let numbers = |of: fn(&Bounds) -> f64| {
        array_or_number(py, shape(&[]), all.iter().map(of).collect::<Vec<f64>>())
    };
    let points = |k: usize| array(py, shape(&[3]), flat(all.iter().map(|it| it.points[k])));
    let lower = numbers(|it| it.lower)?;
    let upper = numbers(|it| it.upper)?;
    let resolved = array_or_number(py, shape(&[]), all.iter().map(|it| it.resolved).collect())?;
    let uncertainty = numbers(|it| it.uncertainty)?;
    let places = |of: fn(&Bounds) -> i64| {
        array_or_number(py, shape(&[]), all.iter().map(of).collect::<Vec<i64>>())
    };
    let structure = places(|it| it.structure)?;
    let robots = array(py, shape(&[2]), all.iter().flat_map(|it| it.robots).collect())?;
    let (on_first, on_second) = (points(0)?, points(1)?);
    let lengths = array(py, shape(&[2]), all.iter().flat_map(|it| it.arc_lengths).collect())?;
    let triangle = places(|it| it.triangle)?;
    let status = statuses(py, all.iter().map(|it| it.status).collect(), is_batch)?;
    match times {
        Some(t) => {
            let values = (
                lower,
                upper,
                resolved,
                uncertainty,
                t,
                structure,
                robots,
                on_first,
                on_second,
                lengths,
                triangle,
                status,
            );
            answer!(py, "SceneMotionClearance", values)
        }
        None => {
            let values = (
                lower,
                upper,
                resolved,
                uncertainty,
                structure,
                robots,
                on_first,
                on_second,
                lengths,
                triangle,
                status,
            );
            answer!(py, "SceneClearance", values)
        }
    }
}
