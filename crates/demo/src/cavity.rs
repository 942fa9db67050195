//! A bumpy closed cavity with a robot inside: a scene of any number of triangles for timing.

use crate::subdivide;
use parry_continuum::Chain;
use parry_continuum::parry::math::{Pose, Vector};
use parry_continuum::parry::shape::TriMesh;

/// An icosphere of about 100 mm whose wall bulges in and out; 20 * 4^level triangles, in the order
/// of subdivision.
pub fn mesh(level: u32) -> TriMesh {
    let mut mesh = icosahedron();
    for _ in 0..level {
        mesh = subdivide::in_four(mesh);
        mesh.0.iter_mut().for_each(|vertex| *vertex = vertex.normalize());
    }
    let vertices = mesh.0.into_iter().map(|direction| direction * radius(direction)).collect();
    TriMesh::new(vertices, mesh.1).expect("an icosphere has triangles")
}

/// How far the wall is from the centre in a direction, mm.
fn radius(direction: Vector) -> f64 {
    let Vector { x, y, z } = direction;
    46.0 + 3.0 * (3.1 * x + 0.5).sin() * (2.7 * y).cos()
        + 1.5 * (7.3 * y + 1.1).sin() * (6.1 * z).cos()
        + 0.5 * (19.0 * z + 0.3).sin() * (17.0 * x).sin()
}

/// Thirty segments of three tubes (radii 1.2, 0.9 and 0.5 mm) that follow the wall at about
/// `clearance` mm.
pub fn robot(clearance: f64) -> (Vec<Vector>, Vec<f64>) {
    let radii: Vec<_> = (0..30).map(|segment| [1.2, 0.9, 0.5][segment / 10]).collect();
    let step = 2.0 / (46.0 - clearance);
    let points = (0..=30)
        .map(|i| {
            let angle: f64 = f64::from(i) * step;
            let direction =
                Vector::new(angle.cos(), angle.sin() * 0.96, 0.3 * (1.3 * angle).sin()).normalize();
            direction * (radius(direction) - clearance - 1.2)
        })
        .collect();
    (points, radii)
}

/// The robot of [`robot`] by Algorithm 1.
pub fn chain(clearance: f64) -> Chain {
    let (points, radii) = robot(clearance);
    Chain::from_centreline(&points, &radii).expect("the scene's robot is valid")
}

/// Poses of a slow motion around the identity: up to half a millimetre and half a degree.
pub fn frames(count: usize) -> Vec<Pose> {
    (0..count)
        .map(|frame| {
            let phase = frame as f64 * std::f64::consts::TAU / count as f64;
            let (sin, cos) = phase.sin_cos();
            Pose::new(Vector::new(sin, cos, sin * cos) * 0.5, Vector::new(cos, sin, -sin) * 0.008)
        })
        .collect()
}

fn icosahedron() -> (Vec<Vector>, Vec<[u32; 3]>) {
    let golden = (1.0 + 5.0_f64.sqrt()) / 2.0;
    let mut vertices = Vec::new();
    for (s, t) in [(1.0, 1.0), (-1.0, 1.0), (1.0, -1.0), (-1.0, -1.0)] {
        let (a, b) = (s, t * golden);
        vertices.extend([Vector::new(0.0, a, b), Vector::new(a, b, 0.0), Vector::new(b, 0.0, a)]);
    }
    let near = |i: usize, j: usize| vertices[i].distance_squared(vertices[j]) < 4.5;
    let mut indices = Vec::new();
    for i in 0..12 {
        for j in i + 1..12 {
            for k in j + 1..12 {
                if near(i, j) && near(j, k) && near(k, i) {
                    let outward = (vertices[j] - vertices[i])
                        .cross(vertices[k] - vertices[i])
                        .dot(vertices[i]);
                    indices
                        .push(if outward > 0.0 { [i, j, k] } else { [i, k, j] }.map(|v| v as u32));
                }
            }
        }
    }
    (vertices.into_iter().map(Vector::normalize).collect(), indices)
}
