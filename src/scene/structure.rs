//! One structure of a scene: a mesh, where it is, and the margin that robots keep from it.

use crate::answer::{Contact, LinkProximity, MeshError, ProximityError};
use crate::engine::{BvhSearch, Proximity};
use crate::pair::{PlacedRobot, rigid_pose};
use crate::robot::{Chain, LinkNode};
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

    /// What the distance of a robot is at least, by the capsule around the robot and the box around the mesh.
    ///
    /// # Errors
    /// The pose is not finite or not rigid, or moves a link out of range.
    pub fn at_least(&self, robot: &Chain, in_mesh: &Pose) -> Result<Real, ProximityError> {
        let placed = PlacedRobot::new(robot, in_mesh)?;
        let whole = match &placed.link_tree()[0] {
            LinkNode::Inner { bound, .. } => placed.bound(bound),
            LinkNode::Leaf(link) => placed.link(*link),
        };
        let [low, high] = self.around;
        Ok(whole.distance_to_box(low, high))
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
