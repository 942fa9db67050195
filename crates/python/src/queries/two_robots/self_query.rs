//! The class `SelfQuery`: queries about one robot and itself.

use super::answers::{Row, proximities};
use super::curves::bounds;
use super::motions::motion_answers;
use super::session::Sessions;
use crate::input::{Caps, Given, Names, Robots, check_length, object_of, of};
use crate::motions::{Motion, Moving};
use crate::output::{Enumeration, array_or_number, decision_value, members};
use crate::queries::chains::set_chain;
use crate::queries::clearance::{Stated, tube, tubes};
use crate::threads::{Asked, answer_each, answer_each_or_kind, ask_each};
use parry_continuum::proximity::{self, Decision, ProximityError};
use parry_continuum::{Chain, Tube};
use pyo3::prelude::*;
use pyo3::types::{PyTuple, PyType};

#[derive(Default)]
struct Session {
    query: proximity::SelfQuery,
    chain: Option<Chain>,
}

/// Exact queries about one robot and itself.
///
/// The last answers warm-start the next query. Any robots may follow; small motions are answered
/// fastest. The warm start never changes an answer. Any number of threads may use one `SelfQuery`.
/// A copy starts without a warm start. For two robots see `RobotPair`.
///
/// Answers are in the robot's own frame, those about motions in the frame of the motion. The first
/// of two parts is the one nearer to the base.
///
/// Examples
/// --------
/// >>> from parry_continuum import SelfQuery
/// >>> query = SelfQuery()
/// >>> hook = [[0, 0, 0], [0, 0, 9], [2, 0, 11], [4, 0, 9], [4, 0, 0]]
/// >>> query.minimum(hook, 0.5).distance
/// 3.0
/// >>> query.clears(hook, 0.5, margin=2.5)
/// True
#[pyclass(frozen, module = "parry_continuum", weakref)]
pub(crate) struct SelfQuery(Sessions<Session>);

impl SelfQuery {
    /// Whether each chain is clear.
    fn clear<'py>(
        &self,
        py: Python<'py>,
        robots: &Robots,
        caps: Caps,
        is_clear: impl Fn(&mut proximity::SelfQuery, &Chain) -> Result<bool, ProximityError> + Sync,
    ) -> PyResult<Bound<'py, PyAny>> {
        let mut all: Vec<bool> = Vec::with_capacity(robots.len());
        let ask = |session: &mut Session, robot: &Given<'_>, row: &mut [bool]| {
            let chain = set_chain(&mut session.chain, robot, caps)?;
            row[0] = is_clear(&mut session.query, chain)?;
            Ok(())
        };
        ask_each(py, &self.0, robots, (false, 1), ask, |_, found| all.extend(found))?;
        array_or_number(py, robots.shape(&[]), all)
    }

    /// The decision about each tube.
    fn decide<'py>(
        &self,
        py: Python<'py>,
        robots: &Robots,
        stated: Stated,
        decide: impl Fn(&mut proximity::SelfQuery, &Tube) -> Result<Decision, ProximityError> + Sync,
    ) -> PyResult<Bound<'py, PyAny>> {
        let mut all: Vec<i8> = Vec::with_capacity(robots.len());
        let ask = |session: &mut Session, robot: &Given<'_>, row: &mut [i8]| {
            row[0] = decision_value(decide(&mut session.query, &tube(robot, stated)?)?);
            Ok(())
        };
        ask_each(py, &self.0, robots, (0, 1), ask, |_, found| all.extend(found))?;
        members(py, Enumeration::Decision, robots.shape(&[]), all)
    }
}

#[pymethods]
impl SelfQuery {
    #[new]
    fn new() -> Self {
        Self(Sessions::default())
    }

    /// The copy has no warm start, which only makes answers faster.
    fn __copy__(&self) -> Self {
        Self::new()
    }

