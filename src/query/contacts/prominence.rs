//! Which local minima are prominent: how far every path on the mesh to a nearer minimum must first
//! rise.
//!
//! # Definitions
//! - p: the prominence that the query asks for.
//! - d(C): the distance of a minimum C.
//! - Take the minima of one link, nearest first. C is *dropped* if a path on the wall leads from C
//!   to a kept minimum, such that
//!   - the distance along the path stays below `d(C) + p` and within the margin, and
//!   - the normals of the two minima differ by at most 60 degrees.
//!
//! A contact without a normal is always kept, and represents no other.
//!
//! # Claim
//! 1. *Each wall stays*: a dropped minimum has a nearer one that *represents* it. A path between
//!    the two rises by less than p, and the directions in which they push the link differ by at
//!    most 60 degrees. In particular the nearest minimum of each connected piece of wall within the
//!    margin is kept, and so are both sides of a groove.
//! 2. *No shallow minimum stays*: a path from a kept minimum to a nearer one with such a normal
//!    rises by at least p, or leaves the margin.
//! 3. *The choice is unique* with properties 1 and 2.
//!
//! **Proof.** 1 and 2 repeat the definition, which asks only about nearer minima. So whether the
//! k-th minimum is kept follows from the choice among the k - 1 before it: 3 by induction. Minima
//! at equal distances are taken in the order of the contacts. The nearest minimum of a piece has
//! no nearer one there to reach.
//!
//! # Passes
//! The part of a triangle within a distance c is convex, because the link is. So two triangles are
//! joined by a shared corner, edge or seam f exactly from `c = d(f)` on (see `local_minima`). A
//! path within c can follow a chain of triangles in which each shares with the next an f with
//! `d(f) <= c`. The least distance of f is a *pass*. The pieces of wall within c are joined by the
//! passes up to c. If an edge is nearer between its ends than at both, the edge itself is a pass;
//! otherwise the nearer of its ends is.
//!
//! C queries the pieces of wall below `d(C) + p`. These distances rise, since the minima are taken
//! nearest first. So a piece for one minimum is part of one piece for all later minima. All
//! triangles that may be within the margin take part, culled ones too.
//!
//! **Determinism.** Passes are measured in double precision, an edge always from the same end, and
//! at the first vertices of its places. So they are the same bit for bit in all engines. A pass f
//! counts as within the margin only if it is so by more than the rounding of its distance and its
//! gap. Then every engine finds every triangle that has f.
//!
//! # Cost
//! - A minimum is kept at once if no kept minimum has a similar normal.
//! - From any other one the wall is flooded ([`Flood`]) over passes below `d(C) + p`, corners
//!   first. The flood ends at a minimum that represents it. Mostly that minimum is a few triangles
//!   away.
//! - Reached pieces stay joined, because the distances rise. So no triangle is flooded twice, and a
//!   later flood continues at the rim of an earlier one.
//! - A corner is measured once, when a triangle that has it is reached, in waves, so that packs are
//!   full. An edge is measured only if it may be nearer between its ends and may join another
//!   piece.
//! - Only a kept minimum is flooded over the whole piece below `d(C) + p`. A triangle is at the rim
//!   of few such pieces: the kept minima of one piece differ in their normals by more than 60
//!   degrees, and fewer than a dozen directions can do so (12 spheres at most touch one of their
//!   size). So the cost of kept minima grows with the
//!   triangles less than p above a minimum, and at most with the triangles within the margin.
//! - A dropped minimum may go around the whole rim of such a piece before it meets its
//!   representative, but mostly that is beside it. It tests the kept minima of a piece in turn, the
//!   last representative first: if there are many, most have a similar normal.
//!
//! # Algorithm
//! [`Flood`] floods the wall near one link below rising distances, from its minima, until each is
//! decided. It answers whether a minimum reaches a kept one below a distance.
//!
//! 1. Each reached triangle belongs to a piece (union-find). A piece has a list of *open* triangles
//!    and a list of its kept minima.
//! 2. If a kept minimum of the piece represents the query's minimum, it is reached.
//! 3. Otherwise take the open triangles as a *wave*. Reach all triangles around each of their
//!    corners that is a pass. A triangle with a corner that is no pass is *closed*.
//!    So is a triangle with a seam; its seams that are passes are followed at once.
//! 4. If there is no open triangle left, follow those edges of the closed triangles that are passes
//!    although both ends are none.
//! 5. Repeat from step 2. If no step reaches anything, the minimum is not reached.
//! 6. Either way the closed triangles become open for the next, greater distance.

