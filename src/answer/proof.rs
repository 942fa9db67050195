//! Proofs for others.

use std::fmt;

/// A proof that a robot is farther than a margin from a mesh, as a text for a file.
///
/// The checker needs the mesh, not this library: `docs/book/check_proof.py` is a short program in
/// plain Python that calculates in whole numbers. It answers yes or no. It prints the premises of
/// the proof, and that the proof does not cover the side of the wall. The [page on
/// proofs](crate::book::proofs) has the format and the premises.
///
/// [`to_string`](ToString::to_string) returns the text.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Proof {
    text: String,
    planes: usize,
    shapes: usize,
}

impl Proof {
    pub(crate) fn new(text: String, planes: usize, shapes: usize) -> Self {
        Self { text, planes, shapes }
    }

    /// The number of planes that separate the robot from the mesh.
    pub fn planes(&self) -> usize {
        self.planes
    }

    /// The number of shapes of the robot in the proof: 1, unless it moves.
    pub fn shapes(&self) -> usize {
        self.shapes
    }
}

impl fmt::Display for Proof {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}
