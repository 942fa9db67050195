//! The nearest triangle of every link.

use super::candidate_batch::CandidateBatch;
use crate::answer::LinkProximity;
use crate::pair::PlacedRobot;
use crate::search::hierarchy::MeshSearch;

/// What a query for every link leaves for the next.
#[derive(Clone, Default)]
pub(crate) struct PerLinkMemory {
    /// The closest triangle of each link at the last query.
    last: Vec<u32>,
    few: CandidateBatch,
}

impl PerLinkMemory {
    pub(crate) fn forget(&mut self) {
        self.last.clear();
    }
}

/// The closest triangle of every link of a robot, in `out`.
pub(crate) fn per_link(
    mut search: MeshSearch,
    robot: PlacedRobot,
    memory: &mut PerLinkMemory,
    out: &mut Vec<LinkProximity>,
) {
    let PerLinkMemory { last, few } = memory;
    out.clear();
    few.clear();
    let mut before = None;
    for number in 0..robot.links().len() {
        let link = robot.link(number);
        let start = [last.get(number).copied(), before];
        let answer = few.add(number, &link, |few| search.nearest_or_candidates(&link, start, few));
        before = Some(match answer {
            Ok(best) => {
                let nearest = best.nearest().unwrap_or_else(|| search.any(&link));
                out.push(link.answer(number, &nearest));
                nearest.triangle
            }
            Err(likely) => {
                out.push(LinkProximity::placeholder());
                likely
            }
        });
    }
    let MeshSearch { level, hierarchy, scratch, .. } = search;
    scratch.work.measured += few.answer(level, &hierarchy.mesh, out);
    last.clear();
    last.extend(out.iter().map(|answer| answer.triangle));
}
