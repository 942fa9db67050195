//! The passes between the triangles near a link: the least distances of the corners and edges that they share, found and
//! measured as far as the minima need them. `prominence` says what for.

use super::local_minima::NONE;
use super::near_triangle::{Index, NearLink};
use super::prominence::Pieces;
use super::wall::Wall;
use crate::mesh::{PARTS, ends_of};
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
    /// For each place of a triangle one bit for each of its parts whose ring was seen.
    seen: Vec<u8>,
    /// The corners of the triangles, for each vertex of the mesh where it stands among them, and their heights.
    corners: Vec<u32>,
    of_vertex: Vec<u32>,
    heights: Vec<Height>,
    passes: Vec<Pass>,
    /// The passes that join for certain when a minimum is asked for, and those that may join.
    certain: Lists,
    possible: Lists,
    /// Those that were measured and join later.
    measured: Lists,
    /// Those that may join, not measured yet.
    open: Vec<u32>,
}

/// A corner or an edge that several triangles have: what one of them calls it.
#[derive(Clone, Copy)]
struct Pass {
    triangle: u32,
    part: u8,
    /// The first minimum that it serves for certain.
    certain: u32,
}

/// A list of passes for each minimum.
#[derive(Clone, Default)]
struct Lists {
    /// For each minimum the first of its list, and for each pass the next.
    first: Vec<u32>,
    next: Vec<u32>,
}

impl Passes {
    /// Finds the corners and edges that join triangles near the link, each once. Minima look around `below` distances, which
    /// rise.
    pub(super) fn find(&mut self, level: Level, around: Surroundings, margin: Real, below: &[Real]) {
        let places = around.near.places();
        self.seen.clear();
        self.seen.resize(places, 0);
        self.passes.clear();
        self.certain.clear(below.len());
        self.possible.clear(below.len());
        self.measured.clear(below.len());
        self.open.clear();
        self.measure_corners(level, around);
        let mesh = around.wall.mesh;
        let shared = mesh.parts();
        around.each(|triangle, place| {
            for part in 0..PARTS {
                let is_needed = part > 2 || shared.is_pinched(triangle, part);
                if !is_needed || self.seen[place] >> part & 1 == 1 {
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
                    self.add(around, margin, below, [triangle, part as u32]);
                }
            }
        });
    }

    /// Measures the corners of all triangles near the link.
    fn measure_corners(&mut self, level: Level, around: Surroundings) {
        let mesh = around.wall.mesh;
        self.corners.clear();
        self.of_vertex.resize(mesh.vertices().len(), 0);
        around.each(|triangle, _| {
            for vertex in mesh.indices()[triangle as usize] {
                let at = &mut self.of_vertex[vertex as usize];
                // What stands there of other links does no harm.
                if self.corners.get(*at as usize) != Some(&vertex) {
                    *at = self.corners.len() as u32;
                    self.corners.push(vertex);
                }
            }
        });
        self.heights.clear();
        let points = self.corners.iter().map(|&vertex| mesh.vertices()[vertex as usize]);
        measure_points(level, around.link, points, |height| self.heights.push(height));
    }

    /// Adds a part of a triangle, for the first minimum that it may serve and the first that it serves for certain.
    fn add(&mut self, around: Surroundings, margin: Real, below: &[Real], [triangle, part]: [u32; 2]) {
        let ends = ends_of([0, 1, 2], part as usize).map(|corner| {
            let vertex = around.wall.mesh.indices()[triangle as usize][corner];
            self.heights[self.of_vertex[vertex as usize] as usize]
        });
        let [from, to] = ends_of(around.wall.mesh.corners(triangle), part as usize);
        let rounding = ends[0].rounding.max(ends[1].rounding);
        let upper = Height { distance: ends[0].distance.min(ends[1].distance), rounding };
        let lower = 0.5 * (ends[0].distance + ends[1].distance - (to - from).length()) - rounding;
        let possible =
            if lower <= margin { below.partition_point(|below| *below <= lower) } else { below.len() };
        let certain = first_served(upper, margin, below);
        let number = self.passes.len() as u32;
        self.passes.push(Pass { triangle, part: part as u8, certain: certain as u32 });
        self.certain.put(certain, number);
        // No edge is farther than its ends.
        self.possible.put(if possible < certain { possible } else { below.len() }, number);
    }

    /// Joins what is certainly joined when a minimum is asked for.
    pub(super) fn join_certain(&mut self, around: Surroundings, minimum: u32, pieces: &mut Pieces) {
        for pass in self.certain.of(minimum).chain(self.measured.of(minimum)) {
            self.passes[pass].join(around, pieces);
        }
        self.open.extend(self.possible.of(minimum).map(|pass| pass as u32));
    }

    /// Joins all that is joined when a minimum is asked for: what is not known of passes is measured.
    pub(super) fn join_others(
        &mut self,
        level: Level,
        around: Surroundings,
        margin: Real,
        below: &[Real],
        minimum: u32,
        pieces: &mut Pieces,
    ) {
        let Self { passes, open, measured, .. } = self;
        open.retain(|&pass| {
            let pass = &passes[pass as usize];
            pass.certain > minimum && pass.joins_some(around, pieces)
        });
        let segments = open.iter().map(|&pass| passes[pass as usize].ends(around));
        let mut passes_of = open.iter();
        measure_segments(level, around.link, segments, |height| {
            let Some(&pass) = passes_of.next() else { return };
            let first = first_served(height, margin, below);
            if first <= minimum as usize {
                passes[pass as usize].join(around, pieces);
            } else if first < passes[pass as usize].certain as usize {
                measured.put(first, pass);
            }
        });
        open.clear();
    }
}

/// The first minimum that a pass of this height serves, if it is within the margin.
fn first_served(height: Height, margin: Real, below: &[Real]) -> usize {
    let is_within = height.distance + height.rounding <= margin;
    if is_within { below.partition_point(|below| *below <= height.distance) } else { below.len() }
}

impl Pass {
    /// The ends of a pass: in an order that does not depend on the triangle that names it.
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

    /// Puts a pass in the list of a minimum, or in none if there is no such minimum. It is in no list yet.
    fn put(&mut self, minimum: usize, pass: u32) {
        let Some(first) = self.first.get_mut(minimum) else { return };
        let place = pass as usize;
        self.next.resize(self.next.len().max(place + 1), NONE);
        self.next[place] = *first;
        *first = pass;
    }

    fn of(&self, minimum: u32) -> impl Iterator<Item = usize> {
        let some = |pass: u32| (pass != NONE).then_some(pass as usize);
        std::iter::successors(some(self.first[minimum as usize]), move |pass| some(self.next[*pass]))
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
