//! What queries about two robots keep between them.

use crate::error::Refused;
use crate::input::{Caps, Given};
use crate::queries::chains::set_chain;
use crate::threads::{Held, Lender};
use parry_continuum::Chain;
use parry_continuum::parry::math::{Pose, Vector};
use parry_continuum::proximity::{self, RobotProximity};
use pyo3::prelude::*;

/// Sessions that no query uses now. They need no mesh.
pub(super) struct Sessions<S>(Held<Vec<S>>);

impl<S> Default for Sessions<S> {
    fn default() -> Self {
        Self(Held::new(Vec::new()))
    }
}

impl<S> Sessions<S> {
    /// Drops all warm starts.
    pub(super) fn forget(&self, py: Python<'_>) {
        let sessions = self.0.with(py, std::mem::take);
        drop(sessions); // not under the lock
    }
}

impl<S: Default + Send> Lender for Sessions<S> {
    type Session = S;

    fn lend(&self, py: Python<'_>) -> PyResult<S> {
        Ok(self.0.with(py, Vec::pop).unwrap_or_default())
    }

    fn take_back(&self, py: Python<'_>, _: usize, sessions: impl IntoIterator<Item = S>) {
        self.0.with(py, |free| free.extend(sessions));
    }
}

/// Sessions of queries about two robots.
pub(super) type Pairs = Sessions<Session>;

#[derive(Default)]
pub(super) struct Session {
    pub(super) pair: proximity::RobotPair,
    pub(super) chains: [Option<Chain>; 2],
    pub(super) found: Vec<RobotProximity>,
}

/// Two robots in the chains of a session: the object that answers, the robots' poses and points,
/// and memory for the answers.
pub(super) struct Placed<'a> {
    pub(super) pair: &'a mut proximity::RobotPair,
    pub(super) chains: [&'a Chain; 2],
    pub(super) poses: [Pose; 2],
    pub(super) points: [&'a [Vector]; 2],
    pub(super) found: &'a mut Vec<RobotProximity>,
}

impl Session {
    pub(super) fn place<'a>(
        &'a mut self,
        robot: &Given<'a>,
        caps: Caps,
    ) -> Result<Placed<'a>, Refused> {
        let other = second(robot)?;
        let Self { pair, chains: [one, two], found } = self;
        let chains = [set_chain(one, robot, caps)?, set_chain(two, &other, caps)?];
        let (poses, points) = ([robot.pose()?, other.pose()?], [robot.points, other.points]);
        Ok(Placed { pair, chains, poses, points, found })
    }
}

/// The second robot of a pair.
pub(super) fn second<'a>(robot: &Given<'a>) -> Result<Given<'a>, Refused> {
    robot.other().ok_or_else(|| {
        Refused::other(
            "defect",
            "a pair has one robot; this is a defect of parry-continuum, please report it",
        )
    })
}
