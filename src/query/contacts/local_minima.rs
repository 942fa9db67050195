//! The local minima of the distance between one link and a mesh: triangles sorted by distance, and
//! union-find.
//!
//! # Definitions
//! - d(x): the distance of a point x from the link. d(T), d(f): the least distance of a triangle T,
//!   and of a corner or an edge f.
//! - Two triangles *share* f if both have it, at the same place. f is a corner, an edge, or a
//!   *seam*: a stretch in which open edges touch within the rounding of their coordinates
//!   ([`SharedParts`](crate::mesh::SharedParts)).
//! - gap(f): a bound on the distance between f and either triangle that shares it. It is 0 where
//!   corners are equal. A triangle with an f of another gap, or with a seam, is *loose*.
//! - The wall within c: all points x of the mesh with `d(x) <= c`. A *piece* is a connected
//!   component of the wall within c. As c grows, pieces appear, grow and merge.
//! - *Local minimum*: the nearest point of a piece, where the piece appears.
//! - t: the rounding of a distance, `32 u extent` of the link and a triangle, edge or corner. It is
//!   far above the error of a measurement. `2 t` stands for t of the triangle where a piece
//!   appeared, plus t and gap(f) of the f where the piece merges.
//!
//! If two pieces merge at most `2 t` above the farther of their minima, the farther piece *ends*:
//! its minimum is not reported. So a flat wall along the link, whose triangles tie within rounding,
//! is one piece. A triangle whose least point lies on a nearer neighbour starts no piece of its
//! own. Since the nearer piece stays, the nearest point of each connected piece of wall within the
//! margin is always reported.
//!
//! # Claim
//! A path on the wall goes through triangles. It changes from one to another only at an f that both
//! share, and may jump there by gap(f).
//!
//! 1. *None is missed*: from every point x of the wall a path on the wall leads to a reported
//!    minimum. Along it d never exceeds `d(x) + 2 t`.
//! 2. *None is found twice*: each path from one reported minimum to another exceeds the farther of
//!    the two by more than `2 t`.
//! 3. *Each is a minimum*: let T' be a triangle that contains it, or that shares an f within gap(f)
//!    of it with the minimum's triangle. No point of T' is nearer, beyond `2 t`.
//!
//! Coincident triangles share their corners and edges, but not their faces. So a minimum between
//! their edges is reported once for each. Closed surfaces that touch one another share only equal
//! corners, because neither has an open edge.
//!
//! # Reduction to a graph
//! The link is convex, so d is a convex function. So the part of a triangle with `d <= c` is
//! convex, and connected. T belongs to the wall within c from `c = d(T)` on, as one piece. Two
//! triangles that share f are joined by f exactly from `c = d(f)` on, when both pieces contain the
//! nearest point of f.
//!
//! So the pieces are the components of a graph. Its nodes are the triangles; T exists from d(T) on.
//! It has an edge for each shared f, from `d(f) >= max(d(T), d(T'))` on. With a gap, d(f) is
//! measured at one side, and `d(f) + gap(f)` is not less than either distance.
//!
//! Of all triangles around a place or an edge, one pair joined by a seam is enough: each of the
//! others shares with one of the two a corner or edge that contains the seam.
//!
//! # Algorithm
//! 1. **Cull** triangles that certainly hold no reported minimum (see below).
//! 2. **Measure** the others and sort them, nearest first; ties by the triangle's number.
//! 3. **Sweep.** Each triangle T in turn starts a piece. It meets a piece at each f that it shares
//!    with an earlier, nearer triangle. If d(f) is at most `2 t` above the farther of the two
//!    minima, the piece with that minimum ends. (This is the elder rule of persistent homology.)
//! 4. **Report** the first triangle of each piece that has not ended.
//!
//! If the least point of T lies on f, d(f) is d(T) and is not computed. That holds for nearly all
//! f.
//!
//! # Proof
//! - Claim 2. The sweep handles f at d(T), before d(f), but misses no pair of pieces thereby. The
//!   minimum of a piece that could end is at least `d(f) - 2 t >= d(T) - 2 t`, and every triangle
//!   nearer than T has been processed.
//! - Claim 1. Go from x straight to the least point of its triangle. Whenever the piece there has
//!   ended, go through its f to the piece that it joined, whose minimum is nearer.
//! - Claim 3. A triangle that contains the minimum of T shares with T an f there, with
//!   `d(f) <= d(T) + 2 t`. So one of the two pieces ended: the piece of T, if the other one is
//!   nearer.
//!
//! # Culling
//! Most triangles lie on a slope: their nearest point is on a shared edge or corner f, and the
//! other triangle is nearer by far more than `2 t`. The search detects that from the neighbour
//! (`descent_cull`) or from the bounds of all candidates (`feature_cull`). A triangle D is *culled*
//! in two cases:
//! - It lies on a slope. At d(D) it joins a piece whose minimum is nearer by far more than `2 t`,
//!   so no piece ever ends in favour of D.
//! - Its nearest point is on an f that it shares with a culled triangle. At d(f) it joins that
//!   triangle, which is in such a piece from a distance on that is not greater.
//!
//! A loose triangle is never culled, since the proofs need the nearest point of D to lie exactly on
//! f. So gaps occur only between triangles that are measured.
//!
//! Culled triangles still count where other pieces meet them. If a piece shares f with D, and d(f)
//! is at most `2 t` above the minimum of that piece, the piece ends. For `d(f) >= d(D)`, so the
//! minimum of D's piece is the nearer one. The piece to which D belongs makes no difference, so all
//! culled triangles count as one piece, nearer than any other ([`CULLED`]).
//!
//! An f that is certainly farther than the nearest point of a triangle joins that triangle to no
//! nearer one. Such an f is skipped.
//!
//! # Cost
//! A triangle queries all triangles that share a corner or an edge with it: whether one is nearer
//! by far or culled, and which came first. The answers are the same for the whole ring, so a long
//! ring is evaluated once (`wall_components`). So the cost grows linearly with the triangles near a
//! link and around their corners.
//!
//! # Overlap
//! Where link and wall overlap, d = 0. A piece is then a connected piece of wall inside the link,
//! and one contact. Its representative is the triangle nearest to the axis; ties go to the lowest
//! triangle.

