//! The scene that examples, benches and tests share: a brain ventricle, a concentric tube robot in it, and a
//! picture of both. Included by path; nothing of it is in the library.
#![allow(dead_code, reason = "each program that includes the scene uses its own part of it")]

pub mod canvas;
pub mod cavity;
pub mod colour_map;
pub mod command;
pub mod ctr;
pub mod field;
pub mod figure;
pub mod lettering;
pub mod levels;
pub mod mesh_file;
pub mod picture;
pub mod remesh;
pub mod steer;
pub mod subdivide;
pub mod surface;
pub mod timing;
pub mod ventricle;
