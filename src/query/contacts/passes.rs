//! The passes between the triangles near a link: the least distances of the corners and edges that they share, found and
//! measured as far as the minima need them. `prominence` says what for.

use super::local_minima::NONE;
use super::near_triangle::{Index, NearLink};
use super::prominence::Pieces;
use super::wall::Wall;
use crate::mesh::ends_of;
use crate::pair::{Height, PlacedLink, measure_points, measure_segments};
use fearless_simd::Level;
use parry3d_f64::math::{Real, Vector};

/// What is near one link.
#[derive(Clone, Copy)]
pub(super) struct Surroundings<'a> {
    pub link: &'a PlacedLink,
    pub wall: Wall<'a>,
    pub near: NearLink<'a>,
    pub index: &'a Index,
}

/// Passes, in memory that is used again.
#[derive(Clone, Default)]
pub(super) struct Passes {
    /// The corners near the link, those at one place as one: the first vertex there, its height, and the first minimum that
    /// it serves.
    corners: Vec<u32>,
    heights: Vec<Height>,
    serves: Vec<u32>,
    /// For each vertex of the mesh where it stands among them.
    of_vertex: Vec<u32>,
    /// For each place of a triangle its three corners.
    of_place: Vec<[u32; 3]>,
    /// For each minimum the corners of triangles that it is the first to be served by: three times the place, and which.
    certain: Lists,
    /// The edges that are nearer between their ends than at them. They are found when they are first asked for.
    edges: Vec<Edge>,
    has_edges: bool,
    /// For each place of a triangle one bit for each of its edges whose ring was seen.
    seen: Vec<u8>,
    /// For each minimum the edges that it may be the first to be served by, and of those that were measured the ones that
    /// do serve it.
    possible: Lists,
    measured: Lists,
    /// The edges that may serve and were not measured yet.
    open: Vec<u32>,
}

/// An edge that several triangles have: what one of them calls it.
#[derive(Clone, Copy)]
struct Edge {
    triangle: u32,
    part: u8,
    /// The first minimum that its ends serve.
    ends_serve: u32,
}

/// A list of numbers for each minimum.
#[derive(Clone, Default)]
struct Lists {
    /// For each minimum the first of its list, and for each number the next.
    first: Vec<u32>,
    next: Vec<u32>,
}

impl Passes {
    /// Measures the corners near the link. Minima look around `below` distances, which rise.
    pub(super) fn find(&mut self, level: Level, around: Surroundings, margin: Real, below: &[Real]) {
        let mesh = around.wall.mesh;
        let shared = mesh.parts();
        let places = around.near.places();
        let Self { corners, heights, serves, of_vertex, of_place, certain, .. } = self;
        of_vertex.resize(mesh.vertices().len(), 0);
        of_place.resize(places.max(of_place.len()), [0; 3]);
        corners.clear();
        around.each(|triangle, place| {
            of_place[place] = mesh.indices()[triangle as usize].map(|vertex| {
                let vertex = shared.first_at(vertex);
                let at = &mut of_vertex[vertex as usize];
                // What stands there of other links does no harm.
                if corners.get(*at as usize) != Some(&vertex) {
                    *at = corners.len() as u32;
                    corners.push(vertex);
                }
                *at
            });
        });
        heights.clear();
        let points = corners.iter().map(|&vertex| mesh.vertices()[vertex as usize]);
        measure_points(level, around.link, points, |height| heights.push(height));
        serves.clear();
        serves.extend(heights.iter().map(|height| first_served(height, margin, below)));
        certain.clear(below.len());
        around.each(|_, place| {
            for (number, corner) in (3 * place as u32..).zip(of_place[place]) {
                certain.put(serves[corner as usize], number);
            }
        });
        self.possible.clear(below.len());
        self.measured.clear(below.len());
        self.open.clear();
        self.has_edges = false;
    }