    fn __deepcopy__(&self, _memo: &Bound<'_, PyAny>) -> Self {
        Self::new()
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> (Bound<'py, PyType>, Bound<'py, PyTuple>) {
        (slf.get_type(), PyTuple::empty(slf.py()))
    }

    /// Forgets the last answers: the next query starts without a warm start.
    fn forget(&self, py: Python<'_>) {
        self.0.forget(py);
    }

    /// The place where a robot comes closest to itself.
    ///
    /// Parts that are close only because they are neighbours do not count. The query considers two
    /// links with a turn of at least pi between them; a flat end or a step in radius and a link,
    /// with a turn of at least pi / 2; and two ends of links that face one another.
    ///
    /// Parameters
    /// ----------
    /// points : (N, 3) or (B, N, 3) array
    /// radii : float, (N - 1,) or (B, N - 1) array
    /// caps : {"fitted", "capsules", "cylinders"}
    ///
    /// Returns
    /// -------
    /// RobotProximity
    ///     If no two parts of the robot count, the distance is infinite and the segments are -1.
    ///
    /// Raises
    /// ------
    /// ContinuumError
    ///     Points or radii are no robot, or a joint is so sharp that its links overlap over more
    ///     than half of the shorter one.
    ///
    /// Examples
    /// --------
    /// >>> from parry_continuum import SelfQuery
    /// >>> hook = [[0, 0, 0], [0, 0, 9], [2, 0, 11], [4, 0, 9], [4, 0, 0]]
    /// >>> SelfQuery().minimum(hook, 0.5).distance
    /// 3.0
    /// >>> SelfQuery().minimum(hook[:3], 0.5).distance
    /// inf
    #[pyo3(signature = (points, radii, *, caps = Caps::Fitted), text_signature = "($self, points, radii, *, caps=\"fitted\")")]
    fn minimum<'py>(
        &self,
        py: Python<'py>,
        points: &Bound<'py, PyAny>,
        radii: &Bound<'py, PyAny>,
        caps: Caps,
    ) -> PyResult<Bound<'py, PyAny>> {
        let robots = Robots::new(Names::one("points"), points, radii, None)?;
        let mut rows = Vec::with_capacity(robots.len());
        let ask = |session: &mut Session, robot: &Given<'_>, row: &mut [Option<Row>]| {
            let chain = set_chain(&mut session.chain, robot, caps)?;
            let found = session.query.minimum(chain)?;
            row[0] = found.map(|found| Row::new(found, [chain; 2], [robot.points; 2]));
            Ok(())
        };
        ask_each(py, &self.0, &robots, (None, 1), ask, |_, found| rows.extend_from_slice(found))?;
        proximities(py, &robots, &rows)
    }

    /// Whether a robot keeps more than a margin to itself.
    ///
    /// The answer equals ``minimum(...).distance > margin`` and takes less work.
    ///
    /// Parameters
    /// ----------
    /// points, radii, caps
    ///     As for `minimum`.
    /// margin : float
    ///     A length, at least 0.
    ///
    /// Returns
    /// -------
    /// bool or (B,) array of bool
    ///
    /// Raises
    /// ------
    /// ContinuumError
    ///     The margin is negative or NaN, or as for `minimum`.
    ///
    /// Examples
    /// --------
    /// >>> from parry_continuum import SelfQuery
    /// >>> SelfQuery().clears([[0, 0, 0], [0, 0, 1], [0, 0, 2]], 3.0, margin=100)  # it is straight
    /// True
    #[pyo3(signature = (points, radii, *, margin, caps = Caps::Fitted), text_signature = "($self, points, radii, *, margin, caps=\"fitted\")")]
    fn clears<'py>(
        &self,
        py: Python<'py>,
        points: &Bound<'py, PyAny>,
        radii: &Bound<'py, PyAny>,
        #[pyo3(from_py_with = of::margin)] margin: f64,
        caps: Caps,
    ) -> PyResult<Bound<'py, PyAny>> {
        let robots = Robots::new(Names::one("points"), points, radii, None)?;
        self.clear(py, &robots, caps, |query, chain| query.clears(chain, margin))
    }

    /// Whether a curved tube keeps more than a margin to itself.
    ///
    /// The query considers the same parts as `minimum`, on the curve itself. The robot is a smooth
    /// tube with flat ends, as for `Mesh.clearance`.
    ///
    /// Parameters
    /// ----------
    /// points : (N, 3) or (B, N, 3) array
    /// radii : float, (N - 1,) or (B, N - 1) array
    /// margin : float
    ///     A length, at least 0.
    /// resolution : float
    ///     A length, at least 0. The answer is undecided only if the distance of such parts is
    ///     within the resolution of the margin, the margin is as wide as the tightest bend, the
    ///     points are too few to show how far the curve turns, or 65,536 pairs of pieces do not
    ///     decide.
    /// tangents, deviation, turn
    ///     As for `Mesh.clearance`.
    ///
    /// Returns
    /// -------
    /// Decision or Decisions
    ///     As of `Mesh.clears_tube`.
    ///
    /// Raises
    /// ------
    /// ContinuumError
    ///     The margin or the resolution is negative or NaN, the resolution is finer than the points
    ///     allow, points turn too sharply for a tube, or the tube bends within its radius.
    ///
    /// Examples
    /// --------
    /// >>> import numpy as np
    /// >>> from parry_continuum import SelfQuery
    /// >>> angle = np.linspace(0, 4 * np.pi, 241)
    /// >>> rise = 4 / (2 * np.pi)
    /// >>> coil = np.stack([10 * np.cos(angle), 10 * np.sin(angle), rise * angle], axis=1)
    /// >>> ends = [[0, 10, rise]] * 2  # the directions of the two ends, after whole turns
    /// >>> SelfQuery().clears_tube(coil, 1.0, margin=1.9, resolution=0.05, tangents=ends)
    /// <Decision.CLEAR: 1>
    /// >>> SelfQuery().clears_tube(coil, 1.0, margin=2.1, resolution=0.05, tangents=ends)
    /// <Decision.CONTACT: -1>
    #[pyo3(signature = (points, radii, *, margin, resolution, tangents = None, deviation = 0.0, turn = None))]
    #[allow(clippy::too_many_arguments)] // they are named in Python
    fn clears_tube<'py>(
        &self,
        py: Python<'py>,
        points: &Bound<'py, PyAny>,
        radii: &Bound<'py, PyAny>,
        #[pyo3(from_py_with = of::margin)] margin: f64,
        #[pyo3(from_py_with = of::resolution)] resolution: f64,
        tangents: Option<&Bound<'py, PyAny>>,
        #[pyo3(from_py_with = of::deviation)] deviation: f64,
        #[pyo3(from_py_with = of::optional::turn)] turn: Option<f64>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let stated = Stated { deviation, turn };
        let robots = Robots::new(Names::one("points"), points, radii, None)?;
        let robots = tubes(robots, "tangents", tangents, stated)?;
        self.decide(py, &robots, stated, |query, tube| query.clears_tube(tube, margin, resolution))
    }

    /// Bounds on the distance of a robot from itself, between places at least `arc` apart along it.
    ///
    /// The distance is the least distance of two cross-sections, the discs across the centreline.
    /// It is never more than `arc`, and exactly `arc` if the robot is straight: choose `arc` larger
    /// than any margin. A round end of the robot has the arc length of the end.
    ///
    /// Parameters
    /// ----------
    /// points, radii, caps
    ///     As for `minimum`.
    /// arc : float
    ///     A length along the robot, at least 0.
    ///
    /// Returns
    /// -------
    /// RobotClearance
    ///     The bounds differ by rounding, with few exceptions: see ``resolved``. If the robot is
    ///     shorter than `arc`, they are infinite.
    ///
    /// Raises
    /// ------
    /// ContinuumError
    ///     `arc` is negative or NaN. Of one robot: points or radii are no robot.
    ///
    /// Examples
    /// --------
    /// >>> from parry_continuum import SelfQuery
    /// >>> hook = [[0, 0, 0], [0, 0, 9], [2, 0, 11], [4, 0, 9], [4, 0, 0]]
    /// >>> round(float(SelfQuery().minimum_beyond(hook, 0.5, arc=9.0).upper), 6)
    /// 3.0
    #[pyo3(signature = (points, radii, *, arc, caps = Caps::Fitted), text_signature = "($self, points, radii, *, arc, caps=\"fitted\")")]
    fn minimum_beyond<'py>(
        &self,
        py: Python<'py>,
        points: &Bound<'py, PyAny>,
        radii: &Bound<'py, PyAny>,
        #[pyo3(from_py_with = of::arc)] arc: f64,
        caps: Caps,
    ) -> PyResult<Bound<'py, PyAny>> {
        check_length(py, "arc", arc)?;
        let robots = Robots::new(Names::one("points"), points, radii, None)?;
        let ask = |session: &mut Session, robot: &Given<'_>| {
            let chain = set_chain(&mut session.chain, robot, caps)?;
            Ok(session.query.minimum_beyond(chain, arc)?)
        };
        bounds(py, &robots, &answer_each_or_kind(py, &self.0, &robots, ask)?)
    }

    /// Whether a robot keeps more than a margin to itself, between places at least `arc` apart
    /// along it.
    ///
    /// True if the lower bound of `minimum_beyond` is more than the margin.
    ///
    /// Parameters
    /// ----------
    /// points, radii, caps
    ///     As for `minimum`.
    /// arc : float
    ///     A length along the robot, at least 0. A margin of `arc` or more is never kept.
    /// margin : float
    ///     A length, at least 0.
    ///
    /// Returns
    /// -------
    /// bool or (B,) array of bool
    ///
    /// Raises
    /// ------
    /// ContinuumError
    ///     `arc` or the margin is negative or NaN, or points or radii are no robot.
    ///
    /// Examples
    /// --------
    /// >>> from parry_continuum import SelfQuery
    /// >>> hook = [[0, 0, 0], [0, 0, 9], [2, 0, 11], [4, 0, 9], [4, 0, 0]]
    /// >>> SelfQuery().clears_beyond(hook, 0.5, arc=9.0, margin=2.9)
    /// True
    #[pyo3(signature = (points, radii, *, arc, margin, caps = Caps::Fitted), text_signature = "($self, points, radii, *, arc, margin, caps=\"fitted\")")]
    fn clears_beyond<'py>(
        &self,
        py: Python<'py>,
        points: &Bound<'py, PyAny>,
        radii: &Bound<'py, PyAny>,
        #[pyo3(from_py_with = of::arc)] arc: f64,
        #[pyo3(from_py_with = of::margin)] margin: f64,
        caps: Caps,
    ) -> PyResult<Bound<'py, PyAny>> {
        let robots = Robots::new(Names::one("points"), points, radii, None)?;
        self.clear(py, &robots, caps, |query, chain| query.clears_beyond(chain, arc, margin))
    }

    /// Bounds on the distance of a curved tube from itself, between places at least `arc` apart
    /// along it.
    ///
    /// As `minimum_beyond`, for the discs of the curve itself. Arc lengths are measured along the
    /// lines between the points.
    ///
    /// Parameters
    /// ----------
    /// points, radii
    ///     As for `clears_tube`.
    /// arc : float
    ///     A length along the tube, at least 0.
    /// tolerance : float
    ///     How far apart the bounds may be, at least 0.
    /// tangents, deviation, turn
    ///     As for `Mesh.clearance`.
    ///
    /// Returns
    /// -------
    /// RobotClearance
    ///     If the tube is shorter than `arc`, the bounds are infinite.
    ///
    /// Raises
    /// ------
    /// ContinuumError
    ///     `arc` or the tolerance is negative or NaN. Of one tube: points turn too sharply.
    #[pyo3(signature = (points, radii, *, arc, tolerance, tangents = None, deviation = 0.0, turn = None))]
    #[allow(clippy::too_many_arguments)] // they are named in Python
    fn clearance_beyond<'py>(
        &self,
        py: Python<'py>,
        points: &Bound<'py, PyAny>,
        radii: &Bound<'py, PyAny>,
        #[pyo3(from_py_with = of::arc)] arc: f64,
        #[pyo3(from_py_with = of::tolerance)] tolerance: f64,
        tangents: Option<&Bound<'py, PyAny>>,
        #[pyo3(from_py_with = of::deviation)] deviation: f64,
        #[pyo3(from_py_with = of::optional::turn)] turn: Option<f64>,
    ) -> PyResult<Bound<'py, PyAny>> {
        check_length(py, "arc", arc)?;
        check_length(py, "tolerance", tolerance)?;
        let stated = Stated { deviation, turn };
        let robots = Robots::new(Names::one("points"), points, radii, None)?;
        let robots = tubes(robots, "tangents", tangents, stated)?;
        let ask = |session: &mut Session, robot: &Given<'_>| {
            Ok(session.query.clearance_beyond(&tube(robot, stated)?, arc, tolerance)?)
        };
        bounds(py, &robots, &answer_each_or_kind(py, &self.0, &robots, ask)?)
    }

    /// Whether a curved tube keeps more than a margin to itself, between places at least `arc`
    /// apart along it.
    ///
    /// The distance is that of `clearance_beyond`.
    ///
    /// Parameters
    /// ----------
    /// points, radii, arc
    ///     As for `clearance_beyond`.
    /// margin : float
    ///     A length, at least 0.
    /// resolution : float
    ///     The answer is undecided only if the distance is within this of the margin, the points do
    ///     not allow a decision, or 65,536 pairs of pieces do not decide.
    /// tangents, deviation, turn
    ///     As for `Mesh.clearance`.
    ///
    /// Returns
    /// -------
    /// Decision or Decisions
    ///     As of `Mesh.clears_tube`.
    ///
    /// Raises
    /// ------
    /// ContinuumError
    ///     `arc`, the margin or the resolution is negative or NaN, or points turn too sharply.
    #[pyo3(signature = (points, radii, *, arc, margin, resolution, tangents = None, deviation = 0.0, turn = None))]
    #[allow(clippy::too_many_arguments)] // they are named in Python
    fn clears_tube_beyond<'py>(
        &self,
        py: Python<'py>,
        points: &Bound<'py, PyAny>,
        radii: &Bound<'py, PyAny>,
        #[pyo3(from_py_with = of::arc)] arc: f64,
        #[pyo3(from_py_with = of::margin)] margin: f64,
        #[pyo3(from_py_with = of::resolution)] resolution: f64,
        tangents: Option<&Bound<'py, PyAny>>,
        #[pyo3(from_py_with = of::deviation)] deviation: f64,
        #[pyo3(from_py_with = of::optional::turn)] turn: Option<f64>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let stated = Stated { deviation, turn };
        let robots = Robots::new(Names::one("points"), points, radii, None)?;
        let robots = tubes(robots, "tangents", tangents, stated)?;
        self.decide(py, &robots, stated, |query, tube| {
            query.clears_tube_beyond(tube, arc, margin, resolution)
        })
    }

    /// Whether a moving robot keeps more than a margin to itself, at every time from 0 to 1.
    ///
    /// ``Decision.CLEAR`` is proven from the speeds that the motion states. The query considers the
    /// same parts as `clears_tube`.
    ///
    /// Parameters
    /// ----------
    /// motion : Motion
    ///     A motion, or a batch.
    /// margin : float
    ///     A length, at least 0.
    /// resolution : float
    ///     A length, at least 0. The answer is undecided only if the robot comes within the
    ///     resolution of the margin, the margin is as wide as the tightest bend, an end turns from
    ///     flat to round, or 65,536 shapes or 262,144 pairs of pieces do not decide.
    ///
    /// Returns
    /// -------
    /// RobotMotionAnswer
    ///     Of one motion, or arrays with one entry for each. Both points of a contact are on the
    ///     same robot, the first one nearer to its base.
    ///
    /// Raises
    /// ------
    /// ContinuumError
    ///     The margin or the resolution is negative or NaN, the resolution is finer than rounding,
    ///     the motion is too fast for the resolution, one of the shapes is no robot, or a shape
    ///     bends within its radius or too sharply at a joint.
    ///
    /// Examples
    /// --------
    /// >>> import numpy as np
    /// >>> from parry_continuum import LinearMotion, SelfQuery
    /// >>> def hairpin(y): return np.array([[0, 0, 0], [0, 0, 40], [8, 0, 40], [4, y, 2]])
    /// >>> swing = LinearMotion(hairpin(-6), hairpin(6), 1.0)  # the tip passes the base
    /// >>> SelfQuery().clears_motion(swing, margin=1.5, resolution=1e-3).decision
    /// <Decision.CLEAR: 1>
    /// >>> SelfQuery().clears_motion(swing, margin=2.5, resolution=1e-3).decision
    /// <Decision.CONTACT: -1>
    #[pyo3(signature = (motion, *, margin, resolution))]
    fn clears_motion<'py>(
        &self,
        py: Python<'py>,
        #[pyo3(from_py_with = object_of::motion)] motion: Bound<'py, Motion>,
        #[pyo3(from_py_with = of::margin)] margin: f64,
        #[pyo3(from_py_with = of::resolution)] resolution: f64,
    ) -> PyResult<Bound<'py, PyAny>> {
        let motions = motion.get();
        let ask = |session: &mut Session, motion: &&Moving| {
            Ok(session.query.clears_motion(*motion, margin, resolution)?)
        };
        let all = answer_each(py, &self.0, motions, ask)?;
        motion_answers(py, &all, |further| motions.shape(further))
    }
}
