//! One structure of a scene: a mesh, where it is, and the margin that robots keep from it.

use crate::answer::{Contact, LinkProximity, MeshError, ProximityError};
use crate::distance::Scalar;
use crate::engine::{BvhSearch, Proximity};
use crate::pair::{PlacedLink, PlacedRobot, rigid_pose};
use crate::robot::{Chain, LinkNode, length};
use parry3d_f64::math::{Pose, Real, Vector};

#[derive(Clone, Debug)]
pub(super) struct Structure {
    pub name: String,
    pub margin: Option<Real>,
    pub search: BvhSearch,
    /// From the mesh's frame to the scene's; none where they are one.
    pose: Option<Pose>,
    /// The corners of a box around the triangles, in the mesh's frame.
    around: [Vector; 2],
}

impl Structure {
    pub fn new(name: String, search: BvhSearch, margin: Option<Real>) -> Self {
        let around = around(&search);
        Self { name, margin, search, pose: None, around }
    }

    /// # Errors
    /// The pose is not finite or not rigid.
    pub fn set_pose(&mut self, pose: &Pose) -> Result<(), ProximityError> {
        let pose = rigid_pose(pose)?;
        self.pose = (pose != Pose::IDENTITY).then_some(pose);
        Ok(())
    }

    /// # Errors
    /// As those of the engine.
    pub fn set_vertices(&mut self, vertices: &[Vector]) -> Result<(), MeshError> {
        self.search.set_vertices(vertices)?;
        self.around = around(&self.search);
        Ok(())
    }

    /// A robot's pose in the mesh's frame.
    pub fn in_mesh(&self, robot: &Pose) -> Pose {
        self.pose.map_or(*robot, |pose| pose.inverse() * *robot)
    }

    /// A robot in the mesh's frame, from where it is `placed` in the scene's.
    ///
    /// # Errors
    /// The structure's pose moves a link out of range.
    pub fn place<'a>(
        &self,
        robot: &'a Chain,
        at: &Pose,
        placed: &PlacedRobot<'a>,
    ) -> Result<PlacedRobot<'a>, ProximityError> {
        if self.pose.is_none() { Ok(*placed) } else { PlacedRobot::new(robot, &self.in_mesh(at)) }
    }

    /// What the distance of a robot is at least, by the boxes around the capsule that holds it and around the mesh.
    ///
    /// Rounding: with M the largest magnitude of the capsule's ends, its radius and the box' corners, each coordinate of the way
    /// between the boxes is a difference of sums that errs by 6 u M at most, their length by less than 11 u M for that, and by less
    /// than 14 u M for its own squares, sums and root; what is taken off errs by less than 6 u M. And what is measured may be less
    /// than it is by 16 u of an extent of 2 M. So 64 u M are taken off.
    pub fn at_least(&self, robot: &PlacedRobot) -> Real {
        let ([start, end], radius, _) = robot.outline(&robot.link_tree()[0]);
        let [low, high] = self.around;
        let way = (start.min(end) - radius - high).max(low - (start.max(end) + radius)).max(Vector::ZERO);
        let largest = start.abs().max(end.abs()).max(low.abs()).max(high.abs()).max_element().max(radius);
        length(way) - 64.0 * Real::UNIT_ROUNDOFF * largest
    }

    /// Whether some link of a robot may be at most `bound` away, by the capsules around its links and the box around the mesh.
    pub fn may_be_within(&self, robot: &PlacedRobot, bound: Real) -> bool {
        let ([low, high], nodes, mut place) = (self.around, robot.link_tree(), 0);
        while let Some(node) = nodes.get(place) {
            let ([start, end], radius, flat) = robot.outline(node);
            let is_far = PlacedLink::between(start, end, radius, flat).distance_to_box(low, high) > bound;
            place += match node {
                LinkNode::Inner { below, .. } if is_far => 1 + below,
                LinkNode::Leaf(_) if !is_far => return true,
                _ => 1,
            };
        }
        false
    }

    /// An answer of the mesh's frame in the scene's.
    pub fn placed(&self, mut nearest: LinkProximity) -> LinkProximity {
        if let Some(pose) = &self.pose {
            nearest.on_robot = pose * nearest.on_robot;
            nearest.on_mesh = pose * nearest.on_mesh;
        }
        nearest
    }

    /// A contact of the mesh's frame in the scene's.
    pub fn placed_contact(&self, mut contact: Contact) -> Contact {
        if let Some(pose) = &self.pose {
            contact.on_robot = pose * contact.on_robot;
            contact.on_mesh = pose * contact.on_mesh;
            contact.lever = pose.rotation * contact.lever;
            contact.normal = contact.normal.map(|normal| pose.rotation * normal);
        }
        contact
    }
}

fn around(search: &BvhSearch) -> [Vector; 2] {
    let vertices = search.vertices();
    let corners = search.triangles().as_flattened().iter().map(|&vertex| vertices[vertex as usize]);
    let nothing = [Vector::splat(Real::INFINITY), Vector::splat(Real::NEG_INFINITY)];
    corners.fold(nothing, |[low, high], corner| [low.min(corner), high.max(corner)])
}
