//! The robots of a question about a scene: a list of them.

use crate::error::{Refused, with_prefix};
use crate::input::{Caps, Given, Names, Robots};
use crate::queries::chains::set_chain;
use parry_continuum::Chain;
use parry_continuum::parry::math::{Pose, Vector};
use pyo3::prelude::*;
use pyo3::types::PyTuple;

/// A robot, its pose, and the points that it was made of.
pub(super) type Placed<'a> = (&'a Chain, Pose, &'a [Vector]);

/// The robots of a question, as the session's chains, with their poses and points.
pub(super) fn place<'a>(
    chains: &'a mut Vec<Option<Chain>>,
    robot: &Given<'a>,
    caps: Caps,
) -> Result<Vec<Placed<'a>>, Refused> {
    let robots: Vec<_> = robot.all().collect();
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
pub(super) fn robots<'py>(py: Python<'py>, given: &[Bound<'py, PyAny>]) -> PyResult<Robots<'py>> {
    let refuse = |text: &str| Refused::other("bad_type", text).raise(py, None);
    if given.len() > MOST_ROBOTS {
        let text = format!(
            "`robots` lists {} robots of one scene, more than {MOST_ROBOTS}; give many shapes of one robot as a batch, (B, N, 3)",
            given.len()
        );
        return Err(refuse(&text));
    }
    let mut all = given.iter().enumerate().rev();
    let last =
        all.next().ok_or_else(|| refuse("`robots` is empty; give a list of at least one robot"))?;
    all.try_fold(one(last)?, |others, given| one(given)?.with_others(py, others))
}

/// A robot of the list, at its place.
fn one<'py>((place, given): (usize, &Bound<'py, PyAny>)) -> PyResult<Robots<'py>> {
    let py = given.py();
    let parts = match given.cast::<PyTuple>() {
        Ok(tuple) => tuple.iter().collect::<Vec<_>>(),
        Err(_) => Vec::new(),
    };
    let (points, radii, pose) = match &parts[..] {
        [points, radii] => (points, radii, None),
        [points, radii, pose] => (points, radii, (!pose.is_none()).then_some(pose)),
        _ => {
            let text = format!(
                "`robots[{place}]` is no tuple (points, radii) or (points, radii, pose); give one for each robot"
            );
            return Err(Refused::other("bad_type", text).raise(py, None));
        }
    };
    Robots::new(Names::entry(place), points, radii, pose)
        .map_err(|error| with_prefix(py, error, &format!("`robots[{place}]`: ")))
}

/// The points of an entry that has no pose.
pub(super) fn points_without_pose<'py>(entry: &Bound<'py, PyAny>) -> Option<Bound<'py, PyAny>> {
    let entry = entry.cast::<PyTuple>().ok()?;
    let has_pose = entry.get_item(2).is_ok_and(|pose| !pose.is_none());
    if has_pose { None } else { entry.get_item(0).ok() }
}
