//! Proofs of answers.

use super::chains::set_chain;
use crate::error::Refused;
use crate::input::{Caps, Given, Numbers, Robots, shape_text, vectors};
use crate::mesh::Mesh;
use crate::output::array;
use crate::threads::{Asked, Session, ask_each};
use parry_continuum::parry::math::{Pose, Vector};
use parry_continuum::proximity::{Certificate, LinkProximity, Proximity, Witness};
use parry_continuum::{Chain, ModifiedCylinder};
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

    /// Refuses an answer about a row whose segment has no length and so is no link, and one that is
    /// missing where the segment is a link.
    fn check_row(&self, row: usize, segment: usize, is_link: bool) -> Result<(), Refused> {
        let points = [self.on_robot[row], self.on_mesh[row]];
        let numbers = [self.distance[row], self.arc_length[row]];
        let (triangle, is_named) = (self.triangle[row], self.triangle[row] >= 0.0);
        let text = if is_link && !is_named {
            format!(
                "`answer.triangle` is {triangle} for segment {segment}, which has a length; give what `per_link` returned"
            )
        } else if !is_link
            && (is_named
                || numbers.into_iter().chain(points.map(Vector::length)).any(|it| !it.is_nan()))
        {
            format!(
                "`answer` has numbers for segment {segment}, which has no length; give what `per_link` returned: NaN, and the \
                 triangle -1"
            )
        } else {
            return Ok(());
        };
        Err(Refused::other("answer_does_not_fit", text))
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

/// Refuses an arc length that is not that of the place on a link's axis which is closest to the
/// other point of the answer.
pub(crate) fn check_arc_length(
    (chain, pose, link): (&Chain, &Pose, u32),
    other: Vector,
    given: f64,
    field: &str,
) -> Result<(), Refused> {
    let (before, along) = chain.links().split_at(link as usize);
    let Some(axis) = along.first().map(|link| link.transformed(pose)) else { return Ok(()) };
    let (direction, offset) = (axis.end() - axis.start(), other - axis.start());
    let share = (offset.dot(direction) / direction.length_squared()).clamp(0.0, 1.0);
    let length = |link: &ModifiedCylinder| (link.end() - link.start()).length();
    let before = before.iter().map(length).sum::<f64>();
    let expected = before + share * direction.length();
    // Rounding: each link adds one to the sum, and the points are rounded to the mesh's frame.
    let size = expected + direction.length() + other.abs().max_element();
    let limit = (chain.links().len() + 64) as f64 * f64::EPSILON * size;
    if (given - expected).abs() <= limit {
        return Ok(());
    }
    let text = format!(
        "`answer.{field}` is {given:?} for link {link}, where the place is at {expected:?}; ask again where robot or pose have \
         changed"
    );
    Err(Refused::other("answer_does_not_fit", text))
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
    /// distance. The answer's distances, points and arc lengths are checked first: an answer for
    /// other points, another radius, pose or mesh is an error.
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
    ///     or the arc length is another, a segment without length has numbers, or the shapes
    ///     differ. Or as for `distance`.
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
            // Takes an answer of the library's own, and overwrites its fields with the given ones.
            session.search.per_link(chain, &pose, &mut session.links)?;
            let mut links = session.links.iter().map(|it| it.witness.segment as usize).peekable();
            for segment in 0..segments {
                let is_link = links.next_if_eq(&segment).is_some();
                given.check_row(first + segment, segment, is_link)?;
            }
            for found in &mut session.links {
                let segment = found.witness.segment as usize;
                given.write(first + segment, found);
                // The same check as that of `LinkProximity::certify`.
                session.search.contact_of(chain, &pose, found)?;
                let Witness { on_mesh, arc_length, .. } = found.witness;
                let place = (chain, &pose, found.link);
                check_arc_length(place, on_mesh, arc_length, "arc_length")?;
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
