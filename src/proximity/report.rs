use super::ProximityError;
use super::checks::{check_ends, check_triangle, check_vertex, rigid_pose};
use super::placed::PlacedLink;
use crate::{Chain, ModifiedCylinder};
use parry3d_f64::math::{Pose, Real, Vector};

/// Where one link of a robot is closest to a mesh, in the mesh's frame and unit.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde-serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde-serialize",
    serde(try_from = "super::serialised::Fields", into = "super::serialised::Fields")
)]
#[non_exhaustive]
pub struct LinkProximity {
    /// The link's position in [`Chain::links`](crate::Chain::links).
    pub link: u32,
    /// The triangle's position in the mesh.
    pub triangle: u32,
    /// The distance between link and triangle, 0 where they touch or overlap.
    pub distance: Real,
    /// The link's closest point.
    pub on_robot: Vector,
    /// The triangle's closest point; the same as `on_robot` where the distance is 0.
    pub on_mesh: Vector,
}

impl LinkProximity {
    /// What stands in a batch until its turn comes.
    pub(super) fn unanswered() -> Self {
        let nowhere = Vector::splat(Real::NAN);
        Self { link: 0, triangle: 0, distance: Real::NAN, on_robot: nowhere, on_mesh: nowhere }
    }

    /// The link that this answer is about.
    ///
    /// # Errors
    /// The robot does not have it.
    pub(super) fn find_link<'a>(&self, robot: &'a Chain) -> Result<&'a ModifiedCylinder, ProximityError> {
        let (link, links) = (self.link as usize, robot.links());
        links.get(link).ok_or(ProximityError::NoSuchLink { link, links: links.len() })
    }

    /// The same in the mesh's frame.
    ///
    /// # Errors
    /// The robot does not have it, or the pose is not finite or not rigid, or moves it out of range.
    pub(super) fn transformed_link(
        &self,
        robot: &Chain,
        pose: &Pose,
    ) -> Result<ModifiedCylinder, ProximityError> {
        let link = self.find_link(robot)?;
        let link = link.transformed(&rigid_pose(pose)?);
        check_ends(self.link as usize, [link.start(), link.end()])?;
        Ok(link)
    }

    /// The same, ready to be measured.
    ///
    /// # Errors
    /// As [`transformed_link`](Self::transformed_link).
    pub(super) fn placed_link(&self, robot: &Chain, pose: &Pose) -> Result<PlacedLink, ProximityError> {
        Ok(PlacedLink::of(&self.transformed_link(robot, pose)?))
    }
}

/// The corners of a triangle of a mesh that an answer is about.
///
/// # Errors
/// The mesh does not have it or one of its vertices, or one of them is not finite or out of range.
pub(super) fn corners(
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

/// How much an engine has computed since it was built, batches left out.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde-serialize", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct Work {
    /// Nodes of the hierarchy whose up to 16 children were bounded; none in an exhaustive engine.
    pub nodes: u64,
    /// Pairs of link and triangle that were visited, 16 triangles at a time.
    pub visited: u64,
    /// Pairs for which the distance between axis and triangle was computed, a pack at a time.
    pub axis_distances: u64,
    /// Pairs that were measured in double precision, with the disc of a flat cap where it decides.
    pub measured: u64,
}

impl std::ops::AddAssign for Work {
    fn add_assign(&mut self, other: Self) {
        self.nodes += other.nodes;
        self.visited += other.visited;
        self.axis_distances += other.axis_distances;
        self.measured += other.measured;
    }
}
