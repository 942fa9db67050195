//! The class `Scene`: several meshes with margins, and several robots.

mod answers;
mod bounds;
mod motions;
mod place;
mod robots;
mod snapshot;
mod tubes;

use crate::error::Refused;
use crate::input::{
    Caps, Given, HasWarned, Robots, check_length, matrices, object_of, of, places, pose_if_one,
    shape_text, stated_frame,
};
use crate::mesh::Mesh;
use crate::output::{array, array_or_number};
use crate::threads::{Asked, Held, ask_each};
use answers::{NOTHING, Row, contacts, per_structure, tightest};
use mesh_files::Frame;
use parry_continuum::parry::math::Pose;
use parry_continuum::proximity::{self, SceneContact, SceneError, StructureProximity};
use pyo3::prelude::*;
use pyo3::types::PyTuple;
use robots::place;
use snapshot::{Session, Snapshot, Structure};
use std::sync::Arc;

/// Several meshes, the structures, each with a margin of its own or none, and robots among them.
///
/// A structure is a `Mesh`: where that moves, the structure has moved for all queries that begin
/// later. Robots are a list, each ``(points, radii)`` or ``(points, radii, pose)``; each is one
/// shape or a batch of as many. A scene can be copied, with the same meshes, and pickled.
///
/// Parameters
/// ----------
/// robot_margin : float, optional
///     The distance that robots keep from one another. Without it the scene does not compare robots
///     with one another, and warns once if a query has several.
/// self_margin : float, optional
///     The distance that each robot keeps from itself, as for `SelfQuery`. `clears`, `clears_tube`
///     and `clears_motion` test it.
/// self_arc : float, optional
///     With it, `self_margin` is the distance of places at least `self_arc` apart along the robot,
///     as for `SelfQuery.clears_beyond`. Without it, `self_margin` is the distance of parts that
///     come near each other, as for `SelfQuery.clears`. Motions need the latter.
/// nested : sequence of (int, int), optional
///     Pairs of robots where one is inside the other, as a tube in the tube that guides it. Such
///     robots touch, and the scene does not compare them with one another. The numbers are the
///     places of two robots in the list of robots.
///
/// Raises
/// ------
/// ContinuumError
///     A margin or `self_arc` is negative or NaN, or a robot is nested in itself.
///
/// Examples
/// --------
/// >>> from parry_continuum import Mesh, Scene
/// >>> floor = Mesh([[-9, -9, 0], [9, -9, 0], [0, 9, 0]], [[0, 1, 2]])
/// >>> scene = Scene()
/// >>> scene.add("floor", floor, margin=1.0)
/// 0
/// >>> robot = [[0, 0, 2], [1, 0, 2]]
/// >>> scene.clears([(robot, 0.5)]), scene.tightest([(robot, 0.5)]).slack
/// (True, 0.5)
#[pyclass(frozen, module = "parry_continuum", weakref)]
pub(crate) struct Scene {
    structures: Held<Vec<Structure>>,
    robot_margin: Option<f64>,
    self_margin: Option<f64>,
    self_arc: Option<f64>,
    nested: Vec<[usize; 2]>,
    /// Whether it has warned of robots in different frames.
    has_warned: HasWarned,
    /// Whether it has warned of robots that it does not compare.
    has_warned_of_robots: HasWarned,
}

impl Scene {
    /// Warns once if a query has robots that are not compared with one another.
    fn note_robots(&self, py: Python<'_>, count: usize) -> PyResult<()> {
        let is_nested =
            |pair: [usize; 2]| self.nested.iter().any(|&[a, b]| [a.min(b), a.max(b)] == pair);
        let mut pairs = (0..count).flat_map(|b| (0..b).map(move |a| [a, b]));
        if self.robot_margin.is_none()
            && let Some([a, b]) = pairs.find(|pair| !is_nested(*pair))
        {
            let text = format!(
                "the scene has no `robot_margin`, so robots {a} and {b} are not compared with each other; give `robot_margin`, or \
                 `nested` if one is inside the other"
            );
            self.has_warned_of_robots.warn(py, &text)?;
        }
        Ok(())
    }

