//! Queries about two robots at their poses.

use super::descent::{Descent, PairLimit, measure_pair};
use super::pair_minima::PairMinima;
use crate::answer::{ProximityError, RobotProximity};
use crate::pair::{PlacedLink, PlacedRobot};
use crate::robot::Chain;
use parry3d_f64::math::{Pose, Real};

/// The most pairs of links that `contacts_within` keeps at once: some megabytes.
const MAX_PAIRS: usize = 1 << 16;

/// State and memory that the next query reuses.
#[derive(Clone, Debug, Default)]
pub(crate) struct PairMemory {
    descent: Descent,
    minima: PairMinima,
    /// The closest links of the last query: the first candidate of the next.
    nearest: Option<[usize; 2]>,
    /// The links that violated the last margin.
    met: Option<[usize; 2]>,
}

impl PairMemory {
    pub fn forget(&mut self) {
        (self.nearest, self.met) = (None, None);
    }
}

/// All pairs of links of two robots are queried.
fn all(_: usize) -> usize {
    0
}

/// Two robots in one frame.
#[derive(Clone, Copy)]
pub(crate) struct TwoRobots<'a> {
    robots: [PlacedRobot<'a>; 2],
}

impl<'a> TwoRobots<'a> {
    /// Places two robots in one frame.
    ///
    /// # Errors
    /// A pose is not finite, not rigid, or moves a link out of range. Errors call the poses
    /// `names`.
    pub fn new(
        robots: [&'a Chain; 2],
        poses: [&Pose; 2],
        names: [&'static str; 2],
    ) -> Result<Self, ProximityError> {
        let placed = |k: usize| {
            PlacedRobot::new(robots[k], poses[k]).map_err(|error| error.of_robot(names[k]))
        };
        Ok(Self { robots: [placed(0)?, placed(1)?] })
    }

    fn both(&self) -> [&PlacedRobot<'a>; 2] {
        let [first, second] = &self.robots;
        [first, second]
    }

    fn links(&self, links: [usize; 2]) -> [PlacedLink; 2] {
        [self.robots[0].link(links[0]), self.robots[1].link(links[1])]
    }

    /// Returns the closest pair of links.
    pub fn minimum(&self, memory: &mut PairMemory) -> RobotProximity {
        let last = memory.nearest.filter(|links| self.have(*links));
        let mut best = last.map(|links| measure_pair(self.both(), links));
        memory.descent.run(self.both(), PairLimit::at_best(&best), all, |found| {
            PairLimit::at(best.insert(found))
        });
        // Without a limit the first pair searched is within it.
        let best = best.unwrap_or_else(|| measure_pair(self.both(), [0, 0]));
        memory.nearest = Some(best.links.map(|link| link as usize));
        best
    }

    /// Appends to `out` the closest link of the second robot for each link of the first.
    pub fn per_link(&self, memory: &mut PairMemory, out: &mut Vec<RobotProximity>) {
        let descent = &mut memory.descent;
        descent.begin(self.both());
        for link in 0..self.robots[0].links().len() {
            let mut best = None;
            descent.run_of_link(self.both(), link, |found| PairLimit::at(best.insert(found)));
            out.push(best.unwrap_or_else(|| measure_pair(self.both(), [link, 0])));
        }
    }

    /// Whether all pairs of links are farther apart than `margin`.
    pub fn clears(&self, margin: Real, memory: &mut PairMemory) -> bool {
        let meets = |links| {
            let [first, second] = self.links(links);
            first.measure_link_within(margin, &second).is_some()
        };
        if memory.met.is_some_and(|links| self.have(links) && meets(links)) {
            return false;
        }
        memory.met = None;
        let met = &mut memory.met;
        memory.descent.run(self.both(), PairLimit::of(margin), all, |found| {
            *met = Some(found.links.map(|link| link as usize));
            PairLimit::NOTHING
        });
        memory.met.is_none()
    }

    /// Appends to `out` the places where the robots are at most `margin` apart.
    pub fn contacts_within(
        &self,
        margin: Real,
        memory: &mut PairMemory,
        out: &mut Vec<RobotProximity>,
    ) {
        let PairMemory { descent, minima, .. } = memory;
        minima.start();
        let (push, end_rows) = (PairMinima::push, PairMinima::end_rows);
        descent.run_in_groups(self.both(), margin, MAX_PAIRS, minima, push, end_rows);
        out.extend(minima.finish().iter().map(|&links| measure_pair(self.both(), links)));
    }

    /// Whether the robots have these link numbers, which come from an earlier query.
    fn have(&self, links: [usize; 2]) -> bool {
        links.iter().zip(&self.robots).all(|(&link, robot)| link < robot.links().len())
    }
}
