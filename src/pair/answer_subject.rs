//! The link and the triangle of an answer, as they are now.

use super::checks::{check_ends, rigid_pose};
use super::placed_link::PlacedLink;
use crate::answer::{LinkProximity, ProximityError};
use crate::mesh::{check_triangle, check_vertex};
use crate::robot::{Chain, ModifiedCylinder};
use parry3d_f64::math::{Pose, Vector};

/// Returns the link of an answer, in the robot's frame.
///
/// # Errors
/// The robot has no such link.
pub(super) fn link_of<'a>(
    answer: &LinkProximity,
    robot: &'a Chain,
) -> Result<&'a ModifiedCylinder, ProximityError> {
    let (link, links) = (answer.link as usize, robot.links());
    links.get(link).ok_or(ProximityError::NoSuchLink { link, links: links.len() })
}

/// Returns the link of an answer, in the mesh's frame.
///
/// # Errors
/// The robot has no such link; the pose is not finite or not rigid; or the pose moves the link out
/// of range.
pub(crate) fn transformed_link(
    answer: &LinkProximity,
    robot: &Chain,
    pose: &Pose,
) -> Result<ModifiedCylinder, ProximityError> {
    let link = link_of(answer, robot)?.transformed(&rigid_pose(pose)?);
    check_ends(answer.link as usize, [link.start(), link.end()])?;
    Ok(link)
}

/// Returns the link of an answer, placed in the mesh's frame.
///
/// # Errors
/// As [`transformed_link`].
pub(crate) fn placed_link(
    answer: &LinkProximity,
    robot: &Chain,
    pose: &Pose,
) -> Result<PlacedLink, ProximityError> {
    Ok(PlacedLink::of(&transformed_link(answer, robot, pose)?))
}

/// Returns the vertices of an answer's triangle.
///
/// # Errors
/// The mesh has no such triangle or lacks one of its vertices, or a vertex is not finite or out of
/// range.
pub(crate) fn corners(
    vertices: &[Vector],
    triangles: &[[u32; 3]],
    triangle: usize,
) -> Result<[Vector; 3], ProximityError> {
    let missing = ProximityError::NoSuchTriangle { triangle, triangles: triangles.len() };
    let indices = triangles.get(triangle).ok_or(missing)?;
    check_triangle(triangle, indices, vertices.len())?;
    let corners = indices.map(|index| vertices[index as usize]);
    for (index, point) in indices.iter().zip(corners) {
        check_vertex(*index as usize, point)?;
    }
    Ok(corners)
}
