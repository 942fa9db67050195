//! How the distance changes with all that the robot is made of.
//!
//! The library gives the derivative with respect to the ends p and q of the link that is closest,
//! both in the mesh's frame. With the pose x -> R x + t, p = R a + t for a point a of the robot:
//! the derivative with respect to a is R^T times that with respect to p, that with respect to t is
//! the sum over the two ends, and that with respect to R is the sum of g a^T, with g the derivative
//! with respect to an end. All other points and radii do not count: only the closest link moves the
//! distance.

use super::chains::set_chain;
use crate::error::Refused;
use crate::input::{Caps, Given};
use crate::mesh::Mesh;
use crate::output::{answer, array, array_or_number};
use crate::threads::{Asked, Session, ask_each};
use parry_continuum::parry::math::Vector;
use parry_continuum::proximity::{Contact, LinkFeature, Proximity};
use parry_continuum::{Cap, Chain};
use pyo3::prelude::*;

/// What there is of one robot.
#[derive(Clone, Copy)]
struct Row {
    value: f64,
    segment: usize,
    ends: [Vector; 2],
    radius: f64,
    pose: [f64; 16],
    kink: bool,
}

const NOTHING: Row = Row {
    value: f64::NAN,
    segment: 0,
    ends: [Vector::NAN; 2],
    radius: f64::NAN,
    pose: [f64::NAN; 16],
    kink: false,
};

fn ask(session: &mut Session, robot: &Given<'_>, caps: Caps) -> Result<Row, Refused> {
    let chain = set_chain(&mut session.chain, robot, caps)?;
    let pose = robot.pose()?;
    let closest = session.search.minimum(chain, &pose)?;
    let contact = session.search.contact_of(chain, &pose, &closest)?;
    let segment = closest.witness.segment as usize;
    let mut row = Row { value: contact.depth, segment, ..NOTHING };
    if let Some(found) = session.search.derivative(chain, &pose, &closest)? {
        let back = pose.rotation.inverse();
        (row.ends, row.radius) = ([back * found.start, back * found.end], found.radius);
        row.kink = found.kink || (caps == Caps::Fitted && is_at_filled_bend(chain, &contact));
        row.pose = [0.0; 16];
        for (rate, point) in
            [(found.start, robot.points[segment]), (found.end, robot.points[segment + 1])]
        {
            for (i, rate) in rate.to_array().into_iter().enumerate() {
                for (j, x) in point.to_array().into_iter().chain([1.0]).enumerate() {
                    row.pose[4 * i + j] += rate * x;
                }
            }
        }
    }
    Ok(row)
}

/// Radii that differ by at most this share are equal, as in `Chain::from_centreline`.
const EQUAL: f64 = 1.0 / (1_u64 << 32) as f64;

/// Whether a change of one radius, however little, changes the cap that the closest place is on.
///
/// The place is on the round cap of a joint. If a joint between equal radii, this one or another
/// within one radius of it, becomes a step, then the wider side of the step is flat, and so is
/// every joint that is too near to that face.
fn is_at_filled_bend(chain: &Chain, contact: &Contact) -> bool {
    let (links, place) = (chain.links(), contact.link as usize);
    let link = &links[place];
    let (end, joint) = match contact.feature.link {
        LinkFeature::Side => return false,
        LinkFeature::StartCap => (0, link.start()),
        LinkFeature::EndCap => (1, link.end()),
    };
    let is_equal = |one: f64, other: f64| (one - other).abs() <= EQUAL * one.max(other);
    link.caps()[end] == Cap::Round
        && links.windows(2).any(|pair| {
            is_equal(pair[0].radius(), pair[1].radius())
                && (pair[0].end() - joint).length() <= link.radius()
        })
}

#[pymethods]
impl Mesh {
    /// The distance with its derivative with respect to every point, radius and pose.
    ///
    /// Where robot and mesh are apart the value is the distance; where they overlap it is minus the
    /// length of the least translation that parts the closest link from its triangle, so that it
    /// goes on through the wall.
    ///
    /// Of most robots one link is closest, and one triangle. Where two are equally close the
    /// distance has a kink, and what is given is the derivative for one of them; ``kink`` says
    /// where the two closest points themselves could be others. With fitted caps, a bend between
    /// segments of equal radii is filled. If one radius there changes alone, the bend is a step
    /// whose wider side is flat, and the distance from there has a kink or jumps: ``kink`` says so
    /// too. The derivatives are NaN where neither side of the triangle is the robot's.
    ///
    /// Parameters
    /// ----------
    /// points, radii, pose, caps
    ///     As for `distance`.
    ///
    /// Returns
    /// -------
    /// Gradient
    ///     ``value``; ``points`` (N, 3), in the robot's frame; ``radii`` (N - 1,), whose sum
    ///     belongs to one radius for all segments; ``pose`` (4, 4), the derivative with respect to
    ///     the entries of the matrix, for changes that leave it rigid; ``kink``. Of a batch, each
    ///     with B in front.
    ///
    /// Raises
    /// ------
    /// ContinuumError
    ///     As for `distance`.
    ///
    /// Examples
    /// --------
    /// >>> import numpy as np
    /// >>> from parry_continuum import Mesh
    /// >>> floor = Mesh([[-9, -9, 0], [9, -9, 0], [0, 9, 0]], [[0, 1, 2]])
    /// >>> robot = [[0, 0, 4], [0, 0, 3], [1, 0, 2]]
    /// >>> found = floor.distance_and_gradient(robot, 0.5, caps="capsules")
    /// >>> found.value, found.points[2], found.radii
    /// (1.5, array([0., 0., 1.]), array([ 0., -1.]))
    #[pyo3(signature = (points, radii, *, pose = None, caps = Caps::Fitted), text_signature = "($self, points, radii, *, pose=None, caps=\"fitted\")")]
    fn distance_and_gradient<'py>(
        &self,
        py: Python<'py>,
        points: &Bound<'py, PyAny>,
        radii: &Bound<'py, PyAny>,
        pose: Option<&Bound<'py, PyAny>>,
        caps: Caps,
    ) -> PyResult<Bound<'py, PyAny>> {
        let robots = self.robots(points, radii, pose)?;
        let (count, each, segments) = (robots.len(), robots.points_each, robots.segments_each());
        let (mut values, mut kinks, mut poses) =
            (Vec::with_capacity(count), Vec::with_capacity(count), Vec::new());
        let (mut of_points, mut of_radii) =
            (vec![0.0; 3 * count * each], vec![0.0; count * segments]);
        let ask = |session: &mut Session, robot: &Given<'_>, row: &mut [Row]| {
            row[0] = ask(session, robot, caps)?;
            Ok(())
        };
        ask_each(py, &self.engine(py), &robots, (NOTHING, 1), ask, |first, rows| {
            for (robot, row) in (first..).zip(rows) {
                values.push(row.value);
                kinks.push(row.kink);
                poses.extend(row.pose);
                for (end, rate) in row.ends.iter().enumerate() {
                    let place = 3 * (robot * each + row.segment + end);
                    of_points[place..place + 3].copy_from_slice(&rate.to_array());
                }
                of_radii[robot * segments + row.segment] = row.radius;
            }
        })?;
        let found = (
            array_or_number(py, robots.shape(&[]), values)?,
            array(py, robots.shape(&[each, 3]), of_points)?,
            array(py, robots.shape(&[segments]), of_radii)?,
            array(py, robots.shape(&[4, 4]), poses)?,
            array_or_number(py, robots.shape(&[]), kinks)?,
        );
        answer!(py, "Gradient", found)
    }
}