use super::local_minima::NONE;
use super::triangle_candidates::NearLink;
use crate::answer::Contact;
use crate::mesh::{Seam, ends_of, find_root, unite};
use crate::pair::{PartDistance, PlacedLink, measure_points, measure_segments};
use fearless_simd::Level;
use parry3d_f64::math::{Real, Vector};

/// The cosine of the greatest angle between the normals of a contact and its representative.
const MIN_COSINE: Real = 0.5;

/// The contacts that a caller wants.
#[derive(Clone, Copy)]
pub(crate) struct ContactQuery {
    /// The greatest distance of a contact.
    pub margin: Real,
    /// The least prominence of a contact.
    pub prominence: Real,
}

/// State of a query; its memory is reused by later queries.
#[derive(Clone, Default)]
pub(super) struct Prominence {
    flood: Flood,
    /// The kept minima of the link, the last representative first.
    of_link: Vec<u32>,
}

impl Prominence {
    /// Appends to `are_prominent`, for each contact of one link, nearest first, whether it has the
    /// prominence.
    pub(super) fn find_prominent(
        &mut self,
        level: Level,
        neighbourhood: LinkNeighbourhood,
        prominence: Real,
        contacts: &[Contact],
        are_prominent: &mut Vec<bool>,
    ) {
        if contacts.len() < 2 {
            are_prominent.extend(contacts.iter().map(|_| true));
            return;
        }
        let Self { flood, of_link } = self;
        flood.begin(neighbourhood);
        of_link.clear();
        for (minimum, contact) in (0..).zip(contacts) {
            let is_near = contact.normal.is_some() && neighbourhood.holds(contact.witness.triangle);
            let represents = |other: u32| {
                let normals = contact.normal.zip(contacts[other as usize].normal);
                normals.is_some_and(|(one, other)| MIN_COSINE <= one.dot(other))
            };
            let below = contact.distance + prominence;
            let is_dropped = is_near
                && is_represented(of_link, represents)
                && flood.reaches(level, neighbourhood, contact.witness.triangle, below, represents);
            if is_near && !is_dropped {
                flood.keep(neighbourhood, contact.witness.triangle, minimum);
                of_link.push(minimum);
            }
            are_prominent.push(!is_dropped);
        }
    }
}

/// Returns true if a kept minimum can represent another one. Moves it to the front, because the
/// next minimum is mostly beside this one.
fn is_represented(kept: &mut [u32], represents: impl Fn(u32) -> bool) -> bool {
    let found = kept.iter().position(|&other| represents(other));
    if let Some(found) = found {
        kept.swap(0, found);
    }
    found.is_some()
}

