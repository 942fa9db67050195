//! A mesh in blocks of 16 triangles, each coordinate in a row of its own, for exhaustive search.

use super::coarse::CoarseFrame;
use super::packed::BLOCK;
use super::scan::Scan;
use super::share::each;
use crate::distance::lanes::{Lane, Pack};
use crate::distance::{Face, Mask, Vec3};
use fearless_simd::Level;
use parry3d_f64::math::Vector;

/// Rows of a block that bound its triangles: a sphere's centre and radius.
const SPHERE_ROWS: usize = 4;
/// Rows of a block that hold its triangles: three vertices and the dual basis.
const FACE_ROWS: usize = 15;
/// How many blocks one thread takes over at a time.
const SHARE: usize = 64;

/// The triangles of a mesh, near one, with what is computed once for each.
pub(super) struct SoaMesh<E> {
    pub frame: CoarseFrame,
    spheres: Vec<E>,
    faces: Vec<E>,
}

impl<E: Scan> SoaMesh<E> {
    pub(super) fn new(level: Level, vertices: &[Vector], indices: &[[u32; 3]]) -> Self {
        let mut mesh = Self { frame: CoarseFrame::new(vertices), spheres: Vec::new(), faces: Vec::new() };
        mesh.update(level, vertices, indices);
        mesh
    }

    /// Takes over moved vertices.
    pub(super) fn update(&mut self, level: Level, vertices: &[Vector], indices: &[[u32; 3]]) {
        self.frame = CoarseFrame::new(vertices);
        let blocks = indices.len().div_ceil(BLOCK);
        self.spheres.resize(blocks * BLOCK * SPHERE_ROWS, E::default());
        self.faces.resize(blocks * BLOCK * FACE_ROWS, E::default());
        let frame = &self.frame;
        let faces = self.faces.chunks_mut(SHARE * BLOCK * FACE_ROWS);
        let mut shares: Vec<_> = faces.zip(self.spheres.chunks_mut(SHARE * BLOCK * SPHERE_ROWS)).collect();
        each(&mut shares, |share, (faces, spheres)| {
            fill(frame, vertices, indices, share * SHARE, faces);
            E::prepare(level, faces, spheres);
        });
    }
}

impl<E: Lane> SoaMesh<E> {
    /// How many blocks there are.
    pub(super) fn blocks(&self) -> usize {
        self.spheres.len() / (BLOCK * SPHERE_ROWS)
    }

    /// Centres and radii of the spheres around the triangles from `lane` on.
    #[inline(always)]
    pub(super) fn spheres<L: Pack<Element = E>>(
        &self,
        token: L::Token,
        block: usize,
        lane: usize,
    ) -> (Vec3<L>, L) {
        let rows = &self.spheres[block * BLOCK * SPHERE_ROWS..][..BLOCK * SPHERE_ROWS];
        (load(token, rows, 0, lane), L::load(token, &rows[3 * BLOCK + lane..]))
    }

    /// The triangles from `lane` on.
    #[inline(always)]
    pub(super) fn faces<L: Pack<Element = E>>(&self, token: L::Token, block: usize, lane: usize) -> Face<L> {
        let rows = &self.faces[block * BLOCK * FACE_ROWS..][..BLOCK * FACE_ROWS];
        let dual = [load(token, rows, 9, lane), load(token, rows, 12, lane)];
        Face::again(load_vertices(token, rows, lane), dual)
    }
}

/// Writes the corners of the triangles into blocks, the first of which has the number `first`.
fn fill<E: Lane>(
    frame: &CoarseFrame,
    vertices: &[Vector],
    indices: &[[u32; 3]],
    first: usize,
    faces: &mut [E],
) {
    for (block, rows) in faces.chunks_exact_mut(BLOCK * FACE_ROWS).enumerate() {
        for lane in 0..BLOCK {
            // The last block is filled up with its last triangle.
            let triangle = indices[((first + block) * BLOCK + lane).min(indices.len() - 1)];
            place_triangle(frame, vertices, triangle, rows, lane);
        }
    }
}

/// Writes the corners of a triangle into its lane of a block.
pub(super) fn place_triangle<E: Lane>(
    frame: &CoarseFrame,
    vertices: &[Vector],
    triangle: [u32; 3],
    rows: &mut [E],
    lane: usize,
) {
    for (corner, index) in triangle.into_iter().enumerate() {
        let point: [E; 3] = frame.point(vertices[index as usize]).into();
        for (axis, value) in point.into_iter().enumerate() {
            rows[(3 * corner + axis) * BLOCK + lane] = value;
        }
    }
}

/// Puts the vertex opposite the longest edge first, and computes dual bases and spheres.
#[inline(always)]
pub(super) fn prepare<L: Pack>(token: L::Token, faces: &mut [L::Element], spheres: &mut [L::Element]) {
    let faces = faces.chunks_exact_mut(BLOCK * FACE_ROWS);
    for (face, sphere) in faces.zip(spheres.chunks_exact_mut(BLOCK * SPHERE_ROWS)) {
        for lane in (0..BLOCK).step_by(L::LANES) {
            let made = Face::new(load_vertices::<L>(token, face, lane));
            let [a, b, c] = made.vertices;
            for (row, vector) in [a, b, c, made.dual[0], made.dual[1]].into_iter().enumerate() {
                store(vector, face, 3 * row, lane);
            }
            // Around the middle of the longest edge, which holds the apex of an obtuse triangle too.
            let centre = (b + c) * a.x.lit(0.5);
            let apex = (a - centre).norm_squared();
            let half = (b - centre).norm_squared();
            // An acute triangle's apex may lie outside: then around the centroid, if that is smaller.
            let middle = (a + b + c) * a.x.lit(1.0 / 3.0);
            let around = (a - middle).norm_squared().max((b - middle).norm_squared());
            let around = around.max((c - middle).norm_squared());
            let take_edge = apex.max(half).le(around);
            let centre = Vec3::select(take_edge, centre, middle);
            let radius = take_edge.select(apex.max(half), around).sqrt();
            store(centre, sphere, 0, lane);
            (radius * radius.lit(1.0 + 8.0 * L::UNIT_ROUNDOFF)).store(&mut sphere[3 * BLOCK + lane..]);
        }
    }
}

/// Three coordinates from the rows `row` to `row + 2`.
#[inline(always)]
pub(super) fn load<L: Pack>(token: L::Token, rows: &[L::Element], row: usize, lane: usize) -> Vec3<L> {
    let rows = &rows[row * BLOCK + lane..];
    Vec3::new(L::load(token, rows), L::load(token, &rows[BLOCK..]), L::load(token, &rows[2 * BLOCK..]))
}

/// Three vertices from the first nine rows.
#[inline(always)]
pub(super) fn load_vertices<L: Pack>(token: L::Token, rows: &[L::Element], lane: usize) -> [Vec3<L>; 3] {
    [load(token, rows, 0, lane), load(token, rows, 3, lane), load(token, rows, 6, lane)]
}

#[inline(always)]
fn store<L: Pack>(vector: Vec3<L>, rows: &mut [L::Element], row: usize, lane: usize) {
    let rows = &mut rows[row * BLOCK + lane..];
    vector.x.store(rows);
    vector.y.store(&mut rows[BLOCK..]);
    vector.z.store(&mut rows[2 * BLOCK..]);
}
