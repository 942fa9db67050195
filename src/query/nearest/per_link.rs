//! The nearest triangle of every link.
//!
//! Each search starts at two triangles: the link's own answer of the last query, and the answer of
//! the link before it. Links with few candidates are measured together at the end
//! ([`CandidateBatch`]).

use super::candidate_batch::CandidateBatch;
use crate::answer::LinkProximity;
use crate::pair::PlacedRobot;
use crate::search::hierarchy::MeshSearch;

/// State that warm-starts the next query.
#[derive(Clone, Default)]
pub(crate) struct PerLinkMemory {
    /// The nearest triangle of each link at the last query.
    last: Vec<u32>,
    few: CandidateBatch,
}

impl PerLinkMemory {
    pub(crate) fn forget(&mut self) {
        self.last.clear();
    }
}

/// Writes the nearest triangle of every link of a robot to `out`, in the order of the links.
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
    last.extend(out.iter().map(|answer| answer.witness.triangle));
}