/// The reached part of the wall near one link; memory is reused by later queries.
#[derive(Clone, Default)]
struct Flood {
    /// The reached triangles.
    reached: Vec<Reached>,
    /// For each triangle of the mesh its index in `reached`. Stale values are harmless, because the
    /// triangle there is compared.
    of_triangle: Vec<u32>,
    /// The corners of the reached triangles, one for each position.
    corners: Vec<Corner>,
    /// The distances of the first corners; the others are not measured yet.
    distances: Vec<PartDistance>,
    /// For each vertex of the mesh its index in `corners`.
    of_vertex: Vec<u32>,
    /// Union-find: for each reached triangle an earlier one of the same piece, or itself.
    joined: Vec<u32>,
    /// For the first triangle of each piece: the open triangles, and the kept minima of the piece.
    /// Between calls each reached triangle with a part that was no pass is open.
    open: DisjointLists,
    kept: DisjointLists,
    /// The open triangles of the current step, and the closed triangles.
    wave: Vec<u32>,
    closed: Vec<u32>,
    /// Edges to be measured: a triangle that has the edge, and the number of the part.
    edges: Vec<(u32, usize)>,
    /// Seams to be measured: a triangle that has the seam, and the seam.
    seams: Vec<(u32, Seam)>,
}

#[derive(Clone, Copy)]
struct Reached {
    triangle: u32,
    corners: [u32; 3],
}

#[derive(Clone, Copy)]
struct Corner {
    /// The first vertex at its position.
    vertex: u32,
    /// Whether all near triangles around it were reached and are one piece.
    is_followed: bool,
}

impl Flood {
    /// Starts again for a link, without reached triangles.
    fn begin(&mut self, neighbourhood: LinkNeighbourhood) {
        let mesh = neighbourhood.near.wall.mesh;
        self.of_triangle.resize(mesh.len(), 0);
        self.of_vertex.resize(mesh.vertices().len(), 0);
        self.reached.clear();
        self.corners.clear();
        self.distances.clear();
        self.joined.clear();
        self.open.clear();
        self.kept.clear();
    }

    /// Adds a kept minimum at a near triangle.
    fn keep(&mut self, neighbourhood: LinkNeighbourhood, triangle: u32, minimum: u32) {
        let item = self.reach(neighbourhood, triangle);
        self.kept.put(find_root(&mut self.joined, item), minimum);
    }

    /// Returns true if a path below the distance `below` leads from a triangle to a kept minimum
    /// that `represents` it. `below` must not decrease from call to call.
    fn reaches(
        &mut self,
        level: Level,
        neighbourhood: LinkNeighbourhood,
        triangle: u32,
        below: Real,
        represents: impl Fn(u32) -> bool,
    ) -> bool {
        let item = self.reach(neighbourhood, triangle);
        self.closed.clear();
        // How many closed triangles have had their edges followed.
        let mut followed = 0;
        let is_reached = loop {
            let piece = find_root(&mut self.joined, item);
            if self.kept.find(piece, &represents) {
                break true;
            }
            self.wave.clear();
            self.open.take(piece, &mut self.wave);
            if !self.wave.is_empty() {
                self.follow_corners(level, neighbourhood, below);
            } else if followed < self.closed.len() {
                self.follow_edges(level, neighbourhood, below, followed);
                followed = self.closed.len();
            } else {
                break false;
            }
        };
        let piece = find_root(&mut self.joined, item);
        self.closed.iter().for_each(|&item| self.open.put(piece, item));
        is_reached
    }

    /// Returns the index of a near triangle in `reached`, and appends the triangle if it is new.
    fn reach(&mut self, neighbourhood: LinkNeighbourhood, triangle: u32) -> u32 {
        if let Some(item) = self.index_of(triangle) {
            return item;
        }
        let mesh = neighbourhood.near.wall.mesh;
        let corners = mesh.indices()[triangle as usize].map(|vertex| {
            let vertex = mesh.parts().first_at(vertex);
            let at = &mut self.of_vertex[vertex as usize];
            if self.corners.get(*at as usize).is_none_or(|corner| corner.vertex != vertex) {
                *at = self.corners.len() as u32;
                self.corners.push(Corner { vertex, is_followed: false });
            }
            *at
        });
        let item = self.reached.len() as u32;
        self.of_triangle[triangle as usize] = item;
        self.reached.push(Reached { triangle, corners });
        self.joined.push(item);
        self.open.begin();
        self.kept.begin();
        self.open.put(item, item);
        item
    }

