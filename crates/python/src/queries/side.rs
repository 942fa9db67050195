//! Inside or outside.

use crate::error::Refused;
use crate::input::{Numbers, shape_text, vectors};
use crate::mesh::Mesh;
use crate::output::{Enumeration, members, side_value};
use crate::threads::ask_points;
use pyo3::prelude::*;

#[pymethods]
impl Mesh {
    /// On which side of the mesh points are, proven.
    ///
    /// Triangles may face outward or inward, as long as all do the same. Near holes of an open
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
}
