//! The class `Scene`: several meshes with margins, and several robots.

use crate::error::Refused;
use crate::input::{Caps, Given, Numbers, Robots, shape_text};
use crate::mesh::Mesh;
use crate::output::{answer, array, array_or_number, flat};
use crate::queries::distance::{no_chain, set_chain};
use crate::queries::two_robots::segment_of;
use crate::threads::{self, Engine, Held, Lender, ask_each};
use parry_continuum::parry::math::{Pose, Vector};
use parry_continuum::proximity::{self, Between, Tightest};
use parry_continuum::{Chain, pose_from_matrix};
use pyo3::prelude::*;
use std::sync::Arc;

/// Several meshes, the structures, each with a margin of its own or none, and robots among them.
///
/// A structure is a `Mesh`: where that moves, the structure has moved for all queries that begin later. Robots are a list, each
/// ``(points, radii)`` or ``(points, radii, pose)``; each is one shape or a batch of as many.
///
/// Parameters
/// ----------
/// robot_margin : float, optional
///     What robots keep from one another. Without it they are not held against one another.
///
/// Raises
/// ------
/// ContinuumError
///     The margin is negative or NaN.
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
}

struct Structure {
    name: String,
    mesh: Py<Mesh>,
    margin: Option<f64>,
    pose: Pose,
}

/// The structures at the time of a question.
struct Snapshot {
    structures: Vec<(String, Arc<Engine>, Option<f64>, Pose)>,
    robot_margin: Option<f64>,
}

struct Session {
    scene: proximity::Scene,
    /// Of each structure's engine, which is in use as long as they are lent.
    lent: Vec<threads::Session>,
    chains: Vec<Option<Chain>>,
}

impl Lender for Snapshot {
    type Session = Session;

    fn lend(&self, py: Python<'_>) -> PyResult<Session> {
        let lent =
            self.structures.iter().map(|(_, engine, ..)| engine.lend(py)).collect::<PyResult<Vec<_>>>()?;
        let mut scene = proximity::Scene::new();
        let mut build = || -> Result<(), Refused> {
            for (number, ((name, _, margin, pose), session)) in self.structures.iter().zip(&lent).enumerate()
            {
                scene.add(name.clone(), session.search.clone(), *margin)?;
                scene.set_pose(number, pose)?;
            }
            Ok(scene.set_robot_margin(self.robot_margin)?)
        };
        build().map_err(|refused| refused.raise(py, None))?;
        Ok(Session { scene, lent, chains: Vec::new() })
    }

    fn take_back(&self, py: Python<'_>, lent: usize, sessions: impl IntoIterator<Item = Session>) {
        let mut free: Vec<Vec<threads::Session>> = self.structures.iter().map(|_| Vec::new()).collect();
        for session in sessions {
            session.lent.into_iter().zip(&mut free).for_each(|(session, free)| free.push(session));
        }
        for ((_, engine, ..), free) in self.structures.iter().zip(free) {
            engine.take_back(py, lent, free);
        }
    }
}

/// A robot, its pose, and the points that it was made of.
type Placed<'a> = (&'a Chain, Pose, &'a [Vector]);

/// The robots of a question, as the session's chains, with their poses and points.
fn place<'a>(
    chains: &'a mut Vec<Option<Chain>>,
    robot: &Given<'a>,
    caps: Caps,
) -> Result<Vec<Placed<'a>>, Refused> {
    set_chain_at(chains, 0, robot, caps)?;
    let mut placed = vec![(robot.points, robot.pose()?)];
    let mut other = robot.other();
    while let Some(robot) = other {
        set_chain_at(chains, placed.len(), &robot, caps)?;
        placed.push((robot.points, robot.pose()?));
        other = robot.other();
    }
    let chains = chains.iter().map(|chain| chain.as_ref().ok_or_else(no_chain));
    placed.into_iter().zip(chains).map(|((points, pose), chain)| Ok((chain?, pose, points))).collect()
}

fn set_chain_at(
    chains: &mut Vec<Option<Chain>>,
    place: usize,
    robot: &Given<'_>,
    caps: Caps,
) -> Result<(), Refused> {
    if chains.len() <= place {
        chains.resize_with(place + 1, || None);
    }
    set_chain(&mut chains[place], robot, caps)
}

