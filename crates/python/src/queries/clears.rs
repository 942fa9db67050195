//! Whether a robot keeps a margin.

use super::chains::set_chain;
use super::chains::{ChainQuestion, ask_chains};
use crate::input::{Caps, Given, of};
use crate::mesh::Mesh;
use crate::output::{Enumeration, answer, array_or_number, members, side_value};
use crate::threads::{Asked, Session, ask_each};
use parry_continuum::Chain;
use parry_continuum::parry::math::Pose;
use parry_continuum::proximity::{BvhSearch, LinkProximity, Proximity, ProximityError};
use pyo3::prelude::*;

/// Whether a margin is kept.
struct Clears {
    margin: f64,
}

impl ChainQuestion for Clears {
    type Row = bool;
    type Answer = bool;

    fn ask(
        &self,
        search: &mut BvhSearch,
        (chain, pose): (&Chain, &Pose),
        _: &mut Vec<LinkProximity>,
        rows: &mut [bool],
    ) -> Result<(), ProximityError> {
        rows[0] = search.clears(chain, pose, self.margin)?;
        Ok(())
    }

    fn ask_batch(
        &self,
        search: &mut impl Proximity,
        robots: &[(&Chain, Pose)],
        out: &mut Vec<Result<bool, ProximityError>>,
    ) -> Result<(), ProximityError> {
        search.clears_batch(robots, self.margin, out)
    }

    fn keep(answer: &bool, rows: &mut [bool]) {
        rows[0] = *answer;
    }
}

#[pymethods]
impl Mesh {
    /// Whether robots keep more than a margin away: exactly ``distance(...) > margin``, for less
    /// work.
    ///
    /// Parameters
    /// ----------
    /// points, radii, pose, caps
    ///     As for `distance`.
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
    ///     The margin is negative or NaN, or as for `distance`.
    ///
    /// Examples
    /// --------
    /// >>> from parry_continuum import Mesh
    /// >>> floor = Mesh([[-9, -9, 0], [9, -9, 0], [0, 9, 0]], [[0, 1, 2]])
    /// >>> [floor.clears([[0, 0, 2], [1, 0, 2]], 0.5, margin=margin) for margin in (1.4, 1.5)]
    /// [True, False]
    #[pyo3(signature = (points, radii, *, margin, pose = None, caps = Caps::Fitted), text_signature = "($self, points, radii, *, margin, pose=None, caps=\"fitted\")")]
    fn clears<'py>(
        &self,
        py: Python<'py>,
        points: &Bound<'py, PyAny>,
        radii: &Bound<'py, PyAny>,
        #[pyo3(from_py_with = of::margin)] margin: f64,
        pose: Option<&Bound<'py, PyAny>>,
        caps: Caps,
    ) -> PyResult<Bound<'py, PyAny>> {
        let robots = self.robots(points, radii, pose)?;
        let mut all: Vec<bool> = Vec::with_capacity(robots.len());
        let question = (&Clears { margin }, caps);
        let keep = |_, found: &[bool]| all.extend(found);
        ask_chains(py, &self.engine(py), &robots, question, (false, 1), keep)?;
        array_or_number(py, robots.shape(&[]), all)
    }

    /// Whether robots keep more than a margin away, on which side their bases and tips are, and
    /// whether they cross an opening of the mesh.
    ///
    /// A robot whose base is inside and which touches neither the mesh nor the lid of an opening is
    /// inside as a whole. A lid is made of the triangles between the edges of an opening and its
    /// centre.
    ///
    /// Parameters
    /// ----------
    /// points, radii, pose, caps
    ///     As for `distance`.
    /// margin : float
    ///     A length, at least 0.
    ///
    /// Returns
    /// -------
    /// InsideAnswer
    ///     ``clears`` and ``crosses_opening``, ``base`` and ``tip``: bool and `Side`, or arrays of
    ///     them. ``holds`` says whether the whole robot is inside and the margin is kept.
    ///
    /// Raises
    /// ------
    /// ContinuumError
    ///     As for `clears`.
    #[pyo3(signature = (points, radii, *, margin, pose = None, caps = Caps::Fitted), text_signature = "($self, points, radii, *, margin, pose=None, caps=\"fitted\")")]
    fn clears_inside<'py>(
        &self,
        py: Python<'py>,
        points: &Bound<'py, PyAny>,
        radii: &Bound<'py, PyAny>,
        #[pyo3(from_py_with = of::margin)] margin: f64,
        pose: Option<&Bound<'py, PyAny>>,
        caps: Caps,
    ) -> PyResult<Bound<'py, PyAny>> {
        let robots = self.robots(points, radii, pose)?;
        self.note_sides(py)?;
        let (mut clears, mut crosses) = (Vec::new(), Vec::new());
        let (mut bases, mut tips) = (Vec::new(), Vec::new());
        let ask = |session: &mut Session, robot: &Given<'_>, row: &mut [([bool; 2], [i8; 2])]| {
            let chain = set_chain(&mut session.chain, robot, caps)?;
            let found = session.search.clears_inside(chain, &robot.pose()?, margin)?;
            let sides = [found.base, found.tip].map(side_value);
            row[0] = ([found.clears, found.crosses_opening], sides);
            Ok(())
        };
        ask_each(py, &self.engine(py), &robots, (Default::default(), 1), ask, |_, found| {
            clears.extend(found.iter().map(|found| found.0[0]));
            crosses.extend(found.iter().map(|found| found.0[1]));
            bases.extend(found.iter().map(|found| found.1[0]));
            tips.extend(found.iter().map(|found| found.1[1]));
        })?;
        let numbers = |values| array_or_number(py, robots.shape(&[]), values);
        let sides = |values| members(py, Enumeration::Side, robots.shape(&[]), values);
        let values = (numbers(clears)?, sides(bases)?, sides(tips)?, numbers(crosses)?);
        answer!(py, "InsideAnswer", values)
    }
}
