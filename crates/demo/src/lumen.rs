//! A bent vessel, open at both ends: the tube in which a planner tries its shapes.

use parry_continuum::parry::math::{Pose, Rot3, Vector};
use parry_continuum::parry::shape::TriMesh;
use std::f64::consts::TAU;

/// The vessel is so long and bends around a circle of this radius, mm.
const LENGTH: f64 = 160.0;
const BEND: f64 = 80.0;

/// A vessel of 6 to 8 mm radius whose wall has `around` triangles of each kind around it and five
/// for each two of them along it: 5 `around`^2 triangles.
pub fn mesh(around: u32) -> TriMesh {
    let along = around * 5 / 2;
    let vertex = |row: u32, column: u32| {
        let s = f64::from(row) / f64::from(along) * LENGTH;
        let angle = f64::from(column) / f64::from(around) * TAU;
        let radius = 7.0 + 0.8 * (0.21 * s).sin() + 0.2 * (3.0 * angle + 0.1 * s).cos();
        place(s) * Vector::new(radius * angle.cos(), radius * angle.sin(), 0.0)
    };
    let vertices = (0..=along).flat_map(|row| (0..around).map(move |column| vertex(row, column)));
    let squares = (0..along).flat_map(|row| (0..around).map(move |column| (row, column)));
    let triangles = squares.flat_map(|(row, column)| {
        let at = |row: u32, column: u32| row * around + column % around;
        let [a, b] = [at(row, column), at(row, column + 1)];
        let [c, d] = [at(row + 1, column), at(row + 1, column + 1)];
        [[a, b, d], [a, d, c]]
    });
    TriMesh::new(vertices.collect(), triangles.collect()).expect("a vessel has triangles")
}

/// Where a robot enters: on the midline, a radius from the opening, along it.
pub fn entry() -> Pose {
    place(8.0)
}

/// The point of the midline at an arc length, with z along it.
fn place(s: f64) -> Pose {
    let angle = s / BEND;
    let point = Vector::new(BEND * (1.0 - angle.cos()), 0.0, BEND * angle.sin());
    Pose::from_parts(point, Rot3::from_scaled_axis(Vector::Y * angle))
}
