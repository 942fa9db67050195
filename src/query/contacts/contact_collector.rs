//! Collects the contacts of a robot, link by link.
//!
//! 1. The search adds each link with the triangles that may be within the margin. Triangles
//!    that certainly hold no reported minimum are culled at once.
//! 2. When enough triangles are to be measured, all links so far are *flushed*: their triangles are
//!    measured together, their local minima found (`local_minima` has the definition and the
//!    algorithm), and the contacts computed. With a prominence, shallow contacts are dropped.

use super::local_minima::{CULLED, CullRing, NONE, Sweep, SweepRing, cull, nearest_first};
use super::long_rings::LongRings;
use super::prominence::{ContactQuery, LinkNeighbourhood, Prominence};
use super::triangle_candidates::{
    CandidateEnd, CandidateIndex, NearLink, TriangleCandidates, Wall,
};
use crate::answer::{Contact, LinkProximity};
use crate::pair::{Measurement, PlacedLink, PlacedPair, PlacedRobot, add_contacts, measure_each};
use fearless_simd::Level;
use parry3d_f64::math::Real;
use std::ops::Range;

/// Links are collected until more triangles than this are to be measured. More fill the packs
/// better; fewer need less memory.
const FLUSH_AT: usize = 1 << 12;

/// State of a query; its memory is reused by later queries.
#[derive(Clone, Default)]
pub(crate) struct ContactMemory {
    /// The links that may be near the wall.
    links: Vec<ActiveLink>,
    /// The triangles that may be within the margin, link by link.
    triangles: TriangleCandidates,
    /// The rank of each candidate among the triangles of its link, or [`CULLED`] or [`NONE`].
    ranks: Vec<u32>,
    /// The index of the candidates of the current link.
    index: CandidateIndex,
    /// The triangles to measure, link by link.
    measured: Vec<u32>,
    /// The measurement of each triangle in `measured`.
    ranked: Vec<Measurement>,
    /// Long rings near the current link, for the culling and for the sweep.
    cull_rings: LongRings<CullRing>,
    sweep_rings: LongRings<SweepRing>,
    /// Union-find: for each rank an earlier one of the same piece, or itself.
    piece: Vec<u32>,
    /// The minima that were found.
    found: Vec<LinkProximity>,
    prominence: Prominence,
    /// For each contact whether it is prominent.
    are_prominent: Vec<bool>,
}

/// A link that may be near the wall.
#[derive(Clone)]
struct ActiveLink {
    number: usize,
    link: PlacedLink,
    /// The begin and end of its candidates.
    triangles: [CandidateEnd; 2],
    measured: Range<usize>,
}

/// Collects the contacts of a robot in `out`, link by link.
pub(crate) struct ContactCollector<'a> {
    level: Level,
    wall: Wall<'a>,
    robot: PlacedRobot<'a>,
    query: ContactQuery,
    memory: &'a mut ContactMemory,
    out: &'a mut Vec<Contact>,
    /// The number of triangles measured.
    measured: u64,
}

impl<'a> ContactCollector<'a> {
    /// A collector without contacts.
    pub(crate) fn new(
        level: Level,
        wall: Wall<'a>,
        robot: PlacedRobot<'a>,
        query: ContactQuery,
        memory: &'a mut ContactMemory,
        out: &'a mut Vec<Contact>,
    ) -> Self {
        memory.clear();
        Self { level, wall, robot, query, memory, out, measured: 0 }
    }

    /// Adds the next link. `find_candidates` adds the triangles that may be within the margin, each
    /// once; some may be farther.
    pub(crate) fn add(
        &mut self,
        number: usize,
        find_candidates: impl FnOnce(&PlacedLink, &mut TriangleCandidates),
    ) {
        let (link, memory) = (self.robot.link(number), &mut *self.memory);
        let (begin, measured) = (memory.triangles.end(), memory.measured.len());
        find_candidates(&link, &mut memory.triangles);
        let triangles = [begin, memory.triangles.end()];
        memory.cull(self.wall, triangles);
        let measured = measured..memory.measured.len();
        memory.links.push(ActiveLink { number, link, triangles, measured });
        if memory.measured.len() > FLUSH_AT {
            self.flush();
        }
    }