use super::prominence::{ContactQuery, LinkNeighbourhood, Prominence};
use super::triangle_candidates::{CandidateEnd, CandidateIndex, TriangleCandidates, Wall};
use super::wall_components::{CULLED, FEW, IncidentTriangles, LongRings, NONE, WallComponents};
use crate::answer::{Contact, LinkProximity};
use crate::pair::{PlacedLink, PlacedPair, PlacedRobot, Ranked, add_contacts, rank_each};
use fearless_simd::Level;
use parry3d_f64::math::Real;
use std::ops::Range;

/// Links are collected until more triangles than this are to be measured. More fill the packs
/// better; fewer need less memory.
const FLUSH_AT: usize = 1 << 12;

/// State of a query; its memory is reused by later queries.
#[derive(Clone, Default)]
pub(crate) struct LocalMinima {
    /// The links that may be near the wall.
    links: Vec<ActiveLink>,
    /// The triangles that may be within the margin, link by link.
    triangles: TriangleCandidates,
    /// For each candidate its index in the sorted triangles of its link, counted from 1; or
    /// [`CULLED`] or [`NONE`].
    places: Vec<u32>,
    /// The index of the candidates of the current link.
    index: CandidateIndex,
    /// The triangles to measure, link by link.
    measured: Vec<u32>,
    /// The measurement of each triangle in `measured`.
    ranked: Vec<Ranked>,
    /// Long rings, as they concern a triangle that may be culled, and one that may be joined.
    lowest: LongRings<Lowest>,
    around: LongRings<IncidentTriangles>,
    /// Union-find: for each index an earlier one of the same piece, or itself.
    piece: Vec<u32>,
    /// The minima that were found.
    found: Vec<LinkProximity>,
    prominence: Prominence,
    /// For each contact whether it is prominent.
    keep: Vec<bool>,
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

/// The ring of a corner or an edge, as it concerns a triangle whose nearest point lies there.
#[derive(Clone)]
struct Lowest {
    /// The least upper bound on the distance of a candidate in the ring.
    upper: Real,
    /// Whether a triangle of the ring is culled.
    is_left_out: bool,
}

impl Default for Lowest {
    fn default() -> Self {
        Self { upper: Real::INFINITY, is_left_out: false }
    }
}

/// Collects the contacts of a robot in `out`, link by link.
pub(crate) struct ContactCollector<'a> {
    level: Level,
    wall: Wall<'a>,
    robot: PlacedRobot<'a>,
    query: ContactQuery,
    minima: &'a mut LocalMinima,
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
        minima: &'a mut LocalMinima,
        out: &'a mut Vec<Contact>,
    ) -> Self {
        minima.clear();
        Self { level, wall, robot, query, minima, out, measured: 0 }
    }

    /// Adds the next link. `near` adds the triangles that may be within the margin, each once; some
    /// may be farther.
    pub(crate) fn add(
        &mut self,
        number: usize,
        near: impl FnOnce(&PlacedLink, &mut TriangleCandidates),
    ) {
        let (link, minima) = (self.robot.link(number), &mut *self.minima);
        let (begin, measured) = (minima.triangles.end(), minima.measured.len());
        near(&link, &mut minima.triangles);
        let triangles = [begin, minima.triangles.end()];
        minima.cull(self.wall, triangles);
        let measured = measured..minima.measured.len();
        minima.links.push(ActiveLink { number, link, triangles, measured });
        if minima.measured.len() > FLUSH_AT {
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
        self.minima.find_minima(level, wall, query.margin);
        let mut links = self.minima.links.iter().peekable();
        let place = |found: &LinkProximity| {
            // Both are in the order of links.
            while links.next_if(|at| at.number < found.link as usize).is_some() {}
            let link = links.peek().map_or_else(|| robot.link(found.link as usize), |at| at.link);
            PlacedPair {
                ends: [link.start(), link.end()],
                radius: link.radius(),
                flat: link.flat(),
                corners: wall.mesh.corners(found.witness.triangle),
                before: robot.length_before(found.link as usize),
            }
        };
        let first = self.out.len();
        add_contacts(level, &self.minima.found, place, self.out);
        if query.prominence > 0.0 {
            self.minima.keep_prominent(level, wall, query, first, self.out);
        }
        self.measured += self.minima.measured.len() as u64;
        self.minima.clear();
    }
}

