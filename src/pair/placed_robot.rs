//! A robot in the mesh's frame.

use super::answer_check::{check_range, rigid_pose};
use super::placed_link::PlacedLink;
use crate::answer::ProximityError;
use crate::distance::Scalar;
#[cfg(feature = "gpu")]
use crate::mesh::SearchFrame;
use crate::robot::{BoundingCapsule, Chain, LinkNode, ModifiedCylinder};
use parry3d_f64::math::{Pose, Real, Vector};

/// A robot at a pose, in the frame of a mesh. Each link is placed on demand.
#[derive(Clone, Copy)]
pub(crate) struct PlacedRobot<'a> {
    robot: &'a Chain,
    /// The pose; its rotation has unit length.
    pose: Pose,
    /// Base and tip, in the mesh's frame.
    ends: [Vector; 2],
    /// The factor by which a rotation that is not exactly of unit length stretches the robot.
    stretch: Real,
    /// The rounding error of a link's position relative to a capsule around it.
    ///
    /// - A rotated point errs by less than 20 u |q|^2 |p| (glam's formula, length of the error),
    ///   and a translated point by u more of its final position.
    /// - |q|^2 |p| is at most the sum of this position and the translation, and a length is at most
    ///   1.74 times its largest coordinate: together 37 u of the largest coordinates of both.
    /// - Twice that, for the capsule and for the link, is less than 128 u.
    slack: Real,
}

impl<'a> PlacedRobot<'a> {
    /// # Errors
    /// The pose is not finite or not rigid, or moves a link out of range.
    pub(crate) fn new(robot: &'a Chain, pose: &Pose) -> Result<Self, ProximityError> {
        let pose = rigid_pose(pose)?;
        let links = robot.links();
        let ends = [pose * links[0].start(), pose * links[links.len() - 1].end()];
        check_range(robot, &pose, ends)?;
        let stretch = pose.rotation.length_squared().max(1.0);
        let around = match robot.link_tree()[0] {
            LinkNode::Inner { bound, .. } => bound.radius * stretch,
            LinkNode::Leaf(_) => 0.0,
        };
        let largest = ends[0].abs().max(ends[1].abs()).max(pose.translation.abs()).max_element();
        let slack = 128.0 * Real::UNIT_ROUNDOFF * (2.0 * largest + around);
        Ok(Self { robot, pose, ends, stretch, slack })
    }

    /// Returns the links in the robot's frame.
    pub(crate) fn links(&self) -> &'a [ModifiedCylinder] {
        self.robot.links()
    }

    /// Returns a link in the mesh's frame.
    pub(crate) fn link(&self, link: usize) -> PlacedLink {
        let segment = self.robot.segment_of(link) as u32;
        PlacedLink::new(&self.robot.links()[link], &self.pose)
            .at(self.robot.length_before(link), segment)
    }

    /// Returns all links in the mesh's frame.
    pub(crate) fn placed_links(&self) -> impl Iterator<Item = PlacedLink> {
        (0..self.robot.links().len()).map(|link| self.link(link))
    }

    /// Returns the robot's axes and its origin in a search frame.
    #[cfg(feature = "gpu")]
    pub(crate) fn axes_in(&self, frame: &SearchFrame) -> ([Vector; 3], Vector) {
        let axes = Vector::AXES.map(|axis| self.pose.rotation * axis * frame.scale);
        (axes, (self.pose.translation - frame.centre) * frame.scale)
    }

    /// Returns an upper bound on the distance between a point placed by the pose and by
    /// [`axes_in`](Self::axes_in), in the mesh's frame.
    ///
    /// By the axes a point p errs by less than 45 u |p| (an axis by 20 u, its product and the sums
    /// by 4 u, times at most sqrt(3)) and u of the origin. With the error by the pose this is
    /// within the 128 u of `slack`.
    #[cfg(feature = "gpu")]
    pub(crate) fn rounding(&self) -> Real {
        self.slack
    }

    /// Returns the total length of the links before a link.
    pub(crate) fn length_before(&self, link: usize) -> Real {
        self.robot.length_before(link)
    }

    pub(crate) fn link_tree(&self) -> &'a [LinkNode] {
        self.robot.link_tree()
    }

    /// Returns a capsule around links, in the mesh's frame.
    pub(crate) fn bound(&self, bound: &BoundingCapsule) -> PlacedLink {
        let ([start, end], radius) = self.capsule(bound);
        PlacedLink::between(start, end, radius, [false; 2])
    }

    /// Returns the ends of the capsule's axis, and a radius that contains the links as they are
    /// placed one by one.
    #[inline(always)]
    fn capsule(&self, bound: &BoundingCapsule) -> ([Vector; 2], Real) {
        ([self.pose * bound.start, self.pose * bound.end], bound.radius * self.stretch + self.slack)
    }

    /// Returns base and tip in the mesh's frame.
    pub(crate) fn ends(&self) -> [Vector; 2] {
        self.ends
    }

    /// Returns the outline of a node in the mesh's frame: the ends of the axis of a link, or of a
    /// capsule around links; the radius; which caps are flat.
    #[inline(always)] // what it hands over is used at once
    pub(crate) fn outline(&self, node: &LinkNode) -> ([Vector; 2], Real, [bool; 2]) {
        match node {
            LinkNode::Inner { bound, .. } => {
                let (ends, radius) = self.capsule(bound);
                (ends, radius, [false; 2])
            }
            LinkNode::Leaf(link) => {
                let link = self.robot.links()[*link].transformed(&self.pose);
                ([link.start(), link.end()], link.radius(), link.flat())
            }
        }
    }

    /// Transforms a point of the robot into the mesh's frame.
    pub(crate) fn placed(&self, point: Vector) -> Vector {
        self.pose * point
    }

    pub(crate) fn in_robot_frame(&self, point: Vector) -> Vector {
        self.pose.inverse_transform_point(point)
    }
}
