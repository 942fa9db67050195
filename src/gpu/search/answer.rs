//! From the candidates of a robot to its answer, in double precision on the CPU.
//!
//! A question is a value that implements [`Answer`]: the batch has no other code for it.

use super::kernels::Question;
use super::robots::Robots;
use crate::answer::{LinkProximity, ProximityError};
use crate::mesh::Mesh;
use crate::pair::{Best, Nearest, PlacedRobot, measure_each};
use fearless_simd::Level;
use parry3d_f64::math::Real;

/// Candidates that are measured at once for a decision.
const AT_ONCE: usize = 64;

/// A link and a triangle that may be the answer.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Candidate {
    /// The number of the link in its robot.
    pub link: u32,
    pub triangle: u32,
}

/// What the device has found about a robot.
pub(super) struct Found<'a> {
    /// A link is certainly within the margin.
    pub is_hit: bool,
    pub candidates: &'a [Candidate],
}

impl Found<'_> {
    /// Whether the robot clears the margin of the question, if that is certain.
    pub(super) fn decision(&self) -> Option<bool> {
        (self.is_hit || self.candidates.is_empty()).then_some(!self.is_hit)
    }
}

/// A question about robots, and how the CPU answers it from candidates.
pub(super) trait Answer: Sync {
    type Value: Clone + Send;

    fn question(&self) -> Question;

    /// The value in `out` until a robot is answered.
    fn placeholder(&self) -> Self::Value;

    /// Answers the robot with this number. `None`: the CPU searches for it. `old` is an answer of
    /// another batch, whose memory may be taken.
    fn answer(
        &self,
        measure: Measure,
        robot: usize,
        found: Found,
        old: &mut Result<Self::Value, ProximityError>,
    ) -> Option<Self::Value>;
}

/// The nearest triangle of each link.
pub(super) struct PerLink<'a>(pub Robots<'a>);

impl Answer for PerLink<'_> {
    type Value = Vec<LinkProximity>;

    fn question(&self) -> Question {
        Question::PerLink
    }

    fn placeholder(&self) -> Self::Value {
        Vec::new()
    }

    fn answer(
        &self,
        measure: Measure,
        robot: usize,
        found: Found,
        old: &mut Result<Self::Value, ProximityError>,
    ) -> Option<Self::Value> {
        let robot = self.0.placed(robot).ok()?;
        let memory = std::mem::replace(old, Ok(Vec::new())).unwrap_or_default();
        measure.per_link(&robot, found, memory)
    }
}

/// The closest link and its triangle.
pub(super) struct Minimum<'a>(pub Robots<'a>);

impl Answer for Minimum<'_> {
    type Value = LinkProximity;

    fn question(&self) -> Question {
        Question::Minimum
    }

    fn placeholder(&self) -> Self::Value {
        LinkProximity::placeholder()
    }

    fn answer(
        &self,
        measure: Measure,
        robot: usize,
        found: Found,
        _: &mut Result<Self::Value, ProximityError>,
    ) -> Option<Self::Value> {
        measure.minimum(&self.0.placed(robot).ok()?, found)
    }
}

/// Whether a robot clears a margin. Most robots need not be placed for that.
pub(super) struct Clears<'a> {
    pub robots: Robots<'a>,
    pub margin: Real,
}

impl Answer for Clears<'_> {
    type Value = bool;

    fn question(&self) -> Question {
        Question::Clears(self.margin)
    }

    fn placeholder(&self) -> bool {
        false
    }

    fn answer(
        &self,
        measure: Measure,
        robot: usize,
        found: Found,
        _: &mut Result<bool, ProximityError>,
    ) -> Option<bool> {
        if let decision @ Some(_) = found.decision() {
            return decision;
        }
        Some(measure.clears(&self.robots.placed(robot).ok()?, found, self.margin))
    }
}

/// The candidates within a margin, sorted and each once.
pub(super) struct Within {
    pub margin: Real,
}

impl Answer for Within {
    type Value = Vec<Candidate>;

    fn question(&self) -> Question {
        Question::Within(self.margin)
    }

    fn placeholder(&self) -> Self::Value {
        Vec::new()
    }

    fn answer(
        &self,
        _: Measure,
        _: usize,
        found: Found,
        _: &mut Result<Self::Value, ProximityError>,
    ) -> Option<Self::Value> {
        let mut candidates = found.candidates.to_vec();
        // The threads of the device write in any order; a tree of a single leaf has it twice.
        candidates.sort_unstable();
        candidates.dedup();
        Some(candidates)
    }
}

/// Measures candidates in a mesh. `None` stands for a link or a robot without a candidate.
#[derive(Clone, Copy)]
pub(super) struct Measure<'a> {
    pub level: Level,
    pub mesh: &'a Mesh,
}

impl Measure<'_> {
    /// The nearest triangle of each link, in `answers`.
    fn per_link(
        self,
        robot: &PlacedRobot,
        found: Found,
        mut answers: Vec<LinkProximity>,
    ) -> Option<Vec<LinkProximity>> {
        let links: Vec<_> = robot.placed_links().collect();
        let mut best = vec![Best::within(Real::INFINITY); links.len()];
        let pairs = found.candidates.iter().map(|of| (&links[of.link as usize], of.triangle));
        let mut candidates = found.candidates.iter();
        measure_each(self.level, self.mesh, pairs, |measured| {
            if let Some(candidate) = candidates.next() {
                best[candidate.link as usize].take(measured.nearest);
            }
        });
        answers.clear();
        answers.extend(
            links
                .iter()
                .zip(best)
                .enumerate()
                .map_while(|(number, (link, best))| Some(link.answer(number, &best.nearest()?))),
        );
        (answers.len() == links.len()).then_some(answers)
    }

    /// The closest candidate. Ties go to the lowest triangle, then to the lowest link.
    fn minimum(self, robot: &PlacedRobot, found: Found) -> Option<LinkProximity> {
        let links: Vec<_> =
            found.candidates.iter().map(|of| robot.link(of.link as usize)).collect();
        let pairs = links.iter().zip(found.candidates).map(|(link, of)| (link, of.triangle));
        let mut best: Option<((Real, u32, u32), usize, Nearest)> = None;
        let mut candidate = 0;
        measure_each(self.level, self.mesh, pairs, |measured| {
            let nearest = measured.nearest;
            let key = (nearest.distance, nearest.triangle, found.candidates[candidate].link);
            if best.is_none_or(|(least, ..)| key < least) {
                best = Some((key, candidate, nearest));
            }
            candidate += 1;
        });
        let ((.., link), candidate, nearest) = best?;
        Some(links[candidate].answer(link as usize, &nearest))
    }

    /// Whether every link is farther than the margin, if the device left that undecided.
    pub(super) fn clears(self, robot: &PlacedRobot, found: Found, margin: Real) -> bool {
        // A few at a time, because the first within the margin decides.
        found.candidates.chunks(AT_ONCE).all(|candidates| {
            let links: Vec<_> = candidates.iter().map(|of| robot.link(of.link as usize)).collect();
            let pairs = links.iter().zip(candidates).map(|(link, of)| (link, of.triangle));
            let mut is_clear = true;
            measure_each(self.level, self.mesh, pairs, |measured| {
                is_clear &= measured.nearest.distance > margin;
            });
            is_clear
        })
    }
}