    /// How many pieces there may be at most: one for each place, and behind them one for each corner.
    pub(super) fn pieces(&self, around: Surroundings) -> usize {
        around.near.places() + self.corners.len()
    }

    /// Joins what corners join when a minimum is asked for, and edges that were measured.
    pub(super) fn join_certain(&mut self, around: Surroundings, minimum: u32, pieces: &mut Pieces) {
        let places = around.near.places();
        for number in self.certain.of(minimum) {
            let (place, corner) = (number as usize / 3, number as usize % 3);
            pieces.join(place, places + self.of_place[place][corner] as usize);
        }
        for edge in self.measured.of(minimum) {
            self.edges[edge as usize].join(around, pieces);
        }
        self.open.extend(self.possible.of(minimum));
    }

    /// Joins all that is joined when a minimum is asked for: the edges that may serve it are measured.
    pub(super) fn join_others(
        &mut self,
        level: Level,
        around: Surroundings,
        margin: Real,
        below: &[Real],
        minimum: u32,
        pieces: &mut Pieces,
    ) {
        if !self.has_edges {
            self.find_edges(around, margin, below);
            self.open.extend((0..=minimum).flat_map(|minimum| self.possible.of(minimum)));
        }
        let Self { edges, open, measured, .. } = self;
        open.retain(|&edge| {
            let edge = &edges[edge as usize];
            edge.ends_serve > minimum && edge.joins_some(around, pieces)
        });
        let segments = open.iter().map(|&edge| edges[edge as usize].ends(around));
        let mut of_heights = open.iter();
        measure_segments(level, around.link, segments, |height| {
            let Some(&edge) = of_heights.next() else { return };
            let serves = first_served(&height, margin, below);
            if serves <= minimum {
                edges[edge as usize].join(around, pieces);
            } else if serves < edges[edge as usize].ends_serve {
                measured.put(serves, edge);
            }
        });
        open.clear();
    }

    /// Finds the edges that may be nearer between their ends than at them.
    fn find_edges(&mut self, around: Surroundings, margin: Real, below: &[Real]) {
        self.has_edges = true;
        self.edges.clear();
        self.seen.clear();
        self.seen.resize(around.near.places(), 0);
        let (mesh, shared) = (around.wall.mesh, around.wall.mesh.parts());
        around.each(|triangle, place| {
            let (corners, points) = (self.of_place[place], mesh.corners(triangle));
            for part in 3..6 {
                let ends = ends_of(corners, part).map(|corner| corner as usize);
                let ends_serve = self.serves[ends[0]].min(self.serves[ends[1]]);
                let [from, to] = ends_of(points, part);
                let Some(lower) = lower_between(ends.map(|end| &self.heights[end]), to - from) else {
                    continue;
                };
                let serves = below.partition_point(|below| *below <= lower) as u32;
                if serves >= ends_serve || lower > margin || self.seen[place] >> part & 1 == 1 {
                    continue;
                }
                let mut count = 0;
                for (other, part) in shared.ring(triangle, part) {
                    if let Some(place) = around.place(other) {
                        self.seen[place] |= 1 << part;
                        count += 1;
                    }
                }
                if count > 1 {
                    self.possible.put(serves, self.edges.len() as u32);
                    self.edges.push(Edge { triangle, part: part as u8, ends_serve });
                }
            }
        });
    }
}

/// The first minimum that a pass of this height serves, if it is within the margin.
fn first_served(height: &Height, margin: Real, below: &[Real]) -> u32 {
    let is_within = height.distance + height.rounding <= margin;
    let served =
        if is_within { below.partition_point(|below| *below <= height.distance) } else { below.len() };
    served as u32
}

