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
    /// The triangles, each by its three vertices, in the file's order and turn. Those of a label map are
    /// counter-clockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
    /// The frame of the coordinates, where the file states it.
    pub frame: Option<Frame>,
}

impl Mesh {
    /// Vertices and triangles, the vertices as any type that three numbers make, such as glam's or parry's vectors.
    pub fn into_parts<Vertex: From<[f64; 3]>>(self) -> (Vec<Vertex>, Vec<[u32; 3]>) {
        (self.vertices.into_iter().map(Vertex::from).collect(), self.triangles)
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
