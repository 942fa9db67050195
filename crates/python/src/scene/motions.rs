//! Queries about robots that move in a scene.

use super::Scene;
use super::bounds::{Bounds, bounds};
use super::place::{Place, place_fields};
use super::snapshot::{Session, Snapshot};
use crate::error::Refused;
use crate::input::{check_length, is_bool, matrices, object_of, of, pose_if_one, vectors};
use crate::mesh::rows;
use crate::motions::{Motion, MotionList, Moving};
use crate::output::{
    Enumeration, answer, array, array_or_number, decision_value, members, reason_value, statuses,
};
use crate::threads::{Asked, answer_each_or_kind};
use parry_continuum::parry::math::{Pose, Vector};
use parry_continuum::proximity::{
    self, SceneError, SceneMotionAnswer, SceneMotionContact, StructureEnd,
};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};

/// Where a structure is at the end of a motion.
enum End {
    Pose(Pose),
    Vertices(Vec<Vector>),
}

impl Scene {
    /// The motions of a question, with the warning of their frames.
    fn motions(&self, py: Python<'_>, given: &[Bound<'_, Motion>]) -> PyResult<MotionList> {
        let made = MotionList::new(py, given)?;
        for (place, motion) in given.iter().enumerate() {
            self.note_frame(py, &format!("motions[{place}]"), motion.as_any())?;
        }
        let frames: Vec<_> = given.iter().map(|motion| motion.get().stated_frame()).collect();
        self.note_frames(py, "motions", &frames)?;
        self.note_robots(py, given.len())?;
        Ok(made)
    }

    /// Asks about each set of motions. One that is refused does not fail its batch.
    fn decide<'py>(
        &self,
        py: Python<'py>,
        motions: &[Bound<'py, Motion>],
        ask: impl Fn(&mut proximity::Scene, &[&Moving]) -> Result<SceneMotionAnswer, SceneError> + Sync,
    ) -> PyResult<Bound<'py, PyAny>> {
        let motions = self.motions(py, motions)?;
        let ask = |session: &mut Session, motions: &Vec<&Moving>| {
            ask(&mut session.scene, motions).map_err(of_motions)
        };
        let structures = self.snapshot(py);
        let all = answer_each_or_kind(py, &structures, &motions, ask)?;
        motion_answers(py, &motions, &structures, &all)
    }
}