/// A lower bound on the distance of an edge that leads `along` from one end to the other, if that may be less than at both
/// ends.
///
/// The distance is convex along the edge. At an end at the distance d and with the way W from the link to it, it changes by
/// g = W . along / |W| on the whole edge. If it does not fall from one of the ends on, it is least there. Else it lies above
/// both tangents d1 + s g1 and d2 + (1 - s) g2, which cross at s = (d2 + g2 - d1) / (g1 + g2). Rounding turns W by its own
/// share of d.
fn lower_between([one, other]: [&Height; 2], along: Vector) -> Option<Real> {
    let rounding = one.rounding.max(other.rounding);
    let turned = 4.0 * rounding * along.length() / one.distance.min(other.distance);
    let change = [one.way.dot(along) / one.way.length(), -other.way.dot(along) / other.way.length()];
    // No number where there is no way: nothing is nearer.
    if !(change[0] < turned && change[1] < turned) {
        return None;
    }
    let fall = change.map(|change| change.min(0.0) - turned);
    let share = (other.distance + fall[1] - one.distance) / (fall[0] + fall[1]);
    // 0 / 0 where nothing falls: the comparison turns it into 0.
    let share = if share > 0.0 { share.min(1.0) } else { 0.0 };
    Some(one.distance + fall[0] * share - 4.0 * rounding)
}

impl Edge {
    /// Its ends, in an order that does not depend on the triangle that names it.
    fn ends(self, around: Surroundings) -> [Vector; 2] {
        let [from, to] = ends_of(around.wall.mesh.corners(self.triangle), usize::from(self.part));
        if from.to_array() <= to.to_array() { [from, to] } else { [to, from] }
    }

    /// The places of the triangles that have it.
    fn places(self, around: Surroundings<'_>) -> impl Iterator<Item = usize> {
        let ring = around.wall.mesh.parts().ring(self.triangle, usize::from(self.part));
        ring.filter_map(move |(triangle, _)| around.place(triangle))
    }

    /// Joins its triangles.
    fn join(self, around: Surroundings, pieces: &mut Pieces) {
        let mut places = self.places(around);
        if let Some(one) = places.next() {
            places.for_each(|other| pieces.join(one, other));
        }
    }

    /// Whether some of its triangles are not joined yet.
    fn joins_some(self, around: Surroundings, pieces: &mut Pieces) -> bool {
        let mut places = self.places(around);
        let Some(one) = places.next() else { return false };
        places.any(|other| !pieces.are_joined(one, other))
    }
}

impl Lists {
    /// An empty list for each of so many minima.
    fn clear(&mut self, minima: usize) {
        self.first.clear();
        self.first.resize(minima, NONE);
        self.next.clear();
    }

    /// Puts a number in the list of a minimum, or in none if there is no such minimum. It is in no list yet.
    fn put(&mut self, minimum: u32, number: u32) {
        let Some(first) = self.first.get_mut(minimum as usize) else { return };
        let place = number as usize;
        self.next.resize(self.next.len().max(place + 1), NONE);
        self.next[place] = *first;
        *first = number;
    }

    fn of(&self, minimum: u32) -> impl Iterator<Item = u32> {
        let some = |number: u32| (number != NONE).then_some(number);
        std::iter::successors(some(self.first[minimum as usize]), move |number| {
            some(self.next[*number as usize])
        })
    }
}

impl Surroundings<'_> {
    /// The place of a triangle, if it is near.
    #[inline(always)]
    pub(super) fn place(&self, triangle: u32) -> Option<usize> {
        self.near.place(self.index, self.wall.place_of(), triangle)
    }

    /// All triangles that are near, each with its place.
    fn each(&self, mut take: impl FnMut(u32, usize)) {
        for (place, known) in self.near.in_question.iter().enumerate() {
            take(known.triangle, place);
        }
        for (leaf, lane, place) in self.near.slopes() {
            let triangle = self.wall.triangle_at(leaf, lane);
            // A leaf that is not full repeats its last triangle.
            if let Some(triangle) = triangle.filter(|triangle| self.place(*triangle) == Some(place)) {
                take(triangle, place);
            }
        }
    }
}
