//! A mesh as every engine keeps it.

use super::MeshError;
use super::checks::check_vertices;
use super::shared_parts::SharedParts;
use parry3d_f64::math::{Real, Vector};
use parry3d_f64::shape::TriMesh;
use std::sync::OnceLock;

/// Vertices and triangles.
#[derive(Clone)]
pub(crate) struct Mesh {
    vertices: Vec<Vector>,
    indices: Vec<[u32; 3]>,
    /// The vertices that triangles use, unless all are used.
    used: Option<Vec<u32>>,
    /// For those who ask which triangles are joined, counted at the first question.
    parts: OnceLock<SharedParts>,
}

impl Mesh {
    /// A copy of `mesh`.
    ///
    /// # Errors
    /// The mesh has no triangles, or a vertex is not finite or out of range.
    pub(crate) fn new(mesh: &TriMesh) -> Result<Self, MeshError> {
        if mesh.indices().is_empty() {
            return Err(MeshError::Empty);
        }
        check_vertices(mesh.vertices())?;
        Ok(Self::of(mesh.vertices().to_vec(), mesh.indices().to_vec()))
    }

    pub(super) fn of(vertices: Vec<Vector>, indices: Vec<[u32; 3]>) -> Self {
        let mut is_used = vec![false; vertices.len()];
        indices.as_flattened().iter().for_each(|&vertex| is_used[vertex as usize] = true);
        let used = (!is_used.iter().all(|&is_used| is_used)).then(|| {
            (0..).zip(&is_used).filter(|(_, is_used)| **is_used).map(|(vertex, _)| vertex).collect()
        });
        Self { vertices, indices, used, parts: OnceLock::new() }
    }

    /// Whether the vertices can move there.
    ///
    /// # Errors
    /// Their number differs, or one is not finite or out of range.
    pub(crate) fn check_moved(&self, vertices: &[Vector]) -> Result<(), MeshError> {
        if vertices.len() != self.vertices.len() {
            return Err(MeshError::VertexCount { expected: self.vertices.len(), got: vertices.len() });
        }
        check_vertices(vertices)
    }

    /// Takes over vertices that were checked.
    pub(crate) fn set_vertices(&mut self, vertices: &[Vector]) {
        self.vertices.copy_from_slice(vertices);
        if self.parts.get().is_some_and(|parts| !parts.stay(vertices)) {
            self.parts.take();
        }
    }

    #[cfg(feature = "gpu")]
    pub(crate) fn vertices(&self) -> &[Vector] {
        &self.vertices
    }

    #[cfg(feature = "gpu")]
    pub(crate) fn indices(&self) -> &[[u32; 3]] {
        &self.indices
    }

    /// How many triangles there are.
    pub(crate) fn len(&self) -> usize {
        self.indices.len()
    }

    /// The corners of a triangle.
    #[inline(always)]
    pub(crate) fn corners(&self, triangle: u32) -> [Vector; 3] {
        self.indices[triangle as usize].map(|vertex| self.vertices[vertex as usize])
    }

    /// The corners and edges that triangles share.
    pub(super) fn parts(&self) -> &SharedParts {
        self.parts.get_or_init(|| SharedParts::new(&self.vertices, &self.indices))
    }

    /// The largest coordinate of a triangle.
    pub(super) fn reach(&self) -> Real {
        self.bounds().map(|corner| corner.abs().max_element()).into_iter().fold(0.0, Real::max)
    }

    /// The corners of the box around all triangles. Vertices that no triangle uses do not count: exported meshes have
    /// some anywhere.
    pub(super) fn bounds(&self) -> [Vector; 2] {
        let around = |[low, high]: [Vector; 2], point: Vector| [low.min(point), high.max(point)];
        let nothing = [Vector::INFINITY, Vector::NEG_INFINITY];
        match &self.used {
            None => self.vertices.iter().copied().fold(nothing, around),
            Some(used) => used.iter().map(|&vertex| self.vertices[vertex as usize]).fold(nothing, around),
        }
    }
}
