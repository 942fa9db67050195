//! Structures that move while the robots move.
//!
//! # Definitions
//! - b(t), R(t): the origin and the rotation of a structure that moves from one pose to another. b
//!   moves straight at constant speed. R turns at constant speed about one axis by the smaller
//!   angle.
//! - p(t): a point of the robot, in the scene's frame. In the structure's frame it is
//!   `R(t)^-1 (p(t) - b(t))`.
//!
//! # Claim
//! The robot moves in the structure's frame as on two moving bases ([`MovingBase`]): the inner one
//! moves by -b(t) without turning, the outer one turns by R(t)^-1 without moving.
//!
//! **Proof.** The inner base maps p to `p - b(t)`. R(t) = E(t) R(0), where E(t) turns about a fixed
//! axis at constant speed. So `R(t)^-1 = R(0)^-1 E(t)^-1` turns at constant speed about the axis
//! that `R(0)^-1` maps E's axis to, by the same angle. R(t) is computed as the inverse of the outer
//! base's rotation. So both agree at an angle of pi too, where two axes are possible.

use super::bounding_box::BoundingBox;
use super::structure::Structure;
use crate::answer::ProximityError;
use crate::distance::Scalar;
use crate::motion::{Motion, MovingBase, RigidPath};
use crate::pair::rigid_pose;
use crate::query::motion::{half_length, midpoint};
use crate::robot::RobotError;
use parry3d_f64::math::{Pose, Real, Vector};

/// Where a structure of a [`Scene`](super::Scene) is at the end of a motion, at t = 1. It begins
/// where it is.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum StructureEnd<'a> {
    /// The structure moves as a whole to this pose, which maps its mesh's frame to the scene's
    /// frame. Its origin moves straight at constant speed. It turns at constant speed about one
    /// axis, by the smaller angle.
    Pose(Pose),
    /// Each vertex moves straight at constant speed to this place, in the mesh's frame.
    Vertices(&'a [Vector]),
}

/// A structure that moves.
#[expect(clippy::large_enum_variant, reason = "a query has a few, and boxes none")]
pub(super) enum MovingStructure<'a> {
    Posed {
        /// -b(t) and R(t)^-1, as the poses of the two bases.
        bases: [[Pose; 2]; 2],
        paths: [RigidPath; 2],
        /// An upper bound on the speed of its points.
        speed: Real,
        /// The largest coordinate of the mesh and of its poses.
        size: Real,
    },
    Deformed {
        to: &'a [Vector],
        /// The box around its triangles at all times, in the scene's frame.
        around: BoundingBox,
        size: Real,
    },
}

impl<'a> MovingStructure<'a> {
    /// # Errors
    /// The pose is not finite, not rigid or out of range; or the vertices do not fit the mesh.
    pub fn new(structure: &Structure, end: &StructureEnd<'a>) -> Result<Self, ProximityError> {
        match end {
            StructureEnd::Pose(to) => {
                let poses = [structure.pose(), rigid_pose(to)?];
                let bases = [
                    poses.map(|pose| Pose::from_translation(-pose.translation)),
                    poses.map(|pose| Pose::from_rotation(pose.rotation.inverse())),
                ];
                let [shift, turn] = bases.map(RigidPath::new);
                let paths = [shift?, turn?];
                let way = poses[1].translation - poses[0].translation;
                let far = structure.around.farthest();
                let up = 1.0 + 16.0 * Real::UNIT_ROUNDOFF;
                let speed = (way.length() + paths[1].angle() * far) * up;
                let size = structure.size().max(poses[1].translation.abs().max_element());
                Ok(Self::Posed { bases, paths, speed, size })
            }
            StructureEnd::Vertices(to) => {
                structure.check_moved(to)?;
                let moved = structure.bounds_of(to);
                let pose = structure.pose();
                let around = structure.around_in_scene().and(moved.moved(&pose));
                Ok(Self::Deformed { to, around, size: structure.size().max(moved.size()) })
            }
        }
    }

    /// The largest coordinate of the mesh and of its poses.
    pub fn size(&self) -> Real {
        match self {
            Self::Posed { size, .. } | Self::Deformed { size, .. } => *size,
        }
    }

    /// The box around the structure in the middle of an interval, in the scene's frame, and how far
    /// its points may be from there during the interval.
    pub fn around(&self, structure: &Structure, times: [Real; 2]) -> (BoundingBox, Real) {
        match self {
            Self::Posed { speed, .. } => {
                let around = structure.around.moved(&self.pose(structure, midpoint(times)));
                (around, half_length(times) * speed * (1.0 + 4.0 * Real::UNIT_ROUNDOFF))
            }
            Self::Deformed { around, .. } => (*around, 0.0),
        }
    }

    /// The pose at time `t`.
    pub fn pose(&self, structure: &Structure, t: Real) -> Pose {
        match self {
            Self::Posed { paths: [shift, turn], .. } => {
                Pose::from_parts(-shift.pose(t).translation, turn.pose(t).rotation.inverse())
            }
            Self::Deformed { .. } => structure.pose(),
        }
    }
}

/// The motion of a robot in the frame of a structure that moves by its pose: -b(t) and R(t)^-1 are
/// the poses of the two bases.
///
/// # Errors
/// The motion has no shape at t = 0, 1/2 or 1, or a pose of it is out of range.
pub(super) fn seen_from<M: Motion>(
    motion: M,
    [shift, turn]: [[Pose; 2]; 2],
) -> Result<MovingBase<MovingBase<M>>, RobotError> {
    MovingBase::new(MovingBase::new(motion, shift)?, turn)
}
