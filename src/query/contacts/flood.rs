//! Floods the wall near one link below rising distances, from its minima, until each is decided.
//!
//! It answers whether a minimum reaches a kept one below a distance; `prominence` states the
//! problem.
//!
//! # Algorithm
//! 1. Each reached triangle belongs to a piece (union-find). A piece has a list of *open* triangles
//!    and a list of its kept minima.
//! 2. If a kept minimum of the piece represents the query's minimum, it is reached.
//! 3. Otherwise take the open triangles as a *wave*. Reach all triangles around each of their
//!    corners that is a pass. A triangle with a corner that is no pass is *closed*.
//! 4. If there is no open triangle left, follow those edges of the closed triangles that are passes
//!    although both ends are none.
//! 5. Repeat from step 2. If no step reaches anything, the minimum is not reached. The closed
//!    triangles become open for the next, greater distance.

use super::disjoint_lists::DisjointLists;
use super::link_neighbourhood::LinkNeighbourhood;
use crate::mesh::{ends_of, find_root, unite};
use crate::pair::{Height, measure_points, measure_segments};
use fearless_simd::Level;
use parry3d_f64::math::{Real, Vector};

/// The reached part of the wall near one link; memory is reused by later queries.
#[derive(Clone, Default)]
pub(super) struct Flood {
    /// The reached triangles.
    reached: Vec<Reached>,
    /// For each triangle of the mesh its index in `reached`. Stale values are harmless, because the
    /// triangle there is compared.
    of_triangle: Vec<u32>,
    /// The corners of the reached triangles, one for each place.
    corners: Vec<Corner>,
    /// The distances of the first corners; the others are not measured yet.
    heights: Vec<Height>,
    /// For each vertex of the mesh its index in `corners`.
    of_vertex: Vec<u32>,
    /// Union-find: for each reached triangle an earlier one of the same piece, or itself.
    joined: Vec<u32>,
    /// For the first triangle of each piece: the open triangles, and the kept minima of the piece.
    open: DisjointLists,
    kept: DisjointLists,
    /// The open triangles of the current step, and the closed triangles.
    wave: Vec<u32>,
    closed: Vec<u32>,
    /// Edges to be measured: a triangle that has the edge, and the number of the part.
    edges: Vec<(u32, usize)>,
}

#[derive(Clone, Copy)]
struct Reached {
    triangle: u32,
    corners: [u32; 3],
}

#[derive(Clone, Copy)]
struct Corner {
    /// The first vertex at its place.
    vertex: u32,
    /// Whether all near triangles around it were reached and are one piece.
    is_followed: bool,
}

impl Flood {
    /// Starts again for a link, without reached triangles.
    pub(super) fn begin(&mut self, around: LinkNeighbourhood) {
        let mesh = around.wall.mesh;
        self.of_triangle.resize(mesh.len(), 0);
        self.of_vertex.resize(mesh.vertices().len(), 0);
        self.reached.clear();
        self.corners.clear();
        self.heights.clear();
        self.joined.clear();
        self.open.clear();
        self.kept.clear();
    }

    /// Adds a kept minimum at a near triangle.
    pub(super) fn keep(&mut self, around: LinkNeighbourhood, triangle: u32, minimum: u32) {
        let place = self.reach(around, triangle);
        self.kept.put(find_root(&mut self.joined, place), minimum);
    }

    /// Returns true if a path below the distance `below` leads from a triangle to a kept minimum
    /// for which `stands_for` holds. `below` must not decrease from call to call.
    pub(super) fn reaches(
        &mut self,
        level: Level,
        around: LinkNeighbourhood,
        triangle: u32,
        below: Real,
        stands_for: impl Fn(u32) -> bool,
    ) -> bool {
        let place = self.reach(around, triangle);
        self.closed.clear();
        // The closed triangles whose edges have been followed.
        let mut ended = 0;
        let is_reached = loop {
            let piece = find_root(&mut self.joined, place);
            if self.kept.find(piece, &stands_for) {
                break true;
            }
            self.wave.clear();
            self.open.take(piece, &mut self.wave);
            if !self.wave.is_empty() {
                self.follow_corners(level, around, below);
            } else if ended < self.closed.len() {
                self.follow_edges(level, around, below, ended);
                ended = self.closed.len();
            } else {
                break false;
            }
        };
        let piece = find_root(&mut self.joined, place);
        self.closed.iter().for_each(|&place| self.open.put(piece, place));
        is_reached
    }