    /// Returns the index of a triangle in `reached`, if it was reached.
    #[inline(always)]
    fn index_of(&self, triangle: u32) -> Option<u32> {
        let item = self.of_triangle[triangle as usize];
        let reached = self.reached.get(item as usize)?;
        (reached.triangle == triangle).then_some(item)
    }

    /// Reaches all near triangles around a corner or an edge of a reached triangle, and unites
    /// their pieces.
    fn follow(&mut self, neighbourhood: LinkNeighbourhood, triangle: u32, part: usize) {
        let own = self.reach(neighbourhood, triangle);
        for other in neighbourhood.near.wall.mesh.parts().others(triangle, part) {
            self.unite_with(neighbourhood, own, other);
        }
    }

    /// Reaches a triangle if it is near, and unites its piece with the piece of a reached one.
    fn unite_with(&mut self, neighbourhood: LinkNeighbourhood, own: u32, other: u32) {
        if self.index_of(other).is_none() && !neighbourhood.holds(other) {
            return;
        }
        let item = self.reach(neighbourhood, other);
        let [first, second] = unite(&mut self.joined, own, item);
        if first != second {
            self.open.append(second, first);
            self.kept.append(second, first);
        }
    }

    /// Step 3: follows the corners of the wave that are passes below a distance, and closes
    /// triangles with a corner that is no pass.
    fn follow_corners(&mut self, level: Level, neighbourhood: LinkNeighbourhood, below: Real) {
        let (vertices, parts) =
            (neighbourhood.near.wall.mesh.vertices(), neighbourhood.near.wall.mesh.parts());
        let unknown = self.corners[self.distances.len()..].iter();
        let points = unknown.map(|corner| vertices[corner.vertex as usize]);
        measure_points(level, neighbourhood.link, points, |measured| self.distances.push(measured));
        let wave = std::mem::take(&mut self.wave);
        for &item in &wave {
            let Reached { triangle, corners } = self.reached[item as usize];
            let mut is_closed = false;
            for (part, corner) in corners.map(|corner| corner as usize).into_iter().enumerate() {
                if self.corners[corner].is_followed {
                    continue;
                }
                let gap = parts.gap(self.corners[corner].vertex);
                if neighbourhood.is_pass(&self.distances[corner], gap, below) {
                    self.corners[corner].is_followed = true;
                    self.follow(neighbourhood, triangle, part);
                } else {
                    is_closed = true;
                }
            }
            if parts.is_loose(triangle) {
                self.seams.extend(parts.seams(triangle).iter().map(|&seam| (item, seam)));
                is_closed = true;
            }
            if is_closed {
                self.closed.push(item);
            }
        }
        self.wave = wave;
        if !self.seams.is_empty() {
            self.follow_seams(level, neighbourhood, below);
        }
    }

    /// Follows the seams of the wave that are passes below a distance.
    fn follow_seams(&mut self, level: Level, neighbourhood: LinkNeighbourhood, below: Real) {
        let vertices = neighbourhood.near.wall.mesh.vertices();
        let seams = std::mem::take(&mut self.seams);
        let segments =
            seams.iter().map(|(_, seam)| in_order(seam.ends.map(|end| vertices[end as usize])));
        let mut of_distances = seams.iter();
        measure_segments(level, neighbourhood.link, segments, |measured| {
            if let Some(&(own, seam)) = of_distances.next()
                && neighbourhood.is_pass(&measured, seam.gap, below)
            {
                self.unite_with(neighbourhood, own, seam.other);
            }
        });
        self.seams = seams;
        self.seams.clear();
    }

