//! Where open edges of a mesh touch within the rounding of their coordinates: seams of an ulp, and
//! T-vertices.
//!
//! # Definitions
//! - *open edge*: an edge whose triangles all have the same third corner. There the wall ends on
//!   one side, unless it goes on beyond a seam. *Open corner*: an end of an open edge.
//! - A point p *touches* a point or an edge if no coordinate of p differs by more than
//!   `32 u m` from the point, or from the nearest point of the edge. m is the largest coordinate of
//!   all points that take part. So the distance from the origin counts, not the extent.
//! - *place*: open corners that touch are one place; so are chains of them. Touching is not
//!   transitive, so the ends of a long chain may be farther apart ([`Seams::gap`]).
//! - *seam*: a stretch that two triangles share although neither has both of its ends as corners.
//!   An open corner V touches an open edge e between its ends. If an open edge from V runs along e,
//!   the stretch that both have in common is the seam. Otherwise V is the seam.
//! - *loose* triangle: one that shares a corner or a stretch only within rounding.
//!
//! # Rounding
//! A tool that computes a point of an edge errs by 5 u m. A rotation and a shift of the mesh move
//! each corner by less than 6 u m more, on both sides of the seam. 32 u m is twice the sum.
//!
//! # Cost
//! A closed mesh with equal corners has no open edge and costs one test per edge. Otherwise the
//! open corners are sorted into a tree of boxes, and each open edge visits the boxes that it meets.

use super::disjoint_sets::{find_root, unite};
use crate::distance::Scalar;
use parry3d_f64::math::{Real, Vector};

/// The open corners in a leaf of the tree. 4 to 16 take the same time.
const LEAF: usize = 8;

/// An edge whose triangles all have the same third corner.
#[derive(Clone, Copy)]
pub(super) struct OpenEdge {
    /// The lowest of its triangles.
    pub triangle: u32,
    /// The first vertices at its ends.
    pub ends: [u32; 2],
}

/// A seam, as one of its triangles sees it.
#[derive(Clone, Copy)]
pub(crate) struct Seam {
    triangle: u32,
    /// The triangle on the other side.
    pub other: u32,
    /// The vertices at its ends; twice the same if it is a corner.
    pub ends: [u32; 2],
    /// A bound on the distance of its points from either triangle.
    pub gap: Real,
}

/// What triangles share within rounding only.
#[derive(Clone)]
pub(crate) struct Seams {
    /// For each vertex a bound on the distance between two corners at its place.
    gaps: Vec<Real>,
    /// Sorted by triangle.
    seams: Vec<Seam>,
    is_loose: Vec<bool>,
    /// The places between the ends of open edges, with the edge's ends in ascending order. Sorted.
    on_edges: Vec<([u32; 2], u32)>,
}

/// The open corners that touch another open corner, or an open edge.
#[derive(Default)]
pub(super) struct Touching {
    corners: Vec<[u32; 2]>,
    /// The corner, and the number of the edge.
    on_edges: Vec<(u32, u32)>,
}

/// Returns a bound on the difference of coordinates that rounding may cause.
fn coordinate_rounding(points: &[Vector]) -> Real {
    let largest = points.iter().fold(Vector::ZERO, |most, point| most.max(point.abs()));
    32.0 * f64::UNIT_ROUNDOFF * largest.max_element()
}

impl Touching {
    /// Finds all open corners that touch. The ends of `open` are the first vertices at their
    /// places.
    pub(super) fn find(vertices: &[Vector], open: &[OpenEdge]) -> Self {
        let tree = CornerTree::new(vertices, open);
        let mut found = Self::default();
        for (number, edge) in (0..).zip(open) {
            let ends = edge.ends.map(|end| vertices[end as usize]);
            tree.visit_near(ends, |corner| {
                if edge.ends.contains(&corner) {
                    return;
                }
                let point = vertices[corner as usize];
                let meets = |end: Vector| touches(point, end, coordinate_rounding(&[point, end]));
                match [0, 1].map(|end| meets(ends[end])) {
                    [false, false] => {
                        if touches_between(point, ends) {
                            found.on_edges.push((corner, number));
                        }
                    }
                    at => {
                        let met = edge.ends.iter().zip(at).filter(|(_, meets)| *meets);
                        found.corners.extend(met.map(|(&end, _)| [corner, end]));
                    }
                }
            });
        }
        found.on_edges.sort_unstable();
        found
    }

    pub(super) fn is_empty(&self) -> bool {
        self.corners.is_empty() && self.on_edges.is_empty()
    }

    /// Renumbers the vertices, so that all at one place have the number of the first. Returns
    /// whether any number changed.
    pub(super) fn unite_places(&self, corners: &mut [u32]) -> bool {
        for &[one, other] in &self.corners {
            unite(corners, one, other);
        }
        for vertex in 0..corners.len() as u32 {
            corners[vertex as usize] = find_root(corners, vertex);
        }
        !self.corners.is_empty()
    }
}

