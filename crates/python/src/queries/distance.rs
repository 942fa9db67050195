//! How near a robot is.

use super::chains::{ChainQuestion, ask_chains};
use crate::input::Caps;
use crate::mesh::Mesh;
use crate::output::{answer, array_or_number, flat};
use crate::threads::Asked;
use parry_continuum::Chain;
use parry_continuum::parry::math::{Pose, Vector};
use parry_continuum::proximity::{BvhSearch, LinkProximity, Proximity, ProximityError};
use pyo3::prelude::*;

/// The closest link and triangle.
struct Minimum;

impl ChainQuestion for Minimum {
    type Row = Option<LinkProximity>;
    type Answer = LinkProximity;

    fn ask(
        &self,
        search: &mut BvhSearch,
        (chain, pose): (&Chain, &Pose),
        _: &mut Vec<LinkProximity>,
        rows: &mut [Self::Row],
    ) -> Result<(), ProximityError> {
        rows[0] = Some(search.minimum(chain, pose)?);
        Ok(())
    }

    fn ask_batch(
        &self,
        search: &mut impl Proximity,
        robots: &[(&Chain, Pose)],
        out: &mut Vec<Result<LinkProximity, ProximityError>>,
    ) -> Result<(), ProximityError> {
        search.minimum_batch(robots, out)
    }

    fn keep(answer: &LinkProximity, rows: &mut [Self::Row]) {
        rows[0] = Some(*answer);
    }
}

#[pymethods]
impl Mesh {
    /// The distance between robots and the mesh's surface.
    ///
    /// It is 0 where they touch or overlap, and exact for the shape that `points`, `radii` and
    /// `caps` describe. It has no sign: a robot that touches nothing may be on either side of the
    /// wall (`side`, `clears_inside`).
    ///
    /// Parameters
    /// ----------
    /// points : (N, 3) or (B, N, 3) array
    ///     The centreline of one robot or of B robots, in the robot's frame. One robot, (N, 3) or
    ///     (1, N, 3), stands for as many as there are poses or rows of radii.
    /// radii : float, (N - 1,) or (B, N - 1) array
    ///     One radius for each segment between two points.
    /// pose : (4, 4) or (B, 4, 4) array, optional
    ///     From the robot's frame to the mesh's: a rotation, a shift in the last column, and
    ///     0 0 0 1. Or scipy's `RigidTransform` or `Rotation`, or a list of them.
    /// caps : {"fitted", "capsules", "cylinders"}
    ///     How links end: flat at the robot's ends and at steps in radius, and round at bends; all
    ///     round; or all flat.
    ///
    /// Returns
    /// -------
    /// float or (B,) array
    ///
    /// Raises
    /// ------
    /// ContinuumError
    ///     Points or radii are no robot, or the pose is not rigid. Of a batch, ``robot`` is the
    ///     first that is refused.
    ///
    /// Examples
    /// --------
    /// >>> import numpy as np
    /// >>> from parry_continuum import Mesh
    /// >>> floor = Mesh([[-9, -9, 0], [9, -9, 0], [0, 9, 0]], [[0, 1, 2]])
    /// >>> robot = np.array([[0, 0, 2], [1, 0, 2], [2, 0, 3]])
    /// >>> floor.distance(robot, 0.5)
    /// 1.5
    /// >>> floor.distance([robot, robot + [0, 0, 1]], 0.5)
    /// array([1.5, 2.5])
    #[pyo3(signature = (points, radii, *, pose = None, caps = Caps::Fitted), text_signature = "($self, points, radii, *, pose=None, caps=\"fitted\")")]
    fn distance<'py>(
        &self,
        py: Python<'py>,
        points: &Bound<'py, PyAny>,
        radii: &Bound<'py, PyAny>,
        pose: Option<&Bound<'py, PyAny>>,
        caps: Caps,
    ) -> PyResult<Bound<'py, PyAny>> {
        let robots = self.robots(points, radii, pose)?;
        let mut distances: Vec<f64> = Vec::with_capacity(robots.len());
        ask_chains(py, &self.engine(py), &robots, (&Minimum, caps), (None, 1), |_, found| {
            distances.extend(found.iter().flatten().map(|found| found.distance))
        })?;
        array_or_number(py, robots.shape(&[]), distances)
    }

    /// The closest link and triangle of each robot, and the two points that are closest.
    ///
    /// Parameters
    /// ----------
    /// points, radii, pose, caps
    ///     As for `distance`.
    ///
    /// Returns
    /// -------
    /// Minimum
    ///     Numbers and points of one robot, or arrays with one for each robot. Of equal distances
    ///     the lowest triangle is named, then the lowest segment.
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
    /// >>> closest = floor.minimum([[0, 0, 4], [0, 0, 2]], 0.5)
    /// >>> closest.distance, closest.segment, closest.triangle
    /// (2.0, 0, 0)
    #[pyo3(signature = (points, radii, *, pose = None, caps = Caps::Fitted), text_signature = "($self, points, radii, *, pose=None, caps=\"fitted\")")]
    fn minimum<'py>(
        &self,
        py: Python<'py>,
        points: &Bound<'py, PyAny>,
        radii: &Bound<'py, PyAny>,
        pose: Option<&Bound<'py, PyAny>>,
        caps: Caps,
    ) -> PyResult<Bound<'py, PyAny>> {
        let robots = self.robots(points, radii, pose)?;
        let mut all: Vec<LinkProximity> = Vec::with_capacity(robots.len());
        ask_chains(py, &self.engine(py), &robots, (&Minimum, caps), (None, 1), |_, found| {
            all.extend(found.iter().flatten())
        })?;
        let shape = || robots.shape(&[]);
        let points = |of: fn(&LinkProximity) -> Vector| {
            crate::output::array(py, robots.shape(&[3]), flat(all.iter().map(of)))
        };
        let values = (
            array_or_number(py, shape(), all.iter().map(|found| found.distance).collect())?,
            points(|found| found.witness.on_robot)?,
            points(|found| found.witness.on_mesh)?,
            array_or_number(
                py,
                shape(),
                all.iter().map(|found| i64::from(found.witness.segment)).collect(),
            )?,
            array_or_number(
                py,
                shape(),
                all.iter().map(|found| found.witness.arc_length).collect(),
            )?,
            array_or_number(
                py,
                shape(),
                all.iter().map(|found| i64::from(found.witness.triangle)).collect(),
            )?,
        );
        answer!(py, "Minimum", values)
    }
}