/// Each robot of a list holds the next one.
const MOST_ROBOTS: usize = 1000;

/// The list of robots that a function was given.
fn robots<'py>(py: Python<'py>, given: Vec<Bound<'py, PyAny>>) -> PyResult<Robots<'py>> {
    let refuse = |text: &str| Refused::other("bad_type", text).raise(py, None);
    let one = |given: &Bound<'py, PyAny>| {
        if let Ok((points, radii)) = given.extract::<(Bound<'py, PyAny>, Bound<'py, PyAny>)>() {
            return Robots::new("points", &points, &radii, None);
        }
        let three = given.extract::<(Bound<'py, PyAny>, Bound<'py, PyAny>, Option<Bound<'py, PyAny>>)>();
        let (points, radii, pose) = three.map_err(|_| {
            refuse("`robots` has an entry that is no tuple (points, radii) or (points, radii, pose)")
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
    let last = all.next().ok_or_else(|| refuse("`robots` is empty; give a list of at least one robot"))?;
    all.try_fold(one(last)?, |others, given| one(given)?.with_others(py, others))
}

/// What there is of the tightest place.
#[derive(Clone, Copy)]
struct Row {
    slack: f64,
    distance: f64,
    structure: i64,
    robots: [i64; 2],
    segments: [i64; 2],
    triangle: i64,
    on_first: Vector,
    on_second: Vector,
}

const NOTHING: Row = Row {
    slack: f64::INFINITY,
    distance: f64::INFINITY,
    structure: -1,
    robots: [-1; 2],
    segments: [-1; 2],
    triangle: -1,
    on_first: Vector::NAN,
    on_second: Vector::NAN,
};

impl Row {
    fn new(found: &Tightest, placed: &[Placed<'_>]) -> Self {
        let slack = found.slack;
        match &found.between {
            Between::Structure(it) => Self {
                slack,
                distance: it.nearest.distance,
                structure: it.structure.into(),
                robots: [it.robot.into(), -1],
                segments: [it.nearest.segment.into(), -1],
                triangle: it.nearest.triangle.into(),
                on_first: it.nearest.on_robot,
                on_second: it.nearest.on_mesh,
            },
            Between::Robots { robots, nearest } => Self {
                slack,
                distance: nearest.distance,
                robots: robots.map(i64::from),
                segments: std::array::from_fn(|k| {
                    let (chain, _, points) = placed[robots[k] as usize];
                    segment_of(chain, points, nearest.links[k] as usize)
                }),
                on_first: nearest.on_first,
                on_second: nearest.on_second,
                ..NOTHING
            },
            _ => Self { slack, ..NOTHING },
        }
    }
}

impl Scene {
    fn snapshot(&self, py: Python<'_>) -> Snapshot {
        let structures = self.structures.with(py, |structures| {
            let copy = |it: &Structure| (it.name.clone(), it.mesh.clone_ref(py), it.margin, it.pose);
            structures.iter().map(copy).collect::<Vec<_>>()
        });
        let engines = structures
            .into_iter()
            .map(|(name, mesh, margin, pose)| (name, mesh.get().engine(py), margin, pose));
        Snapshot { structures: engines.collect(), robot_margin: self.robot_margin }
    }
}

/// A margin is a length, or there is none.
fn check(py: Python<'_>, parameter: &'static str, margin: Option<f64>) -> PyResult<()> {
    match margin {
        Some(value) if value.is_nan() || value < 0.0 => {
            Err(Refused::Query(proximity::ProximityError::Negative { parameter, value }).raise(py, None))
        }
        _ => Ok(()),
    }
}

#[pymethods]
impl Scene {
    #[new]
    #[pyo3(signature = (*, robot_margin = None))]
    fn new(py: Python<'_>, robot_margin: Option<f64>) -> PyResult<Self> {
        check(py, "robot_margin", robot_margin)?;
        Ok(Self { structures: Held::new(Vec::new()), robot_margin })
    }

    /// Adds a structure, and returns its number: structures count from 0.
    ///
    /// Parameters
    /// ----------
    /// name : str
    ///     For messages.
    /// mesh : Mesh
    /// margin : float, optional
    ///     The distance that robots keep from it. A structure without a margin is in no answer.
    /// pose : (4, 4) array, optional
    ///     From the mesh's frame to the scene's.
    ///
    /// Raises
    /// ------
    /// ContinuumError
    ///     The margin is negative or NaN, or the pose is not rigid.
    #[pyo3(signature = (name, mesh, margin = None, pose = None))]
    fn add(
        &self,
        py: Python<'_>,
        name: String,
        mesh: Py<Mesh>,
        margin: Option<f64>,
        pose: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<usize> {
        check(py, "margin", margin)?;
        let pose = match pose {
            None => Pose::IDENTITY,
            Some(pose) => {
                let numbers = Numbers::new(pose, "pose")?;
                let (&[4, 4], Some(matrix)) = (numbers.shape(), numbers.values().as_chunks::<16>().0.first())
                else {
                    let text = format!(
                        "`pose` has the shape {}; give None, or the shape (4, 4)",
                        shape_text(numbers.shape())
                    );
                    return Err(Refused::other("bad_shape", text).raise(py, None));
                };
                let row = |row: usize| std::array::from_fn(|column| matrix[4 * row + column]);
                pose_from_matrix(std::array::from_fn(row))
                    .map_err(|error| Refused::from(error).raise(py, None))?
            }
        };
        let structure = Structure { name, mesh, margin, pose };
        Ok(self.structures.with(py, |structures| {
            structures.push(structure);
            structures.len() - 1
        }))
    }

    /// How many structures there are.
    fn __len__(&self, py: Python<'_>) -> usize {
        self.structures.with(py, |structures| structures.len())
    }

    /// Whether all robots keep the margins of all structures, and robots that of robots.
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
    ///     The list is empty, or something in it is no robot.
    #[pyo3(signature = (robots, *, caps = Caps::Fitted), text_signature = "($self, robots, *, caps=\"fitted\")")]
    fn clears<'py>(
        &self,
        py: Python<'py>,
        robots: Vec<Bound<'py, PyAny>>,
        caps: Caps,
    ) -> PyResult<Bound<'py, PyAny>> {
        let robots = self::robots(py, robots)?;
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
    ///     Of one set of robots, or arrays with one entry for each. Of equal slacks the lowest structure is named.
    ///
    /// Raises
    /// ------
    /// ContinuumError
    ///     As for `clears`.
    #[pyo3(signature = (robots, *, caps = Caps::Fitted), text_signature = "($self, robots, *, caps=\"fitted\")")]
    fn tightest<'py>(
        &self,
        py: Python<'py>,
        robots: Vec<Bound<'py, PyAny>>,
        caps: Caps,
    ) -> PyResult<Bound<'py, PyAny>> {
        let robots = self::robots(py, robots)?;
        let mut all: Vec<Row> = Vec::with_capacity(robots.len());
        let ask = |session: &mut Session, robot: &Given<'_>, row: &mut [Row]| {
            let placed = place(&mut session.chains, robot, caps)?;
            let chains: Vec<_> = placed.iter().map(|(chain, pose, _)| (*chain, *pose)).collect();
            row[0] = session.scene.tightest(&chains)?.map_or(NOTHING, |found| Row::new(&found, &placed));
            Ok(())
        };
        ask_each(py, &self.snapshot(py), &robots, (NOTHING, 1), ask, |_, found| all.extend(found))?;
        let shape = || robots.shape(&[]);
        let values = (
            array_or_number(py, shape(), all.iter().map(|row| row.slack).collect())?,
            array_or_number(py, shape(), all.iter().map(|row| row.distance).collect())?,
            array_or_number(py, shape(), all.iter().map(|row| row.structure).collect())?,
            array(py, robots.shape(&[2]), all.iter().flat_map(|row| row.robots).collect())?,
            array(py, robots.shape(&[2]), all.iter().flat_map(|row| row.segments).collect())?,
            array_or_number(py, shape(), all.iter().map(|row| row.triangle).collect())?,
            array(py, robots.shape(&[3]), flat(all.iter().map(|row| row.on_first)))?,
            array(py, robots.shape(&[3]), flat(all.iter().map(|row| row.on_second)))?,
        );
        answer(py, "Tightest", values)
    }
}
