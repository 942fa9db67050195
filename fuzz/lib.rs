//! What the fuzz targets share.

pub mod bodies;
#[path = "../examples/scene"]
mod scene {
    #![allow(dead_code, reason = "only files are read here")]
    pub mod mesh_file;
    pub mod surface;
}