    /// The robots of a query that compares them with one another.
    fn robots_apart<'py>(
        &self,
        py: Python<'py>,
        given: Vec<Bound<'py, PyAny>>,
    ) -> PyResult<Robots<'py>> {
        let count = given.len();
        let made = self.robots(py, given)?;
        self.note_robots(py, count)?;
        Ok(made)
    }

    /// The robots of a question. A mesh in the scene's own frame warns once if points without a
    /// pose state another frame.
    fn robots<'py>(&self, py: Python<'py>, given: Vec<Bound<'py, PyAny>>) -> PyResult<Robots<'py>> {
        let made = robots::robots(py, &given)?;
        let points: Vec<_> = given.iter().map(robots::points_without_pose).collect();
        for points in points.iter().flatten() {
            self.note_frame(py, "points", points)?;
        }
        let frame =
            |points: &Option<Bound<'py, PyAny>>| points.as_ref().map_or(Ok(None), stated_frame);
        let frames = points.iter().map(frame).collect::<PyResult<Vec<_>>>()?;
        self.note_frames(py, "robots", &frames)?;
        Ok(made)
    }

    /// Warns once if robots of a list, or motions, state different frames.
    fn note_frames(&self, py: Python<'_>, list: &str, frames: &[Option<Frame>]) -> PyResult<()> {
        let Some(first) = frames.iter().position(Option::is_some) else { return Ok(()) };
        for (place, frame) in frames.iter().enumerate().skip(first + 1) {
            let names = [format!("{list}[{first}]"), format!("{list}[{place}]")];
            let names = [names[0].as_str(), names[1].as_str()];
            self.has_warned.note_pair(py, names, [frames[first], *frame])?;
        }
        Ok(())
    }

    /// A mesh in the scene's own frame warns once if points or a motion state another frame.
    fn note_frame(&self, py: Python<'_>, name: &str, given: &Bound<'_, PyAny>) -> PyResult<()> {
        if stated_frame(given)?.is_none() {
            return Ok(());
        }
        let meshes: Vec<Arc<Py<Mesh>>> = self.structures.with(py, |structures| {
            let in_place = structures.iter().filter(|it| it.matrix.is_none());
            in_place.map(|it| Arc::clone(&it.mesh)).collect()
        });
        meshes.iter().try_for_each(|mesh| mesh.get().note_frame(name, given))
    }

    fn snapshot(&self, py: Python<'_>) -> Snapshot {
        let structures = self.structures.with(py, |structures| structures.clone());
        let engines = structures.into_iter().map(|it| {
            let engine = it.mesh.get().engine(py);
            (it, engine)
        });
        Snapshot {
            structures: engines.collect(),
            robot_margin: self.robot_margin,
            self_margin: self.self_margin,
            self_arc: self.self_arc,
            nested: self.nested.clone(),
        }
    }
}

#[pymethods]
impl Scene {
    #[new]
    #[pyo3(signature = (*, robot_margin = None, self_margin = None, self_arc = None, nested = Vec::new()), text_signature = "(*, robot_margin=None, self_margin=None, self_arc=None, nested=())")]
    fn new(
        py: Python<'_>,
        #[pyo3(from_py_with = of::optional::robot_margin)] robot_margin: Option<f64>,
        #[pyo3(from_py_with = of::optional::self_margin)] self_margin: Option<f64>,
        #[pyo3(from_py_with = of::optional::self_arc)] self_arc: Option<f64>,
        #[pyo3(from_py_with = places)] nested: Vec<[usize; 2]>,
    ) -> PyResult<Self> {
        check_length(py, "robot_margin", robot_margin)?;
        check_length(py, "self_margin", self_margin)?;
        check_length(py, "self_arc", self_arc)?;
        Ok(Self {
            structures: Held::new(Vec::new()),
            robot_margin,
            self_margin,
            self_arc,
            nested,
            has_warned: HasWarned::default(),
            has_warned_of_robots: HasWarned::default(),
        })
    }

