//! Meshes are read as they were written, and what is wrong with a file is said in one line.

mod broken;
#[cfg(feature = "centrelines")]
mod centrelines;
mod doubts;
#[cfg(feature = "label-maps")]
mod label_maps;
mod limits;
mod losses;
#[cfg(feature = "label-maps")]
mod meta_image;
mod mutations;
mod polygons;
mod reports;
#[cfg(feature = "centrelines")]
mod tables;
mod triangles;
#[cfg(feature = "label-maps")]
mod volumes;
#[cfg(feature = "centrelines")]
mod vtk;

use mesh_files::Mesh;
use std::f64::consts::TAU;
use std::path::{Path, PathBuf};

type Vertex = [f64; 3];

/// A bent ring, off the origin: no two vertices share a coordinate.
fn ring() -> (Vec<Vertex>, Vec<[u32; 3]>) {
    const AROUND: u32 = 24;
    const ACROSS: u32 = 14;
    let place = |i: u32, j: u32| {
        let (a, b) =
            ((f64::from(i) + 0.13) / f64::from(AROUND) * TAU, (f64::from(j) + 0.29) / 14.0 * TAU);
        let r = 9.0 + (3.0 + 0.1 * (2.0 * a).sin()) * b.cos();
        [3.0 + r * a.cos(), -7.0 + r * a.sin(), 11.0 + 3.0 * b.sin() + 0.3 * a.cos()]
    };
    let number = |i: u32, j: u32| i % AROUND * ACROSS + j % ACROSS;
    let squares = || (0..AROUND).flat_map(|i| (0..ACROSS).map(move |j| (i, j)));
    let triangles = squares().flat_map(|(i, j)| {
        let [a, b, c, d] = [number(i, j), number(i + 1, j), number(i + 1, j + 1), number(i, j + 1)];
        [[a, b, c], [a, c, d]]
    });
    (squares().map(|(i, j)| place(i, j)).collect(), triangles.collect())
}

/// A file with the given bytes, in a directory of this test's own.
fn file(name: &str, bytes: &[u8]) -> PathBuf {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    std::fs::write(&path, bytes).unwrap();
    path
}

/// Bytes as a file of this name.
fn read(name: &str, bytes: impl AsRef<[u8]>) -> Result<Mesh, String> {
    mesh_files::from_bytes(name, bytes.as_ref(), &Default::default())
        .map_err(|error| error.to_string())
}

/// An error must be one line that says this, in words of our own.
fn refused<T>(name: &str, result: Result<T, String>, expected: &str) {
    let Err(message) = result else { panic!("{name} is read") };
    assert!(message.contains(expected) && !message.contains('\n'), "{name}: {message}");
    for foreign in ["failed to fill", "LoadError", "Err(", "{", "InvalidData", "unexpected end"] {
        assert!(!message.contains(foreign), "{name}: {message}");
    }
}

fn binary_stl((points, triangles): &(Vec<Vertex>, Vec<[u32; 3]>)) -> Vec<u8> {
    let vertex = |i: u32| stl_io::Vertex::new(points[i as usize].map(|x| x as f32));
    let facet = |t: &[u32; 3]| stl_io::Triangle {
        normal: stl_io::Normal::new([0.0; 3]),
        vertices: t.map(vertex),
    };
    let facets: Vec<_> = triangles.iter().map(facet).collect();
    let mut bytes = Vec::new();
    stl_io::write_stl(&mut bytes, facets.iter()).unwrap();
    bytes
}

fn ascii_stl((points, triangles): &(Vec<Vertex>, Vec<[u32; 3]>)) -> String {
    let facets = triangles.iter().map(|t| {
        let corners: String = t
            .iter()
            .map(|&i| points[i as usize])
            .map(|[x, y, z]| format!("vertex {x:e} {y:e} {z:e}\n"))
            .collect();
        format!("facet normal 0 0 0\nouter loop\n{corners}endloop\nendfacet\n")
    });
    format!("solid\n{}endsolid\n", facets.collect::<String>())
}

fn ply_header(vertices: usize, faces: usize, format: &str, number: &str) -> String {
    format!(
        "ply\nformat {format} 1.0\nelement vertex {vertices}\nproperty {number} x\nproperty {number} y\n\
         property {number} z\nelement face {faces}\nproperty list uchar int vertex_indices\nend_header\n"
    )
}
