//! The local minima of the distance between one link and a mesh.
//!
//! # What a local minimum is
//! Let d(x) be the distance of a point x from the link. Two triangles are joined at a corner or an
//! edge that both have, at the same place; the wall within a distance c is what of the mesh has
//! d(x) <= c. As c grows, connected pieces of it appear, grow and join. Where a piece appears there
//! is a *local minimum*: the nearest point of the piece. A piece that joins another before it has
//! grown by more than rounding is none of its own: a flat wall along the link, whose triangles are
//! all as near as far as rounding can tell, is one piece, and so is a triangle's least point that
//! lies on a nearer neighbour. Of the two the one that is farther ends, so that the nearest point
//! of each connected piece of wall within the margin is always among the minima.
//!
//! Let t be the rounding of a distance, 32 u extent of link and triangle, edge or corner: far above
//! what a measurement errs by. A piece has grown by more than rounding where d exceeds its minimum
//! by t of the triangle at which it appeared and t of the edge or corner at which it joins another.
//! Of the minima found
//!
//! 1. *none is missed*: from every point x of the wall a way on the wall leads to one of them,
//!    along which d never exceeds d(x) + 2 t;
//! 2. *none is found twice*: a way from one to another exceeds the farther of the two by more than
//!    2 t;
//! 3. *each is one*: no point of a triangle that contains it is nearer, but for rounding.
//!
//! # Why it is enough to look at triangles, edges and corners
//! A link is convex, so d is a convex function, and what of a triangle has d <= c is convex:
//! connected. Let T's least distance be d(T), and that of a corner or an edge f be d(f). T is part
//! of the wall within c from c = d(T) on, as one piece. Two triangles that share f are joined by it
//! exactly from c = d(f) on: their pieces then both contain f's nearest point. So the pieces are
//! the components of a graph with the triangles as nodes, which exist from d(T) on, and an edge for
//! each shared f, from d(f) >= max(d(T), d(T')) on.
//!
//! The triangles are taken nearest first. T starts a piece of its own. It meets a piece at each f
//! that an earlier, nearer triangle has. If d(f) is at most 2 t above the farther of the two
//! pieces' minima, that one ends there (the elder rule of persistent homology). No pair is
//! overlooked for being met too early: the minimum of a piece that could end is at least d(f) - 2 t
//! >= d(T) - 2 t, and all that is nearer than T has been seen. That is 2. For 1, follow the pieces:
//! from x straight to the least point of its triangle, and whenever a piece has ended, through its
//! f to the one that it joined, whose minimum is nearer. For 3, a triangle that contains the
//! minimum of T shares there an f with d(f) <= d(T) + 2 t, so that one of the two pieces ended, T's
//! if the other is nearer.
//!
//! Where T's least point lies on f, d(f) is d(T) and need not be computed; that spares nearly all
//! of them.
//!
//! # What need not be measured
//! Most triangles lie on a slope: their nearest point is on an edge or a corner f that another
//! triangle has too, and that one is nearer by far more than 2 t. The search can see that, from a
//! look at the neighbour (`descent_cull`) or from all that it found (`feature_cull`). Such a
//! triangle D is *left out*: at d(D) it joins a piece whose minimum is nearer by far more than 2 t,
//! so that no piece ever ends for being that of D. So is one whose nearest point is on an f that it
//! shares with another that is left out: at d(f) it joins that one, which is in such a piece from a
//! distance on that is no greater. For the others what is left out still counts where they join it.
//! A piece that has an f with D, and d(f) at most 2 t above its own minimum, ends there: d(f) >=
//! d(D), so that the minimum of D's piece is the nearer one. Which piece D is part of makes no
//! difference, and all that are left out are taken for one, nearer than any.
//!
//! At an edge or a corner that is certainly farther than its nearest point a triangle joins nothing
//! that is nearer.
//!
//! # How much work it is
//! A triangle asks about all that have a corner or an edge with it. What it asks of them, whether
//! any is nearer by far or left out, and which came first, can be asked of all in the ring at once:
//! where there are very many, it is gathered once for all of them (`long_rings`). So the work grows
//! with the triangles near a link and those around their corners, and not with the square of their
//! number.
//!
//! # Where link and wall overlap
//! There d = 0, and a piece is a connected piece of wall inside the link: it is one contact. Of its
//! triangles the one nearest to the axis comes first and stands for it, the lowest of equals.

