//! A proof that others can check.

use std::fmt;

/// A proof that a robot keeps more than a margin away from a mesh, as a text to be written to a
/// file.
///
/// Whoever has the mesh can check it, without this library: `docs/book/check_proof.py` is a short
/// program in plain Python that calculates in whole numbers. It answers yes or no, and prints the
/// premises of the proof and what it does not cover: the side of the wall. The [page on
/// proofs](crate::book::proofs) has the format and the reasoning.
///
/// The text is what [`to_string`](ToString::to_string) gives.
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

    /// How many planes part the robot from the mesh.
    pub fn planes(&self) -> usize {
        self.planes
    }

    /// How many shapes of the robot they are about: one, unless it moves.
    pub fn shapes(&self) -> usize {
        self.shapes
    }
}

impl fmt::Display for Proof {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}