/// Returns true if no coordinate of two points differs by more than `rounding`.
fn touches(one: Vector, other: Vector, rounding: Real) -> bool {
    (one - other).abs().max_element() <= rounding
}

/// Returns true if a point touches an edge between its ends.
fn touches_between(point: Vector, [from, to]: [Vector; 2]) -> bool {
    let along = to - from;
    let share = (point - from).dot(along) / along.length_squared();
    (0.0..=1.0).contains(&share)
        && touches(point, from + along * share, coordinate_rounding(&[point, from, to]))
}

impl Seams {
    /// `corners` has the first vertex at the place of each vertex.
    pub(super) fn new(
        vertices: &[Vector],
        indices: &[[u32; 3]],
        corners: &[u32],
        open: &[OpenEdge],
        touching: &Touching,
    ) -> Self {
        let mut gaps = vec![0.0; vertices.len()];
        for (vertex, &first) in vertices.iter().zip(corners) {
            let gap: &mut Real = &mut gaps[first as usize];
            *gap = gap.max(2.0 * (*vertex - vertices[first as usize]).length());
        }
        for vertex in 0..vertices.len() {
            gaps[vertex] = gaps[corners[vertex] as usize];
        }
        let on_edges = places_on_edges(corners, open, touching);
        let seams = find_seams(vertices, corners, &gaps, open, &on_edges);
        let mut is_loose: Vec<_> = indices
            .iter()
            .map(|triangle| triangle.iter().any(|&vertex| gaps[vertex as usize] > 0.0))
            .collect();
        seams.iter().for_each(|seam| is_loose[seam.triangle as usize] = true);
        let ascending = |ends: [u32; 2]| [ends[0].min(ends[1]), ends[0].max(ends[1])];
        let ends = |edge: u32| ascending(open[edge as usize].ends.map(|end| corners[end as usize]));
        let mut on_edges: Vec<_> =
            on_edges.into_iter().map(|(corner, edge)| (ends(edge), corner)).collect();
        on_edges.sort_unstable();
        on_edges.dedup();
        Self { gaps, seams, is_loose, on_edges }
    }

    /// Returns the places between the ends of an edge, which are given in ascending order.
    pub(super) fn on_edge(&self, ends: [u32; 2]) -> impl Iterator<Item = u32> {
        let first = self.on_edges.partition_point(|(edge, _)| *edge < ends);
        let at = self.on_edges[first..].iter().take_while(move |(edge, _)| *edge == ends);
        at.map(|(_, corner)| *corner)
    }

    /// Returns true if the triangle shares a corner or a stretch only within rounding.
    #[inline(always)]
    pub(super) fn is_loose(&self, triangle: u32) -> bool {
        self.is_loose[triangle as usize]
    }

    /// Returns the seams of a triangle.
    pub(super) fn of(&self, triangle: u32) -> &[Seam] {
        let end = |triangle| self.seams.partition_point(|seam| seam.triangle < triangle);
        &self.seams[end(triangle)..end(triangle + 1)]
    }

    /// Returns a bound on the distance between two corners at the place of a vertex.
    pub(super) fn gap(&self, vertex: u32) -> Real {
        self.gaps[vertex as usize]
    }
}

/// Returns the places between the ends of open edges, with the numbers of the edges. Sorted.
fn places_on_edges(corners: &[u32], open: &[OpenEdge], touching: &Touching) -> Vec<(u32, u32)> {
    let place = |vertex: u32| corners[vertex as usize];
    let ends = |edge: u32| open[edge as usize].ends.map(place);
    // Corners that are at the place of an end of the edge are shared by the rings.
    let between = touching.on_edges.iter().map(|&(corner, edge)| (place(corner), edge));
    let mut on_edges: Vec<_> =
        between.filter(|&(corner, edge)| !ends(edge).contains(&corner)).collect();
    on_edges.sort_unstable();
    on_edges.dedup();
    on_edges
}