#[pymethods]
impl Scene {
    /// Whether robots that move at the same time keep all margins, at every time from 0 to 1: from
    /// structures, from one another, and each from itself. A planner asks this for each edge.
    ///
    /// ``Decision.CLEAR`` is proven for every instant, from the speeds of the motions. The query
    /// tests robots against structures, beginning with the pairs that seem nearest. Then it tests
    /// pairs of robots, then each robot against itself, and returns the first contact that it
    /// finds. Another contact may be earlier in time: see `time_of_contact`. A set that is refused
    /// does not fail its batch: it is undecided, and its ``status`` is the ``kind`` of its error.
    ///
    /// Parameters
    /// ----------
    /// motions : list of Motion
    ///     A motion for each robot, in the scene's frame; each one motion or a batch of as many. A
    ///     robot at rest is a `RigidMotion` from a pose to the same pose.
    /// resolution : float
    ///     A length. The answer is undecided only if a distance is within the resolution of its
    ///     margin, if an end near a margin turns from flat to round, or if the query reaches a
    ///     limit of work. ``reason`` says which.
    ///
    /// Returns
    /// -------
    /// SceneMotionAnswer
    ///     The answer for one set of motions. For a batch, arrays with one entry per set.
    ///
    /// Raises
    /// ------
    /// ContinuumError
    ///     The list is empty, batches differ in size, nothing has a margin, or the resolution is
    ///     negative or NaN. Of one set: a shape is no robot, a robot bends too sharply for a margin
    ///     to itself, or the resolution is finer than rounding. The text names the robot.
    ///
    /// Examples
    /// --------
    /// >>> import numpy as np
    /// >>> from parry_continuum import LinearMotion, Mesh, Scene
    /// >>> floor = Mesh([[-9, -9, 0], [9, -9, 0], [0, 9, 0]], [[0, 1, 2]])
    /// >>> scene = Scene(robot_margin=0.5)
    /// >>> scene.add("floor", floor, margin=1.0)
    /// 0
    /// >>> high = np.array([[0, 0, 4], [1, 0, 4]])
    /// >>> falls = LinearMotion(high, high - [0, 0, 3], 0.2)
    /// >>> waits = LinearMotion(high + 2, high + 2, 0.2)
    /// >>> found = scene.clears_motion([falls, waits], resolution=1e-3)
    /// >>> found.decision, found.structure, found.robots
    /// (<Decision.CONTACT: -1>, 0, array([ 0, -1]))
    /// >>> scene.clears_motion([waits], resolution=1e-3).is_clear
    /// True
    #[pyo3(signature = (motions, *, resolution))]
    fn clears_motion<'py>(
        &self,
        py: Python<'py>,
        #[pyo3(from_py_with = object_of::motions)] motions: Vec<Bound<'py, Motion>>,
        #[pyo3(from_py_with = of::resolution)] resolution: f64,
    ) -> PyResult<Bound<'py, PyAny>> {
        check_length(py, "resolution", resolution)?;
        self.decide(py, &motions, |scene, motions| scene.clears_motion(motions, resolution))
    }

    /// When moving robots first violate a margin.
    ///
    /// All margins are kept until ``interval[0]``, which is proven, and one is not kept at
    /// ``interval[1]``. The contact is the earliest of all.
    ///
    /// Parameters
    /// ----------
    /// motions, resolution
    ///     As for `clears_motion`.
    ///
    /// Returns
    /// -------
    /// SceneMotionAnswer
    ///
    /// Raises
    /// ------
    /// ContinuumError
    ///     As for `clears_motion`.
    #[pyo3(signature = (motions, *, resolution))]
    fn time_of_contact<'py>(
        &self,
        py: Python<'py>,
        #[pyo3(from_py_with = object_of::motions)] motions: Vec<Bound<'py, Motion>>,
        #[pyo3(from_py_with = of::resolution)] resolution: f64,
    ) -> PyResult<Bound<'py, PyAny>> {
        check_length(py, "resolution", resolution)?;
        self.decide(py, &motions, |scene, motions| scene.time_of_contact(motions, resolution))
    }

    /// `clears_motion` while structures move, too.
    ///
    /// The meshes stay where they are.
    ///
    /// Parameters
    /// ----------
    /// ends : dict of int to array
    ///     For the number of a structure, where it is at the time 1: a pose, (4, 4), from its
    ///     mesh's frame to the scene's, or its vertices, (V, 3), in the mesh's frame. With a pose
    ///     it moves as a whole, straight and evenly, and turns evenly by the smaller angle. With
    ///     vertices each vertex moves straight and evenly. Other structures rest.
    /// motions, resolution
    ///     As for `clears_motion`.
    ///
    /// Returns
    /// -------
    /// SceneMotionAnswer
    ///     The points of a contact are those at its time.
    ///
    /// Raises
    /// ------
    /// ContinuumError
    ///     There is no such structure, a pose is not rigid, the number of vertices differs, or as
    ///     for `clears_motion`.
    ///
    /// Examples
    /// --------
    /// >>> import numpy as np
    /// >>> from parry_continuum import Mesh, RigidMotion, Scene
    /// >>> floor = Mesh([[-9, -9, 0], [9, -9, 0], [0, 9, 0]], [[0, 1, 2]])
    /// >>> scene = Scene()
    /// >>> scene.add("floor", floor, margin=1.0)
    /// 0
    /// >>> waits = RigidMotion([[0, 0, 5], [1, 0, 5]], 0.5, np.eye(4), np.eye(4))
    /// >>> risen = np.eye(4)
    /// >>> risen[2, 3] = 3.0
    /// >>> scene.clears_motion_while({0: risen}, [waits], resolution=1e-3).is_clear
    /// True
    /// >>> moved = floor.vertices + [0, 0, 4]
    /// >>> scene.clears_motion_while({0: moved}, [waits], resolution=1e-3).is_clear
    /// False
    #[pyo3(signature = (ends, motions, *, resolution))]
    fn clears_motion_while<'py>(
        &self,
        py: Python<'py>,
        #[pyo3(from_py_with = object_of::ends)] ends: Bound<'py, PyDict>,
        #[pyo3(from_py_with = object_of::motions)] motions: Vec<Bound<'py, Motion>>,
        #[pyo3(from_py_with = of::resolution)] resolution: f64,
    ) -> PyResult<Bound<'py, PyAny>> {
        check_length(py, "resolution", resolution)?;
        let ends: Vec<(usize, End)> =
            ends.iter().map(|(number, end)| self.end(&number, &end)).collect::<PyResult<_>>()?;
        self.decide(py, &motions, |scene, motions| {
            let ends = ends.iter().map(|(number, end)| {
                let end = match end {
                    End::Pose(pose) => StructureEnd::Pose(*pose),
                    End::Vertices(to) => StructureEnd::Vertices(to),
                };
                (*number, end)
            });
            scene.clears_motion_while(&ends.collect::<Vec<_>>(), motions, resolution)
        })
    }

    /// The least slack of moving robots, between proven bounds, and when: of the robots and the
    /// structures with a margin, and between robots.
    ///
    /// The slack is the clearance minus the margin. A set that is refused does not fail its batch:
    /// its bounds are NaN, and its ``status`` is the ``kind`` of its error.
    ///
    /// Parameters
    /// ----------
    /// motions
    ///     As for `clears_motion`.
    /// tolerance : float
    ///     How far apart the bounds may be, at least 0.
    ///
    /// Returns
    /// -------
    /// SceneMotionClearance
    ///     The answer for one set of motions. For a batch, arrays with one entry per set.
    ///
    /// Raises
    /// ------
    /// ContinuumError
    ///     The list is empty, batches differ in size, or the tolerance is negative or NaN. Of one
    ///     set: a shape is no robot.
    ///
    /// Examples
    /// --------
    /// >>> import numpy as np
    /// >>> from parry_continuum import LinearMotion, Mesh, Scene
    /// >>> floor = Mesh([[-9, -9, 0], [9, -9, 0], [0, 9, 0]], [[0, 1, 2]])
    /// >>> scene = Scene()
    /// >>> scene.add("floor", floor, margin=1.0)
    /// 0
    /// >>> high = np.array([[0, 0, 4], [1, 0, 4]])
    /// >>> falls = LinearMotion(high, high - [0, 0, 2], 0.5)
    /// >>> found = scene.clearance_of_motion([falls], tolerance=0.01)
    /// >>> bool(found.lower <= 0.5 <= found.upper), bool(found.t > 0.99)
    /// (True, True)
    #[pyo3(signature = (motions, *, tolerance))]
    fn clearance_of_motion<'py>(
        &self,
        py: Python<'py>,
        #[pyo3(from_py_with = object_of::motions)] motions: Vec<Bound<'py, Motion>>,
        #[pyo3(from_py_with = of::tolerance)] tolerance: f64,
    ) -> PyResult<Bound<'py, PyAny>> {
        check_length(py, "tolerance", tolerance)?;
        let motions = self.motions(py, &motions)?;
        let ask = |session: &mut Session, motions: &Vec<&Moving>| {
            let found = session.scene.clearance_of_motion(motions, tolerance);
            let found = found.map_err(of_motions)?;
            Ok(found.map_or(Bounds::WITHOUT_MARGIN, Bounds::of_motion))
        };
        let structures = self.snapshot(py);
        let all = answer_each_or_kind(py, &structures, &motions, ask)?;
        bounds(py, &motions, &structures, &all, true)
    }
}

