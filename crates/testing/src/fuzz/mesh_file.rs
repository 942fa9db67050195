//! Any bytes as a mesh file: an error of one line, or a mesh whose triangles name vertices that are there.

use mesh_files::{Options, from_bytes};

/// The first byte chooses the format.
pub fn mesh_file(bytes: &[u8]) {
    let Some((first, file)) = bytes.split_first() else { return };
    let name = ["fuzz.stl", "fuzz.obj", "fuzz.ply", "fuzz.nii.gz", "fuzz.nrrd"][usize::from(first % 5)];
    match from_bytes(name, file, &Options::default()) {
        Ok(mesh) => {
            assert!(!mesh.triangles.is_empty());
            assert!(mesh.vertices.iter().flatten().all(|x| x.is_finite()));
            assert!(mesh.triangles.iter().flatten().all(|&corner| (corner as usize) < mesh.vertices.len()));
        }
        Err(error) => assert!(!error.to_string().contains('\n'), "{error}"),
    }
}
