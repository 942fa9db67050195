//! Inside or outside, and what a mesh is as a surface.

use super::chains::set_chain;
use super::two_robots::segment_of;
use crate::error::Refused;
use crate::input::{Caps, Given, Numbers, shape_text, vectors};
use crate::mesh::Mesh;
use crate::output::{Enumeration, answer, members, rows, side_value};
use crate::threads::{Asked, Session, alone, ask_each, ask_points};
use parry_continuum::proximity::Side;
use pyo3::prelude::*;
use pyo3::types::PyTuple;

#[pymethods]
impl Mesh {
    /// On which side of the mesh points are, proven.
    ///
    /// Triangles may face outward or inward, as long as all do the same: the first question about
    /// sides warns if they do not. Near holes of an open
    /// mesh, and on triangles, the answer is ``Side.UNDECIDED``.
    ///
    /// Parameters
    /// ----------
    /// points : (..., 3) array
    ///     Points in the mesh's frame.
    ///
    /// Returns
    /// -------
    /// Side or Sides
    ///     The side of one point, or an array of `Side` of the shape of `points` without its last
    ///     axis. Neither has a truth value: ask for ``is_inside`` or ``is_outside``.
    ///
    /// Raises
    /// ------
    /// ContinuumError
    ///     `points` has another shape or type. A point that is not finite is undecided.
    ///
    /// Examples
    /// --------
    /// >>> from parry_continuum import Mesh
    /// >>> corners = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]
    /// >>> tetrahedron = Mesh(corners, [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
    /// >>> tetrahedron.side([0.1, 0.1, 0.1]).is_inside
    /// True
    /// >>> tetrahedron.side([[0.1, 0.1, 0.1], [2, 2, 2], [0, 0, 0]])
    /// Sides([INSIDE, OUTSIDE, UNDECIDED])
    fn side<'py>(
        &self,
        py: Python<'py>,
        points: &Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let numbers = Numbers::new(points, "points")?;
        self.note_frame("points", points)?;
        self.note_sides(py)?;
        let Some((3, shape)) =
            numbers.shape().split_last().map(|(last, rest)| (*last, rest.to_vec()))
        else {
            let text = format!(
                "`points` has the shape {}, not (..., 3); give a row of three coordinates for each point",
                shape_text(numbers.shape())
            );
            return Err(Refused::other("bad_shape", text).raise(py, None));
        };
        let points = vectors(numbers.points());
        let sides = ask_points(py, &self.engine(py), &points, |search, point| {
            side_value(search.side(point))
        })?;
        members(py, Enumeration::Side, shape, sides)
    }

    /// On which side of the mesh the link of every segment is.
    ///
    /// A link that touches the mesh or the lid of an opening is ``Side.UNDECIDED``. The other links
    /// are on one side of the mesh and its lids from one such link to the next. Their side is the
    /// `side` of their ends that are decided; without any, or if two contradict one another, it is
    /// ``Side.UNDECIDED``, as for a segment without length. See `clears_inside` for lids.
    ///
    /// Parameters
    /// ----------
    /// points, radii, pose, caps
    ///     As for `distance`.
    ///
    /// Returns
    /// -------
    /// Sides
    ///     An array of `Side` of the shape (N - 1,), or (B, N - 1) of a batch.
    ///
    /// Raises
    /// ------
    /// ContinuumError
    ///     As for `distance`.
    ///
    /// Examples
    /// --------
    /// >>> from parry_continuum import Mesh
    /// >>> corners = [[0, 0, 0], [9, 0, 0], [0, 9, 0], [0, 0, 9]]
    /// >>> wall = Mesh(corners, [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
    /// >>> wall.link_sides([[1, 1, 1], [1, 1, 2], [1, 1, 9], [1, 1, 12]], 0.5)
    /// Sides([INSIDE, UNDECIDED, OUTSIDE])
    #[pyo3(signature = (points, radii, *, pose = None, caps = Caps::Fitted), text_signature = "($self, points, radii, *, pose=None, caps=\"fitted\")")]
    fn link_sides<'py>(
        &self,
        py: Python<'py>,
        points: &Bound<'py, PyAny>,
        radii: &Bound<'py, PyAny>,
        pose: Option<&Bound<'py, PyAny>>,
        caps: Caps,
    ) -> PyResult<Bound<'py, PyAny>> {
        let robots = self.robots(points, radii, pose)?;
        self.note_sides(py)?;
        let segments = robots.segments_each();
        let mut all = Vec::with_capacity(robots.len() * segments);
        let ask = |session: &mut Session, robot: &Given<'_>, row: &mut [i8]| {
            let chain = set_chain(&mut session.chain, robot, caps)?;
            let mut sides = Vec::new();
            session.search.link_sides(chain, &robot.pose()?, &mut sides)?;
            for (link, side) in sides.into_iter().enumerate() {
                if let Ok(segment) = usize::try_from(segment_of(chain, robot.points, link)) {
                    row[segment] = side_value(side);
                }
            }
            Ok(())
        };
        let empty = (side_value(Side::Undecided), segments.max(1));
        ask_each(py, &self.engine(py), &robots, empty, ask, |_, found| all.extend(found))?;
        members(py, Enumeration::Side, robots.shape(&[segments]), all)
    }

    /// What the mesh is as a surface: its openings with their widths, edges of more than two
    /// triangles, and edges whose triangles face opposite ways.
    ///
    /// Corners at the same place are one corner. An opening is a group of edges of one triangle
    /// each, connected by their corners; edges that lie on one line within rounding are a seam, not
    /// an opening. Through an opening a robot can leave without touching the mesh. `load` warns of
    /// all of it, and so does `doubts`.
    ///
    /// Returns
    /// -------
    /// Surface
    ///     ``width``, ``centre`` and ``edges`` of the openings, arrays of one length, the widest
    ///     first; and ``nonmanifold_edges`` and ``misoriented_edges``. ``is_sound`` says whether
    ///     there is nothing of it.
    ///
    /// Examples
    /// --------
    /// >>> from parry_continuum import Mesh
    /// >>> corners = [[0, 0, 0], [3, 0, 0], [0, 4, 0], [0, 0, 9]]
    /// >>> Mesh(corners, [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]).surface().is_sound
    /// True
    /// >>> Mesh(corners, [[0, 1, 3], [0, 3, 2], [1, 2, 3]]).surface().width
    /// array([2.4])
    fn surface<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let found = alone(py, &self.engine(py), |session| session.search.surface().clone())?;
        let openings = &found.openings;
        let values = [
            rows(py, openings, |opening| [opening.width]),
            rows(py, openings, |opening| opening.centre.to_array()),
            rows(py, openings, |opening| [opening.edges as i64]),
            found.nonmanifold_edges.into_pyobject(py)?.into_any(),
            found.misoriented_edges.into_pyobject(py)?.into_any(),
        ];
        answer!(py, "Surface", PyTuple::new(py, values)?)
    }
}
