//! Pieces of wall below rising distances, each grown from a minimum only as far as it must be.
//! `prominence` says what for.

use super::disjoint_lists::DisjointLists;
use super::link_neighbourhood::LinkNeighbourhood;
use crate::mesh::{ends_of, find_root, unite};
use crate::pair::{Height, measure_points, measure_segments};
use fearless_simd::Level;
use parry3d_f64::math::{Real, Vector};

/// What was reached of the wall near one link, in memory that is used again.
#[derive(Clone, Default)]
pub(super) struct Flood {
    /// The triangles that were reached.
    reached: Vec<Reached>,
    /// For each triangle of the mesh where it stands among them. What stands there of other links
    /// does no harm.
    of_triangle: Vec<u32>,
    /// Their corners, those at one place as one.
    corners: Vec<Corner>,
    /// How far away they are, as far as they were measured.
    heights: Vec<Height>,
    /// For each vertex of the mesh where it stands among them.
    of_vertex: Vec<u32>,
    /// For each that was reached an earlier one of the same piece, or itself.
    joined: Vec<u32>,
    /// For the first of each piece those from which more may be reached, and its minima that are
    /// kept.
    open: DisjointLists,
    kept: DisjointLists,
    /// Those from which more is reached at the moment, and those from which no corner leads
    /// farther.
    wave: Vec<u32>,
    closed: Vec<u32>,
    /// Edges to be measured: the triangle that names each, and which of its parts it is.
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
    /// Whether all that is near around it was reached and is one piece.
    is_followed: bool,
}

impl Flood {
    /// Nothing was reached yet.
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

    /// Keeps a minimum, at a triangle that is near.
    pub(super) fn keep(&mut self, around: LinkNeighbourhood, triangle: u32, minimum: u32) {
        let place = self.reach(around, triangle);
        self.kept.put(find_root(&mut self.joined, place), minimum);
    }

    /// Whether one that is kept and `stands_for` a minimum at a triangle is reached from there
    /// below a distance. That distance may not be less than for those who asked before.
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
        // Of the closed ones so many have edges that lead no farther.
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

    /// Where a triangle stands that is near: behind all that were reached, if it was not yet.
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

    /// Where a triangle stands that was reached.
    #[inline(always)]
    fn place(&self, triangle: u32) -> Option<u32> {
        let place = self.of_triangle[triangle as usize];
        let reached = self.reached.get(place as usize)?;
        (reached.triangle == triangle).then_some(place)
    }

    /// Reaches all that is near around a corner or an edge of one that was reached.
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

    /// Follows the corners of the wave that are passes below a distance. Where one is none, its
    /// triangle is closed.
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

    /// Follows the edges of the closed ones, from one of them on, that are passes below a distance
    /// although their ends are none.
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
            // Another that names it may have been followed already.
            if around.is_pass(&height, below) && self.reaches_other_piece(around, triangle, part) {
                self.follow(around, triangle, part);
            }
        });
        self.edges = edges;
    }

    /// Whether behind one that was reached, the next in the ring of an edge that is near belongs to
    /// another piece. If it is so for none of them, all in the ring are one piece.
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

/// The ends of an edge in an order that does not depend on the triangle that names it.
fn in_order([from, to]: [Vector; 2]) -> [Vector; 2] {
    if from.to_array() <= to.to_array() { [from, to] } else { [to, from] }
}
