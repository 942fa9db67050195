//! Proofs of answers.

use super::distance::set_chain;
use crate::error::Refused;
use crate::input::{Caps, Given, Numbers, Robots, shape_text};
use crate::mesh::Mesh;
use crate::output::array;
use crate::threads::{Asked, Session, ask_each};
use parry_continuum::proximity::{Certificate, Proximity, ProximityError};
use pyo3::prelude::*;

#[pymethods]
impl Mesh {
    /// Bounds on the distances of a `PerLink` answer that hold whatever was rounded on the way.
    ///
    /// Each bounds the distance between a segment's link and the triangle that the answer names, of the mesh as it is now. They
    /// are computed in twice the digits, without trust in the code that answered: ``lower <= answer.distance <= upper`` but for
    /// the last bits of the distance.
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
    ///     ``lower`` and ``upper``, arrays of the shape of ``answer.distance``; NaN for segments without length.
    ///
    /// Raises
    /// ------
    /// ContinuumError
    ///     The answer does not fit robot and mesh, or as for `distance`.
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
        let robots = Robots::new("points", points, radii, pose)?;
        let segments = robots.segments_each();
        let refuse = |text: String| Refused::other("answer_does_not_fit", text).raise(py, None);
        let triangles = answer.getattr("triangle").map_err(|_| {
            refuse("`answer` has no triangles; give what `per_link` returned".into())
        })?;
        let triangles = Numbers::new(&triangles, "answer.triangle")?;
        let shape = robots.shape(&[segments]);
        if triangles.shape() != shape {
            return Err(refuse(format!(
                "`answer` has the shape {}, but the robots have {}; give the robots that were asked about",
                shape_text(triangles.shape()),
                shape_text(&shape)
            )));
        }
        // Positions of triangles are whole numbers far below 2^53.
        let triangles = triangles.values().to_vec();
        let mut bounds: Vec<[f64; 2]> = Vec::with_capacity(triangles.len());
        let ask = |session: &mut Session, robot: &Given<'_>, rows: &mut [[f64; 2]]| {
            let chain = set_chain(&mut session.chain, robot, caps)?;
            let pose = robot.pose()?;
            let named = &triangles[segments * robot.number..segments * (robot.number + 1)];
            let asked: Vec<_> = (0..named.len()).filter(|&segment| named[segment] >= 0.0).collect();
            if asked.len() != chain.links().len() {
                let (link, links) = (asked.len(), chain.links().len());
                return Err(ProximityError::NoSuchLink { link, links }.into());
            }
            for (segment, link) in asked.into_iter().zip(chain.links()) {
                let (triangle, all) = (named[segment] as usize, session.search.triangles());
                let corners = all
                    .get(triangle)
                    .ok_or(ProximityError::NoSuchTriangle { triangle, triangles: all.len() })?;
                let corners = corners.map(|corner| session.search.vertices()[corner as usize]);
                let found = Certificate::between(link, &pose, corners)?;
                rows[segment] = [found.lower, found.upper];
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
