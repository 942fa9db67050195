//! Meshes are read as they were written, and what is wrong with a file is said in one line.

use continuum_scene::surface::Mesh;
use continuum_scene::{mesh_file, remesh, surface};
use parry_continuum::parry::math::{Real, Vector};
use std::path::{Path, PathBuf};

/// A ball with a dent, off the origin: no two vertices share a coordinate.
fn mesh() -> Mesh {
    let field = |p: Vector| (p - Vector::new(3.0, -7.0, 11.0)).length() - 9.0 - (0.7 * p.x).sin();
    let fine = surface::extract(&field, Vector::new(-9.0, -19.0, -1.0), Vector::new(15.0, 5.0, 23.0), 1.1);
    remesh::remesh(&field, fine, 800, 1e-4)
}

/// A file with the given bytes, in a directory of this test's own.
fn file(name: &str, bytes: &[u8]) -> PathBuf {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    std::fs::write(&path, bytes).unwrap();
    path
}

fn binary_stl((points, triangles): &Mesh) -> Vec<u8> {
    let vertex = |i: u32| stl_io::Vertex::new(points[i as usize].to_array().map(|x| x as f32));
    let facet =
        |t: &[u32; 3]| stl_io::Triangle { normal: stl_io::Normal::new([0.0; 3]), vertices: t.map(vertex) };
    let facets: Vec<_> = triangles.iter().map(facet).collect();
    let mut bytes = Vec::new();
    stl_io::write_stl(&mut bytes, facets.iter()).unwrap();
    bytes
}

/// The mesh as text: a line for each vertex and one for each triangle.
fn lines(mesh: &Mesh, vertex: impl Fn(Vector) -> String, face: impl Fn([u32; 3]) -> String) -> String {
    mesh.0.iter().map(|&p| vertex(p)).chain(mesh.1.iter().map(|&t| face(t))).collect()
}

fn ply_header(mesh: &Mesh, format: &str, number: &str) -> String {
    format!(
        "ply\nformat {format} 1.0\nelement vertex {}\nproperty {number} x\nproperty {number} y\nproperty {number} z\n\
         element face {}\nproperty list uchar int vertex_indices\nend_header\n",
        mesh.0.len(),
        mesh.1.len()
    )
}

#[test]
fn meshes_are_read_as_they_were_written() {
    let mesh = &mesh();
    let mut solid = binary_stl(mesh);
    // A binary file may call itself solid, and an ASCII file may leave its solid without a name.
    solid[..16].copy_from_slice(b"solid of bytes \n");
    let facets: String = mesh
        .1
        .iter()
        .map(|t| {
            let corners: String = t
                .iter()
                .map(|&i| mesh.0[i as usize])
                .map(|p| format!("vertex {:e} {:e} {:e}\n", p.x as f32, p.y as f32, p.z as f32))
                .collect();
            format!("facet normal 0 0 0\nouter loop\n{corners}endloop\nendfacet\n")
        })
        .collect();
    let obj = lines(
        mesh,
        |p| format!("v {} {} {}\n", p.x, p.y, p.z),
        |[a, b, c]| format!("f {} {} {}\n", a + 1, b + 1, c + 1),
    );
    let ply = lines(mesh, |p| format!("{} {} {}\n", p.x, p.y, p.z), |[a, b, c]| format!("3 {a} {b} {c}\n"));
    let mut packed = ply_header(mesh, "binary_little_endian", "float").into_bytes();
    mesh.0.iter().flat_map(|p| p.to_array()).for_each(|x| packed.extend((x as f32).to_le_bytes()));
    for triangle in &mesh.1 {
        packed.push(3);
        triangle.iter().for_each(|corner| packed.extend(corner.to_le_bytes()));
    }

    let single = 24.0 * Real::from(f32::EPSILON);
    for (name, bytes, tolerance) in [
        ("read.stl", binary_stl(mesh), single),
        ("solid.STL", solid, single),
        ("ascii.stl", format!("solid\n{facets}endsolid\n").into_bytes(), single),
        ("read.obj", obj.into_bytes(), single),
        ("ascii.ply", (ply_header(mesh, "ascii", "double") + &ply).into_bytes(), 0.0),
        ("binary.ply", packed, single),
    ] {
        for scale in [1.0, 1000.0] {
            let (points, triangles) = mesh_file::load(&file(name, &bytes), scale).unwrap();
            assert_eq!((points.len(), triangles.len()), (mesh.0.len(), mesh.1.len()), "{name}");
            for (read, written) in triangles.iter().zip(&mesh.1) {
                for corner in 0..3 {
                    let (p, q) = (points[read[corner] as usize], mesh.0[written[corner] as usize] * scale);
                    assert!((p - q).abs().max_element() <= tolerance * scale, "{name}: {p} for {q}");
                }
            }
        }
    }
}

