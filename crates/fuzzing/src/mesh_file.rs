//! Any bytes as a mesh file: an error of one line, or a mesh whose triangles name vertices that are there.

use continuum_scene::mesh_file::from_bytes;
use std::path::Path;

/// The first byte chooses the format.
pub fn mesh_file(bytes: &[u8]) {
    let Some((first, file)) = bytes.split_first() else { return };
    let name = ["fuzz.stl", "fuzz.obj", "fuzz.ply"][usize::from(first % 3)];
    match from_bytes(Path::new(name), file.to_vec(), 1.0) {
        Ok((vertices, triangles)) => {
            assert!(!triangles.is_empty());
            assert!(vertices.iter().all(|vertex| vertex.is_finite()));
            assert!(triangles.iter().flatten().all(|&corner| (corner as usize) < vertices.len()));
        }
        Err(error) => assert!(!error.contains('\n'), "{error}"),
    }
}