/// Returns each seam twice, once for each of its triangles.
fn find_seams(
    vertices: &[Vector],
    corners: &[u32],
    gaps: &[Real],
    open: &[OpenEdge],
    on_edges: &[(u32, u32)],
) -> Vec<Seam> {
    let ends = |edge: u32| open[edge as usize].ends.map(|end| corners[end as usize]);
    let is_on = |corner: u32, edge: u32| {
        ends(edge).contains(&corner) || on_edges.binary_search(&(corner, edge)).is_ok()
    };
    let numbers = 0..open.len() as u32;
    let mut edges_at: Vec<_> =
        numbers.flat_map(|edge| ends(edge).map(|corner| (corner, edge))).collect();
    edges_at.sort_unstable();
    let mut seams = Vec::new();
    let mut add = |edges: [u32; 2], ends: [u32; 2]| {
        let [one, other] = edges.map(|edge| open[edge as usize].triangle);
        if one != other {
            let ends = [ends[0].min(ends[1]), ends[0].max(ends[1])];
            let of_edges = edges.map(|edge| open[edge as usize].ends);
            let [a, b] = of_edges.map(|ends| ends.map(|end| vertices[end as usize]));
            // A point differs in three coordinates.
            let touching = 2.0 * coordinate_rounding(&[a[0], a[1], b[0], b[1]]);
            let gap = touching + gaps[ends[0] as usize].max(gaps[ends[1] as usize]);
            seams.push(Seam { triangle: one, other, ends, gap });
            seams.push(Seam { triangle: other, other: one, ends, gap });
        }
    };
    for &(corner, edge) in on_edges {
        let first = edges_at.partition_point(|&(at, _)| at < corner);
        let at_corner = edges_at[first..].iter().take_while(|&&(at, _)| at == corner);
        let mut is_alone = true;
        for &(_, other) in at_corner {
            let [one, two] = ends(other);
            let far = if one == corner { two } else { one };
            let end = if is_on(far, edge) {
                Some(far)
            } else {
                ends(edge).into_iter().find(|&end| is_on(end, other))
            };
            if let Some(end) = end {
                add([edge, other], [corner, end]);
                is_alone = false;
            }
        }
        // The triangles at the corner share it with one another.
        if is_alone && let Some(&(_, other)) = edges_at.get(first) {
            add([edge, other], [corner; 2]);
        }
    }
    let key = |seam: &Seam| (seam.triangle, seam.other, seam.ends);
    seams.sort_unstable_by(|one, other| {
        key(one).cmp(&key(other)).then(one.gap.total_cmp(&other.gap))
    });
    seams.dedup_by_key(|seam| key(seam));
    seams
}

/// A tree of boxes around the open corners, in preorder.
struct CornerTree {
    nodes: Vec<Node>,
    corners: Vec<(Vector, u32)>,
}

struct Node {
    /// The lowest and the highest coordinates.
    bounds: [Vector; 2],
    /// The number of nodes in this subtree.
    below: usize,
    /// The corners of a leaf; none of an inner node.
    corners: std::ops::Range<usize>,
}

impl CornerTree {
    fn new(vertices: &[Vector], open: &[OpenEdge]) -> Self {
        let mut ends: Vec<_> = open.iter().flat_map(|edge| edge.ends).collect();
        ends.sort_unstable();
        ends.dedup();
        let mut tree = Self { nodes: Vec::new(), corners: Vec::with_capacity(ends.len()) };
        tree.corners.extend(ends.into_iter().map(|end| (vertices[end as usize], end)));
        tree.divide(0..tree.corners.len());
        tree
    }

    fn divide(&mut self, range: std::ops::Range<usize>) {
        let (number, corners) = (self.nodes.len(), &mut self.corners[range.clone()]);
        let nothing = [Vector::INFINITY, Vector::NEG_INFINITY];
        let bounds = corners
            .iter()
            .fold(nothing, |[low, high], (point, _)| [low.min(*point), high.max(*point)]);
        let is_leaf = corners.len() <= LEAF;
        let of_leaf = if is_leaf { range.clone() } else { 0..0 };
        self.nodes.push(Node { bounds, below: 1, corners: of_leaf });
        if !is_leaf {
            let size = (bounds[1] - bounds[0]).to_array();
            let axis = (0..3).fold(0, |widest, axis| match size[widest] < size[axis] {
                true => axis,
                false => widest,
            });
            let middle = corners.len() / 2;
            corners.select_nth_unstable_by(middle, |one, other| {
                one.0[axis].total_cmp(&other.0[axis]).then(one.1.cmp(&other.1))
            });
            let middle = range.start + middle;
            self.divide(range.start..middle);
            self.divide(middle..range.end);
            self.nodes[number].below = self.nodes.len() - number;
        }
    }

    /// Passes all corners that may touch an edge to `visit`.
    fn visit_near(&self, [from, to]: [Vector; 2], mut visit: impl FnMut(u32)) {
        // Twice the rounding, for that of the test.
        let rounding = Vector::splat(2.0 * coordinate_rounding(&[from, to]));
        let (middle, half) = ((from + to) * 0.5, (to - from) * 0.5);
        let reach = half.abs();
        let mut at = 0;
        while let Some(node) = self.nodes.get(at) {
            let [low, high] = node.bounds;
            let size = (high - low) * 0.5 + rounding;
            let apart = middle - (low + high) * 0.5;
            // The separating axes of a segment and a box: the axes of the box, and the directions
            // across the segment and an axis.
            let across = half.cross(apart).abs();
            let limit = Vector::new(
                size.y * reach.z + size.z * reach.y,
                size.z * reach.x + size.x * reach.z,
                size.x * reach.y + size.y * reach.x,
            );
            if !(apart.abs().cmple(size + reach).all() && across.cmple(limit).all()) {
                at += node.below;
                continue;
            }
            self.corners[node.corners.clone()].iter().for_each(|&(_, corner)| visit(corner));
            at += 1;
        }
    }
}