impl LocalMinima {
    fn clear(&mut self) {
        self.links.clear();
        self.triangles.clear();
        self.places.clear();
        self.measured.clear();
    }

    /// Step 1: culls the candidates of a link that certainly lie on a slope towards a nearer
    /// triangle.
    fn cull(&mut self, wall: Wall, triangles: [CandidateEnd; 2]) {
        let near = self.triangles.between(triangles);
        if near.in_question.is_empty() {
            return;
        }
        self.index.number(near, wall.mesh.len());
        let shared = wall.mesh.parts();
        let first = self.places.len();
        self.places.resize(first + near.in_question.len(), NONE);
        let places = &mut self.places[first..];
        self.lowest.clear();
        // A culled triangle may cull another; the second round finds most such cases.
        for _ in 0..2 {
            for (place, known) in near.in_question.iter().enumerate() {
                let Some(foot) = known.nearest_feature().filter(|_| places[place] != CULLED) else {
                    continue;
                };
                if shared.is_loose(known.triangle) {
                    continue;
                }
                let mut others = shared.others(known.triangle, foot);
                let leaves_out = |other: u32| match near.index(&self.index, other) {
                    Some(index) => {
                        near.in_question[index].upper < known.lower || places[index] == CULLED
                    }
                    None => near.is_culled(&self.index, wall.place_of(), other),
                };
                let mut is_left_out = others.by_ref().take(FEW).any(leaves_out);
                if !is_left_out && others.next().is_some() {
                    let add = |lowest: &mut Lowest, other: u32, index: Option<usize>| match index {
                        Some(index) => {
                            lowest.upper = lowest.upper.min(near.in_question[index].upper);
                            lowest.is_left_out |= places[index] == CULLED;
                        }
                        None => {
                            lowest.is_left_out |=
                                near.is_culled(&self.index, wall.place_of(), other)
                        }
                    };
                    let lowest = self.lowest.around(shared, near, &self.index, [place, foot], add);
                    // The ring includes the triangle itself, but its `upper` is not below its
                    // `lower`.
                    is_left_out = lowest.is_left_out || lowest.upper < known.lower;
                }
                if is_left_out {
                    places[place] = CULLED;
                    self.lowest.all_around(place, |lowest| lowest.is_left_out = true);
                }
            }
        }
        let others = near.in_question.iter().zip(places).filter(|(_, place)| **place != CULLED);
        self.measured.extend(others.map(|(known, _)| known.triangle));
    }

    /// Steps 2 to 4: finds the local minima of all links, nearest first for each link.
    fn find_minima(&mut self, level: Level, wall: Wall, margin: Real) {
        self.ranked.clear();
        let of_link = |at: &ActiveLink| self.measured[at.measured.clone()].iter();
        let pairs =
            self.links.iter().flat_map(|at| of_link(at).map(|&triangle| (&at.link, triangle)));
        rank_each(level, wall.mesh, pairs, |ranked| self.ranked.push(ranked));
        self.found.clear();
        for ActiveLink { number: link_number, link, triangles, measured } in &self.links {
            let near = self.triangles.between(*triangles);
            let ranked = nearest_first(&mut self.ranked[measured.clone()], margin);
            if ranked.is_empty() {
                continue;
            }
            self.index.number(near, wall.mesh.len());
            let places = &mut self.places[triangles[0].in_question..triangles[1].in_question];
            for (place, ranked) in (1..).zip(ranked) {
                if let Some(index) = near.index(&self.index, ranked.nearest.triangle) {
                    places[index] = place;
                }
            }
            self.around.clear();
            let (index, piece, around) = (&self.index, &mut self.piece, &mut self.around);
            let mut pieces =
                WallComponents { link, wall, near, places, index, ranked, piece, around };
            self.found
                .extend(pieces.first_triangles().map(|nearest| link.answer(*link_number, nearest)));
        }
    }

