//! A mesh that was read, and its frame.

use std::collections::HashMap;

/// The directions of the axes of a patient's frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Frame {
    /// Right, anterior, superior: NIfTI, FreeSurfer.
    Ras,
    /// Left, posterior, superior: DICOM, ITK.
    Lps,
}

impl Frame {
    /// Returns RAS or LPS.
    pub fn name(self) -> &'static str {
        match self {
            Self::Ras => "RAS",
            Self::Lps => "LPS",
        }
    }

    /// Returns the frame of coordinates: the one that their file states, or else the one that the
    /// user chose.
    ///
    /// # Errors
    /// The stated frame, if the user chose the other one.
    pub fn resolve(stated: Option<Self>, chosen: Option<Self>) -> Result<Option<Self>, Self> {
        match (stated, chosen) {
            (Some(stated), Some(chosen)) if stated != chosen => Err(stated),
            _ => Ok(stated.or(chosen)),
        }
    }
}

/// A mesh of triangles.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Mesh {
    /// The vertices.
    pub vertices: Vec<[f64; 3]>,
    /// The triangles as indices of three vertices, in the file's order and orientation. Triangles
    /// of a label map are counter-clockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
    /// The frame of the coordinates, if the file states it.
    pub frame: Option<Frame>,
    /// Whether the file states its unit of length. Label maps do, and are converted to millimetres;
    /// one that does not is taken to be in millimetres. Files of triangles do not.
    pub states_unit: bool,
    /// The number of faces that are left out because they name fewer than three different vertices
    /// and so have no area.
    ///
    /// Each face counts once, for any number of vertices; the other faces keep their order. A
    /// polygon that names a vertex twice but has area is triangulated as any other, and is not
    /// counted. In an STL file vertices with identical coordinates are one vertex. Faces with
    /// different vertices stay, however thin.
    pub skipped_faces: usize,
    /// The labels of a label map that was read as one surface, without a requested label: all that
    /// are not 0, in ascending order; the lowest 1000 if there are more. Otherwise empty.
    pub labels: Vec<u32>,
    /// What other programs read differently: one sentence each, without a full stop, whose subject
    /// is the file. A NIfTI label map is doubtful if its sform and qform place it differently.
    pub doubts: Vec<String>,
}

impl Mesh {
    /// Returns vertices and triangles. The vertices are of any type that is made of three numbers,
    /// such as the vectors of glam or parry.
    pub fn into_parts<Vertex: From<[f64; 3]>>(self) -> (Vec<Vertex>, Vec<[u32; 3]>) {
        (self.vertices.into_iter().map(Vertex::from).collect(), self.triangles)
    }

    /// Adds a convex face as a fan about its first vertex, without triangles that name a vertex
    /// twice.
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

    /// Returns the mesh in the given frame; `None` if its own frame is unknown.
    pub fn in_frame(mut self, frame: Frame) -> Option<Self> {
        if self.frame? != frame {
            // A half turn about the third axis keeps the orientation of triangles.
            for [x, y, _] in &mut self.vertices {
                (*x, *y) = (-*x, -*y);
            }
            self.frame = Some(frame);
        }
        Some(self)
    }
}

/// Maps positions to vertices: identical positions are one vertex.
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
