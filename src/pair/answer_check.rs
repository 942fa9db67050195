//! The checks of a robot and its pose that every engine makes; and whether an answer belongs to a
//! link and a triangle as they are now. The mesh may have moved since, or may be another.

use super::coordinates::Nearest;
use super::placed_link::PlacedLink;
use crate::answer::{LinkProximity, PlacementFault, ProximityError};
use crate::distance::Scalar;
use crate::mesh::{check_triangle, check_vertex, in_range};
use crate::robot::{COORDINATE_LIMIT, Chain, LinkNode, ModifiedCylinder, NotRigid, rigid};
use parry3d_f64::math::{Pose, Real, Vector};

/// The tolerance, relative to the largest coordinate plus the extent.
///
/// In the pair's own coordinates a distance and its two points err by at most 16 u of the extent;
/// the largest measured error is 4.4 u. Each point is then rounded to the mesh's frame, by u of its
/// largest coordinate, so by less than 2 u of it in length. An answer that was written as text and
/// read again may be off by the same amount once more.
pub(super) const ROUNDED: Real = 16.0 * f64::UNIT_ROUNDOFF;

impl LinkProximity {
    /// Checks this answer against a link and a triangle: `on_robot` lies in the link, `on_mesh`
    /// lies on the triangle, and `distance` is the distance both of the two points and of the two
    /// shapes. `measured` is the pair's result now.
    ///
    /// # Errors
    /// The answer does not fit.
    #[inline(always)]
    pub(crate) fn check_answer(
        &self,
        measured: &Nearest,
        link: impl FnOnce() -> PlacedLink,
        corners: [Vector; 3],
    ) -> Result<(), ProximityError> {
        // Every engine returns the measured result, bit for bit.
        let is_that = self.distance == measured.distance
            && self.witness.on_mesh == measured.on_mesh
            && self.witness.on_robot == measured.on_robot;
        if is_that {
            Ok(())
        } else {
            self.check_rounded_answer(measured.distance, &link(), corners)
        }
    }

    /// Same as [`check_answer`](Self::check_answer), for an answer that was rounded or computed in
    /// another way.
    #[cold]
    fn check_rounded_answer(
        &self,
        measured: Real,
        link: &PlacedLink,
        corners: [Vector; 3],
    ) -> Result<(), ProximityError> {
        let (distance, on_robot, on_mesh) =
            (self.distance, self.witness.on_robot, self.witness.on_mesh);
        let [a, b, c] = corners;
        let points = [link.start(), link.end(), a, b, c];
        let largest =
            points.iter().fold(0.0, |most: Real, point| most.max(point.abs().max_element()));
        let limit = ROUNDED * (largest + link.extent_with(corners));
        let (link_number, triangle) = (self.link as usize, self.witness.triangle as usize);
        let check = check_within(limit, |field, off| ProximityError::AnswerDoesNotFit {
            link: link_number,
            triangle,
            field,
            off,
            limit,
        });
        let reach = 2.0 * (largest + link.radius());
        for (field, point) in [("on_mesh", on_mesh), ("on_robot", on_robot)] {
            check_reach(&check, field, point, link, reach)?;
        }
        let ball = PlacedLink::between(on_mesh, on_mesh, 0.0, [false; 2]);
        check("on_mesh", ball.measure(0, corners).distance)?;
        check("on_robot", link.measure(0, [on_robot; 3]).distance)?;
        check("distance", (ball.measure(0, [on_robot; 3]).distance - distance).abs())?;
        check("distance", (measured - distance).abs())
    }
}

/// Returns the check of one field of an answer: `off`, by which the field is wrong, is at most
/// `limit`. `refuse` makes the error.
pub(super) fn check_within(
    limit: Real,
    refuse: impl Fn(&'static str, Real) -> ProximityError,
) -> impl Fn(&'static str, Real) -> Result<(), ProximityError> {
    // NaN does not fit.
    move |field, off| if off <= limit { Ok(()) } else { Err(refuse(field, off)) }
}

/// Refuses a point with a coordinate beyond `reach`, the reach of the shapes: measuring it could
/// overflow.
pub(super) fn check_reach(
    check: impl Fn(&'static str, Real) -> Result<(), ProximityError>,
    field: &'static str,
    point: Vector,
    link: &PlacedLink,
    reach: Real,
) -> Result<(), ProximityError> {
    if point.abs().cmple(Vector::splat(reach)).all() {
        return Ok(());
    }
    check(field, (point - link.start()).abs().max_element())
}

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

/// Returns the pose with a rotation of unit length. Every query places its robot by this pose.
pub(crate) fn rigid_pose(pose: &Pose) -> Result<Pose, ProximityError> {
    if !pose.is_finite() {
        return Err(PlacementFault::PoseNotFinite.into());
    }
    rigid(pose).map_err(|NotRigid { length }| PlacementFault::PoseNotRigid { length }.into())
}

/// Checks that a pose keeps every link within range. `ends` are base and tip in the mesh's frame.
pub(crate) fn check_range(
    robot: &Chain,
    pose: &Pose,
    [base, tip]: [Vector; 2],
) -> Result<(), ProximityError> {
    // The capsule around all links may prove the range without a test of each link.
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

/// Checks that the ends of a link, in the mesh's frame, are within range.
pub(crate) fn check_ends(link: usize, ends: [Vector; 2]) -> Result<(), ProximityError> {
    if ends.into_iter().all(in_range) {
        Ok(())
    } else {
        Err(PlacementFault::OutOfRange { link, limit: COORDINATE_LIMIT }.into())
    }
}
