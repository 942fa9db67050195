//! Bounds and decisions about two curved tubes.

use super::RobotPair;
use super::session::{Pairs, Session, second};
use crate::error::Refused;
use crate::input::{Given, Names, Robots, check_length, of};
use crate::output::{
    Enumeration, answer, array, array_or_number, decision_value, flat, members, statuses,
};
use crate::queries::clearance::{Stated, tube, tubes};
use crate::threads::{Asked, answer_each_or_kind, ask_each};
use parry_continuum::parry::math::{Pose, Vector};
use parry_continuum::proximity::{Decision, ProximityError, RobotClearance};
use parry_continuum::{Tube, proximity};
use pyo3::prelude::*;

/// The errors that are stated for the points of either robot.
type Both = [Stated; 2];

impl Session {
    /// Asks about the tubes of two robots.
    fn about_tubes<A>(
        &mut self,
        robot: &Given<'_>,
        stated: Both,
        ask: impl FnOnce(&mut proximity::RobotPair, [(&Tube, &Pose); 2]) -> Result<A, ProximityError>,
    ) -> Result<A, Refused> {
        let other = second(robot)?;
        let [first, second] = [tube(robot, stated[0])?, tube(&other, stated[1])?];
        let poses = [robot.pose()?, other.pose()?];
        Ok(ask(&mut self.pair, [(&first, &poses[0]), (&second, &poses[1])])?)
    }
}

/// Bounds of each question; of a robot without two such places they are infinite.
pub(super) fn bounds<'py>(
    py: Python<'py>,
    robots: &Robots<'py>,
    all: &[Result<Option<RobotClearance>, &'static str>],
) -> PyResult<Bound<'py, PyAny>> {
    let found = |it: &Result<Option<RobotClearance>, &'static str>| it.ok().flatten();
    let numbers = |of: fn(&RobotClearance) -> f64, without: f64| {
        let number = |it: &Result<Option<RobotClearance>, _>| match it {
            Ok(found) => found.as_ref().map_or(without, of),
            Err(_) => f64::NAN,
        };
        array_or_number(py, robots.shape(&[]), all.iter().map(number).collect())
    };
    let points = |of: fn(&RobotClearance) -> Vector| {
        let points = all.iter().map(|it| found(it).as_ref().map_or(Vector::NAN, of));
        array(py, robots.shape(&[3]), flat(points))
    };
    let lengths =
        all.iter().flat_map(|it| found(it).map_or([f64::NAN; 2], |it| it.witness.arc_lengths));
    let resolved = all.iter().map(|it| it.is_ok_and(|it| it.is_none_or(|it| it.resolved)));
    let values = (
        numbers(|found| found.lower, f64::INFINITY)?,
        numbers(|found| found.upper, f64::INFINITY)?,
        array_or_number(py, robots.shape(&[]), resolved.collect())?,
        numbers(|found| found.uncertainty, 0.0)?,
        points(|found| found.witness.on_first)?,
        points(|found| found.witness.on_second)?,
        array(py, robots.shape(&[2]), lengths.collect())?,
        statuses(py, all, robots.count.is_some())?,
    );
    answer!(py, "RobotClearance", values)
}

impl Pairs {
    fn clearance<'py>(
        &self,
        py: Python<'py>,
        robots: &Robots<'py>,
        stated: Both,
        tolerance: f64,
    ) -> PyResult<Bound<'py, PyAny>> {
        check_length(py, "tolerance", tolerance)?;
        let ask = |session: &mut Session, robot: &Given<'_>| {
            session.about_tubes(robot, stated, |pair, [a, b]| {
                pair.clearance(a.0, a.1, b.0, b.1, tolerance)
            })
        };
        let all = answer_each_or_kind(py, self, robots, ask)?;
        let all: Vec<_> = all.into_iter().map(|found| found.map(Some)).collect();
        bounds(py, robots, &all)
    }

    fn clears_tubes<'py>(
        &self,
        py: Python<'py>,
        robots: &Robots<'py>,
        stated: Both,
        [margin, resolution]: [f64; 2],
    ) -> PyResult<Bound<'py, PyAny>> {
        let mut all: Vec<i8> = Vec::with_capacity(robots.len());
        let ask = |session: &mut Session, robot: &Given<'_>, row: &mut [i8]| {
            let found: Decision = session.about_tubes(robot, stated, |pair, [a, b]| {
                pair.clears_tubes(a.0, a.1, b.0, b.1, margin, resolution)
            })?;
            row[0] = decision_value(found);
            Ok(())
        };
        ask_each(py, self, robots, (0, 1), ask, |_, found| all.extend(found))?;
        members(py, Enumeration::Decision, robots.shape(&[]), all)
    }
}

/// The arguments that say what two tubes are.
struct Arguments<'a, 'py> {
    points: [&'a Bound<'py, PyAny>; 2],
    radii: [&'a Bound<'py, PyAny>; 2],
    poses: [Option<&'a Bound<'py, PyAny>>; 2],
    tangents: [Option<&'a Bound<'py, PyAny>>; 2],
    stated: Both,
}

impl<'py> Arguments<'_, 'py> {
    fn robots(&self) -> PyResult<Robots<'py>> {
        let robots = |which: usize, tangents: &'static str| {
            let robots = Robots::new(
                Names::PAIR[which],
                self.points[which],
                self.radii[which],
                self.poses[which],
            )?;
            tubes(robots, tangents, self.tangents[which], self.stated[which])
        };
        let others = robots(1, "tangents_b")?;
        robots(0, "tangents_a")?.with_others(self.points[0].py(), others)
    }
}