impl Scene {
    /// The end of a structure: a pose, or the vertices of its mesh.
    fn end(&self, number: &Bound<'_, PyAny>, end: &Bound<'_, PyAny>) -> PyResult<(usize, End)> {
        let py = number.py();
        let structure = if is_bool(number)? { None } else { number.extract::<usize>().ok() };
        let Some(structure) = structure else {
            let text = format!(
                "`ends` has the key {}; give the numbers that `add` returned",
                number.repr()?
            );
            return Err(Refused::other("bad_type", text).raise(py, None));
        };
        let name = format!("ends[{structure}]");
        let end = match pose_if_one(py, &matrices(end, &name)?, &name)? {
            Some((pose, _)) => End::Pose(pose),
            None => End::Vertices(vectors(rows(end, &name)?.points())),
        };
        Ok((structure, end))
    }
}

/// The error of a query whose robots are the entries of `motions`.
fn of_motions(error: SceneError) -> Refused {
    Refused::of_scene(error, "motions")
}

fn place_of(contact: &SceneMotionContact) -> Place {
    match contact {
        SceneMotionContact::Structure { structure, robot, shape, .. } => {
            Place::at_structure(*structure, *robot, &shape.witness)
        }
        SceneMotionContact::Robots { robots, shapes, .. } => {
            Place::between_robots(*robots, &shapes.witness)
        }
        SceneMotionContact::Itself { robot, shapes, .. } => {
            Place::between_robots([*robot; 2], &shapes.witness)
        }
        _ => Place::NONE,
    }
}

fn motion_answers<'py>(
    py: Python<'py>,
    asked: &impl Asked,
    structures: &Snapshot,
    all: &[Result<SceneMotionAnswer, &'static str>],
) -> PyResult<Bound<'py, PyAny>> {
    let contacts: Vec<_> = all.iter().map(|it| it.ok().and_then(|it| it.contact)).collect();
    let numbers = |of: fn(&SceneMotionContact) -> f64| {
        let numbers = contacts.iter().map(|it| it.as_ref().map_or(f64::NAN, of));
        array_or_number(py, asked.shape(&[]), numbers.collect())
    };
    let decisions = all.iter().map(|it| it.map_or(0, |it| decision_value(it.decision))).collect();
    let reasons = all.iter().map(|it| reason_value(it.ok().and_then(|it| it.reason))).collect();
    let intervals = all.iter().flat_map(|it| it.map_or([0.0, 1.0], |it| it.interval)).collect();
    let places: Vec<_> =
        contacts.iter().map(|it| it.as_ref().map_or(Place::NONE, place_of)).collect();
    let mut values = vec![
        members(py, Enumeration::Decision, asked.shape(&[]), decisions)?,
        array(py, asked.shape(&[2]), intervals)?.into_any(),
        numbers(SceneMotionContact::t)?,
        numbers(SceneMotionContact::upper)?,
    ];
    values.extend(place_fields(py, asked, structures, &places)?);
    values.push(members(py, Enumeration::UndecidedReason, asked.shape(&[]), reasons)?);
    values.push(statuses(py, all, asked.count().is_some())?);
    answer!(py, "SceneMotionAnswer", PyTuple::new(py, values)?)
}
