//! A mesh in blocks of 16 triangles, each triangle with its bounding sphere.

use crate::distance::lanes::{Lane, Pack};
use crate::distance::{Face, Mask, Vec3};
use crate::mesh::{BLOCK, Mesh, SearchFrame, load, load_vertices, place_points};
use crate::threads::each;

/// Rows of a block for the bounding spheres: centre and radius.
const SPHERE_ROWS: usize = 4;
/// Rows of a block for the triangles: three vertices and the dual basis.
const FACE_ROWS: usize = 15;
/// Blocks that one task takes.
const TASK_SIZE: usize = 64;

/// The triangles of a mesh in the frame of the search, with the values that are computed once for
/// each.
#[derive(Clone)]
pub(crate) struct Blocks<E> {
    pub frame: SearchFrame,
    spheres: Vec<E>,
    faces: Vec<E>,
}

impl<E: Lane> Blocks<E> {
    /// Fills blocks with the triangles of a mesh. `prepare` is [`prepare`] for an instruction set.
    pub(crate) fn new(mesh: &Mesh, prepare: impl Fn(&mut [E], &mut [E]) + Sync + Send) -> Self {
        let mut blocks =
            Self { frame: SearchFrame::new(mesh), spheres: Vec::new(), faces: Vec::new() };
        blocks.refill(mesh, prepare);
        blocks
    }

    /// Fills the blocks with the current vertices.
    pub(crate) fn refill(
        &mut self,
        mesh: &Mesh,
        prepare: impl Fn(&mut [E], &mut [E]) + Sync + Send,
    ) {
        self.frame = SearchFrame::new(mesh);
        let blocks = mesh.len().div_ceil(BLOCK);
        self.spheres.resize(blocks * BLOCK * SPHERE_ROWS, E::default());
        self.faces.resize(blocks * BLOCK * FACE_ROWS, E::default());
        let frame = &self.frame;
        let faces = self.faces.chunks_mut(TASK_SIZE * BLOCK * FACE_ROWS);
        let mut shares: Vec<_> =
            faces.zip(self.spheres.chunks_mut(TASK_SIZE * BLOCK * SPHERE_ROWS)).collect();
        each(&mut shares, |share, (faces, spheres)| {
            fill(frame, mesh, share * TASK_SIZE, faces);
            prepare(faces, spheres);
        });
    }

    /// The number of blocks.
    pub(crate) fn len(&self) -> usize {
        self.spheres.len() / (BLOCK * SPHERE_ROWS)
    }

    /// The centres and radii of the spheres around the triangles from `lane` on.
    #[inline(always)]
    pub(crate) fn spheres<L: Pack<Element = E>>(
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
    pub(crate) fn faces<L: Pack<Element = E>>(
        &self,
        token: L::Token,
        block: usize,
        lane: usize,
    ) -> Face<L> {
        let rows = &self.faces[block * BLOCK * FACE_ROWS..][..BLOCK * FACE_ROWS];
        let dual = [load(token, rows, 9, lane), load(token, rows, 12, lane)];
        Face::again(load_vertices(token, rows, lane), dual)
    }
}

/// Writes the corners of the triangles into blocks; `first` is the number of the first block.
fn fill<E: Lane>(frame: &SearchFrame, mesh: &Mesh, first: usize, faces: &mut [E]) {
    for (block, rows) in faces.chunks_exact_mut(BLOCK * FACE_ROWS).enumerate() {
        for lane in 0..BLOCK {
            // The last block is filled up with its last triangle.
            let triangle = ((first + block) * BLOCK + lane).min(mesh.len() - 1);
            place_points(frame, mesh.corners(triangle as u32), rows, lane);
        }
    }
}

/// Writes three coordinates to the rows `row` to `row + 2`.
#[inline(always)]
fn store<L: Pack>(vector: Vec3<L>, rows: &mut [L::Element], row: usize, lane: usize) {
    let rows = &mut rows[row * BLOCK + lane..];
    vector.x.store(rows);
    vector.y.store(&mut rows[BLOCK..]);
    vector.z.store(&mut rows[2 * BLOCK..]);
}

/// Puts the vertex opposite the longest edge first, and computes dual bases and bounding spheres.
#[inline(always)]
pub(crate) fn prepare<L: Pack>(
    token: L::Token,
    faces: &mut [L::Element],
    spheres: &mut [L::Element],
) {
    let faces = faces.chunks_exact_mut(BLOCK * FACE_ROWS);
    for (face, sphere) in faces.zip(spheres.chunks_exact_mut(BLOCK * SPHERE_ROWS)) {
        for lane in (0..BLOCK).step_by(L::LANES) {
            let made = Face::new(load_vertices::<L>(token, face, lane));
            let [a, b, c] = made.vertices;
            for (row, vector) in [a, b, c, made.dual[0], made.dual[1]].into_iter().enumerate() {
                store(vector, face, 3 * row, lane);
            }
            // The sphere around the middle of the longest edge. It holds an obtuse triangle's apex
            // too.
            let centre = (b + c) * a.x.lit(0.5);
            let apex = (a - centre).norm_squared();
            let half = (b - centre).norm_squared();
            // The apex of an acute triangle may lie outside. Then the sphere around the centroid
            // may be smaller.
            let middle = (a + b + c) * a.x.lit(1.0 / 3.0);
            let around = (a - middle).norm_squared().max((b - middle).norm_squared());
            let around = around.max((c - middle).norm_squared());
            let take_edge = apex.max(half).le(around);
            let centre = Vec3::select(take_edge, centre, middle);
            let radius = take_edge.select(apex.max(half), around).sqrt();
            store(centre, sphere, 0, lane);
            (radius * radius.lit(1.0 + 8.0 * L::UNIT_ROUNDOFF))
                .store(&mut sphere[3 * BLOCK + lane..]);
        }
    }
}
