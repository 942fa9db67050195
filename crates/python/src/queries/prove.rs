//! Proofs that travel: texts that a short program checks without this library.

use super::chains::set_chain;
use super::clearance::{Stated, tubes};
use super::way::{Arguments, Question};
use crate::error::Refused;
use crate::input::{Caps, Given, Robots, of};
use crate::mesh::Mesh;
use crate::threads::{Session, ask_each};
use parry_continuum::Motion;
use parry_continuum::proximity::{Proof, ProximityError};
use pyo3::prelude::*;

/// Proofs are about one robot each.
fn one(py: Python<'_>, count: Option<usize>) -> PyResult<()> {
    match count {
        None => Ok(()),
        Some(count) => {
            let text = format!(
                "a proof is about one robot or motion, and {count} are given; give them one by one"
            );
            Err(Refused::other("bad_shape", text).raise(py, None))
        }
    }
}

fn text(proof: Option<Proof>) -> Option<String> {
    proof.map(|proof| proof.to_string())
}

impl Mesh {
    /// Asks for the proof about one robot.
    fn prove_one<'py>(
        &self,
        py: Python<'py>,
        robots: &Robots<'py>,
        ask: impl Fn(&mut Session, &Given<'_>) -> Result<Option<Proof>, Refused> + Sync,
    ) -> PyResult<Option<String>> {
        one(py, robots.count)?;
        let mut proof = None;
        let ask = |session: &mut Session, robot: &Given<'_>, row: &mut [Option<Proof>]| {
            row[0] = ask(session, robot)?;
            Ok(())
        };
        ask_each(py, &self.engine(py), robots, (None, 1), ask, |_, found| {
            proof = found[0].clone()
        })?;
        Ok(text(proof))
    }
}

struct Proves {
    margin: f64,
    resolution: f64,
}

impl Question<Option<Proof>> for Proves {
    fn ask(
        &self,
        session: &mut Session,
        motion: &impl Motion,
    ) -> Result<Option<Proof>, ProximityError> {
        session.search.prove_motion(motion, self.margin, self.resolution)
    }
}