    /// Adds a structure, and returns its number: structures count from 0. Warns if its mesh and an
    /// earlier one state different frames, and neither has a pose.
    ///
    /// Parameters
    /// ----------
    /// name : str
    ///     For answers and messages. Each structure has its own.
    /// mesh : Mesh
    /// margin : float or None
    ///     The distance that robots keep from it. A structure with None may be touched, such as a
    ///     target: `per_structure` and `contacts_within` measure it, and the others ignore it.
    /// pose : (4, 4) array, optional
    ///     From the mesh's frame to the scene's.
    /// solid : bool
    ///     Whether a robot inside is in contact, at the distance 0. Without it, a mesh is a surface
    ///     that a robot may be inside of. `contacts_within` takes each structure as a surface.
    ///
    /// Raises
    /// ------
    /// ContinuumError
    ///     The name is taken, the margin is negative or NaN, the pose is not rigid, or the
    ///     structure is solid and its mesh is open. If the mesh opens later, queries raise that.
    ///
    /// Examples
    /// --------
    /// >>> from parry_continuum import Mesh, Scene
    /// >>> corners = [[x, y, z] for x in (0, 9) for y in (0, 9) for z in (0, 9)]
    /// >>> faces = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
    /// >>> box = Mesh(corners, [[a, b, c] for p, q, r, s in faces for a, b, c in ((p, q, r), (p, r, s))])
    /// >>> scene = Scene()
    /// >>> scene.add("table", box, margin=1.0, solid=True)
    /// 0
    /// >>> inside = [[4, 4, 4], [5, 4, 4]]
    /// >>> scene.tightest([(inside, 0.5)])[:4]
    /// (-1.0, 0.0, 0, 'table')
    #[pyo3(signature = (name, mesh, *, margin, pose = None, solid = false))]
    fn add(
        &self,
        py: Python<'_>,
        #[pyo3(from_py_with = object_of::name)] name: String,
        #[pyo3(from_py_with = object_of::mesh)] mesh: Py<Mesh>,
        #[pyo3(from_py_with = of::optional::margin)] margin: Option<f64>,
        pose: Option<&Bound<'_, PyAny>>,
        solid: bool,
    ) -> PyResult<usize> {
        check_length(py, "margin", margin)?;
        let (pose, matrix) = match pose {
            None => (Pose::IDENTITY, None),
            Some(pose) => {
                let numbers = matrices(pose, "pose")?;
                let Some((pose, matrix)) = pose_if_one(py, &numbers, "pose")? else {
                    let text = format!(
                        "`pose` has the shape {}; give None, or the shape (4, 4)",
                        shape_text(numbers.shape())
                    );
                    return Err(Refused::other("bad_shape", text).raise(py, None));
                };
                (pose, Some(matrix))
            }
        };
        // A pose leads into the scene's frame.
        if let (None, Some(frame)) = (&matrix, mesh.get().stated_frame()) {
            let before = self.structures.with(py, |structures| {
                let at_rest = structures.iter().filter(|structure| structure.matrix.is_none());
                let mut stated = at_rest.map(|it| (it.name.clone(), it.mesh.get().stated_frame()));
                stated.find(|(_, frame)| frame.is_some())
            });
            if let Some((first, other)) = before {
                HasWarned::default().note_pair(py, [&name, &first], [Some(frame), other])?;
            }
        }
        if solid {
            // The same check as in a query: the errors are the same.
            let mut alone = proximity::Scene::new();
            let checked = alone
                .add(name.clone(), mesh.get().engine(py).base(py), None)
                .and_then(|structure| alone.set_solid(structure, true));
            checked.map_err(|error| Refused::from(error).raise(py, None))?;
        }
        let mesh = Arc::new(mesh);
        let margins_between = Vec::new();
        let structure = Structure { name, mesh, margin, margins_between, solid, pose, matrix };
        let added = self.structures.with(py, |structures| {
            if let Some(taken) = structures.iter().position(|it| it.name == structure.name) {
                return Err(SceneError::NameTaken { name: structure.name, structure: taken });
            }
            structures.push(structure);
            Ok(structures.len() - 1)
        });
        added.map_err(|error| Refused::from(error).raise(py, None))
    }

