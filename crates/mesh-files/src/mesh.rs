//! The mesh that comes back, and its frame.

use std::collections::HashMap;

/// Which way the axes of a patient's frame point.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Frame {
    /// Right, anterior, superior: NIfTI, FreeSurfer.
    Ras,
    /// Left, posterior, superior: DICOM, ITK.
    Lps,
}

/// A mesh of triangles.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Mesh {
    /// The vertices.
    pub vertices: Vec<[f64; 3]>,
    /// The triangles, each by its three vertices, in the file's order and turn. Those of a label
    /// map are counter-clockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
    /// The frame of the coordinates, where the file states it.
    pub frame: Option<Frame>,
    /// Whether the file states its unit of length. Label maps do, and come in millimetres; where
    /// one does not, its numbers are taken for millimetres. Files of triangles do not.
    pub states_unit: bool,
    /// How many faces of the file are not among the triangles, because they name fewer than three
    /// different vertices and so have no area. Each counts once, whatever its number of
    /// corners; the others keep their order. A polygon that names a vertex twice and has area
    /// all the same is cut as any other, and is not counted. In an STL file the corners at
    /// exactly the same place are one vertex. Faces whose vertices differ stay, be they ever so
    /// thin.
    pub skipped_faces: usize,
}

impl Mesh {
    /// Vertices and triangles, the vertices as any type that three numbers make, such as glam's or
    /// parry's vectors.
    pub fn into_parts<Vertex: From<[f64; 3]>>(self) -> (Vec<Vertex>, Vec<[u32; 3]>) {
        (self.vertices.into_iter().map(Vertex::from).collect(), self.triangles)
    }

    /// Adds a convex face, cut into a fan about its first corner, without the triangles that name a
    /// vertex twice.
    pub(crate) fn add_face(&mut self, corners: &[u32]) {
        let before = self.triangles.len();
        if let Some((&first, others)) = corners.split_first() {
            let fan = others.windows(2).map(|edge| [first, edge[0], edge[1]]);
            self.triangles.extend(fan.filter(|[a, b, c]| a != b && b != c && c != a));
        }
        if self.triangles.len() == before {
            self.skipped_faces += 1;
        }
    }

    /// The mesh in the given frame; none if its own is unknown.
    pub fn in_frame(mut self, frame: Frame) -> Option<Self> {
        if self.frame? != frame {
            // Half a turn about the third axis: triangles keep their turn.
            for [x, y, _] in &mut self.vertices {
                (*x, *y) = (-*x, -*y);
            }
            self.frame = Some(frame);
        }
        Some(self)
    }
}

/// Corners to vertices: those at exactly the same place are one.
#[derive(Default)]
pub(crate) struct Merger {
    pub vertices: Vec<[f64; 3]>,
    numbers: HashMap<[u64; 3], u32>,
}

impl Merger {
    pub fn number(&mut self, vertex: [f64; 3]) -> u32 {
        // Adding 0 makes -0 and 0 the same.
        let place = vertex.map(|x| (x + 0.0).to_bits());
        *self.numbers.entry(place).or_insert_with(|| {
            self.vertices.push(vertex);
            self.vertices.len() as u32 - 1
        })
    }
}
