//! What looks like a mistake, though an answer exists: a robot in another frame or unit than the
//! mesh.

use crate::input::{Block, Given};
use crate::mesh::{Mesh, frames_text};
use crate::threads::{Asked, alone, compute};
use mesh_files::Frame;
use parry_continuum::parry::math::Vector;
use parry_continuum::proximity::Proximity;
use pyo3::prelude::*;

/// A robot is hardly ever larger or smaller than the mesh by more than this factor.
const FAR_FROM_ALIKE: f64 = 100.0;

/// A box around points.
#[derive(Clone, Copy)]
struct Extent {
    low: Vector,
    high: Vector,
}

impl Extent {
    /// The box around balls, or `None` if there are none with finite numbers.
    fn of(balls: impl IntoIterator<Item = (Vector, f64)>) -> Option<Self> {
        let balls = balls.into_iter().filter(|(centre, radius)| (*centre * *radius).is_finite());
        let boxes = balls.map(|(centre, radius)| Self {
            low: centre - Vector::splat(radius),
            high: centre + Vector::splat(radius),
        });
        boxes.reduce(|a, b| Self { low: a.low.min(b.low), high: a.high.max(b.high) })
    }

    fn size(&self) -> f64 {
        (self.high - self.low).length()
    }

    /// How far the boxes are apart along the axis where they are farthest apart; negative if they
    /// overlap.
    fn gap(&self, other: &Self) -> f64 {
        (self.low - other.high).max(other.low - self.high).max_element()
    }

    fn is_alike(&self, other: &Self) -> bool {
        (1.0 / FAR_FROM_ALIKE..=FAR_FROM_ALIKE).contains(&(self.size() / other.size()))
    }
}

/// What would bring the robot to the mesh.
struct Remedy {
    scale: f64,
    turns: bool,
}

impl Remedy {
    fn text(&self) -> String {
        let Self { scale, turns } = self;
        let points = match (turns, *scale == 1.0) {
            (true, true) => {
                "`points * [-1, -1, 1]`, the other of the frames RAS and LPS".to_owned()
            }
            (true, false) => format!("`points * [-{scale}, -{scale}, {scale}]`"),
            (false, _) => format!("`points * {scale}`"),
        };
        if *scale == 1.0 { points } else { format!("{points} and `radii * {scale}`") }
    }

    fn apply(&self, point: Vector) -> Vector {
        let sign = if self.turns { -1.0 } else { 1.0 };
        point * self.scale * Vector::new(sign, sign, 1.0)
    }
}

/// One line for each doubt about balls around the points of robots.
fn doubts(
    robot: &[(Vector, f64)],
    mesh: &Extent,
    frames: Option<[Frame; 2]>,
    may_turn: bool,
) -> Vec<String> {
    let mut doubts: Vec<_> =
        frames.into_iter().map(|frames| frames_text("points", frames)).collect();
    let Some(around) = Extent::of(robot.iter().copied()) else { return doubts };
    let mut misfits = Vec::new();
    if !around.is_alike(mesh) {
        let (robot, mesh) = (around.size(), mesh.size());
        misfits.push(format!("the robot's box measures {robot:.3}, the mesh's {mesh:.3}"));
    }
    let gap = around.gap(mesh);
    if gap > 0.0 {
        misfits.push(format!(
            "the robot's box and the mesh's do not overlap; they are {gap:.3} apart"
        ));
    }
    let scales = [1000.0, 1e-3, 10.0, 0.1];
    let turned = [(1.0, true)].into_iter().chain(scales.map(|scale| (scale, true)));
    let turned = turned.filter(|_| may_turn);
    let all =
        turned.clone().take(1).chain(scales.map(|scale| (scale, false))).chain(turned.skip(1));
    let helps = |remedy: &Remedy| {
        let mended =
            |&(point, radius): &(Vector, f64)| (remedy.apply(point), radius * remedy.scale);
        Extent::of(robot.iter().map(mended))
            .is_some_and(|mended| mended.gap(mesh) <= 0.0 && mended.is_alike(mesh))
    };
    if let Some(last) = misfits.last_mut()
        && let Some(remedy) = all.map(|(scale, turns)| Remedy { scale, turns }).find(helps)
    {
        last.push_str(&format!("; with {} they fit", remedy.text()));
    }
    doubts.append(&mut misfits);
    doubts
}

#[pymethods]
impl Mesh {
    /// What looks like a mistake in frame or unit, though every query has an answer: a line for
    /// each doubt.
    ///
    /// There is a doubt if points and mesh state different frames, if the box of the robots is a
    /// hundred times smaller or larger than the mesh's, or if the two boxes do not overlap. Each
    /// names what would help, if a change of frame or unit would.
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
            balls.extend(robot.points.iter().map(|&point| (pose * point, radius)));
        }
        let frames = if pose.is_none() { self.frames(points)? } else { None };
        let mesh = alone(py, &self.engine(py), |session| {
            Extent::of(session.search.vertices().iter().map(|&vertex| (vertex, 0.0)))
        })?;
        let Some(mesh) = mesh else { return Ok(Vec::new()) };
        let may_turn = pose.is_none();
        compute(py, || doubts(&balls, &mesh, frames, may_turn))
    }
}