    /// Step 4: follows the edges of the closed triangles, from one of them on, that are passes
    /// below a distance although their ends are none.
    fn follow_edges(
        &mut self,
        level: Level,
        neighbourhood: LinkNeighbourhood,
        below: Real,
        from: usize,
    ) {
        let mesh = neighbourhood.near.wall.mesh;
        self.edges.clear();
        let closed = std::mem::take(&mut self.closed);
        for &item in &closed[from..] {
            let Reached { triangle, corners } = self.reached[item as usize];
            let points = mesh.corners(triangle);
            for part in 3..6 {
                let ends = ends_of(corners, part).map(|corner| corner as usize);
                if ends.iter().any(|&end| self.corners[end].is_followed) {
                    continue;
                }
                let [start, end] = ends_of(points, part);
                if !neighbourhood.may_pass_between(
                    ends.map(|end| &self.distances[end]),
                    end - start,
                    below,
                ) {
                    continue;
                }
                if self.reaches_other_piece(neighbourhood, triangle, part) {
                    self.edges.push((triangle, part));
                }
            }
        }
        self.closed = closed;
        let edges = std::mem::take(&mut self.edges);
        let parts = mesh.parts();
        let segments = edges.iter().map(|&(triangle, part)| {
            let ends = ends_of(mesh.indices()[triangle as usize], part);
            in_order(ends.map(|end| mesh.vertices()[parts.first_at(end) as usize]))
        });
        let mut of_distances = edges.iter();
        measure_segments(level, neighbourhood.link, segments, |measured| {
            let Some(&(triangle, part)) = of_distances.next() else { return };
            let gaps = ends_of(mesh.indices()[triangle as usize], part).map(|end| parts.gap(end));
            let is_pass = neighbourhood.is_pass(&measured, gaps[0].max(gaps[1]), below);
            // Another triangle with this edge may have been followed already.
            if is_pass && self.reaches_other_piece(neighbourhood, triangle, part) {
                self.follow(neighbourhood, triangle, part);
            }
        });
        self.edges = edges;
    }

    /// Returns true if the next near triangle in the ring of an edge belongs to another piece, or
    /// is not reached. If this is false for all triangles of the ring, they are one piece.
    fn reaches_other_piece(
        &mut self,
        neighbourhood: LinkNeighbourhood,
        triangle: u32,
        part: usize,
    ) -> bool {
        let own = self.reach(neighbourhood, triangle);
        for other in neighbourhood.near.wall.mesh.parts().others(triangle, part) {
            if let Some(other) = self.index_of(other) {
                return find_root(&mut self.joined, other) != find_root(&mut self.joined, own);
            }
            if neighbourhood.holds(other) {
                return true;
            }
        }
        false
    }
}

/// The ends of an edge in an order that does not depend on the triangle.
fn in_order([from, to]: [Vector; 2]) -> [Vector; 2] {
    if from.to_array() <= to.to_array() { [from, to] } else { [to, from] }
}

/// Disjoint lists: each number is in at most one list, and once.
#[derive(Clone, Default)]
struct DisjointLists {
    /// For each list its first and its last number.
    ends: Vec<[u32; 2]>,
    /// For each number the next.
    next: Vec<u32>,
}

impl DisjointLists {
    /// Removes all lists and numbers.
    fn clear(&mut self) {
        self.ends.clear();
        self.next.clear();
    }

    /// Adds an empty list; lists are numbered in order.
    fn begin(&mut self) {
        self.ends.push([NONE; 2]);
    }

    /// Prepends a number that is in no list.
    fn put(&mut self, list: u32, number: u32) {
        let (at, number_at) = (list as usize, number as usize);
        let [head, tail] = self.ends[at];
        self.next.resize(self.next.len().max(number_at + 1), NONE);
        self.next[number_at] = head;
        self.ends[at] = [number, if tail == NONE { number } else { tail }];
    }

    /// Appends the numbers of the list `from` to the list `to`, and empties `from`.
    fn append(&mut self, from: u32, to: u32) {
        let [head, tail] = std::mem::replace(&mut self.ends[from as usize], [NONE; 2]);
        if head == NONE {
            return;
        }
        let [to_head, to_tail] = self.ends[to as usize];
        if to_head == NONE {
            self.ends[to as usize] = [head, tail];
        } else {
            self.next[to_tail as usize] = head;
            self.ends[to as usize] = [to_head, tail];
        }
    }

