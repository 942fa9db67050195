//! Any bytes as a file: an error of one line, a mesh whose triangles name existing vertices, or a
//! centreline.

use mesh_files::{MeshFileError, Options, centreline_from_bytes, from_bytes};

/// The first byte chooses the format.
pub fn mesh_file(bytes: &[u8]) {
    const MESHES: [&str; 6] =
        ["fuzz.stl", "fuzz.obj", "fuzz.ply", "fuzz.nii.gz", "fuzz.nrrd", "fuzz.mha"];
    const CENTRELINES: [&str; 4] = ["fuzz.mrk.json", "fuzz.vtk", "fuzz.vtp", "fuzz.csv"];
    const SURFACES: [&str; 2] = ["surface.vtk", "surface.vtp"];
    let Some((&first, file)) = bytes.split_first() else { return };
    let names: Vec<_> = MESHES.iter().chain(&CENTRELINES).chain(&SURFACES).collect();
    let name = names[usize::from(first) % names.len()];
    if !CENTRELINES.contains(name) {
        match from_bytes(name, file, &Options::default()) {
            Ok(mesh) => {
                assert!(!mesh.triangles.is_empty());
                assert!(mesh.vertices.iter().flatten().all(|x| x.is_finite()));
                let count = mesh.vertices.len();
                assert!(mesh.triangles.iter().flatten().all(|&corner| (corner as usize) < count));
            }
            Err(error) => is_one_line(&error),
        }
    } else {
        let options = Options::default().with_line(Some(0));
        match centreline_from_bytes(name, file, &options) {
            Ok(line) => assert!(line.points.iter().flatten().all(|x| x.is_finite())),
            Err(error) => is_one_line(&error),
        }
    }
}

fn is_one_line(error: &MeshFileError) {
    assert!(!error.to_string().contains('\n'), "{error}");
}
