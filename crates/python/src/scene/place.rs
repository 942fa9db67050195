//! Where in a scene an answer is.

use super::snapshot::Snapshot;
use crate::output::{array, array_or_number, flat};
use crate::threads::Asked;
use parry_continuum::parry::math::Vector;
use parry_continuum::proximity::{PairWitness, Witness};
use pyo3::prelude::*;

/// A place between a robot and a structure, or between two robots. Missing numbers are -1,
/// missing lengths NaN.
#[derive(Clone, Copy)]
pub(super) struct Place {
    structure: i64,
    robots: [i64; 2],
    points: [Vector; 2],
    arc_lengths: [f64; 2],
    triangle: i64,
}

impl Place {
    pub(super) const NONE: Self = Self {
        structure: -1,
        robots: [-1; 2],
        points: [Vector::NAN; 2],
        arc_lengths: [f64::NAN; 2],
        triangle: -1,
    };

    pub(super) fn at_structure(structure: u32, robot: u32, witness: &Witness) -> Self {
        Self {
            structure: structure.into(),
            robots: [robot.into(), -1],
            points: [witness.on_robot, witness.on_mesh],
            arc_lengths: [witness.arc_length, f64::NAN],
            triangle: witness.triangle.into(),
        }
    }

    pub(super) fn between_robots(robots: [u32; 2], witness: &PairWitness) -> Self {
        Self {
            robots: robots.map(i64::from),
            points: [witness.on_first, witness.on_second],
            arc_lengths: witness.arc_lengths,
            ..Self::NONE
        }
    }
}

/// The fields `structure`, `name`, `robots`, `on_first`, `on_second`, `arc_lengths` and `triangle`.
pub(super) fn place_fields<'py>(
    py: Python<'py>,
    asked: &impl Asked,
    structures: &Snapshot,
    places: &[Place],
) -> PyResult<[Bound<'py, PyAny>; 7]> {
    let numbers = |of: fn(&Place) -> i64| {
        array_or_number(py, asked.shape(&[]), places.iter().map(of).collect::<Vec<_>>())
    };
    let points = |k: usize| {
        Ok::<_, PyErr>(
            array(py, asked.shape(&[3]), flat(places.iter().map(|it| it.points[k])))?.into_any(),
        )
    };
    let robots = places.iter().flat_map(|it| it.robots).collect();
    let lengths = places.iter().flat_map(|it| it.arc_lengths).collect();
    Ok([
        numbers(|it| it.structure)?,
        structures.names(py, &asked.shape(&[]), places.iter().map(|it| it.structure))?,
        array(py, asked.shape(&[2]), robots)?.into_any(),
        points(0)?,
        points(1)?,
        array(py, asked.shape(&[2]), lengths)?.into_any(),
        numbers(|it| it.triangle)?,
    ])
}
