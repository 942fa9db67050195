//! The robot: its caps, its boxes, its outline, and the fewest links that do.

mod aabb;
mod algorithm_1;
mod simplify;
mod to_trimesh;
