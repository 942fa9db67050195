//! What a question about a motion was given: two shapes and radii, or a motion.

use crate::error::Refused;
use crate::input::{Caps, Given, Names, Robots};
use crate::mesh::Mesh;
use crate::motions::{Maker, Motion, Moving, maker};
use crate::threads::{Asked, Engine, Session, answer_each};
use pyo3::prelude::*;
use std::sync::Arc;

/// The arguments of a query about a motion. A motion object stands for the first three.
pub(super) struct Arguments<'a, 'py> {
    pub start: &'a Bound<'py, PyAny>,
    pub end: Option<&'a Bound<'py, PyAny>>,
    pub radii: Option<&'a Bound<'py, PyAny>>,
    pub caps: Option<Caps>,
}

/// The motions of a query.
pub(super) enum Way<'a, 'py> {
    Motion(&'a Bound<'py, Motion>),
    /// Each motion is made when its query begins.
    Linear(Box<Robots<'py>>, Maker),
}

/// A question about any motion of the library's.
pub(super) trait Question<A>: Sync {
    fn ask(
        &self,
        session: &mut Session,
        motion: &impl parry_continuum::Motion,
    ) -> Result<A, parry_continuum::proximity::ProximityError>;
}

/// The value of a parameter that shapes need.
fn needed<T>(py: Python<'_>, parameter: &str, given: Option<T>) -> PyResult<T> {
    given.ok_or_else(|| {
        let text =
            format!("`{parameter}` is missing; give `start`, `end` and `radii`, or one motion");
        Refused::other("bad_type", text).raise(py, None)
    })
}

impl Mesh {
    /// What a question was given. Warns once if shapes state another frame than the mesh.
    pub(super) fn way<'a, 'py>(&self, given: &Arguments<'a, 'py>) -> PyResult<Way<'a, 'py>> {
        let way = Way::new(given)?;
        self.note_frame("start", given.start)?;
        given.end.map_or(Ok(()), |end| self.note_frame("end", end))?;
        Ok(way)
    }
}

impl<'a, 'py> Way<'a, 'py> {
    fn new(given: &Arguments<'a, 'py>) -> PyResult<Self> {
        let py = given.start.py();
        if let Ok(motion) = given.start.cast::<Motion>() {
            let besides = [
                ("end", given.end.is_some()),
                ("radii", given.radii.is_some()),
                ("caps", given.caps.is_some()),
            ];
            return match besides.into_iter().find(|(_, is_given)| *is_given) {
                None => Ok(Self::Motion(motion)),
                Some((name, _)) => {
                    let text = format!(
                        "`{name}` is given beside a motion, which has its own; leave `{name}` out"
                    );
                    Err(Refused::other("bad_type", text).raise(py, None))
                }
            };
        }
        let end = needed(py, "end", given.end)?;
        let radii = needed(py, "radii", given.radii)?;
        let make = maker(py, given.caps.unwrap_or(Caps::Fitted))?;
        let robots = Robots::new(Names::one("start"), given.start, radii, None)?
            .with_as_many("end", end, "start")?;
        Ok(Self::Linear(Box::new(robots), make))
    }

    /// How many motions there are; none where there is one by itself.
    pub(super) fn count(&self) -> Option<usize> {
        match self {
            Self::Motion(motion) => Asked::count(motion.get()),
            Self::Linear(robots, _) => robots.count,
        }
    }

    /// The answer about each.
    pub(super) fn ask<A: Clone + Send>(
        &self,
        py: Python<'py>,
        engine: &Arc<Engine>,
        question: &impl Question<A>,
    ) -> PyResult<Vec<A>> {
        match self {
            Self::Motion(motion) => {
                let ask =
                    |session: &mut Session, motion: &&Moving| Ok(question.ask(session, *motion)?);
                answer_each(py, engine, motion.get(), ask)
            }
            Self::Linear(robots, make) => {
                let ask = |session: &mut Session, robot: &Given<'_>| {
                    let motion = make(robot.points, robot.more, robot.radii)?;
                    Ok(question.ask(session, &motion)?)
                };
                answer_each(py, engine, &**robots, ask)
            }
        }
    }
}
