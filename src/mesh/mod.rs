//! The triangles of a mesh in the form that every engine stores.

mod disjoint_sets;
mod engine_mesh;
mod seams;
mod search_frame;
mod shared_parts;
mod triangle_block;

pub(crate) use disjoint_sets::{find_root, unite};
pub(crate) use engine_mesh::{Mesh, check_triangle, check_vertex, in_range};
pub(crate) use seams::Seam;
pub(crate) use search_frame::{SearchFrame, round};
pub(crate) use shared_parts::{PART_WITHOUT, PARTS, SharedParts, ends_of};
pub(crate) use triangle_block::{
    BLOCK, first_of_face, load, load_vertices, place_face, place_points, points_in, rotated, splat,
};