#[pymethods]
impl Mesh {
    /// A proof that a robot keeps more than a margin away, for those who do not trust this library:
    /// a text that a short program in plain Python checks, ``docs/book/check_proof.py`` in the
    /// repository. The page on proofs in the same folder explains the meaning of a proof.
    ///
    /// The proof does not say on which side of the wall the robot is: `side` answers that.
    ///
    /// The program reads the mesh as an OBJ file with the vertices and triangles that the mesh has
    /// here, in its order.
    ///
    /// Parameters
    /// ----------
    /// points, radii, pose, caps
    ///     As for `distance`, of one robot.
    /// margin : float
    ///     A length, at least 0.
    ///
    /// Returns
    /// -------
    /// str or None
    ///     None if the robot does not keep the margin, or exceeds it by at most rounding.
    ///
    /// Raises
    /// ------
    /// ContinuumError
    ///     The margin is negative or NaN, more than one robot is given, or as for `distance`.
    ///
    /// Examples
    /// --------
    /// >>> from parry_continuum import Mesh
    /// >>> floor = Mesh([[-9, -9, 0], [9, -9, 0], [0, 9, 0]], [[0, 1, 2]])
    /// >>> proof = floor.prove([[0, 0, 2], [1, 0, 2]], 0.5, margin=1)
    /// >>> proof.splitlines()[0]
    /// 'proof of clearance 2'
    /// >>> floor.prove([[0, 0, 2], [1, 0, 2]], 0.5, margin=2) is None
    /// True
    /// >>> obj = [f"v {x!r} {y!r} {z!r}" for x, y, z in floor.vertices.tolist()]
    /// >>> obj += [f"f {a + 1} {b + 1} {c + 1}" for a, b, c in floor.faces.tolist()]
    #[pyo3(signature = (points, radii, *, margin, pose = None, caps = Caps::Fitted), text_signature = "($self, points, radii, *, margin, pose=None, caps=\"fitted\")")]
    fn prove<'py>(
        &self,
        py: Python<'py>,
        points: &Bound<'py, PyAny>,
        radii: &Bound<'py, PyAny>,
        #[pyo3(from_py_with = of::margin)] margin: f64,
        pose: Option<&Bound<'py, PyAny>>,
        caps: Caps,
    ) -> PyResult<Option<String>> {
        self.prove_one(py, &self.robots(points, radii, pose)?, |session, robot| {
            let chain = set_chain(&mut session.chain, robot, caps)?;
            Ok(session.search.prove(chain, &robot.pose()?, margin)?)
        })
    }

    /// The same for a curved tube. What the proof takes for granted of the curve is printed by the
    /// program that checks it: points, and how long and how bent it is between them at most.
    ///
    /// Parameters
    /// ----------
    /// points, radii, pose
    ///     As for `distance`, of one robot.
    /// margin : float
    ///     A length, at least 0.
    /// resolution : float
    ///     How near to the margin a proof may be missed, at least 0.
    /// tangents, deviation, turn
    ///     As for `clearance`.
    ///
    /// Returns
    /// -------
    /// str or None
    ///     None if the tube does not keep the margin, or exceeds it by at most the resolution.
    ///
    /// Raises
    /// ------
    /// ContinuumError
    ///     More than one robot is given, or as for `clears_tube`.
    #[pyo3(signature = (points, radii, *, margin, resolution, tangents = None, deviation = 0.0, turn = None, pose = None))]
    #[allow(clippy::too_many_arguments)] // they are named in Python
    fn prove_tube<'py>(
        &self,
        py: Python<'py>,
        points: &Bound<'py, PyAny>,
        radii: &Bound<'py, PyAny>,
        #[pyo3(from_py_with = of::margin)] margin: f64,
        #[pyo3(from_py_with = of::resolution)] resolution: f64,
        tangents: Option<&Bound<'py, PyAny>>,
        #[pyo3(from_py_with = of::deviation)] deviation: f64,
        #[pyo3(from_py_with = of::optional::turn)] turn: Option<f64>,
        pose: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Option<String>> {
        let stated = Stated { deviation, turn };
        let robots = tubes(self.robots(points, radii, pose)?, "tangents", tangents, stated)?;
        self.prove_one(py, &robots, |session, robot| {
            let tube = super::clearance::tube(robot, stated)?;
            Ok(session.search.prove_tube(&tube, &robot.pose()?, margin, resolution)?)
        })
    }

    /// The same for a motion: the proof that the robot keeps more than the margin away at every
    /// time from 0 to 1. The speeds of the motion are taken for granted, and printed.
    ///
    /// Parameters
    /// ----------
    /// start, end, radii, margin, resolution, caps
    ///     As for `clears_motion`, of one motion.
    ///
    /// Returns
    /// -------
    /// str or None
    ///     None if some shape does not keep the margin, or keeps it by at most about the
    ///     resolution, or if 65,536 shapes do not prove it, or if the proof would be longer than
    ///     16 MiB.
    ///
    /// Raises
    /// ------
    /// ContinuumError
    ///     More than one motion is given, or as for `clears_motion`.
    ///
    /// Examples
    /// --------
    /// >>> import numpy as np
    /// >>> from parry_continuum import Mesh, RigidMotion
    /// >>> floor = Mesh([[-9, -9, 0], [9, -9, 0], [0, 9, 0]], [[0, 1, 2]])
    /// >>> down = np.eye(4) - np.outer([0, 0, 1, 0], [0, 0, 0, 1])
    /// >>> motion = RigidMotion([[0, 0, 5], [4, 0, 5]], 0.5, np.eye(4), down)
    /// >>> floor.prove_motion(motion, margin=3, resolution=0.01).splitlines()[2]
    /// 'margin 3.0'
    #[pyo3(signature = (start, end = None, radii = None, *, margin, resolution, caps = None), text_signature = "($self, start, end=None, radii=None, *, margin, resolution, caps=\"fitted\")")]
    #[allow(clippy::too_many_arguments)] // they are named in Python
    fn prove_motion<'py>(
        &self,
        py: Python<'py>,
        start: &Bound<'py, PyAny>,
        end: Option<&Bound<'py, PyAny>>,
        radii: Option<&Bound<'py, PyAny>>,
        #[pyo3(from_py_with = of::margin)] margin: f64,
        #[pyo3(from_py_with = of::resolution)] resolution: f64,
        caps: Option<Caps>,
    ) -> PyResult<Option<String>> {
        let way = self.way(&Arguments { start, end, radii, caps })?;
        one(py, way.count())?;
        let question = Proves { margin, resolution };
        Ok(text(way.ask(py, &self.engine(py), &question)?.into_iter().flatten().next()))
    }
}
