//! The checks of a mesh that every engine makes.

use crate::answer::MeshError;
use crate::robot::COORDINATE_LIMIT;
use parry3d_f64::math::Vector;

/// Checks that the corners of all triangles are among `vertices` vertices.
pub(crate) fn check_triangles(triangles: &[[u32; 3]], vertices: usize) -> Result<(), MeshError> {
    triangles
        .iter()
        .enumerate()
        .try_for_each(|(triangle, corners)| check_triangle(triangle, corners, vertices))
}

/// Checks that the corners of the triangle with the number `triangle` are among `vertices`
/// vertices.
pub(crate) fn check_triangle(
    triangle: usize,
    corners: &[u32; 3],
    vertices: usize,
) -> Result<(), MeshError> {
    match corners.iter().find(|&&vertex| vertex as usize >= vertices) {
        Some(&vertex) => Err(MeshError::NoSuchVertex { triangle, vertex, vertices }),
        None => Ok(()),
    }
}

/// Checks that all vertices are finite and within range.
pub(crate) fn check_vertices(vertices: &[Vector]) -> Result<(), MeshError> {
    match vertices.iter().position(|&point| !in_range(point)) {
        Some(vertex) => check_vertex(vertex, vertices[vertex]),
        None => Ok(()),
    }
}

/// Checks that a vertex is finite and within range. `vertex` is its number in the mesh.
pub(crate) fn check_vertex(vertex: usize, point: Vector) -> Result<(), MeshError> {
    for value in point.to_array() {
        if !value.is_finite() {
            return Err(MeshError::NotFinite { vertex, value });
        }
        if value.abs() > COORDINATE_LIMIT {
            return Err(MeshError::OutOfRange { vertex, value, limit: COORDINATE_LIMIT });
        }
    }
    Ok(())
}

/// Returns true if the point is within range. The comparison fails for NaN.
pub(crate) fn in_range(point: Vector) -> bool {
    point.abs().cmple(Vector::splat(COORDINATE_LIMIT)).all()
}
