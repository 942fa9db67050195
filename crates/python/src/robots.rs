//! Fewer links for the same robot, and the surfaces of links.

use crate::error::Refused;
use crate::input::{Block, Caps, Names, Robots, of, stated_frame};
use crate::output::{array, flat, framed};
use crate::queries::chains::set_chain;
use crate::queries::two_robots::segment_of;
use crate::threads::{Asked, compute};
use mesh_files::Frame;
use numpy::PyArrayDyn;
use pyo3::prelude::*;

type Arrays<'py> = (Bound<'py, PyAny>, Bound<'py, PyArrayDyn<f64>>);
type Surfaces<'py> =
    (Bound<'py, PyArrayDyn<f64>>, Bound<'py, PyArrayDyn<i64>>, Bound<'py, PyArrayDyn<i64>>);

/// Few points that stay within a tolerance of a centreline.
///
/// They are a subset of the given points, keep both ends and every change of radius, and their
/// lines and the given ones lie within the tolerance of each other. Flat faces, at both ends and on
/// the wider side of each step, move by at most the tolerance too. The time is proportional to the
/// number of points.
///
/// Parameters
/// ----------
/// points : (N, 3) array
/// radii : float or (N - 1,) array
/// tolerance : float
///     A length, at least 0.
///
/// Returns
/// -------
/// (points, radii)
///     Arrays of the shapes (M, 3) and (M - 1,). The points have the frame of the given ones.
///
/// Raises
/// ------
/// ContinuumError
///     The tolerance is negative or NaN, or the points are no robot.
///
/// Examples
/// --------
/// >>> import numpy as np
/// >>> from parry_continuum import simplify
/// >>> points, radii = simplify([[0, 0, 0], [0, 0, 1], [0, 0, 2], [1, 0, 2]], 0.1, tolerance=0.01)
/// >>> len(points)
/// 3
#[pyfunction]
#[pyo3(signature = (points, radii, *, tolerance))]
pub(crate) fn simplify<'py>(
    py: Python<'py>,
    points: &Bound<'py, PyAny>,
    radii: &Bound<'py, PyAny>,
    #[pyo3(from_py_with = of::tolerance)] tolerance: f64,
) -> PyResult<Arrays<'py>> {
    let robots = Robots::new(Names::one("points"), points, radii, None)?;
    if robots.count.is_some() {
        let text = "`points` is a batch; give one robot, of the shape (N, 3)";
        return Err(Refused::other("bad_shape", text).raise(py, None));
    }
    let mut block = Block::default();
    robots.copy(0..1, &mut block).map_err(|refused| refused.raise(py, None))?;
    let robot = block.robot(0);
    let found = compute(py, || parry_continuum::simplify(robot.points, robot.radii, tolerance))?;
    let (fewer, radii) = found.map_err(|error| Refused::from(error).raise(py, None))?;
    let fewer = array(py, vec![fewer.len(), 3], flat(fewer))?;
    let frame = stated_frame(points)?.map(Frame::name);
    Ok((framed(fewer, frame)?, array(py, vec![radii.len()], radii)?))
}

/// The surfaces of a robot's links, each with 24 sides, in the mesh's frame.
///
/// Parameters
/// ----------
/// points, radii, pose, caps
///     As for `Mesh.per_link`, of one robot.
///
/// Returns
/// -------
/// (vertices, triangles, segments)
///     Arrays of the shapes (V, 3), (T, 3) and (T,): triangles face outwards, and each has the
///     segment of the input that its link is.
///
/// Raises
/// ------
/// ContinuumError
///     More than one robot is given, or as for `Mesh.per_link`.
#[pyfunction]
#[pyo3(signature = (points, radii, *, pose = None, caps = Caps::Fitted), text_signature = "(points, radii, *, pose=None, caps=\"fitted\")")]
pub(crate) fn link_surfaces<'py>(
    py: Python<'py>,
    points: &Bound<'py, PyAny>,
    radii: &Bound<'py, PyAny>,
    pose: Option<&Bound<'py, PyAny>>,
    caps: Caps,
) -> PyResult<Surfaces<'py>> {
    const SIDES: u32 = 24;
    let robots = Robots::new(Names::one("points"), points, radii, pose)?;
    if let Some(count) = robots.count {
        let text =
            format!("a surface is of one robot, and {count} are given; give them one by one");
        return Err(Refused::other("bad_shape", text).raise(py, None));
    }
    let mut block = Block::default();
    let mut made = || {
        robots.copy(0..1, &mut block)?;
        let robot = block.robot(0);
        let (mut vertices, mut triangles, mut segments) = (Vec::new(), Vec::new(), Vec::new());
        let (mut chain, pose) = (None, robot.pose()?);
        let chain = set_chain(&mut chain, &robot, caps)?;
        for (number, link) in chain.links().iter().enumerate() {
            let (around, faces) = link.transformed(&pose).to_trimesh(SIDES);
            let first = vertices.len() as i64;
            let segment = segment_of(chain, robot.points, number);
            segments.extend(faces.iter().map(|_| segment));
            triangles.extend(faces.iter().flatten().map(|&corner| first + i64::from(corner)));
            vertices.extend(around);
        }
        Ok((vertices, triangles, segments))
    };
    let (vertices, triangles, segments) =
        made().map_err(|refused: Refused| refused.raise(py, None))?;
    Ok((
        array(py, vec![vertices.len(), 3], flat(vertices))?,
        array(py, vec![segments.len(), 3], triangles)?,
        array(py, vec![segments.len()], segments)?,
    ))
}
