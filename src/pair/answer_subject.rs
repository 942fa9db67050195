//! The link and the triangle that an answer is about, as they are now.

use super::checks::{check_ends, rigid_pose};
use super::placed_link::PlacedLink;
use crate::answer::{LinkProximity, ProximityError};
use crate::mesh::{check_triangle, check_vertex};
use crate::robot::{Chain, ModifiedCylinder};
use parry3d_f64::math::{Pose, Vector};

/// The link that an answer is about.
///
/// # Errors
/// The robot does not have it.
pub(super) fn link_of<'a>(
    answer: &LinkProximity,
    robot: &'a Chain,
) -> Result<&'a ModifiedCylinder, ProximityError> {
    let (link, links) = (answer.link as usize, robot.links());
    links.get(link).ok_or(ProximityError::NoSuchLink { link, links: links.len() })
}

/// The same in the mesh's frame.
///
/// # Errors
/// The robot does not have it, or the pose is not finite or not rigid, or moves it out of range.
pub(crate) fn transformed_link(
    answer: &LinkProximity,
    robot: &Chain,
    pose: &Pose,
) -> Result<ModifiedCylinder, ProximityError> {
    let link = link_of(answer, robot)?.transformed(&rigid_pose(pose)?);
    check_ends(answer.link as usize, [link.start(), link.end()])?;
    Ok(link)
}

/// The same, ready to be measured.
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

/// The corners of a triangle of a mesh that an answer is about.
///
/// # Errors
/// The mesh does not have it or one of its vertices, or one of them is not finite or out of range.
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
