//! The meshes that all chapters ask, and the engines on the GPU for one of them.

use crate::{Opened, text};
use continuum_demo::subdivide::{in_four, shuffled};
use continuum_demo::ventricle;
use parry_continuum::gpu::GpuExhaustive;
use parry_continuum::parry::shape::TriMesh;
use parry_continuum::proximity::Proximity;

/// The meshes, 1e4 triangles and more. Each is the first part of the ventricle, divided in four
/// until it has enough triangles, and shuffled.
pub fn meshes(largest: u32) -> Result<Vec<TriMesh>, String> {
    let mut sizes: Vec<_> = [10_000, 100_000, 1_000_000, 10_000_000]
        .into_iter()
        .filter(|&size| size < largest)
        .collect();
    sizes.push(largest);
    sizes.into_iter().map(mesh).collect()
}

fn mesh(triangles: u32) -> Result<TriMesh, String> {
    let mut divided = ventricle::mesh(ventricle::DEFAULT_TRIANGLES);
    while divided.1.len() < triangles as usize {
        divided = in_four(divided);
    }
    let (vertices, mut indices) = shuffled(divided, 1);
    indices.truncate(triangles as usize);
    TriMesh::new(vertices, indices).map_err(text)
}

/// An engine for a mesh on each GPU.
pub fn on_gpus(opened: &[Opened], mesh: &TriMesh) -> Result<Vec<Box<dyn Proximity>>, String> {
    let engine = |opened: &Opened| -> Result<Box<dyn Proximity>, String> {
        Ok(Box::new(GpuExhaustive::on(&opened.gpu, mesh).map_err(text)?))
    };
    opened.iter().map(engine).collect()
}
