//! The tuples `RobotProximity` and `RobotContacts`.

use crate::input::Robots;
use crate::output::{answer, array, array_or_number, flat};
use crate::threads::Asked;
use parry_continuum::Chain;
use parry_continuum::parry::math::Vector;
use parry_continuum::proximity::RobotProximity;
use pyo3::prelude::*;

/// What there is of one pair of robots, or of one of its links.
#[derive(Clone, Copy)]
pub(super) struct Row {
    pub found: RobotProximity,
    pub segments: [i64; 2],
}

impl Row {
    pub(super) fn new(found: RobotProximity, chains: [&Chain; 2], points: [&[Vector]; 2]) -> Self {
        let segments =
            std::array::from_fn(|k| segment_of(chains[k], points[k], found.links[k] as usize));
        Self { found, segments }
    }
}

/// The input segment that has the ends of a link, among the segments that the link stands for.
pub(crate) fn segment_of(chain: &Chain, points: &[Vector], link: usize) -> i64 {
    let has_its_ends = |&segment: &usize| {
        chain.links()[link].start() == points[segment]
            && chain.links()[link].end() == points[segment + 1]
    };
    chain.segments_of(link).find(has_its_ends).map_or(-1, |segment| segment as i64)
}

/// Where no parts could meet the distance is infinite.
pub(super) fn proximities<'py>(
    py: Python<'py>,
    robots: &Robots<'py>,
    rows: &[Option<Row>],
) -> PyResult<Bound<'py, PyAny>> {
    tuple(py, &robots.shape(&[]), rows, f64::INFINITY)
}

/// A row for each segment of the first robot; of one without length there is no distance.
pub(super) fn proximities_of_segments<'py>(
    py: Python<'py>,
    robots: &Robots<'py>,
    rows: &[Option<Row>],
) -> PyResult<Bound<'py, PyAny>> {
    tuple(py, &robots.shape(&[robots.segments_each()]), rows, f64::NAN)
}

fn tuple<'py>(
    py: Python<'py>,
    shape: &[usize],
    rows: &[Option<Row>],
    without: f64,
) -> PyResult<Bound<'py, PyAny>> {
    let of = |last: usize| shape.iter().copied().chain([last]).collect::<Vec<_>>();
    let points = |of_row: fn(&RobotProximity) -> Vector| {
        let points = rows.iter().map(|row| row.map_or(Vector::NAN, |row| of_row(&row.found)));
        array(py, of(3), flat(points))
    };
    let distances = rows.iter().map(|row| row.map_or(without, |row| row.found.distance)).collect();
    let segments = rows.iter().flat_map(|row| row.map_or([-1; 2], |row| row.segments)).collect();
    let lengths = rows
        .iter()
        .flat_map(|row| row.map_or([f64::NAN; 2], |row| row.found.witness.arc_lengths))
        .collect();
    let values = (
        array_or_number(py, shape.to_vec(), distances)?,
        points(|found| found.witness.on_first)?,
        points(|found| found.witness.on_second)?,
        array(py, of(2), segments)?,
        array(py, of(2), lengths)?,
    );
    answer!(py, "RobotProximity", values)
}

/// Rows of a batch. The rows of pair k are between two offsets.
pub(super) fn proximities_within<'py>(
    py: Python<'py>,
    rows: &[Row],
    offsets: Vec<i64>,
) -> PyResult<Bound<'py, PyAny>> {
    let count = rows.len();
    let points = |of: fn(&RobotProximity) -> Vector| {
        array(py, vec![count, 3], flat(rows.iter().map(|row| of(&row.found))))
    };
    let pair_of = offsets
        .windows(2)
        .zip(0_i64..)
        .flat_map(|(ends, pair)| (ends[0]..ends[1]).map(move |_| pair));
    let values = (
        array(py, vec![count], rows.iter().map(|row| row.found.distance).collect())?,
        points(|found| found.witness.on_first)?,
        points(|found| found.witness.on_second)?,
        array(py, vec![count, 2], rows.iter().flat_map(|row| row.segments).collect())?,
        array(
            py,
            vec![count, 2],
            rows.iter().flat_map(|row| row.found.witness.arc_lengths).collect(),
        )?,
        array(py, vec![count], pair_of.collect())?,
        array(py, vec![offsets.len()], offsets.clone())?,
    );
    answer!(py, "RobotContacts", values)
}
