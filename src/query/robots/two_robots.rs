//! The questions about two robots at their poses.

use super::descent::{Descent, Limit};
use super::local_minima::LocalMinima;
use crate::answer::{ProximityError, RobotProximity};
use crate::pair::{PlacedLink, PlacedRobot};
use crate::robot::Chain;
use parry3d_f64::math::{Pose, Real};
use std::ops::Range;

/// What one query leaves for the next.
#[derive(Clone, Debug, Default)]
pub(crate) struct PairMemory {
    descent: Descent,
    minima: LocalMinima,
    /// The links that were nearest, which are the first to be looked at again.
    nearest: Option<[usize; 2]>,
    /// The links that did not keep a margin.
    met: Option<[usize; 2]>,
}

impl PairMemory {
    pub fn forget(&mut self) {
        (self.nearest, self.met) = (None, None);
    }
}

/// Of two robots all pairs of links are asked for.
fn all(_: [Range<usize>; 2]) -> bool {
    true
}

/// Two robots in one frame.
#[derive(Clone, Copy)]
pub(crate) struct TwoRobots<'a> {
    robots: [PlacedRobot<'a>; 2],
}

impl<'a> TwoRobots<'a> {
    /// # Errors
    /// A pose is not finite or not rigid, or moves a link out of range; the poses are called `names`.
    pub fn new(
        robots: [&'a Chain; 2],
        poses: [&Pose; 2],
        names: [&'static str; 2],
    ) -> Result<Self, ProximityError> {
        let placed =
            |k: usize| PlacedRobot::new(robots[k], poses[k]).map_err(|error| error.of_robot(names[k]));
        Ok(Self { robots: [placed(0)?, placed(1)?] })
    }

    fn both(&self) -> [&PlacedRobot<'a>; 2] {
        let [first, second] = &self.robots;
        [first, second]
    }

    fn links(&self, links: [usize; 2]) -> [PlacedLink; 2] {
        [self.robots[0].link(links[0]), self.robots[1].link(links[1])]
    }

    /// The two links if they are at most `bound` apart.
    fn measure_within(&self, bound: Real, links: [usize; 2]) -> Option<RobotProximity> {
        let [first, second] = self.links(links);
        let nearest = first.measure_link_within(bound, &second)?;
        Some(nearest.answer(links, [&first, &second]))
    }

    /// The two links that are nearest.
    pub fn minimum(&self, memory: &mut PairMemory) -> RobotProximity {
        let last = memory.nearest.filter(|links| self.have(*links)).unwrap_or([0, 0]);
        let [first, second] = self.links(last);
        let mut best = first.measure_link(&second).answer(last, [&first, &second]);
        memory.descent.run(self.both(), Limit::at(&best), all, |links| {
            if !best.is_of(links)
                && let Some(found) = self.measure_within(best.distance, links)
                && found.comes_before(&best)
            {
                best = found;
            }
            Limit::at(&best)
        });
        memory.nearest = Some(best.links.map(|link| link as usize));
        best
    }

    /// Of each link of the first robot, the nearest link of the second.
    pub fn per_link(&self, memory: &mut PairMemory, out: &mut Vec<RobotProximity>) {
        let last = self.robots[1].links().len() - 1;
        memory.descent.run_per_link(self.both(), |link, other| {
            let Some(other) = other else {
                // Neighbours have near neighbours: what was nearest to the last link bounds this one.
                let guess = out.last().map_or(0, |best| best.links[1] as usize).min(last);
                let [first, second] = self.links([link, guess]);
                let best = first.measure_link(&second).answer([link, guess], [&first, &second]);
                out.push(best);
                return Limit::at(&best);
            };
            let Some(best) = out.last_mut() else { return Limit::NOTHING };
            if !best.is_of([link, other])
                && let Some(found) = self.measure_within(best.distance, [link, other])
                && found.comes_before(best)
            {
                *best = found;
            }
            Limit::at(best)
        });
    }

    /// Whether all links are farther apart than `margin`.
    pub fn clears(&self, margin: Real, memory: &mut PairMemory) -> bool {
        let meets = |links| self.measure_within(margin, links).is_some();
        if memory.met.is_some_and(|links| self.have(links) && meets(links)) {
            return false;
        }
        memory.met = None;
        let met = &mut memory.met;
        memory.descent.run(self.both(), Limit::of(margin), all, |links| {
            if meets(links) {
                *met = Some(links);
                return Limit::NOTHING;
            }
            Limit::of(margin)
        });
        memory.met.is_none()
    }

    /// The places where the robots are at most `margin` apart.
    pub fn within(&self, margin: Real, memory: &mut PairMemory, out: &mut Vec<RobotProximity>) {
        let PairMemory { descent, minima, .. } = memory;
        minima.start();
        descent.run(self.both(), Limit::of(margin), all, |links| {
            if let Some(found) = self.measure_within(margin, links) {
                minima.push(found);
            }
            Limit::of(margin)
        });
        minima.finish(out);
    }

    /// Whether the robots have the links that others had.
    fn have(&self, links: [usize; 2]) -> bool {
        links.iter().zip(&self.robots).all(|(&link, robot)| link < robot.links().len())
    }
}