use super::link_neighbourhood::LinkNeighbourhood;
use super::long_rings::{FEW, LongRings};
use super::prominence::{ContactQuery, Prominence};
use super::triangle_candidates::{CandidateEnd, CandidateIndex, TriangleCandidates};
use super::wall::Wall;
use super::wall_components::{IncidentTriangles, WallComponents};
use crate::answer::{Contact, LinkProximity};
use crate::pair::{PlacedLink, PlacedPair, PlacedRobot, Ranked, add_contacts, rank_each};
use fearless_simd::Level;
use parry3d_f64::math::Real;
use std::ops::Range;

/// The place of all that are left out.
pub(crate) const CULLED: u32 = 0;

/// The place of no triangle.
pub(crate) const NONE: u32 = u32::MAX;

/// Links are put off while no more triangles than these are to be measured, so that packs are full
/// and memory is small.
const FLUSH_AT: usize = 1 << 12;

/// Memory that is used again.
#[derive(Clone, Default)]
pub(crate) struct LocalMinima {
    /// The links that something may be near to.
    links: Vec<ActiveLink>,
    /// The triangles that may be within the margin, link by link.
    triangles: TriangleCandidates,
    /// For each of them that is in question its place among those within the margin of its link,
    /// counted from 1, or that of all that are left out.
    places: Vec<u32>,
    /// Where the triangles of the link at hand stand.
    index: CandidateIndex,
    /// Those that are measured, link by link.
    measured: Vec<u32>,
    /// What was measured of them.
    ranked: Vec<Ranked>,
    /// What long rings of triangles are to those that they may leave out, and to those that may
    /// join them.
    lowest: LongRings<Lowest>,
    around: LongRings<IncidentTriangles>,
    /// For each place an earlier one of the same piece, or itself.
    piece: Vec<u32>,
    /// The minima that were found.
    found: Vec<LinkProximity>,
    prominence: Prominence,
    /// Whether each of them is prominent.
    keep: Vec<bool>,
}

/// A link that something may be near to.
#[derive(Clone)]
struct ActiveLink {
    number: usize,
    link: PlacedLink,
    /// Where its triangles begin and end.
    triangles: [CandidateEnd; 2],
    measured: Range<usize>,
}

/// What the triangles around a corner or an edge are to one whose nearest point lies there.
#[derive(Clone)]
struct Lowest {
    /// The most that one of those in question may keep.
    upper: Real,
    /// Whether one is left out.
    is_left_out: bool,
}

impl Default for Lowest {
    fn default() -> Self {
        Self { upper: Real::INFINITY, is_left_out: false }
    }
}

/// The contacts of a robot, link by link, in `out`.
pub(crate) struct ContactCollector<'a> {
    level: Level,
    wall: Wall<'a>,
    robot: PlacedRobot<'a>,
    query: ContactQuery,
    minima: &'a mut LocalMinima,
    out: &'a mut Vec<Contact>,
    /// How many triangles were measured.
    measured: u64,
}

impl<'a> ContactCollector<'a> {
    /// Nothing yet.
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

    /// Looks at a link, behind the last one. `near` adds the triangles that may be within the
    /// margin; some may be farther away, and none may stand there twice.
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

    /// The contacts of all links, nearest first for each. Returns how many triangles were measured.
    pub(crate) fn finish(mut self) -> u64 {
        self.flush();
        self.measured
    }

    /// Finds the contacts of the links that were put off.
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
                corners: wall.mesh.corners(found.triangle),
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

    /// Leaves out the triangles of a link that certainly lie on a slope towards a nearer one.
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
        // What one leaves out may leave out another: most of these are met the second time.
        for _ in 0..2 {
            for (place, known) in near.in_question.iter().enumerate() {
                let Some(foot) = known.nearest_feature().filter(|_| places[place] != CULLED) else {
                    continue;
                };
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
                    // It is not below itself.
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

    /// Finds the local minima of all links, nearest first for each.
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

    /// Leaves out the contacts, from `first` on, that are not prominent.
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

/// Those within the margin, nearest first.
fn nearest_first(ranked: &mut [Ranked], margin: Real) -> &[Ranked] {
    // Those beyond it come last: their rank is their distance.
    ranked.sort_unstable_by(|a, b| {
        a.rank.total_cmp(&b.rank).then(a.nearest.triangle.cmp(&b.nearest.triangle))
    });
    let count = ranked.partition_point(|ranked| ranked.nearest.distance <= margin);
    &ranked[..count]
}

/// The contacts of a robot, for an engine without a search of its own for them.
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
