//! The robot: its caps, its boxes, its outline, the links that suffice.

mod aabb;
mod algorithm_1;
mod constant_curvature;
mod nalgebra_types;
mod registration;
mod simplify;
mod to_trimesh;
mod tube;
