//! The tuples `SceneClearance` and `SceneMotionClearance`.

use super::place::{Place, place_fields};
use super::snapshot::Snapshot;
use crate::output::{answer, array_or_number, statuses};
use crate::threads::Asked;
use parry_continuum::proximity::{SceneClearance, SceneMotionClearance, ScenePlace};
use pyo3::prelude::*;
use pyo3::types::PyTuple;

/// The bounds of one set of robots.
#[derive(Clone, Copy)]
pub(super) struct Bounds {
    lower: f64,
    upper: f64,
    resolved: bool,
    uncertainty: f64,
    t: f64,
    place: Place,
}

impl Bounds {
    /// Nothing has a margin.
    pub(super) const WITHOUT_MARGIN: Self = Self {
        lower: f64::INFINITY,
        upper: f64::INFINITY,
        resolved: true,
        uncertainty: 0.0,
        t: f64::NAN,
        place: Place::NONE,
    };

    const REFUSED: Self =
        Self { lower: f64::NAN, upper: f64::NAN, resolved: false, ..Self::WITHOUT_MARGIN };

    pub(super) fn of_motion(found: SceneMotionClearance) -> Self {
        let SceneMotionClearance { lower, upper, resolved, uncertainty, t, place, .. } = found;
        Self { lower, upper, resolved, uncertainty, t, place: place_of(&place) }
    }

    pub(super) fn of_tubes(found: SceneClearance) -> Self {
        let SceneClearance { lower, upper, resolved, uncertainty, place, .. } = found;
        Self { lower, upper, resolved, uncertainty, t: f64::NAN, place: place_of(&place) }
    }
}

fn place_of(place: &ScenePlace) -> Place {
    match place {
        ScenePlace::Structure { structure, robot, witness, .. } => {
            Place::at_structure(*structure, *robot, witness)
        }
        ScenePlace::Robots { robots, witness, .. } => Place::between_robots(*robots, witness),
        _ => Place::NONE,
    }
}

/// The tuple of one answer, or of a batch; with the times of motions.
pub(super) fn bounds<'py>(
    py: Python<'py>,
    asked: &impl Asked,
    structures: &Snapshot,
    all: &[Result<Bounds, &'static str>],
    is_of_motion: bool,
) -> PyResult<Bound<'py, PyAny>> {
    let rows: Vec<_> = all.iter().map(|it| it.unwrap_or(Bounds::REFUSED)).collect();
    let numbers = |of: fn(&Bounds) -> f64| {
        array_or_number(py, asked.shape(&[]), rows.iter().map(of).collect())
    };
    let resolved = rows.iter().map(|it| it.resolved).collect();
    let places: Vec<_> = rows.iter().map(|it| it.place).collect();
    let mut values = vec![
        numbers(|it| it.lower)?,
        numbers(|it| it.upper)?,
        array_or_number(py, asked.shape(&[]), resolved)?,
        numbers(|it| it.uncertainty)?,
    ];
    if is_of_motion {
        values.push(numbers(|it| it.t)?);
    }
    values.extend(place_fields(py, asked, structures, &places)?);
    values.push(statuses(py, all, asked.count().is_some())?);
    let values = PyTuple::new(py, values)?;
    if is_of_motion {
        answer!(py, "SceneMotionClearance", values)
    } else {
        answer!(py, "SceneClearance", values)
    }
}
