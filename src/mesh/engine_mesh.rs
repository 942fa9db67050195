//! The mesh of an engine: vertices and triangles.

use super::shared_parts::SharedParts;
use crate::answer::MeshError;
use crate::robot::COORDINATE_LIMIT;
use crate::threads::{Lazy, each};
use parry3d_f64::math::Vector;
use parry3d_f64::shape::TriMesh;
use std::sync::Arc;

/// Vertices and triangles.
#[derive(Clone)]
pub(crate) struct Mesh {
    vertices: Vec<Vector>,
    indices: Vec<[u32; 3]>,
    /// The vertices that triangles use, unless all are used.
    used: Option<Vec<u32>>,
    /// The shared corners and edges, built on first use.
    parts: Lazy<Arc<SharedParts>>,
    /// The shared corners and edges before the vertices moved.
    parts_before: Option<Arc<SharedParts>>,
}

impl Mesh {
    /// Vertices that one task takes.
    pub(crate) const TASK_SIZE: usize = 1 << 14;

    /// A copy of `mesh`.
    ///
    /// # Errors
    /// As [`from_triangles`](Self::from_triangles).
    pub(crate) fn new(mesh: &TriMesh) -> Result<Self, MeshError> {
        Self::from_triangles(mesh.vertices(), mesh.indices())
    }

    /// A copy of vertices and triangles.
    ///
    /// # Errors
    /// - There are no triangles.
    /// - A vertex is not finite or out of range.
    /// - A triangle names a vertex that does not exist.
    pub(crate) fn from_triangles(
        vertices: &[Vector],
        triangles: &[[u32; 3]],
    ) -> Result<Self, MeshError> {
        if triangles.is_empty() {
            return Err(MeshError::Empty);
        }
        check_all(vertices)?;
        check_triangles(triangles, vertices.len())?;
        Ok(Self::of(vertices.to_vec(), triangles.to_vec()))
    }

    pub(crate) fn of(vertices: Vec<Vector>, indices: Vec<[u32; 3]>) -> Self {
        let mut is_used = vec![false; vertices.len()];
        indices.as_flattened().iter().for_each(|&vertex| is_used[vertex as usize] = true);
        let used = (!is_used.iter().all(|&is_used| is_used)).then(|| {
            (0..).zip(&is_used).filter(|(_, is_used)| **is_used).map(|(vertex, _)| vertex).collect()
        });
        Self { vertices, indices, used, parts: Lazy::new(), parts_before: None }
    }

    /// Checks that the vertices can move to these places.
    ///
    /// # Errors
    /// - The number of vertices differs.
    /// - A vertex is not finite or out of range.
    pub(crate) fn check_moved(&self, vertices: &[Vector]) -> Result<(), MeshError> {
        if vertices.len() != self.vertices.len() {
            return Err(MeshError::VertexCount {
                expected: self.vertices.len(),
                got: vertices.len(),
            });
        }
        check_all(vertices)
    }

    /// Moves the vertices to these places, which the caller has checked.
    pub(crate) fn set_vertices(&mut self, vertices: &[Vector]) {
        let shares =
            self.vertices.chunks_mut(Mesh::TASK_SIZE).zip(vertices.chunks(Mesh::TASK_SIZE));
        each(&mut shares.collect::<Vec<_>>(), |_, (own, moved)| own.copy_from_slice(moved));
        // The next call of `parts` checks whether they are still valid.
        self.parts_before = self.parts.take().or(self.parts_before.take());
    }

    pub(crate) fn vertices(&self) -> &[Vector] {
        &self.vertices
    }

    pub(crate) fn indices(&self) -> &[[u32; 3]] {
        &self.indices
    }

    /// The vertices that triangles use.
    #[cfg(feature = "tubes")]
    pub(crate) fn used_vertices(&self) -> impl Iterator<Item = usize> {
        let (all, some) = match &self.used {
            None => (0..self.vertices.len(), &[][..]),
            Some(used) => (0..0, &used[..]),
        };
        all.chain(some.iter().map(|&vertex| vertex as usize))
    }

    /// The number of triangles.
    pub(crate) fn len(&self) -> usize {
        self.indices.len()
    }

    /// The corners of a triangle.
    #[inline(always)]
    pub(crate) fn corners(&self, triangle: u32) -> [Vector; 3] {
        let [a, b, c] = self.indices[triangle as usize];
        [self.vertices[a as usize], self.vertices[b as usize], self.vertices[c as usize]]
    }

