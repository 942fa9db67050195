//! What looks like a mistake, though an answer exists: a robot in another frame or unit than the
//! mesh, a radius in another unit, or a mesh without an inside.

use crate::input::{Block, Given, mesh_text, of};
use crate::mesh::Mesh;
use crate::threads::{Asked, alone, compute};
use mesh_files::{
    Bounds, Change, Frame, RadiusDoubt, margin_doubt, misfits, radius_doubt, scales_radius,
    sharp_turns,
};
use parry_continuum::proximity::Proximity;
use pyo3::prelude::*;

/// What to try, in Python. `radii` are scaled too, unless they have the mesh's unit already.
fn words(Change { scale, turns }: Change, scales_radii: bool) -> String {
    let points = match (turns, scale == 1.0) {
        (true, true) => "`points * [-1, -1, 1]`, the other of the frames RAS and LPS".to_owned(),
        (true, false) => format!("`points * [-{scale}, -{scale}, {scale}]`"),
        (false, _) => format!("`points * {scale}`"),
    };
    if scales_radii { format!("{points} and `radii * {scale}`") } else { points }
}

/// One line for each doubt about the points of robots and their largest radius.
fn doubts(
    points: &[[f64; 3]],
    radius: f64,
    mesh: &Bounds,
    frames: Option<[Frame; 2]>,
    may_turn: bool,
) -> Vec<String> {
    let around =
        |change: Change| Bounds::of_points(points.iter().map(|&point| change.apply(point)));
    let misfits = misfits(around, mesh, may_turn);
    let scale = misfits.remedy.map_or(1.0, |remedy| remedy.scale);
    let scales_radii = scale != 1.0 && scales_radius(radius, scale, mesh);
    let scale = if scales_radii { scale } else { 1.0 };
    let radius = radius_doubt(radius * scale, mesh).map(|RadiusDoubt { doubt, factor }| {
        format!("{doubt}: `radii * {}` would be usual", scale * factor)
    });
    let frames = frames.into_iter().map(|frames| mesh_text("points", false, frames));
    let misfits = misfits.with_remedy(|change| words(change, scales_radii));
    frames.chain(misfits).chain(radius).collect()
}

#[pymethods]
impl Mesh {
    /// What looks like a mistake in frame, unit or mesh, though every query has an answer: a line
    /// for each doubt.
    ///
    /// There is a doubt if points and mesh state different frames, if the box of the points is a
    /// hundred times smaller or larger than the mesh's, if the two boxes do not overlap, or if the
    /// largest radius is not between 1/5000 and 1/10 of the diagonal of the mesh's box (0 is not
    /// doubted). Each names what would help, if a change of frame or unit would. A margin is
    /// doubted if it is less than 1/10,000 of that diagonal, and a robot if it turns by more than
    /// 90 degrees at a point. There are also the doubts of `surface`: an open mesh, for example.
    ///
    /// Parameters
    /// ----------
    /// points, radii, pose
    ///     As for `distance`. The robots of a batch are in one box.
    /// margin : float, optional
    ///     As for `clears`.
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
    /// >>> corners = [[0, 0, 0], [90, 0, 0], [0, 90, 0], [0, 0, 90]]
    /// >>> wall = Mesh(corners, [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
    /// >>> wall.doubts([[20, 20, 20], [20, 20, 40]], 2.5)
    /// []
    /// >>> wall.doubts([[0.02, 0.02, 0.02], [0.02, 0.02, 0.04]], 0.0025)
    /// ["the robot's box measures 0.020, the mesh's 155.885; with `points * 1000` and `radii * 1000` they fit"]
    /// >>> floor = Mesh([[-90, -90, 0], [90, -90, 0], [0, 90, 0]], [[0, 1, 2]])
    /// >>> floor.doubts([[0, 0, 2], [40, 0, -2]], 2.5)
    /// ['the mesh is open: one opening 161 wide at (0, -30, 0); a robot may leave there without touching it']
    #[pyo3(signature = (points, radii, *, pose = None, margin = None))]
    fn doubts<'py>(
        &self,
        py: Python<'py>,
        points: &Bound<'py, PyAny>,
        radii: &Bound<'py, PyAny>,
        pose: Option<&Bound<'py, PyAny>>,
        #[pyo3(from_py_with = of::optional::margin)] margin: Option<f64>,
    ) -> PyResult<Vec<String>> {
        let robots =
            crate::input::Robots::new(crate::input::Names::one("points"), points, radii, pose)?;
        let mut block = Block::default();
        robots.copy(0..robots.len(), &mut block).map_err(|refused| refused.raise(py, None))?;
        let (mut all, mut radius, mut turns) = (Vec::new(), 0.0_f64, None);
        for place in 0..robots.len() {
            let robot: Given<'_> = block.robot(place);
            let placed = robot.pose();
            let pose = placed.map_err(|error| error.raise(py, robots.count.map(|_| place)))?;
            let radii = robot.radii.iter().copied().filter(|radius| radius.is_finite());
            radius = radii.fold(radius, f64::max);
            let first = all.len();
            all.extend(robot.points.iter().map(|&point| (pose * point).to_array()));
            turns = turns.or_else(|| {
                let found = sharp_turns(&all[first..])?;
                Some(robots.count.map_or(found.clone(), |_| format!("robot {place}: {found}")))
            });
        }
        let frames = if pose.is_none() { self.frames(points)? } else { None };
        let (mesh, surface) = alone(py, &self.engine(py), |session| {
            let vertices = session.search.vertices().iter();
            let bounds = Bounds::of_points(vertices.map(|vertex| vertex.to_array()));
            (bounds, session.search.surface().doubts())
        })?;
        let may_turn = pose.is_none();
        let doubts = compute(py, || {
            let Some(mesh) = mesh else { return Vec::new() };
            let mut doubts = doubts(&all, radius, &mesh, frames, may_turn);
            doubts.extend(margin.and_then(|margin| margin_doubt(margin, &mesh)));
            doubts.extend(turns);
            doubts
        })?;
        Ok([doubts, surface].concat())
    }
}