#[pymethods]
impl RobotPair {
    /// How near two curved tubes are, between proven bounds.
    ///
    /// Both robots are taken for smooth tubes with flat ends, as `Mesh.clearance` takes them.
    ///
    /// A pair that is refused does not fail its batch: its bounds are NaN, and its ``status`` is
    /// the ``kind`` of its error.
    ///
    /// Parameters
    /// ----------
    /// points_a, radii_a, points_b, radii_b, pose_a, pose_b
    ///     As for `minimum`.
    /// tolerance : float
    ///     How far apart the bounds may be, at least 0.
    /// tangents_a, tangents_b, deviation_a, deviation_b, turn_a, turn_b
    ///     Of either robot as for `Mesh.clearance`.
    ///
    /// Returns
    /// -------
    /// RobotClearance
    ///     Numbers and points of one pair, or arrays with one for each pair.
    ///
    /// Raises
    /// ------
    /// ContinuumError
    ///     The tolerance is negative or NaN. Of one pair: points turn too sharply for a tube, or as
    ///     for `minimum`.
    ///
    /// Examples
    /// --------
    /// >>> import numpy as np
    /// >>> from parry_continuum import RobotPair
    /// >>> angle = np.linspace(0, 1, 60)
    /// >>> arc = 30 * np.stack([np.cos(angle), 0 * angle, np.sin(angle)], axis=1)
    /// >>> other = arc * [-1, 1, 1] + [65, 0, 0]
    /// >>> found = RobotPair().clearance(arc, 1.0, other, 1.0, tolerance=0.1)
    /// >>> bool(found.lower <= 3 <= found.upper), bool(found.resolved)
    /// (True, True)
    #[pyo3(signature = (points_a, radii_a, points_b, radii_b, *, tolerance, tangents_a = None, tangents_b = None, deviation_a = 0.0, deviation_b = 0.0, turn_a = None, turn_b = None, pose_a = None, pose_b = None))]
    #[allow(clippy::too_many_arguments)] // they are named in Python
    fn clearance<'py>(
        &self,
        py: Python<'py>,
        points_a: &Bound<'py, PyAny>,
        radii_a: &Bound<'py, PyAny>,
        points_b: &Bound<'py, PyAny>,
        radii_b: &Bound<'py, PyAny>,
        #[pyo3(from_py_with = of::tolerance)] tolerance: f64,
        tangents_a: Option<&Bound<'py, PyAny>>,
        tangents_b: Option<&Bound<'py, PyAny>>,
        #[pyo3(from_py_with = of::deviation_a)] deviation_a: f64,
        #[pyo3(from_py_with = of::deviation_b)] deviation_b: f64,
        #[pyo3(from_py_with = of::optional::turn_a)] turn_a: Option<f64>,
        #[pyo3(from_py_with = of::optional::turn_b)] turn_b: Option<f64>,
        pose_a: Option<&Bound<'py, PyAny>>,
        pose_b: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let given = Arguments {
            points: [points_a, points_b],
            radii: [radii_a, radii_b],
            poses: [pose_a, pose_b],
            tangents: [tangents_a, tangents_b],
            stated: [
                Stated { deviation: deviation_a, turn: turn_a },
                Stated { deviation: deviation_b, turn: turn_b },
            ],
        };
        self.note_frames(given.points, given.poses)?;
        self.0.clearance(py, &given.robots()?, given.stated, tolerance)
    }

    /// Whether two curved tubes keep more than a margin from each other.
    ///
    /// Parameters
    /// ----------
    /// points_a, radii_a, points_b, radii_b, pose_a, pose_b
    ///     As for `minimum`.
    /// margin : float
    ///     A length, at least 0.
    /// resolution : float
    ///     The answer is undecided only where the clearance is within this of the margin, or where
    ///     65,536 pairs of pieces do not decide it.
    /// tangents_a, tangents_b, deviation_a, deviation_b, turn_a, turn_b
    ///     Of either robot as for `Mesh.clearance`.
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
    ///     allow, or as for `clearance`. Of a batch, ``robot`` is the first that is refused.
    #[pyo3(signature = (points_a, radii_a, points_b, radii_b, *, margin, resolution, tangents_a = None, tangents_b = None, deviation_a = 0.0, deviation_b = 0.0, turn_a = None, turn_b = None, pose_a = None, pose_b = None))]
    #[allow(clippy::too_many_arguments)] // they are named in Python
    fn clears_tubes<'py>(
        &self,
        py: Python<'py>,
        points_a: &Bound<'py, PyAny>,
        radii_a: &Bound<'py, PyAny>,
        points_b: &Bound<'py, PyAny>,
        radii_b: &Bound<'py, PyAny>,
        #[pyo3(from_py_with = of::margin)] margin: f64,
        #[pyo3(from_py_with = of::resolution)] resolution: f64,
        tangents_a: Option<&Bound<'py, PyAny>>,
        tangents_b: Option<&Bound<'py, PyAny>>,
        #[pyo3(from_py_with = of::deviation_a)] deviation_a: f64,
        #[pyo3(from_py_with = of::deviation_b)] deviation_b: f64,
        #[pyo3(from_py_with = of::optional::turn_a)] turn_a: Option<f64>,
        #[pyo3(from_py_with = of::optional::turn_b)] turn_b: Option<f64>,
        pose_a: Option<&Bound<'py, PyAny>>,
        pose_b: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let given = Arguments {
            points: [points_a, points_b],
            radii: [radii_a, radii_b],
            poses: [pose_a, pose_b],
            tangents: [tangents_a, tangents_b],
            stated: [
                Stated { deviation: deviation_a, turn: turn_a },
                Stated { deviation: deviation_b, turn: turn_b },
            ],
        };
        self.note_frames(given.points, given.poses)?;
        self.0.clears_tubes(py, &given.robots()?, given.stated, [margin, resolution])
    }
}