    /// Sets the margin between a structure and one robot, in place of the structure's margin.
    ///
    /// Parameters
    /// ----------
    /// structure : int
    ///     The number that `add` returned.
    /// robot : int
    ///     The place of the robot in the list of robots.
    /// margin : float or None
    ///     With None, the two may touch.
    ///
    /// Raises
    /// ------
    /// ContinuumError
    ///     There is no such structure, or the margin is negative or NaN.
    ///
    /// Examples
    /// --------
    /// >>> from parry_continuum import Mesh, Scene
    /// >>> target = Mesh([[-9, -9, 0], [9, -9, 0], [0, 9, 0]], [[0, 1, 2]])
    /// >>> scene = Scene(robot_margin=1.0)
    /// >>> number = scene.add("target", target, margin=5.0)
    /// >>> scene.set_margin_between(number, 0, margin=None)
    /// >>> needle, probe = ([[0, 0, 0], [0, 0, 9]], 0.5), ([[4, 0, 7], [4, 0, 9]], 0.5)
    /// >>> scene.clears([needle, probe]), scene.clears([probe, needle])
    /// (True, False)
    #[pyo3(signature = (structure, robot, *, margin))]
    fn set_margin_between(
        &self,
        py: Python<'_>,
        #[pyo3(from_py_with = of::structure)] structure: u32,
        #[pyo3(from_py_with = of::robot)] robot: u32,
        #[pyo3(from_py_with = of::optional::margin)] margin: Option<f64>,
    ) -> PyResult<()> {
        check_length(py, "margin", margin)?;
        let set = self.structures.with(py, |structures| {
            let (structure, count) = (structure as usize, structures.len());
            let known = structures
                .get_mut(structure)
                .ok_or(SceneError::NoSuchStructure { structure, structures: count })?;
            known.margins_between.retain(|(other, _)| *other != robot as usize);
            known.margins_between.push((robot as usize, margin));
            Ok::<_, SceneError>(())
        });
        set.map_err(|error| Refused::from(error).raise(py, None))
    }

    /// A scene with the same meshes: where one of them moves, it has moved in both.
    fn __copy__(&self, py: Python<'_>) -> Self {
        let structures = self.structures.with(py, |structures| structures.clone());
        Self {
            structures: Held::new(structures),
            robot_margin: self.robot_margin,
            self_margin: self.self_margin,
            self_arc: self.self_arc,
            nested: self.nested.clone(),
            has_warned: HasWarned::default(),
            has_warned_of_robots: HasWarned::default(),
        }
    }

