//! Proofs that others can check: planes that separate a robot from a mesh.
//!
//! The planes are found here and checked by `docs/book/check_proof.py`. The book's page on proofs
//! has the reasoning.

mod body;
mod direction;
mod groups;
mod motion_proof;
mod plane_search;
mod shape;
mod text;
mod tube_shape;

pub(crate) use motion_proof::motion_proof;
pub(crate) use plane_search::PlaneSearch;
pub(crate) use shape::Shape;
pub(crate) use text::{Kind, write_proof};
pub(crate) use tube_shape::tube_shape;
