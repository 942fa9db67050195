//! Proofs of answers.

use super::distance::set_chain;
use crate::error::Refused;
use crate::input::{Caps, Given, Numbers, Robots, shape_text, vectors};
use crate::mesh::Mesh;
use crate::output::array;
use crate::threads::{Asked, Session, ask_each};
use parry_continuum::parry::math::Vector;
use parry_continuum::proximity::{Certificate, LinkProximity, Proximity, ProximityError};
use pyo3::prelude::*;

/// The fields of a `PerLink` answer, a row for each segment of each robot.
struct Answers {
    distance: Vec<f64>,
    on_robot: Vec<Vector>,
    on_mesh: Vec<Vector>,
    arc_length: Vec<f64>,
    /// Positions of triangles are whole numbers far below 2^53.
    triangle: Vec<f64>,
}

impl Answers {
    fn new(answer: &Bound<'_, PyAny>, robots: &Robots<'_>, segments: usize) -> PyResult<Self> {
        let field = |name: &str, last: &[usize]| {
            let shape: Vec<_> = [segments].iter().chain(last).copied().collect();
            answer_field(answer, "per_link", name, &[robots.shape(&shape)])
        };
        Ok(Self {
            triangle: field("triangle", &[])?.0.values().to_vec(),
            distance: field("distance", &[])?.0.values().to_vec(),
            on_robot: vectors(field("on_robot", &[3])?.0.points()),
            on_mesh: vectors(field("on_mesh", &[3])?.0.points()),
            arc_length: field("arc_length", &[])?.0.values().to_vec(),
        })
    }

    /// Writes the fields of one row into an answer of the library's.
    fn write(&self, row: usize, found: &mut LinkProximity) {
        found.distance = self.distance[row];
        found.witness.on_robot = self.on_robot[row];
        found.witness.on_mesh = self.on_mesh[row];
        found.witness.arc_length = self.arc_length[row];
        found.witness.triangle = self.triangle[row] as u32;
    }
}

/// A field of an answer that `function` returned, and the place of the field's shape in `shapes`.
/// Another shape is an error.
pub(crate) fn answer_field<'py>(
    answer: &Bound<'py, PyAny>,
    function: &str,
    name: &str,
    shapes: &[Vec<usize>],
) -> PyResult<(Numbers<'py>, usize)> {
    let py = answer.py();
    let refuse = |text: String| Refused::other("answer_does_not_fit", text).raise(py, None);
    let Some(values) = answer.getattr_opt(name)? else {
        return Err(refuse(format!("`answer` has no `{name}`; give what `{function}` returned")));
    };
    let values = Numbers::new(&values, &format!("answer.{name}"))?;
    match shapes.iter().position(|shape| shape == values.shape()) {
        Some(kind) => Ok((values, kind)),
        None => {
            let fit: Vec<_> = shapes.iter().map(|shape| shape_text(shape)).collect();
            Err(refuse(format!(
                "`answer.{name}` has the shape {}, but of these robots it has {}; give the robots that were asked about",
                shape_text(values.shape()),
                fit.join(" or ")
            )))
        }
    }
}

#[pymethods]
impl Mesh {
    /// Bounds on the distances of a `PerLink` answer that hold despite all rounding.
    ///
    /// Each bounds the distance between a segment's link and the triangle that the answer names, of
    /// the mesh as it is now. The bounds are computed in twice the digits, without trust in the
    /// code that answered: ``lower <= answer.distance <= upper`` up to the last bits of the
    /// distance. The answer's distances and points are checked first: an answer for other points,
    /// another radius, pose or mesh is an error.
    ///
    /// Parameters
    /// ----------
    /// points, radii, pose, caps
    ///     As they were given to `per_link`.
    /// answer : PerLink
    ///
    /// Returns
    /// -------
    /// Certificate
    ///     ``lower`` and ``upper``, arrays of the shape of ``answer.distance``; NaN for segments
    ///     without length.
    ///
    /// Raises
    /// ------
    /// ContinuumError
    ///     The answer does not fit robot, pose and mesh: a point is not where it says, the distance
    ///     is another, or the shapes differ. Or as for `distance`.
    ///
    /// Examples
    /// --------
    /// >>> from parry_continuum import Mesh
    /// >>> floor = Mesh([[-9, -9, 0], [9, -9, 0], [0, 9, 0]], [[0, 1, 2]])
    /// >>> robot = [[0, 0, 2], [1, 0, 2.1]], 0.5
    /// >>> proof = floor.certify(*robot, floor.per_link(*robot))
    /// >>> bool(proof.upper[0] - proof.lower[0] < 1e-15)
    /// True
    #[pyo3(signature = (points, radii, answer, *, pose = None, caps = Caps::Fitted), text_signature = "($self, points, radii, answer, *, pose=None, caps=\"fitted\")")]
    fn certify<'py>(
        &self,
        py: Python<'py>,
        points: &Bound<'py, PyAny>,
        radii: &Bound<'py, PyAny>,
        answer: &Bound<'py, PyAny>,
        pose: Option<&Bound<'py, PyAny>>,
        caps: Caps,
    ) -> PyResult<Bound<'py, PyAny>> {
        let robots = self.robots(points, radii, pose)?;
        let segments = robots.segments_each();
        let shape = robots.shape(&[segments]);
        let given = Answers::new(answer, &robots, segments)?;
        let mut bounds: Vec<[f64; 2]> = Vec::with_capacity(given.triangle.len());
        let ask = |session: &mut Session, robot: &Given<'_>, rows: &mut [[f64; 2]]| {
            let chain = set_chain(&mut session.chain, robot, caps)?;
            let pose = robot.pose()?;
            let first = segments * robot.number;
            let named = (first..first + segments).filter(|&row| given.triangle[row] >= 0.0).count();
            let links = chain.links().len();
            if named != links {
                return Err(ProximityError::NoSuchLink { link: named, links }.into());
            }
            // Takes an answer of the library's own, and overwrites its fields with the given ones.
            session.search.per_link(chain, &pose, &mut session.links)?;
            for found in &mut session.links {
                let segment = found.witness.segment as usize;
                given.write(first + segment, found);
                // The same check as that of `LinkProximity::certify`.
                session.search.contact_of(chain, &pose, found)?;
                let corners = session.search.triangles()[found.witness.triangle as usize]
                    .map(|corner| session.search.vertices()[corner as usize]);
                let proof =
                    Certificate::between(&chain.links()[found.link as usize], &pose, corners)?;
                rows[segment] = [proof.lower, proof.upper];
            }
            Ok(())
        };
        ask_each(
            py,
            &self.engine(py),
            &robots,
            ([f64::NAN; 2], segments.max(1)),
            ask,
            |_, found| bounds.extend(found),
        )?;
        let lower = array(py, shape.clone(), bounds.iter().map(|it| it[0]).collect())?;
        let upper = array(py, shape, bounds.iter().map(|it| it[1]).collect())?;
        crate::output::answer!(py, "Certificate", (lower, upper))
    }
}
