//! The robot: its caps, its boxes, its outline, the fewest links that do, and stations.

mod aabb;
mod algorithm_1;
mod constant_curvature;
mod nalgebra_types;
mod registration;
mod simplify;
mod stations;
mod to_trimesh;
mod tube;