    /// Returns the index of a near triangle in `reached`, and appends the triangle if it is new.
    fn reach(&mut self, around: LinkNeighbourhood, triangle: u32) -> u32 {
        if let Some(place) = self.place(triangle) {
            return place;
        }
        let mesh = around.wall.mesh;
        let corners = mesh.indices()[triangle as usize].map(|vertex| {
            let vertex = mesh.parts().first_at(vertex);
            let at = &mut self.of_vertex[vertex as usize];
            if self.corners.get(*at as usize).is_none_or(|corner| corner.vertex != vertex) {
                *at = self.corners.len() as u32;
                self.corners.push(Corner { vertex, is_followed: false });
            }
            *at
        });
        let place = self.reached.len() as u32;
        self.of_triangle[triangle as usize] = place;
        self.reached.push(Reached { triangle, corners });
        self.joined.push(place);
        self.open.begin();
        self.kept.begin();
        self.open.put(place, place);
        place
    }

    /// Returns the index of a triangle in `reached`, if it was reached.
    #[inline(always)]
    fn place(&self, triangle: u32) -> Option<u32> {
        let place = self.of_triangle[triangle as usize];
        let reached = self.reached.get(place as usize)?;
        (reached.triangle == triangle).then_some(place)
    }

    /// Reaches all near triangles around a corner or an edge of a reached triangle, and unites
    /// their pieces.
    fn follow(&mut self, around: LinkNeighbourhood, triangle: u32, part: usize) {
        let own = self.reach(around, triangle);
        for other in around.wall.mesh.parts().others(triangle, part) {
            if self.place(other).is_none() && !around.holds(other) {
                continue;
            }
            let place = self.reach(around, other);
            let [first, second] = unite(&mut self.joined, own, place);
            if first != second {
                self.open.append(second, first);
                self.kept.append(second, first);
            }
        }
    }

    /// Step 3: follows the corners of the wave that are passes below a distance, and closes
    /// triangles with a corner that is no pass.
    fn follow_corners(&mut self, level: Level, around: LinkNeighbourhood, below: Real) {
        let vertices = around.wall.mesh.vertices();
        let unknown = self.corners[self.heights.len()..].iter();
        let points = unknown.map(|corner| vertices[corner.vertex as usize]);
        measure_points(level, around.link, points, |height| self.heights.push(height));
        let wave = std::mem::take(&mut self.wave);
        for &place in &wave {
            let Reached { triangle, corners } = self.reached[place as usize];
            let mut is_closed = false;
            for (part, corner) in corners.map(|corner| corner as usize).into_iter().enumerate() {
                if self.corners[corner].is_followed {
                    continue;
                }
                if around.is_pass(&self.heights[corner], below) {
                    self.corners[corner].is_followed = true;
                    self.follow(around, triangle, part);
                } else {
                    is_closed = true;
                }
            }
            if is_closed {
                self.closed.push(place);
            }
        }
        self.wave = wave;
    }

    /// Step 4: follows the edges of the closed triangles, from one of them on, that are passes
    /// below a distance although their ends are none.
    fn follow_edges(&mut self, level: Level, around: LinkNeighbourhood, below: Real, from: usize) {
        let mesh = around.wall.mesh;
        self.edges.clear();
        let closed = std::mem::take(&mut self.closed);
        for &place in &closed[from..] {
            let Reached { triangle, corners } = self.reached[place as usize];
            let points = mesh.corners(triangle);
            for part in 3..6 {
                let ends = ends_of(corners, part).map(|corner| corner as usize);
                if ends.iter().any(|&end| self.corners[end].is_followed) {
                    continue;
                }
                let [start, end] = ends_of(points, part);
                if !around.may_pass_between(ends.map(|end| &self.heights[end]), end - start, below)
                {
                    continue;
                }
                if self.reaches_other_piece(around, triangle, part) {
                    self.edges.push((triangle, part));
                }
            }
        }
        self.closed = closed;
        let edges = std::mem::take(&mut self.edges);
        let segments =
            edges.iter().map(|&(triangle, part)| in_order(ends_of(mesh.corners(triangle), part)));
        let mut of_heights = edges.iter();
        measure_segments(level, around.link, segments, |height| {
            let Some(&(triangle, part)) = of_heights.next() else { return };
            // Another triangle with this edge may have been followed already.
            if around.is_pass(&height, below) && self.reaches_other_piece(around, triangle, part) {
                self.follow(around, triangle, part);
            }
        });
        self.edges = edges;
    }

    /// Returns true if the next near triangle in the ring of an edge belongs to another piece, or
    /// is not reached. If this is false for all triangles of the ring, they are one piece.
    fn reaches_other_piece(
        &mut self,
        around: LinkNeighbourhood,
        triangle: u32,
        part: usize,
    ) -> bool {
        let own = self.reach(around, triangle);
        for other in around.wall.mesh.parts().others(triangle, part) {
            if let Some(other) = self.place(other) {
                return find_root(&mut self.joined, other) != find_root(&mut self.joined, own);
            }
            if around.holds(other) {
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