    /// Writes the contacts of all links, nearest first for each link. Returns the number of
    /// triangles measured.
    pub(crate) fn finish(mut self) -> u64 {
        self.flush();
        self.measured
    }

    /// Finds the contacts of the links collected so far.
    fn flush(&mut self) {
        let Self { level, wall, robot, query, .. } = *self;
        self.memory.find_minima(level, wall, query.margin);
        let mut links = self.memory.links.iter().peekable();
        let placed_pair = |found: &LinkProximity| {
            // Both are in the order of links.
            while links.next_if(|at| at.number < found.link as usize).is_some() {}
            let link = links.peek().map_or_else(|| robot.link(found.link as usize), |at| at.link);
            let corners = wall.mesh.corners(found.witness.triangle);
            PlacedPair::new(&link, corners, robot.length_before(found.link as usize))
        };
        let first = self.out.len();
        add_contacts(level, &self.memory.found, placed_pair, self.out);
        if query.prominence > 0.0 {
            self.memory.drop_shallow(level, wall, query, first, self.out);
        }
        self.measured += self.memory.measured.len() as u64;
        self.memory.clear();
    }
}

impl ContactMemory {
    fn clear(&mut self) {
        self.links.clear();
        self.triangles.clear();
        self.ranks.clear();
        self.measured.clear();
    }

    /// Culls candidates of a link, and adds the others to the triangles to measure.
    fn cull(&mut self, wall: Wall, triangles: [CandidateEnd; 2]) {
        let candidates = self.triangles.between(triangles);
        if candidates.triangles.is_empty() {
            return;
        }
        self.index.number(candidates, wall.mesh.len());
        let first = self.ranks.len();
        self.ranks.resize(first + candidates.triangles.len(), NONE);
        let ranks = &mut self.ranks[first..];
        cull(&NearLink { wall, candidates, index: &self.index }, ranks, &mut self.cull_rings);
        let others = candidates.triangles.iter().zip(ranks).filter(|(_, rank)| **rank != CULLED);
        self.measured.extend(others.map(|(known, _)| known.triangle));
    }

    /// Finds the local minima of all links, nearest first for each link.
    fn find_minima(&mut self, level: Level, wall: Wall, margin: Real) {
        self.ranked.clear();
        let of_link = |at: &ActiveLink| self.measured[at.measured.clone()].iter();
        let pairs =
            self.links.iter().flat_map(|at| of_link(at).map(|&triangle| (&at.link, triangle)));
        measure_each(level, wall.mesh, pairs, |ranked| self.ranked.push(ranked));
        self.found.clear();
        for ActiveLink { number: link_number, link, triangles, measured } in &self.links {
            let candidates = self.triangles.between(*triangles);
            let ranked = nearest_first(&mut self.ranked[measured.clone()], margin);
            if ranked.is_empty() {
                continue;
            }
            self.index.number(candidates, wall.mesh.len());
            let near = &NearLink { wall, candidates, index: &self.index };
            let ranks = &mut self.ranks[triangles[0].triangles..triangles[1].triangles];
            for (rank, ranked) in (1..).zip(ranked) {
                if let Some(candidate) = near.index_of(ranked.nearest.triangle) {
                    ranks[candidate] = rank;
                }
            }
            self.sweep_rings.clear();
            let (piece, rings) = (&mut self.piece, &mut self.sweep_rings);
            let mut sweep = Sweep { link, near, ranks, ranked, piece, rings };
            let minima = sweep.first_triangles();
            self.found.extend(minima.map(|nearest| link.answer(*link_number, nearest)));
        }
    }

