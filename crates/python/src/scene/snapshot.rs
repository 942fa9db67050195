//! The structures of a scene at the time of a question.

use crate::error::Refused;
use crate::mesh::Mesh;
use crate::output::names;
use crate::threads::{self, Engine, Lender};
use parry_continuum::Chain;
use parry_continuum::parry::math::Pose;
use parry_continuum::proximity;
use pyo3::prelude::*;
use std::sync::Arc;

#[derive(Clone)]
pub(super) struct Structure {
    pub(super) name: String,
    pub(super) mesh: Arc<Py<Mesh>>,
    pub(super) margin: Option<f64>,
    /// The margins from single robots, in the order in which they were set.
    pub(super) margins_between: Vec<(usize, Option<f64>)>,
    pub(super) solid: bool,
    pub(super) pose: Pose,
    /// The pose as it was given.
    pub(super) matrix: Option<[f64; 16]>,
}

/// The structures at the time of a question.
pub(super) struct Snapshot {
    pub(super) structures: Vec<(Structure, Arc<Engine>)>,
    pub(super) robot_margin: Option<f64>,
    pub(super) self_margin: Option<f64>,
    pub(super) self_arc: Option<f64>,
    pub(super) nested: Vec<[usize; 2]>,
}

pub(super) struct Session {
    pub(super) scene: proximity::Scene,
    /// Of each structure's engine, which is in use as long as they are lent.
    pub(super) lent: Vec<threads::Session>,
    pub(super) chains: Vec<Option<Chain>>,
}

impl Lender for Snapshot {
    type Session = Session;

    fn lend(&self, py: Python<'_>) -> PyResult<Session> {
        let lent = self
            .structures
            .iter()
            .map(|(_, engine)| engine.lend(py))
            .collect::<PyResult<Vec<_>>>()?;
        let mut scene = proximity::Scene::new();
        let mut build = || -> Result<(), Refused> {
            for (number, ((it, _), session)) in self.structures.iter().zip(&lent).enumerate() {
                scene.add(it.name.clone(), session.search.clone(), it.margin)?;
                scene.set_pose(number, &it.pose)?;
                for &(robot, margin) in &it.margins_between {
                    scene.set_margin_between(number, robot, margin)?;
                }
                if it.solid {
                    scene.set_solid(number, true)?;
                }
            }
            scene.set_nested(&self.nested);
            scene.set_self_margin(self.self_margin)?;
            scene.set_self_arc(self.self_arc)?;
            Ok(scene.set_robot_margin(self.robot_margin)?)
        };
        build().map_err(|refused| refused.raise(py, None))?;
        Ok(Session { scene, lent, chains: Vec::new() })
    }

    fn take_back(&self, py: Python<'_>, lent: usize, sessions: impl IntoIterator<Item = Session>) {
        let mut free: Vec<Vec<threads::Session>> =
            self.structures.iter().map(|_| Vec::new()).collect();
        for session in sessions {
            session.lent.into_iter().zip(&mut free).for_each(|(session, free)| free.push(session));
        }
        for ((_, engine), free) in self.structures.iter().zip(free) {
            engine.take_back(py, lent, free);
        }
    }
}

impl Snapshot {
    /// The names of structures; an empty name for -1.
    pub(super) fn names<'py>(
        &self,
        py: Python<'py>,
        shape: &[usize],
        structures: impl Iterator<Item = i64>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let name = |number: i64| {
            let structure = usize::try_from(number).ok().and_then(|it| self.structures.get(it));
            structure.map_or("", |(structure, _)| structure.name.as_str())
        };
        names(py, shape, structures.map(name).collect())
    }
}
