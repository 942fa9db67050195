//! What every engine refuses.

use crate::answer::{MeshError, ProximityError};
use crate::robot::{COORDINATE_LIMIT, Chain, LinkNode, NotRigid, rigid};
use parry3d_f64::math::{Pose, Real, Vector};

/// A margin that can be kept.
pub(crate) fn check_margin(margin: Real) -> Result<(), ProximityError> {
    check_not_negative("margin", margin)
}

/// A margin, a tolerance or a resolution, as the function that was called names it.
pub(crate) fn check_not_negative(parameter: &'static str, value: Real) -> Result<(), ProximityError> {
    // Written so that NaN is an error.
    if value >= 0.0 { Ok(()) } else { Err(ProximityError::Negative { parameter, value }) }
}

/// A bound, which asks for nothing where it is below zero.
pub(crate) fn check_bound(bound: Real) -> Result<(), ProximityError> {
    if bound.is_nan() { Err(ProximityError::NotANumber { parameter: "bound" }) } else { Ok(()) }
}

/// The pose with a rotation of unit length: every query places its robot by this.
pub(crate) fn rigid_pose(pose: &Pose) -> Result<Pose, ProximityError> {
    if !pose.is_finite() {
        return Err(ProximityError::PoseNotFinite);
    }
    rigid(pose).map_err(|NotRigid { length }| ProximityError::PoseNotRigid { length })
}

/// A pose that keeps every link within range. `ends` are base and tip in the mesh's frame.
pub(crate) fn check_range(
    robot: &Chain,
    pose: &Pose,
    [base, tip]: [Vector; 2],
) -> Result<(), ProximityError> {
    // The capsule around all links, from base to tip, spares looking at each.
    if let Some(LinkNode::Inner { bound, .. }) = robot.link_tree().first()
        && base.abs().max(tip.abs()).max_element() + bound.radius <= COORDINATE_LIMIT
    {
        return Ok(());
    }
    for (link, place) in robot.links().iter().enumerate() {
        check_ends(link, [pose * place.start(), pose * place.end()])?;
    }
    Ok(())
}

/// A link whose ends, in the mesh's frame, are within range.
pub(crate) fn check_ends(link: usize, ends: [Vector; 2]) -> Result<(), ProximityError> {
    if ends.into_iter().all(in_range) {
        Ok(())
    } else {
        Err(ProximityError::OutOfRange { link, limit: COORDINATE_LIMIT })
    }
}

/// Triangles whose corners are all among so many vertices.
pub(crate) fn check_triangles(triangles: &[[u32; 3]], vertices: usize) -> Result<(), MeshError> {
    triangles
        .iter()
        .enumerate()
        .try_for_each(|(triangle, corners)| check_triangle(triangle, corners, vertices))
}

/// A triangle with the number `triangle` whose corners are among so many vertices.
pub(crate) fn check_triangle(triangle: usize, corners: &[u32; 3], vertices: usize) -> Result<(), MeshError> {
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
fn in_range(point: Vector) -> bool {
    point.abs().cmple(Vector::splat(COORDINATE_LIMIT)).all()
}
