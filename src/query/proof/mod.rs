//! Proofs that others can check: planes that separate a robot from a mesh.
//!
//! The planes are found here and checked by `docs/book/check_proof.py`. The book's page on proofs
//! has the reasoning.

mod motion_proof;
mod plane_search;
mod text;

pub(crate) use motion_proof::{motion_proof, tube_shape};
pub(crate) use plane_search::PlaneSearch;
pub(crate) use text::{Kind, Shape, write_proof};