    fn __deepcopy__<'py>(
        &self,
        py: Python<'py>,
        memo: &Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let (make, arguments) = self.__reduce__(py)?;
        let arguments = py.import("copy")?.call_method1("deepcopy", (arguments, memo))?;
        make.call1(arguments.cast_into::<PyTuple>()?)
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyAny>)> {
        let make = py.import("parry_continuum._copies")?.getattr("scene")?;
        let structures = self.structures.with(py, |structures| structures.clone());
        let structures = structures.into_iter().map(|it| {
            let pose =
                it.matrix.map(|matrix| array(py, vec![4, 4], matrix.to_vec())).transpose()?;
            let mesh = it.mesh.clone_ref(py);
            (it.name, mesh, it.margin, pose, it.solid, it.margins_between).into_pyobject(py)
        });
        let structures = structures.collect::<PyResult<Vec<_>>>()?;
        let nested: Vec<_> = self.nested.iter().map(|&[a, b]| (a, b)).collect();
        let arguments = (self.robot_margin, nested, structures, self.self_margin, self.self_arc)
            .into_pyobject(py)?;
        Ok((make, arguments.into_any()))
    }

    fn __repr__(&self, py: Python<'_>) -> String {
        let names = self.structures.with(py, |structures| {
            structures.iter().map(|it| format!("{:?}", it.name)).collect::<Vec<_>>()
        });
        format!("Scene({})", names.join(", "))
    }

    /// How many structures there are.
    fn __len__(&self, py: Python<'_>) -> usize {
        self.structures.with(py, |structures| structures.len())
    }

    /// Whether all robots keep the margins of all structures, robots that of robots, and each robot
    /// that to itself.
    ///
    /// Parameters
    /// ----------
    /// robots : list of (points, radii) or (points, radii, pose)
    /// caps : {"fitted", "capsules", "cylinders"}
    ///
    /// Returns
    /// -------
    /// bool or (B,) array of bool
    ///
    /// Raises
    /// ------
    /// ContinuumError
    ///     The list is empty, or something in it is no robot. Nothing in the scene has a margin.
    #[pyo3(signature = (robots, *, caps = Caps::Fitted), text_signature = "($self, robots, *, caps=\"fitted\")")]
    fn clears<'py>(
        &self,
        py: Python<'py>,
        #[pyo3(from_py_with = object_of::robots)] robots: Vec<Bound<'py, PyAny>>,
        caps: Caps,
    ) -> PyResult<Bound<'py, PyAny>> {
        let robots = self.robots_apart(py, robots)?;
        let mut all: Vec<bool> = Vec::with_capacity(robots.len());
        let ask = |session: &mut Session, robot: &Given<'_>, row: &mut [bool]| {
            let placed = place(&mut session.chains, robot, caps)?;
            let placed: Vec<_> = placed.into_iter().map(|(chain, pose, _)| (chain, pose)).collect();
            row[0] = session.scene.clears(&placed)?;
            Ok(())
        };
        ask_each(py, &self.snapshot(py), &robots, (false, 1), ask, |_, found| all.extend(found))?;
        array_or_number(py, robots.shape(&[]), all)
    }

    /// Where the slack, the distance less the margin, is least.
    ///
    /// Parameters
    /// ----------
    /// robots, caps
    ///     As for `clears`.
    ///
    /// Returns
    /// -------
    /// Tightest
    ///     Of one set of robots, or arrays with one entry for each. Of equal slacks the lowest
    ///     structure is named.
    ///
    /// Raises
    /// ------
    /// ContinuumError
    ///     The list is empty, or something in it is no robot.
    #[pyo3(signature = (robots, *, caps = Caps::Fitted), text_signature = "($self, robots, *, caps=\"fitted\")")]
    fn tightest<'py>(
        &self,
        py: Python<'py>,
        #[pyo3(from_py_with = object_of::robots)] robots: Vec<Bound<'py, PyAny>>,
        caps: Caps,
    ) -> PyResult<Bound<'py, PyAny>> {
        let robots = self.robots_apart(py, robots)?;
        let mut all: Vec<Row> = Vec::with_capacity(robots.len());
        let structures = self.snapshot(py);
        let ask = |session: &mut Session, robot: &Given<'_>, row: &mut [Row]| {
            let placed = place(&mut session.chains, robot, caps)?;
            let chains: Vec<_> = placed.iter().map(|(chain, pose, _)| (*chain, *pose)).collect();
            row[0] =
                session.scene.tightest(&chains)?.map_or(NOTHING, |found| Row::new(&found, &placed));
            Ok(())
        };
        ask_each(py, &structures, &robots, (NOTHING, 1), ask, |_, found| all.extend(found))?;
        tightest(py, &robots, &structures, &all)
    }

    /// Of each structure, where the robots are closest to it, whether it has a margin or not. If
    /// robots have different margins from it, where the slack is least.
    ///
    /// Parameters
    /// ----------
    /// robots, caps
    ///     As for `clears`.
    ///
    /// Returns
    /// -------
    /// PerStructure
    ///     Arrays with an entry for each structure, (M, ...), or (B, M, ...) of a batch.
    ///
    /// Raises
    /// ------
    /// ContinuumError
    ///     As for `tightest`.
    #[pyo3(signature = (robots, *, caps = Caps::Fitted), text_signature = "($self, robots, *, caps=\"fitted\")")]
    fn per_structure<'py>(
        &self,
        py: Python<'py>,
        #[pyo3(from_py_with = object_of::robots)] robots: Vec<Bound<'py, PyAny>>,
        caps: Caps,
    ) -> PyResult<Bound<'py, PyAny>> {
        let (robots, snapshot) = (self.robots(py, robots)?, self.snapshot(py));
        let mut all: Vec<StructureProximity> =
            Vec::with_capacity(robots.len() * snapshot.structures.len());
        let ask = |session: &mut Session,
                   robot: &Given<'_>,
                   row: &mut [Vec<StructureProximity>]| {
            let placed = place(&mut session.chains, robot, caps)?;
            let placed: Vec<_> = placed.into_iter().map(|(chain, pose, _)| (chain, pose)).collect();
            Ok(session.scene.per_structure(&placed, &mut row[0])?)
        };
        ask_each(py, &snapshot, &robots, (Vec::new(), 1), ask, |_, found| {
            all.extend(found.iter().flatten())
        })?;
        per_structure(py, &robots.shape(&[snapshot.structures.len()]), &snapshot, &all)
    }

    /// Every contact of every robot with every structure that is at most `reach` away, whether that
    /// has a margin or not, structure by structure and robot by robot: `Mesh.contacts_within` of
    /// all of them.
    ///
    /// Parameters
    /// ----------
    /// robots, caps
    ///     As for `clears`.
    /// reach : float
    ///     A length, at least 0.
    /// prominence : float
    ///     As for `Mesh.contacts_within`: 0 takes every place that is closest among its neighbours.
    ///
    /// Returns
    /// -------
    /// SceneContacts
    ///     Arrays of one length, with a row for each contact. The rows of set k of the batch are
    ///     ``offsets[k]:offsets[k + 1]``.
    ///
    /// Raises
    /// ------
    /// ContinuumError
    ///     The reach or the prominence is negative or NaN, or as for `tightest`.
    #[pyo3(signature = (robots, *, reach, prominence = 0.0, caps = Caps::Fitted), text_signature = "($self, robots, *, reach, prominence=0.0, caps=\"fitted\")")]
    fn contacts_within<'py>(
        &self,
        py: Python<'py>,
        #[pyo3(from_py_with = object_of::robots)] robots: Vec<Bound<'py, PyAny>>,
        #[pyo3(from_py_with = of::reach)] reach: f64,
        #[pyo3(from_py_with = of::prominence)] prominence: f64,
        caps: Caps,
    ) -> PyResult<Bound<'py, PyAny>> {
        // A batch without robots asks nothing of the scene itself.
        check_length(py, "reach", Some(reach))?;
        check_length(py, "prominence", Some(prominence))?;
        let robots = self.robots(py, robots)?;
        let (mut all, mut offsets): (Vec<SceneContact>, _) = (Vec::new(), vec![0_i64]);
        let structures = self.snapshot(py);
        let ask = |session: &mut Session, robot: &Given<'_>, row: &mut [Vec<SceneContact>]| {
            let placed = place(&mut session.chains, robot, caps)?;
            let placed: Vec<_> = placed.into_iter().map(|(chain, pose, _)| (chain, pose)).collect();
            Ok(session.scene.contacts_within(&placed, reach, prominence, &mut row[0])?)
        };
        ask_each(py, &structures, &robots, (Vec::new(), 1), ask, |_, found| {
            for found in found {
                all.extend(found);
                offsets.push(all.len() as i64);
            }
        })?;
        contacts(py, &structures, &all, offsets)
    }
}
