//! The robots of a question about a scene: a list of them.

use crate::error::Refused;
use crate::input::{Caps, Given, Robots};
use crate::queries::distance::set_chain;
use parry_continuum::Chain;
use parry_continuum::parry::math::{Pose, Vector};
use pyo3::prelude::*;

/// A robot, its pose, and the points that it was made of.
pub(super) type Placed<'a> = (&'a Chain, Pose, &'a [Vector]);

/// The robots of a question, as the session's chains, with their poses and points.
pub(super) fn place<'a>(
    chains: &'a mut Vec<Option<Chain>>,
    robot: &Given<'a>,
    caps: Caps,
) -> Result<Vec<Placed<'a>>, Refused> {
    let robots: Vec<_> = std::iter::successors(Some(*robot), Given::other).collect();
    if chains.len() < robots.len() {
        chains.resize_with(robots.len(), || None);
    }
    let placed = chains.iter_mut().zip(&robots);
    placed
        .map(|(chain, robot)| Ok((set_chain(chain, robot, caps)?, robot.pose()?, robot.points)))
        .collect()
}

/// Each robot of a list holds the next one.
const MOST_ROBOTS: usize = 1000;

/// The list of robots that a function was given.
pub(super) fn robots<'py>(py: Python<'py>, given: Vec<Bound<'py, PyAny>>) -> PyResult<Robots<'py>> {
    let refuse = |text: &str| Refused::other("bad_type", text).raise(py, None);
    let one = |given: &Bound<'py, PyAny>| {
        if let Ok((points, radii)) = given.extract::<(Bound<'py, PyAny>, Bound<'py, PyAny>)>() {
            return Robots::new("points", &points, &radii, None);
        }
        let three =
            given.extract::<(Bound<'py, PyAny>, Bound<'py, PyAny>, Option<Bound<'py, PyAny>>)>();
        let (points, radii, pose) = three.map_err(|_| {
            refuse(
                "`robots` has an entry that is no tuple (points, radii) or (points, radii, pose)",
            )
        })?;
        Robots::new("points", &points, &radii, pose.as_ref())
    };
    if given.len() > MOST_ROBOTS {
        let text = format!(
            "`robots` lists {} robots of one scene, more than {MOST_ROBOTS}; give many shapes of one robot as a batch, (B, N, 3)",
            given.len()
        );
        return Err(refuse(&text));
    }
    let mut all = given.iter().rev();
    let last =
        all.next().ok_or_else(|| refuse("`robots` is empty; give a list of at least one robot"))?;
    all.try_fold(one(last)?, |others, given| one(given)?.with_others(py, others))
}
