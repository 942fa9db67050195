//! Queries about two robots, and about one robot and itself.

mod answers;
mod certify;
mod curves;
mod motions;
mod robot_pair;
mod self_query;
mod session;

pub(crate) use answers::segment_of;
pub(crate) use robot_pair::RobotPair;
pub(crate) use self_query::SelfQuery;

use crate::input::{Caps, Given, Names, Robots, stated_frame};
use crate::output::array_or_number;
use crate::threads::{Asked, ask_each};
use answers::{Row, proximities, proximities_of_segments, proximities_within};
use pyo3::prelude::*;
use session::{Pairs, Placed, Session};

impl RobotPair {
    /// Two robots or two batches, or one robot and a batch. Warns once if they state different
    /// frames.
    fn robots<'py>(
        &self,
        [points_a, radii_a, points_b, radii_b]: [&Bound<'py, PyAny>; 4],
        [pose_a, pose_b]: [Option<&Bound<'py, PyAny>>; 2],
    ) -> PyResult<Robots<'py>> {
        let py = points_a.py();
        let others = Robots::new(Names::PAIR[1], points_b, radii_b, pose_b)?;
        let robots =
            Robots::new(Names::PAIR[0], points_a, radii_a, pose_a)?.with_others(py, others)?;
        self.note_frames([points_a, points_b], [pose_a, pose_b])?;
        Ok(robots)
    }

    /// Warns once if the points of two robots state different frames. A pose may lead into another
    /// frame.
    fn note_frames(
        &self,
        [points_a, points_b]: [&Bound<'_, PyAny>; 2],
        poses: [Option<&Bound<'_, PyAny>>; 2],
    ) -> PyResult<()> {
        if poses.iter().any(Option::is_some) {
            return Ok(());
        }
        let frames = [stated_frame(points_a)?, stated_frame(points_b)?];
        self.1.note_pair(points_a.py(), Names::PAIR.map(|names| names.points), frames)
    }
}

impl Pairs {
    fn minimum<'py>(
        &self,
        py: Python<'py>,
        robots: &Robots<'py>,
        caps: Caps,
    ) -> PyResult<Bound<'py, PyAny>> {
        let mut rows = Vec::with_capacity(robots.len());
        let ask = |session: &mut Session, robot: &Given<'_>, row: &mut [Option<Row>]| {
            let Placed { pair, chains, poses, points, .. } = session.place(robot, caps)?;
            let found = pair.minimum(chains[0], &poses[0], chains[1], &poses[1])?;
            row[0] = Some(Row::new(found, chains, points));
            Ok(())
        };
        ask_each(py, self, robots, (None, 1), ask, |_, found| rows.extend_from_slice(found))?;
        proximities(py, robots, &rows)
    }

    fn per_link<'py>(
        &self,
        py: Python<'py>,
        robots: &Robots<'py>,
        caps: Caps,
    ) -> PyResult<Bound<'py, PyAny>> {
        let segments = robots.segments_each();
        let mut rows = Vec::with_capacity(robots.len() * segments);
        let ask = |session: &mut Session, robot: &Given<'_>, row: &mut [Option<Row>]| {
            let Placed { pair, chains, poses, points, found } = session.place(robot, caps)?;
            pair.per_link(chains[0], &poses[0], chains[1], &poses[1], found)?;
            for found in found.iter() {
                let found = Row::new(*found, chains, points);
                if let Some(row) =
                    usize::try_from(found.segments[0]).ok().and_then(|place| row.get_mut(place))
                {
                    *row = Some(found);
                }
            }
            Ok(())
        };
        ask_each(py, self, robots, (None, segments.max(1)), ask, |_, found| {
            rows.extend_from_slice(found)
        })?;
        proximities_of_segments(py, robots, &rows)
    }

    fn contacts_within<'py>(
        &self,
        py: Python<'py>,
        robots: &Robots<'py>,
        margin: f64,
        caps: Caps,
    ) -> PyResult<Bound<'py, PyAny>> {
        let (mut rows, mut offsets) = (Vec::new(), vec![0_i64]);
        let ask = |session: &mut Session, robot: &Given<'_>, row: &mut [Vec<Row>]| {
            let Placed { pair, chains, poses, points, found } = session.place(robot, caps)?;
            pair.contacts_within(chains[0], &poses[0], chains[1], &poses[1], margin, found)?;
            row[0] = found.iter().map(|found| Row::new(*found, chains, points)).collect();
            Ok(())
        };
        ask_each(py, self, robots, (Vec::new(), 1), ask, |_, found| {
            for found in found {
                rows.extend_from_slice(found);
                offsets.push(rows.len() as i64);
            }
        })?;
        proximities_within(py, &rows, offsets)
    }

    fn clears<'py>(
        &self,
        py: Python<'py>,
        robots: &Robots<'py>,
        margin: f64,
        caps: Caps,
    ) -> PyResult<Bound<'py, PyAny>> {
        let mut all: Vec<bool> = Vec::with_capacity(robots.len());
        let ask = |session: &mut Session, robot: &Given<'_>, row: &mut [bool]| {
            let Placed { pair, chains, poses, .. } = session.place(robot, caps)?;
            row[0] = pair.clears(chains[0], &poses[0], chains[1], &poses[1], margin)?;
            Ok(())
        };
        ask_each(py, self, robots, (false, 1), ask, |_, found| all.extend(found))?;
        array_or_number(py, robots.shape(&[]), all)
    }
}