    /// Drops the contacts, from `first` on, that are not prominent.
    fn keep_prominent(
        &mut self,
        level: Level,
        wall: Wall,
        query: ContactQuery,
        first: usize,
        contacts: &mut Vec<Contact>,
    ) {
        self.keep.clear();
        let mut of_links =
            contacts[first..].chunk_by(|one, other| one.link == other.link).peekable();
        for ActiveLink { number, link, triangles, .. } in &self.links {
            let Some(of_link) = of_links.next_if(|of_link| of_link[0].link as usize == *number)
            else {
                continue;
            };
            let near = self.triangles.between(*triangles);
            self.index.number(near, wall.mesh.len());
            let around =
                LinkNeighbourhood { link, wall, near, index: &self.index, margin: query.margin };
            self.prominence.keep_prominent(
                level,
                around,
                query.prominence,
                of_link,
                &mut self.keep,
            );
        }
        let mut keep = std::iter::repeat_n(true, first).chain(self.keep.iter().copied());
        contacts.retain(|_| keep.next().unwrap_or(true));
    }
}

/// Sorts the triangles, nearest first, and returns those within the margin.
fn nearest_first(ranked: &mut [Ranked], margin: Real) -> &[Ranked] {
    // Triangles beyond the margin come last, because their rank is their distance.
    ranked.sort_unstable_by(|a, b| {
        a.rank.total_cmp(&b.rank).then(a.nearest.triangle.cmp(&b.nearest.triangle))
    });
    let count = ranked.partition_point(|ranked| ranked.nearest.distance <= margin);
    &ranked[..count]
}

/// The contacts of a robot, for an engine without its own search for contacts.
#[cfg(feature = "gpu")]
pub(crate) fn contacts_by_all_triangles(
    wall: Wall,
    robot: PlacedRobot,
    query: ContactQuery,
    out: &mut Vec<Contact>,
) {
    let mut minima = LocalMinima::default();
    let mut contacts = ContactCollector::new(Level::new(), wall, robot, query, &mut minima, out);
    for number in 0..robot.links().len() {
        contacts.add(number, |link, near| {
            let may_meet =
                |triangle: &u32| link.at_least(wall.mesh.corners(*triangle)) <= query.margin;
            near.add_unclassified((0..wall.mesh.len() as u32).filter(may_meet));
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

    /// Adds all links, and all triangles to each. Writes the contacts if the query is not abandoned.
    fn ask(
        mesh: &Mesh,
        robot: &Chain,
        minima: &mut LocalMinima,
        is_abandoned: bool,
    ) -> Vec<Contact> {
        let robot = PlacedRobot::new(robot, &Pose::IDENTITY).unwrap();
        let (query, mut out) = (ContactQuery { margin: 2.0, prominence: 0.1 }, Vec::new());
        let mut contacts =
            ContactCollector::new(Level::new(), Wall::of(mesh), robot, query, minima, &mut out);
        for number in 0..robot.links().len() {
            contacts.add(number, |_, near| near.add_unclassified(0..mesh.len() as u32));
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
        let (mut minima, mut found) = (LocalMinima::default(), 0);
        for round in 0..60 {
            let count = 3 + random.below(12);
            let corners = (0..count).map(|_| random.point() * 2.0).collect();
            let triangles = (0..2 * count).map(|_| [0; 3].map(|_| random.below(count))).collect();
            let mesh = Mesh::of(corners, triangles);
            let points: Vec<_> =
                (0..2 + random.below(4)).map(|_| random.point()).collect::<Vec<Vector>>();
            let robot = Chain::capsules(&points, &vec![0.1; points.len() - 1]).unwrap();
            if round % 3 == 0 {
                ask(&mesh, &robot, &mut minima, true);
            } else {
                let fresh = ask(&mesh, &robot, &mut LocalMinima::default(), false);
                assert_eq!(ask(&mesh, &robot, &mut minima, false), fresh, "{round}");
                found += fresh.len();
            }
        }
        assert!(found > 100, "{found}");
    }
}
