//! The checks of a robot and its pose that every engine makes.

use crate::answer::ProximityError;
use crate::mesh::in_range;
use crate::robot::{COORDINATE_LIMIT, Chain, LinkNode, NotRigid, rigid};
use parry3d_f64::math::{Pose, Vector};

/// Returns the pose with a rotation of unit length. Every query places its robot by this pose.
pub(crate) fn rigid_pose(pose: &Pose) -> Result<Pose, ProximityError> {
    if !pose.is_finite() {
        return Err(ProximityError::PoseNotFinite);
    }
    rigid(pose).map_err(|NotRigid { length }| ProximityError::PoseNotRigid { length })
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
        Err(ProximityError::OutOfRange { link, limit: COORDINATE_LIMIT })
    }
}
