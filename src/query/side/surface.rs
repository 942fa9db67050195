//! The openings of a mesh and their lids, and the edges that make its sides doubtful.
//!
//! # Definitions
//! - *face*: a triangle whose corners are at three different places. Other triangles have no edges.
//! - *edge*: a stretch of a face's side between two places of corners. Corners that lie on an open
//!   side within rounding divide it (`mesh/seams.rs`). So the faces at a T-vertex share their
//!   edges.
//! - *boundary edge*: an edge of exactly one face.
//! - *opening*: boundary edges that are connected by their corners, unless they are a seam.
//! - *seam*: boundary edges within [`SEAM_WIDTH`] of one line, such as those between corners that
//!   divide two sides in different orders. Nothing leaves through a seam.
//! - *lid* of an opening: a triangle for each boundary edge, with the opening's centre.
//!
//! # What lids are for
//! **Claim.** Let each edge of the mesh have one face or two, and let no opening be a seam. A curve
//! that touches neither the mesh nor a lid stays on one side of the mesh with its lids.
//!
//! **Proof.** Each corner has an even number of boundary edges: each face at a corner has two edges
//! there, and all edges but the boundary edges are counted twice. So each edge between a corner and
//! the centre belongs to an even number of the lid's triangles, and each boundary edge to a face
//! and to a triangle of a lid. Every edge thus has an even number of triangles. The number of
//! crossings with a closed curve is then even, so the parity of crossings tells two sides apart.

use crate::answer::{Opening, SurfaceReport};
use crate::distance::Scalar;
use crate::mesh::{Mesh, PARTS, SharedParts, ends_of, find_root, unite};
use crate::robot::{direction, length};
use crate::search::hierarchy::Hierarchy;
use fearless_simd::Level;
use parry3d_f64::math::{Real, Vector};

/// The width of a seam over its largest coordinate.
///
/// Corners and edges touch if no coordinate differs by more than `32 u` of the largest one
/// (`mesh/seams.rs`). That is a distance of less than `56 u`. The width itself errs by less than
/// `8 u`.
const SEAM_WIDTH: Real = 64.0 * f64::UNIT_ROUNDOFF;

/// A mesh as a surface.
#[derive(Clone)]
pub(crate) struct Surface {
    pub report: SurfaceReport,
    /// The lids of all openings. `None` for a closed mesh.
    pub lids: Option<Hierarchy>,
}

impl Surface {
    pub(crate) fn new(level: Level, mesh: &Mesh) -> Self {
        let parts = mesh.parts();
        let (mut report, edges) = classify_edges(mesh, parts);
        let mut lids = Vec::new();
        for edges in groups(edges, mesh.vertices().len()) {
            let ends: Vec<_> = edges
                .iter()
                .map(|edge| edge.map(|place| mesh.vertices()[place as usize]))
                .collect();
            let corners = ends.as_flattened();
            let share = 1.0 / corners.len() as Real;
            let centre = corners.iter().map(|&corner| corner * share).sum();
            let width = width(corners, centre);
            if width <= SEAM_WIDTH * largest_coordinate(corners) {
                continue;
            }
            report.openings.push(Opening { edges: edges.len(), width, centre });
            lids.extend(ends.iter().flat_map(|&[from, to]| [from, to, centre]));
        }
        report.openings.sort_by(|one, other| other.width.total_cmp(&one.width));
        let triangles = (0..lids.len() as u32 / 3).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]);
        let triangles = triangles.collect();
        let lids = (!lids.is_empty()).then(|| Hierarchy::new(level, Mesh::of(lids, triangles)));
        Self { report, lids }
    }
}

/// The faces of an edge.
struct Edge {
    /// The places of its ends, in ascending order.
    ends: [u32; 2],
    faces: usize,
    /// How many of the faces have it from the lower place to the other.
    ascending: usize,
}

