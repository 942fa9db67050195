//! Every contact of a robot.

use super::chains::set_chain;
use crate::input::{Caps, Given, of};
use crate::mesh::Mesh;
use crate::output::{answer, rows};
use crate::threads::{Asked, Session, ask_each};
use parry_continuum::parry::math::Vector;
use parry_continuum::proximity::{Contact, Proximity};
use pyo3::prelude::*;
use pyo3::types::PyTuple;

#[pymethods]
impl Mesh {
    /// Every contact at most a margin away: where the distance between a link and the mesh has a
    /// local minimum.
    ///
    /// A wall that bends towards a link is one contact, however many triangles it has, and a link
    /// in a narrow lumen has one on each side. Contacts come robot by robot, segment by segment,
    /// the nearest first.
    ///
    /// Where the two are apart ``depth`` is the distance, and ``normal`` points from the wall to
    /// the robot. Where they overlap ``depth`` is minus the length of the least translation, along
    /// ``normal``, that parts the link from that triangle. The normal is NaN where neither side of
    /// the triangle is the robot's.
    ///
    /// Parameters
    /// ----------
    /// points, radii, pose, caps
    ///     As for `distance`.
    /// margin : float
    ///     A length, at least 0.
    /// prominence : float
    ///     Leaves out local minima that are shallow: by how much farther every way on the mesh from
    ///     a contact to a nearer place must first lead. 0 keeps all of them.
    ///
    /// Returns
    /// -------
    /// Contacts
    ///     Arrays of one length, with a row for each contact. The rows of robot k are
    ///     ``offsets[k]:offsets[k + 1]``.
    ///
    /// Raises
    /// ------
    /// ContinuumError
    ///     The margin or the prominence is negative or NaN, or as for `distance`.
    ///
    /// Examples
    /// --------
    /// >>> from parry_continuum import Mesh
    /// >>> floor = Mesh([[-9, -9, 0], [9, -9, 0], [0, 9, 0]], [[0, 1, 2]])
    /// >>> robot = [[0, 0, 4], [0, 0, 3], [0, 0, 1]]
    /// >>> contacts = floor.contacts_within(robot, 0.5, margin=1, caps="capsules")
    /// >>> contacts.segment, contacts.distance, contacts.normal
    /// (array([1]), array([0.5]), array([[0., 0., 1.]]))
    #[pyo3(signature = (points, radii, *, margin, prominence = 0.0, pose = None, caps = Caps::Fitted), text_signature = "($self, points, radii, *, margin, prominence=0.0, pose=None, caps=\"fitted\")")]
    #[allow(clippy::too_many_arguments)] // they are named in Python
    fn contacts_within<'py>(
        &self,
        py: Python<'py>,
        points: &Bound<'py, PyAny>,
        radii: &Bound<'py, PyAny>,
        #[pyo3(from_py_with = of::margin)] margin: f64,
        #[pyo3(from_py_with = of::prominence)] prominence: f64,
        pose: Option<&Bound<'py, PyAny>>,
        caps: Caps,
    ) -> PyResult<Bound<'py, PyAny>> {
        let robots = self.robots(points, radii, pose)?;
        // Each with the number of its robot.
        let mut all: Vec<(Contact, i64)> = Vec::new();
        let mut offsets = Vec::with_capacity(robots.len() + 1);
        offsets.push(0_i64);
        let ask = |session: &mut Session, robot: &Given<'_>, row: &mut [Vec<(Contact, i64)>]| {
            let chain = set_chain(&mut session.chain, robot, caps)?;
            session.search.contacts_within(
                chain,
                &robot.pose()?,
                margin,
                prominence,
                &mut session.contacts,
            )?;
            row[0] =
                session.contacts.iter().map(|contact| (*contact, robot.number as i64)).collect();
            Ok(())
        };
        ask_each(py, &self.engine(py), &robots, (Vec::new(), 1), ask, |_, found| {
            for contacts in found {
                all.extend_from_slice(contacts);
                offsets.push(all.len() as i64);
            }
        })?;
        let numbers = |of: fn(&Contact) -> f64| rows(py, &all, |(contact, _)| [of(contact)]);
        let points =
            |of: fn(&Contact) -> Vector| rows(py, &all, |(contact, _)| of(contact).to_array());
        let values = [
            rows(py, &all, |(contact, _)| [i64::from(contact.witness.segment)]),
            numbers(|contact| contact.fraction),
            numbers(|contact| contact.witness.arc_length),
            numbers(|contact| contact.distance),
            numbers(|contact| contact.depth),
            points(|contact| contact.normal.unwrap_or(Vector::NAN)),
            points(|contact| contact.witness.on_robot),
            points(|contact| contact.witness.on_mesh),
            rows(py, &all, |(contact, _)| [i64::from(contact.witness.triangle)]),
            rows(py, &all, |(_, robot)| [*robot]),
            rows(py, &offsets, |offset| [*offset]),
        ];
        answer!(py, "Contacts", PyTuple::new(py, values)?)
    }
}
