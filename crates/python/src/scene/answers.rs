//! The tuples of a scene's answers.

use super::robots::Placed;
use super::snapshot::Snapshot;
use crate::input::Robots;
use crate::output::{answer, array, array_or_number, flat};
use crate::queries::two_robots::segment_of;
use crate::threads::Asked;
use parry_continuum::parry::math::Vector;
use parry_continuum::proximity::{Between, Contact, SceneContact, StructureProximity, Tightest};
use pyo3::prelude::*;
use pyo3::types::PyTuple;

/// What there is of the tightest place.
#[derive(Clone, Copy)]
pub(super) struct Row {
    slack: f64,
    distance: f64,
    structure: i64,
    robots: [i64; 2],
    segments: [i64; 2],
    triangle: i64,
    on_first: Vector,
    on_second: Vector,
}

pub(super) const NOTHING: Row = Row {
    slack: f64::INFINITY,
    distance: f64::INFINITY,
    structure: -1,
    robots: [-1; 2],
    segments: [-1; 2],
    triangle: -1,
    on_first: Vector::NAN,
    on_second: Vector::NAN,
};

impl Row {
    pub(super) fn new(found: &Tightest, placed: &[Placed<'_>]) -> Self {
        let slack = found.slack;
        match &found.between {
            Between::Structure(it) => Self {
                slack,
                distance: it.nearest.distance,
                structure: it.structure.into(),
                robots: [it.robot.into(), -1],
                segments: [it.nearest.witness.segment.into(), -1],
                triangle: it.nearest.witness.triangle.into(),
                on_first: it.nearest.witness.on_robot,
                on_second: it.nearest.witness.on_mesh,
            },
            Between::Robots { robots, nearest } => Self {
                slack,
                distance: nearest.distance,
                robots: robots.map(i64::from),
                segments: std::array::from_fn(|k| {
                    let (chain, _, points) = placed[robots[k] as usize];
                    segment_of(chain, points, nearest.links[k] as usize)
                }),
                on_first: nearest.witness.on_first,
                on_second: nearest.witness.on_second,
                ..NOTHING
            },
            _ => Self { slack, ..NOTHING },
        }
    }
}

pub(super) fn tightest<'py>(
    py: Python<'py>,
    robots: &Robots<'py>,
    structures: &Snapshot,
    all: &[Row],
) -> PyResult<Bound<'py, PyAny>> {
    let shape = || robots.shape(&[]);
    let values = (
        array_or_number(py, shape(), all.iter().map(|row| row.slack).collect())?,
        array_or_number(py, shape(), all.iter().map(|row| row.distance).collect())?,
        array_or_number(py, shape(), all.iter().map(|row| row.structure).collect())?,
        structures.names(py, &shape(), all.iter().map(|row| row.structure))?,
        array(py, robots.shape(&[2]), all.iter().flat_map(|row| row.robots).collect())?,
        array(py, robots.shape(&[2]), all.iter().flat_map(|row| row.segments).collect())?,
        array_or_number(py, shape(), all.iter().map(|row| row.triangle).collect())?,
        array(py, robots.shape(&[3]), flat(all.iter().map(|row| row.on_first)))?,
        array(py, robots.shape(&[3]), flat(all.iter().map(|row| row.on_second)))?,
    );
    answer!(py, "Tightest", values)
}

/// Of `shape` many structures, and before that of a batch.
pub(super) fn per_structure<'py>(
    py: Python<'py>,
    shape: &[usize],
    structures: &Snapshot,
    all: &[StructureProximity],
) -> PyResult<Bound<'py, PyAny>> {
    let numbers = |of: fn(&StructureProximity) -> f64| {
        array(py, shape.to_vec(), all.iter().map(of).collect())
    };
    let places = |of: fn(&StructureProximity) -> u32| {
        array(py, shape.to_vec(), all.iter().map(|it| of(it).into()).collect::<Vec<i64>>())
    };
    let points = |of: fn(&StructureProximity) -> Vector| {
        array(py, shape.iter().copied().chain([3]).collect(), flat(all.iter().map(of)))
    };
    let values = (
        numbers(|it| it.nearest.distance)?,
        numbers(|it| it.slack.unwrap_or(f64::NAN))?,
        points(|it| it.nearest.witness.on_robot)?,
        points(|it| it.nearest.witness.on_mesh)?,
        places(|it| it.robot)?,
        places(|it| it.nearest.witness.segment)?,
        numbers(|it| it.nearest.witness.arc_length)?,
        places(|it| it.nearest.witness.triangle)?,
        structures.names(py, shape, all.iter().map(|it| it.structure.into()))?,
    );
    answer!(py, "PerStructure", values)
}

/// The rows of set k of a batch are between two offsets.
pub(super) fn contacts<'py>(
    py: Python<'py>,
    structures: &Snapshot,
    all: &[SceneContact],
    offsets: Vec<i64>,
) -> PyResult<Bound<'py, PyAny>> {
    let count = || vec![all.len()];
    let numbers = |of: fn(&Contact) -> f64| {
        array(py, count(), all.iter().map(|it| of(&it.contact)).collect())
    };
    let places = |of: fn(&SceneContact) -> u32| {
        array(py, count(), all.iter().map(|it| of(it).into()).collect::<Vec<i64>>())
    };
    let points = |of: fn(&Contact) -> Vector| {
        array(py, vec![all.len(), 3], flat(all.iter().map(|it| of(&it.contact))))
    };
    let set_of = offsets
        .windows(2)
        .zip(0_i64..)
        .flat_map(|(ends, set)| (ends[0]..ends[1]).map(move |_| set));
    let values = [
        places(|it| it.structure)?.into_any(),
        structures.names(py, &count(), all.iter().map(|it| it.structure.into()))?,
        places(|it| it.robot)?.into_any(),
        places(|it| it.contact.witness.segment)?.into_any(),
        numbers(|contact| contact.fraction)?.into_any(),
        numbers(|contact| contact.witness.arc_length)?.into_any(),
        numbers(|contact| contact.distance)?.into_any(),
        numbers(|contact| contact.depth)?.into_any(),
        points(|contact| contact.normal.unwrap_or(Vector::NAN))?.into_any(),
        points(|contact| contact.witness.on_robot)?.into_any(),
        points(|contact| contact.witness.on_mesh)?.into_any(),
        places(|it| it.contact.witness.triangle)?.into_any(),
        array(py, count(), set_of.collect())?.into_any(),
        array(py, vec![offsets.len()], offsets.clone())?.into_any(),
    ];
    answer!(py, "SceneContacts", PyTuple::new(py, values)?)
}
