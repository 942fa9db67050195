//! What every engine refuses of a mesh.

use crate::answer::MeshError;
use crate::robot::COORDINATE_LIMIT;
use parry3d_f64::math::Vector;

/// Triangles whose corners are all among so many vertices.
pub(crate) fn check_triangles(triangles: &[[u32; 3]], vertices: usize) -> Result<(), MeshError> {
    triangles
        .iter()
        .enumerate()
        .try_for_each(|(triangle, corners)| check_triangle(triangle, corners, vertices))
}

/// A triangle with the number `triangle` whose corners are among so many vertices.
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

/// Vertices that are all within range.
pub(crate) fn check_vertices(vertices: &[Vector]) -> Result<(), MeshError> {
    match vertices.iter().position(|&point| !in_range(point)) {
        Some(vertex) => check_vertex(vertex, vertices[vertex]),
        None => Ok(()),
    }
}

/// A vertex within range; `vertex` is its place in the mesh.
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

/// Written so that NaN is out of range too.
pub(crate) fn in_range(point: Vector) -> bool {
    point.abs().cmple(Vector::splat(COORDINATE_LIMIT)).all()
}