    /// Moves the numbers of a list to the end of `out`.
    fn take(&mut self, list: u32, out: &mut Vec<u32>) {
        let [mut at, _] = std::mem::replace(&mut self.ends[list as usize], [NONE; 2]);
        while at != NONE {
            out.push(at);
            at = self.next[at as usize];
        }
    }

    /// Returns true if `is_such` holds for a number of a list, and moves the first such number to
    /// the front.
    fn find(&mut self, list: u32, is_such: impl Fn(u32) -> bool) -> bool {
        let [head, tail] = self.ends[list as usize];
        let (mut before, mut at) = (NONE, head);
        while at != NONE && !is_such(at) {
            (before, at) = (at, self.next[at as usize]);
        }
        if at != NONE && before != NONE {
            self.next[before as usize] = self.next[at as usize];
            self.next[at as usize] = head;
            self.ends[list as usize] = [at, if at == tail { before } else { tail }];
        }
        at != NONE
    }
}

/// The triangles near one link.
#[derive(Clone, Copy)]
pub(super) struct LinkNeighbourhood<'a> {
    pub link: &'a PlacedLink,
    pub near: NearLink<'a>,
    /// The greatest distance of a pass.
    pub margin: Real,
}

impl LinkNeighbourhood<'_> {
    /// Returns true if a triangle may be within the margin.
    #[inline(always)]
    fn holds(&self, triangle: u32) -> bool {
        self.near.index_of(triangle).is_some() || self.near.is_culled(triangle)
    }

    /// Returns true if a corner, edge or seam at this distance is a pass below `below`. `gap` is
    /// the distance by which its triangles may miss it.
    #[inline(always)]
    fn is_pass(&self, measured: &PartDistance, gap: Real, below: Real) -> bool {
        measured.distance < below && measured.distance + measured.rounding + gap <= self.margin
    }

    /// Returns true if an edge may be a pass below `below` although neither of its ends is. `along`
    /// leads from one end to the other.
    fn may_pass_between(&self, ends: [&PartDistance; 2], along: Vector, below: Real) -> bool {
        lower_between(ends, along).is_some_and(|lower| lower < below && lower <= self.margin)
    }
}

/// Returns a lower bound on the distance of an edge, if the edge may be nearer than both of its
/// ends. `along` leads from one end to the other.
///
/// **Derivation.** The distance is convex along the edge. Let an end have the distance d and the
/// vector W from the link. Along the whole edge the tangent there changes by `g = W . along / |W|`.
/// If the distance does not fall from an end on, that end is nearest. Otherwise it lies above both
/// tangents `d1 + s g1` and `d2 + (1 - s) g2`, which cross at `s = (d2 + g2 - d1) / (g1 + g2)`.
///
/// **Rounding.** W errs by less than `2 rounding`, so it turns by less than `4 rounding / d`. The
/// two distances and the bound itself err by less than `4 rounding` together.
fn lower_between([one, other]: [&PartDistance; 2], along: Vector) -> Option<Real> {
    let rounding = one.rounding.max(other.rounding);
    let turned = 4.0 * rounding * along.length() / one.distance.min(other.distance);
    let change =
        [one.way.dot(along) / one.way.length(), -other.way.dot(along) / other.way.length()];
    // NaN if W is 0: then no point is nearer.
    if !(change[0] < turned && change[1] < turned) {
        return None;
    }
    let fall = change.map(|change| change.min(0.0) - turned);
    let share = (other.distance + fall[1] - one.distance) / (fall[0] + fall[1]);
    // If nothing falls this is 0 / 0; the comparison turns NaN into 0.
    let share = if share > 0.0 { share.min(1.0) } else { 0.0 };
    Some(one.distance + fall[0] * share - 4.0 * rounding)
}