/// Counts the edges by their faces, and returns the boundary edges as pairs of places. Each ring of
/// a side is walked once.
fn classify_edges(mesh: &Mesh, parts: &SharedParts) -> (SurfaceReport, Vec<[u32; 2]>) {
    // Whether the sides of faces ascend, until their ring is counted.
    let sides_of = |corners: &[u32; 3]| {
        let [a, b, c] = corners.map(|vertex| parts.first_at(vertex));
        let is_face = a != b && b != c && c != a;
        [a < b, b < c, c < a].map(|ascends| is_face.then_some(ascends))
    };
    let mut sides: Vec<_> = mesh.indices().iter().map(sides_of).collect();
    let (mut report, mut boundary) = (SurfaceReport::default(), Vec::new());
    let mut count = |Edge { ends, faces, ascending }: Edge| {
        report.unbalanced_edges += usize::from(faces > 1 && 2 * ascending != faces);
        match (faces, ascending) {
            (2, 1) => {}
            (1, _) => boundary.push(ends),
            (2, _) => report.misoriented_edges += 1,
            _ => report.nonmanifold_edges += 1,
        }
    };
    // The edges of all sides, if edges of different sides may be the same.
    let mut divided = Vec::new();
    for (triangle, corners) in mesh.indices().iter().enumerate() {
        for side in 3..PARTS {
            if sides[triangle][side - 3].is_none() {
                continue;
            }
            let [from, to] = ends_of(*corners, side).map(|vertex| parts.first_at(vertex));
            let ends = [from.min(to), from.max(to)];
            let mut edge = Edge { ends, faces: 0, ascending: 0 };
            for (triangle, side) in parts.ring(triangle as u32, side) {
                if let Some(ascends) = sides[triangle as usize][side - 3].take() {
                    edge.faces += 1;
                    edge.ascending += usize::from(ascends);
                }
            }
            if parts.has_seams() {
                divide(mesh.vertices(), parts, &edge, &mut divided);
            } else {
                count(edge);
            }
        }
    }
    divided.sort_unstable_by_key(|edge| edge.ends);
    for same in divided.chunk_by(|one, other| one.ends == other.ends) {
        let [faces, ascending] =
            same.iter().fold([0, 0], |sum, edge| [sum[0] + edge.faces, sum[1] + edge.ascending]);
        count(Edge { ends: same[0].ends, faces, ascending });
    }
    (report, boundary)
}

/// Divides a side at the corners on it.
fn divide(vertices: &[Vector], parts: &SharedParts, side: &Edge, edges: &mut Vec<Edge>) {
    let [low, high] = side.ends;
    let [from, to] = side.ends.map(|end| vertices[end as usize]);
    let along = direction(to - from);
    let way = |place: u32| along.dot(vertices[place as usize] - from);
    let mut places: Vec<_> = parts.on_edge(side.ends).collect();
    places.sort_unstable_by(|&one, &other| way(one).total_cmp(&way(other)));
    let mut before = low;
    for place in places.into_iter().chain([high]) {
        let descending = side.faces - side.ascending;
        edges.push(Edge {
            ends: [before.min(place), before.max(place)],
            faces: side.faces,
            ascending: if before < place { side.ascending } else { descending },
        });
        before = place;
    }
}

/// Returns the edges in groups that are connected by their ends. Ends are below `places`.
fn groups(mut edges: Vec<[u32; 2]>, places: usize) -> Vec<Vec<[u32; 2]>> {
    if edges.is_empty() {
        return Vec::new();
    }
    let mut joined: Vec<_> = (0..places as u32).collect();
    for &[from, to] in &edges {
        unite(&mut joined, from, to);
    }
    let mut group = |edge: &[u32; 2]| find_root(&mut joined, edge[0]);
    edges.sort_by_key(&mut group);
    edges.chunk_by(|one, other| group(one) == group(other)).map(<[_]>::to_vec).collect()
}

/// Returns the extent of points across the line between two that are far apart: the one farthest
/// from the centre, and the one farthest from it.
fn width(points: &[Vector], centre: Vector) -> Real {
    let farthest = |from: Vector| {
        let distance = |point: &Vector| length(*point - from);
        let farthest = points.iter().copied();
        farthest.max_by(|one, other| distance(one).total_cmp(&distance(other))).unwrap_or(from)
    };
    let base = farthest(centre);
    let along = direction(farthest(base) - base);
    let across = |point: Vector| {
        let offset = point - base;
        offset - along * along.dot(offset)
    };
    let longest = points.iter().map(|&point| across(point));
    let longest = longest.max_by(|one, other| length(*one).total_cmp(&length(*other)));
    let sideways = direction(longest.unwrap_or(Vector::ZERO));
    let extents = [sideways, along.cross(sideways)].map(|axis| {
        let places = points.iter().map(|&point| axis.dot(across(point)));
        let (low, high) = places
            .fold((Real::INFINITY, Real::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
        high - low
    });
    length(Vector::new(extents[0], extents[1], 0.0))
}

fn largest_coordinate(points: &[Vector]) -> Real {
    points.iter().map(|point| point.abs().max_element()).fold(0.0, Real::max)
}