    /// The corners and edges that triangles share.
    pub(crate) fn parts(&self) -> &SharedParts {
        self.parts.get_or_build(|| {
            let before = self.parts_before.as_ref().filter(|before| before.stay(&self.vertices));
            before.map_or_else(
                || Arc::new(SharedParts::new(&self.vertices, &self.indices)),
                Arc::clone,
            )
        })
    }

    /// For each edge of a triangle the opposite corner of another triangle at that edge; NaN if
    /// there is none. All are NaN for a loose triangle, which is never culled (`local_minima`).
    pub(crate) fn corners_across(&self, triangle: u32) -> [Vector; 3] {
        let parts = self.parts();
        [3, 4, 5].map(|edge| {
            let across = parts.across(triangle, edge).filter(|_| !parts.is_loose(triangle));
            across.map_or(Vector::NAN, |(other, corner)| self.corners(other)[corner])
        })
    }

    /// The corners of the box around all triangles. Vertices without a triangle do not count:
    /// exported meshes may have some anywhere.
    pub(crate) fn bounds(&self) -> [Vector; 2] {
        match &self.used {
            None => box_around(&self.vertices, |&point| point),
            Some(used) => box_around(used, |&vertex| self.vertices[vertex as usize]),
        }
    }
}

/// [`check_vertices`] on all cores.
fn check_all(vertices: &[Vector]) -> Result<(), MeshError> {
    let mut shares: Vec<_> = vertices.chunks(Mesh::TASK_SIZE).map(|share| (share, true)).collect();
    each(&mut shares, |_, (share, is_right)| *is_right = check_vertices(share).is_ok());
    // Runs again in order, so that the error names the vertex by its number in the whole mesh.
    if shares.iter().all(|(_, is_right)| *is_right) { Ok(()) } else { check_vertices(vertices) }
}

/// The corners of the box around the points of all items.
fn box_around<T: Sync>(items: &[T], point: impl Fn(&T) -> Vector + Sync + Send) -> [Vector; 2] {
    let nothing = [Vector::INFINITY, Vector::NEG_INFINITY];
    let mut shares: Vec<_> = items.chunks(Mesh::TASK_SIZE).map(|share| (share, nothing)).collect();
    each(&mut shares, |_, (share, corners)| {
        *corners = share
            .iter()
            .map(&point)
            .fold(nothing, |[low, high], point| [low.min(point), high.max(point)]);
    });
    let corners = shares.into_iter().map(|(_, corners)| corners);
    corners.fold(nothing, |[low, high], [other_low, other_high]| {
        [low.min(other_low), high.max(other_high)]
    })
}

/// Checks that the corners of all triangles are among `vertices` vertices.
fn check_triangles(triangles: &[[u32; 3]], vertices: usize) -> Result<(), MeshError> {
    triangles
        .iter()
        .enumerate()
        .try_for_each(|(triangle, corners)| check_triangle(triangle, corners, vertices))
}

/// Checks that the corners of the triangle with the number `triangle` are among `vertices`
/// vertices.
pub(crate) fn check_triangle(
    triangle: usize,
    corners: &[u32; 3],
    vertices: usize,
) -> Result<(), MeshError> {
    match corners.iter().find(|&&vertex| vertex as usize >= vertices) {
        Some(&vertex) => Err(MeshError::NoSuchVertex { triangle, vertex, vertices }),
        None => Ok(()),
    }
}

/// Checks that all vertices are finite and within range.
fn check_vertices(vertices: &[Vector]) -> Result<(), MeshError> {
    match vertices.iter().position(|&point| !in_range(point)) {
        Some(vertex) => check_vertex(vertex, vertices[vertex]),
        None => Ok(()),
    }
}

/// Checks that a vertex is finite and within range. `vertex` is its number in the mesh.
pub(crate) fn check_vertex(vertex: usize, point: Vector) -> Result<(), MeshError> {
    for value in point.to_array() {
        if !value.is_finite() {
            return Err(MeshError::NotFinite { vertex, value });
        }
        if value.abs() > COORDINATE_LIMIT {
            return Err(MeshError::OutOfRange { vertex, value, limit: COORDINATE_LIMIT });
        }
    }
    Ok(())
}

/// Returns true if the point is within range. The comparison fails for NaN.
pub(crate) fn in_range(point: Vector) -> bool {
    point.abs().cmple(Vector::splat(COORDINATE_LIMIT)).all()
}
