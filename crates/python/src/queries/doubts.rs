//! What looks like a mistake, though an answer exists: a robot in another frame or unit than the
//! mesh, or a radius in another unit.

use crate::input::{Block, Given, mesh_text};
use crate::mesh::Mesh;
use crate::threads::{Asked, alone, compute};
use mesh_files::{Bounds, Change, Frame, RadiusDoubt, misfits, radius_doubt};
use parry_continuum::proximity::Proximity;
use pyo3::prelude::*;

/// What to try, in Python.
fn words(Change { scale, turns }: Change) -> String {
    let points = match (turns, scale == 1.0) {
        (true, true) => "`points * [-1, -1, 1]`, the other of the frames RAS and LPS".to_owned(),
        (true, false) => format!("`points * [-{scale}, -{scale}, {scale}]`"),
        (false, _) => format!("`points * {scale}`"),
    };
    if scale == 1.0 { points } else { format!("{points} and `radii * {scale}`") }
}

/// One line for each doubt about balls around the points of robots.
fn doubts(
    robot: &[([f64; 3], f64)],
    mesh: &Bounds,
    frames: Option<[Frame; 2]>,
    may_turn: bool,
) -> Vec<String> {
    let around = |change: Change| {
        let changed =
            |&(point, radius): &([f64; 3], f64)| (change.apply(point), radius * change.scale);
        Bounds::of_balls(robot.iter().map(changed))
    };
    let misfits = misfits(around, mesh, may_turn);
    let scale = misfits.remedy.map_or(1.0, |remedy| remedy.scale);
    let radii = robot.iter().map(|&(_, radius)| radius).filter(|radius| radius.is_finite());
    let radius = radius_doubt(radii.fold(0.0, f64::max) * scale, mesh).map(
        |RadiusDoubt { doubt, factor }| {
            format!("{doubt}: `radii * {}` would be usual", scale * factor)
        },
    );
    let frames = frames.into_iter().map(|frames| mesh_text("points", false, frames));
    frames.chain(misfits.with_remedy(words)).chain(radius).collect()
}

#[pymethods]
impl Mesh {
    /// What looks like a mistake in frame or unit, though every query has an answer: a line for
    /// each doubt.
    ///
    /// There is a doubt if points and mesh state different frames, if the box of the robots is a
    /// hundred times smaller or larger than the mesh's, if the two boxes do not overlap, or if the
    /// largest radius is not between 1/5000 and 1/10 of the diagonal of the mesh's box (0 is not
    /// doubted). Each names what would help, if a change of frame or unit would.
    ///
    /// Parameters
    /// ----------
    /// points, radii, pose
    ///     As for `distance`. The robots of a batch are in one box.
    ///
    /// Returns
    /// -------
    /// list of str
    ///     Empty if there is no doubt.
    ///
    /// Raises
    /// ------
    /// ContinuumError
    ///     Points, radii or pose have another shape or type, or a pose is not rigid.
    ///
    /// Examples
    /// --------
    /// >>> from parry_continuum import Mesh
    /// >>> floor = Mesh([[-90, -90, 0], [90, -90, 0], [0, 90, 0]], [[0, 1, 2]])
    /// >>> floor.doubts([[0, 0, 2], [40, 0, 2]], 2.5)
    /// []
    /// >>> floor.doubts([[0, 0, 0.002], [0.04, 0, 0.002]], 0.0025)
    /// ["the robot's box measures 0.046, the mesh's 254.558; with `points * 1000` and `radii * 1000` they fit"]
    #[pyo3(signature = (points, radii, *, pose = None))]
    fn doubts<'py>(
        &self,
        py: Python<'py>,
        points: &Bound<'py, PyAny>,
        radii: &Bound<'py, PyAny>,
        pose: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Vec<String>> {
        let robots =
            crate::input::Robots::new(crate::input::Names::one("points"), points, radii, pose)?;
        let mut block = Block::default();
        robots.copy(0..robots.len(), &mut block).map_err(|refused| refused.raise(py, None))?;
        let mut balls = Vec::new();
        for place in 0..robots.len() {
            let robot: Given<'_> = block.robot(place);
            let placed = robot.pose();
            let pose = placed.map_err(|error| error.raise(py, robots.count.map(|_| place)))?;
            let radius = robot.radii.iter().copied().fold(0.0, f64::max);
            balls.extend(robot.points.iter().map(|&point| ((pose * point).to_array(), radius)));
        }
        let frames = if pose.is_none() { self.frames(points)? } else { None };
        let mesh = alone(py, &self.engine(py), |session| {
            let vertices = session.search.vertices().iter();
            Bounds::of_balls(vertices.map(|vertex| (vertex.to_array(), 0.0)))
        })?;
        let Some(mesh) = mesh else { return Ok(Vec::new()) };
        let may_turn = pose.is_none();
        compute(py, || doubts(&balls, &mesh, frames, may_turn))
    }
}