#[test]
fn polygons_are_cut_and_objects_joined() {
    let quad = b"v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n";
    let (_, triangles) = mesh_file::load(&file("quad.obj", quad), 1.0).unwrap();
    assert_eq!(triangles, [[0, 1, 2], [0, 2, 3]]);
    let two = b"o one\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\no two\nv 0 0 9\nv 1 0 9\nv 0 1 9\nf 4 5 6\n";
    let (points, triangles) = mesh_file::load(&file("two.obj", two), 1.0).unwrap();
    assert_eq!(triangles.len(), 2);
    assert!(triangles[0].iter().all(|&i| points[i as usize].z == 0.0));
    assert!(triangles[1].iter().all(|&i| points[i as usize].z == 9.0));
    // What a surface needs not may be broken: here a texture coordinate that is not there.
    let textured = b"v 0 0 0\nv 1 0 0\nvt 0 0\nv 0 1 0\nvn 0 0 1\nf 1/-9/2 2/7/1 3/1/-5\n";
    let (points, triangles) = mesh_file::load(&file("textured.obj", textured), 1.0).unwrap();
    assert_eq!((points.len(), triangles), (3, vec![[0, 1, 2]]));
    let mesh = (vec![Vector::ZERO; 5], vec![[0; 3]]);
    let text = ply_header(&mesh, "ascii", "float") + &"0 0 0\n".repeat(5) + "5 0 1 2 3 4\n";
    let (_, triangles) = mesh_file::load(&file("pentagon.ply", text.as_bytes()), 1.0).unwrap();
    assert_eq!(triangles, [[0, 1, 2], [0, 2, 3], [0, 3, 4]]);
}

#[test]
fn every_error_of_a_mesh_file_is_one_line_that_says_what_to_do() {
    let mesh = &mesh();
    let cut = binary_stl(mesh)[..10_000].to_vec();
    let mut nan = binary_stl(mesh);
    nan[96..100].copy_from_slice(&f32::NAN.to_le_bytes());
    let triangle = (vec![Vector::ZERO; 3], vec![[0; 3]]);
    let ply = |faces: &str| {
        let text = ply_header(&triangle, "ascii", "float") + "0 0 0\n1 0 0\n0 1 0\n" + faces;
        text.into_bytes()
    };
    let mut packed = ply_header(&triangle, "binary_big_endian", "double").into_bytes();
    [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, Real::NAN, 0.0].iter().for_each(|x| packed.extend(x.to_be_bytes()));
    packed.extend([3, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 2]);
    let huge =
        ply_header(&triangle, "binary_little_endian", "float").replace("vertex 3", "vertex 99999999999");
    for (name, bytes, scale, expected) in [
        ("a.xyz", vec![], 1.0, "ends in .stl, .obj or .ply"),
        ("empty.stl", vec![], 1.0, "export it again"),
        ("cut.stl", cut, 1.0, "export it again"),
        ("none.stl", vec![0; 84], 1.0, "no triangles"),
        ("nan.stl", nan, 1.0, "repair that vertex"),
        ("text.stl", b"solid x\nfacet normal\n".to_vec(), 1.0, "export it again"),
        ("points.obj", b"v 0 0 0\nv 1 0 0\n".to_vec(), 1.0, "no triangles"),
        ("beyond.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n".to_vec(), 1.0, "export it again"),
        ("word.obj", b"v 0 zero 0\n".to_vec(), 1.0, "export it again"),
        ("nan.obj", b"v 0 nan 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n".to_vec(), 1.0, "repair that vertex"),
        ("beyond.ply", ply("3 0 1 3\n"), 1.0, "names vertex 3, but there are 3"),
        ("negative.ply", ply("3 0 1 -1\n"), 1.0, "export it again"),
        ("missing.ply", ply(""), 1.0, "export it again"),
        ("huge.ply", huge.into_bytes(), 1.0, "export it again"),
        ("nan.ply", packed, 1.0, "repair that vertex"),
        ("scale.ply", ply("3 0 1 2\n"), 0.0, "give a positive number"),
        ("nan-scale.ply", ply("3 0 1 2\n"), Real::NAN, "give a positive number"),
        ("far.ply", ply("3 0 1 2\n"), 1e300, ""),
    ] {
        let result = mesh_file::load(&file(name, &bytes), scale);
        if expected.is_empty() {
            assert!(result.is_ok(), "{name}: {result:?}");
            continue;
        }
        let message = result.expect_err(name);
        assert!(message.contains(expected) && !message.contains('\n'), "{name}: {message}");
    }
    let message = mesh_file::load(Path::new("nowhere/brain.stl"), 1.0).unwrap_err();
    assert!(message.contains("nowhere/brain.stl") && message.contains("check the path"), "{message}");
}