    /// Drops the contacts, from `first` on, that are not prominent.
    fn drop_shallow(
        &mut self,
        level: Level,
        wall: Wall,
        query: ContactQuery,
        first: usize,
        contacts: &mut Vec<Contact>,
    ) {
        self.are_prominent.clear();
        let mut of_links =
            contacts[first..].chunk_by(|one, other| one.link == other.link).peekable();
        for ActiveLink { number, link, triangles, .. } in &self.links {
            let Some(of_link) = of_links.next_if(|of_link| of_link[0].link as usize == *number)
            else {
                continue;
            };
            let candidates = self.triangles.between(*triangles);
            self.index.number(candidates, wall.mesh.len());
            let near = NearLink { wall, candidates, index: &self.index };
            let around = LinkNeighbourhood { link, near, margin: query.margin };
            self.prominence.find_prominent(
                level,
                around,
                query.prominence,
                of_link,
                &mut self.are_prominent,
            );
        }
        let mut are_prominent =
            std::iter::repeat_n(true, first).chain(self.are_prominent.iter().copied());
        contacts.retain(|_| are_prominent.next().unwrap_or(true));
    }
}

/// The contacts of a robot, for an engine without its own search for contacts.
#[cfg(feature = "gpu")]
pub(crate) fn contacts_by_all_triangles(
    wall: Wall,
    robot: PlacedRobot,
    query: ContactQuery,
    out: &mut Vec<Contact>,
) {
    let mut memory = ContactMemory::default();
    let mut contacts = ContactCollector::new(Level::new(), wall, robot, query, &mut memory, out);
    for number in 0..robot.links().len() {
        contacts.add(number, |link, candidates| {
            let may_meet =
                |triangle: &u32| link.at_least(wall.mesh.corners(*triangle)) <= query.margin;
            candidates.add_unclassified((0..wall.mesh.len() as u32).filter(may_meet));
        });
    }
    contacts.finish();
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::Mesh;
    use crate::robot::Chain;
    use continuum_testing::Random;
    use parry3d_f64::math::{Pose, Vector};

    /// Adds all links, and all triangles to each. Writes the contacts if the query is not
    /// abandoned.
    fn ask(
        mesh: &Mesh,
        robot: &Chain,
        memory: &mut ContactMemory,
        is_abandoned: bool,
    ) -> Vec<Contact> {
        let robot = PlacedRobot::new(robot, &Pose::IDENTITY).unwrap();
        let (query, mut out) = (ContactQuery { margin: 2.0, prominence: 0.1 }, Vec::new());
        let mut contacts =
            ContactCollector::new(Level::new(), Wall::of(mesh), robot, query, memory, &mut out);
        for number in 0..robot.links().len() {
            contacts.add(number, |_, candidates| candidates.add_unclassified(0..mesh.len() as u32));
        }
        if !is_abandoned {
            contacts.finish();
        }
        out
    }

    /// A query answers as one with fresh memory, after queries about other meshes and robots, and
    /// after one that was abandoned half way.
    #[test]
    fn earlier_queries_leave_nothing_behind() {
        let random = &mut Random::new(53);
        let (mut memory, mut found) = (ContactMemory::default(), 0);
        for round in 0..60 {
            let count = 3 + random.below(12);
            let corners = (0..count).map(|_| random.point() * 2.0).collect();
            let triangles = (0..2 * count).map(|_| [0; 3].map(|_| random.below(count))).collect();
            let mesh = Mesh::of(corners, triangles);
            let points: Vec<_> =
                (0..2 + random.below(4)).map(|_| random.point()).collect::<Vec<Vector>>();
            let robot = Chain::capsules(&points, &vec![0.1; points.len() - 1]).unwrap();
            if round % 3 == 0 {
                ask(&mesh, &robot, &mut memory, true);
            } else {
                let fresh = ask(&mesh, &robot, &mut ContactMemory::default(), false);
                assert_eq!(ask(&mesh, &robot, &mut memory, false), fresh, "{round}");
                found += fresh.len();
            }
        }
        assert!(found > 100, "{found}");
    }
}
