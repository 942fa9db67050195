//! How near each link of a robot is.

use super::chains::{ChainQuestion, ask_chains};
use crate::input::Caps;
use crate::mesh::Mesh;
use crate::output::{answer, array};
use crate::threads::Asked;
use parry_continuum::Chain;
use parry_continuum::parry::math::{Pose, Vector};
use parry_continuum::proximity::{BvhSearch, LinkProximity, Proximity, ProximityError};
use pyo3::prelude::*;

/// What there is of a segment; of one without length, nothing.
#[derive(Clone, Copy)]
struct Row {
    distance: f64,
    on_robot: Vector,
    on_mesh: Vector,
    arc_length: f64,
    triangle: i64,
}

const NOTHING: Row = Row {
    distance: f64::NAN,
    on_robot: Vector::NAN,
    on_mesh: Vector::NAN,
    arc_length: f64::NAN,
    triangle: -1,
};

/// The closest triangle of every link.
struct PerLink;

impl ChainQuestion for PerLink {
    type Row = Row;
    type Answer = Vec<LinkProximity>;

    fn ask(
        &self,
        search: &mut BvhSearch,
        (chain, pose): (&Chain, &Pose),
        links: &mut Vec<LinkProximity>,
        rows: &mut [Row],
    ) -> Result<(), ProximityError> {
        search.per_link(chain, pose, links)?;
        Self::keep(links, rows);
        Ok(())
    }

    fn ask_batch(
        &self,
        search: &mut impl Proximity,
        robots: &[(&Chain, Pose)],
        out: &mut Vec<Result<Self::Answer, ProximityError>>,
    ) -> Result<(), ProximityError> {
        search.per_link_batch(robots, out)
    }

    fn keep(answer: &Self::Answer, rows: &mut [Row]) {
        for found in answer {
            rows[found.witness.segment as usize] = Row {
                distance: found.distance,
                on_robot: found.witness.on_robot,
                on_mesh: found.witness.on_mesh,
                arc_length: found.witness.arc_length,
                triangle: found.witness.triangle.into(),
            };
        }
    }
}

#[pymethods]
impl Mesh {
    /// The closest triangle of every segment, and the two points that are closest.
    ///
    /// Answers stand where their segment does: row k is about the segment from point k to point
    /// k + 1. A segment without length is no link, and has NaN and the triangle -1.
    ///
    /// Parameters
    /// ----------
    /// points, radii, pose, caps
    ///     As for `distance`.
    ///
    /// Returns
    /// -------
    /// PerLink
    ///     Arrays of the shape (N - 1, ...), or (B, N - 1, ...) of a batch.
    ///
    /// Raises
    /// ------
    /// ContinuumError
    ///     As for `distance`.
    ///
    /// Examples
    /// --------
    /// >>> from parry_continuum import Mesh
    /// >>> floor = Mesh([[-9, -9, 0], [9, -9, 0], [0, 9, 0]], [[0, 1, 2]])
    /// >>> links = floor.per_link([[0, 0, 2], [1, 0, 2], [1, 0, 2], [1, 0, 4]], 0.5)
    /// >>> links.distance
    /// array([1.5, nan, 1.5])
    #[pyo3(signature = (points, radii, *, pose = None, caps = Caps::Fitted), text_signature = "($self, points, radii, *, pose=None, caps=\"fitted\")")]
    fn per_link<'py>(
        &self,
        py: Python<'py>,
        points: &Bound<'py, PyAny>,
        radii: &Bound<'py, PyAny>,
        pose: Option<&Bound<'py, PyAny>>,
        caps: Caps,
    ) -> PyResult<Bound<'py, PyAny>> {
        let robots = self.robots(points, radii, pose)?;
        let segments = robots.segments_each();
        let count = robots.len() * segments;
        let (mut distance, mut arc_length) = (Vec::with_capacity(count), Vec::with_capacity(count));
        let (mut on_robot, mut on_mesh) = (Vec::with_capacity(count), Vec::with_capacity(count));
        let mut triangle = Vec::with_capacity(count);
        let (question, empty) = ((&PerLink, caps), (NOTHING, segments.max(1)));
        ask_chains(py, &self.engine(py), &robots, question, empty, |_, rows| {
            distance.extend(rows.iter().map(|row| row.distance));
            on_robot.extend(rows.iter().map(|row| row.on_robot.to_array()));
            on_mesh.extend(rows.iter().map(|row| row.on_mesh.to_array()));
            arc_length.extend(rows.iter().map(|row| row.arc_length));
            triangle.extend(rows.iter().map(|row| row.triangle));
        })?;
        let shape = || robots.shape(&[segments]);
        let values = (
            array(py, shape(), distance)?,
            array(py, robots.shape(&[segments, 3]), on_robot.into_flattened())?,
            array(py, robots.shape(&[segments, 3]), on_mesh.into_flattened())?,
            array(py, shape(), arc_length)?,
            array(py, shape(), triangle)?,
        );
        answer!(py, "PerLink", values)
    }
}
