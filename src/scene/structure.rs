//! One structure of a scene: a mesh, its pose, and its margin.

use super::bounding_box::BoundingBox;
use crate::answer::{Contact, LinkProximity, MeshError, ProximityError, Witness};
use crate::engine::{BvhSearch, Proximity};
use crate::pair::{PlacedRobot, rigid_pose};
use crate::robot::Chain;
use parry3d_f64::math::{Pose, Real, Vector};

#[derive(Clone, Debug)]
pub(super) struct Structure {
    pub name: String,
    pub margin: Option<Real>,
    /// The margins from single robots that differ from `margin`, each with the robot's number.
    margins_between: Vec<(usize, Option<Real>)>,
    /// Whether a robot inside is in contact.
    pub is_solid: bool,
    /// Boxed, so that the fields that reject a far robot lie close together in memory for all
    /// structures.
    pub search: Box<BvhSearch>,
    /// Maps the mesh's frame to the scene's; `None` if they are the same.
    pose: Option<Pose>,
    /// The bounding box of the triangles, in the mesh's frame.
    pub around: BoundingBox,
    /// The largest coordinate of the box and of the pose.
    size: Real,
}

impl Structure {
    pub fn new(name: String, search: BvhSearch, margin: Option<Real>) -> Self {
        let search = Box::new(search);
        let mut new = Self {
            name,
            margin,
            margins_between: Vec::new(),
            is_solid: false,
            search,
            pose: None,
            around: BoundingBox::default(),
            size: 0.0,
        };
        new.update_bounds();
        new
    }

    /// The margin from a robot.
    pub fn margin_from(&self, robot: usize) -> Option<Real> {
        let mut margins = self.margins_between.iter();
        margins.find(|(other, _)| *other == robot).map_or(self.margin, |(_, margin)| *margin)
    }

    /// Sets the margin from one robot.
    pub fn set_margin_from(&mut self, robot: usize, margin: Option<Real>) {
        self.margins_between.retain(|(other, _)| *other != robot);
        self.margins_between.push((robot, margin));
    }

    fn margins(&self) -> impl Iterator<Item = Real> {
        let between = self.margins_between.iter().map(|(_, margin)| *margin);
        std::iter::once(self.margin).chain(between).flatten()
    }

    /// Whether some robot has a margin.
    pub fn has_margin(&self) -> bool {
        self.margins().next().is_some()
    }

    /// The largest margin, or -infinity.
    pub fn largest_margin(&self) -> Real {
        self.margins().fold(Real::NEG_INFINITY, Real::max)
    }

    fn update_bounds(&mut self) {
        self.around = self.bounds_of(self.search.vertices());
        self.measure();
    }

    /// The bounding box of the triangles if the vertices are these, in the mesh's frame.
    pub fn bounds_of(&self, vertices: &[Vector]) -> BoundingBox {
        let corners = self.search.triangles().as_flattened().iter();
        BoundingBox::points(corners.map(|&corner| vertices[corner as usize]))
    }

    /// Checks that the vertices can move to these places.
    ///
    /// # Errors
    /// As [`Proximity::set_vertices`].
    pub fn check_moved(&self, vertices: &[Vector]) -> Result<(), MeshError> {
        self.search.check_moved(vertices)
    }

    /// Maps the mesh's frame to the scene's.
    pub fn pose(&self) -> Pose {
        self.pose.unwrap_or(Pose::IDENTITY)
    }

    fn measure(&mut self) {
        let translation = self.pose.map_or(0.0, |pose| pose.translation.abs().max_element());
        self.size = self.around.size().max(translation);
    }

    /// The largest coordinate of the mesh and of its pose.
    pub fn size(&self) -> Real {
        self.size
    }

    /// Sets the pose.
    ///
    /// # Errors
    /// The pose is not finite or not rigid.
    pub fn set_pose(&mut self, pose: &Pose) -> Result<(), ProximityError> {
        let pose = rigid_pose(pose)?;
        self.pose = (pose != Pose::IDENTITY).then_some(pose);
        self.measure();
        Ok(())
    }

    /// Moves the vertices.
    ///
    /// # Errors
    /// As [`Proximity::set_vertices`].
    pub fn set_vertices(&mut self, vertices: &[Vector]) -> Result<(), MeshError> {
        self.search.set_vertices(vertices)?;
        self.update_bounds();
        Ok(())
    }

    /// Maps a robot's pose to the mesh's frame.
    pub fn in_mesh(&self, robot: &Pose) -> Pose {
        self.pose.map_or(*robot, |pose| pose.inverse() * *robot)
    }

    /// Maps the scene's frame to the mesh's; `None` if they are the same.
    pub fn scene_to_mesh(&self) -> Option<Pose> {
        self.pose.map(|pose| pose.inverse())
    }

    /// The largest coordinate of the mesh and of its pose, if it has one.
    pub fn frame(&self) -> Option<Real> {
        self.pose.map(|_| self.size)
    }

    /// Places a robot in the mesh's frame. `placed` is the robot placed in the scene's frame.
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

    /// The bounding box in the scene's frame.
    pub fn around_in_scene(&self) -> BoundingBox {
        self.pose.map_or(self.around, |pose| self.around.moved(&pose))
    }

    /// Maps an answer from the mesh's frame to the scene's.
    pub fn placed(&self, mut nearest: LinkProximity) -> LinkProximity {
        nearest.witness = self.placed_witness(nearest.witness);
        nearest
    }

    /// Maps a place from the mesh's frame to the scene's.
    pub fn placed_witness(&self, witness: Witness) -> Witness {
        self.pose.map_or(witness, |pose| place_witness(&pose, witness))
    }

    /// Maps a contact from the mesh's frame to the scene's.
    pub fn placed_contact(&self, mut contact: Contact) -> Contact {
        if let Some(pose) = &self.pose {
            contact.witness = place_witness(pose, contact.witness);
            contact.lever = pose.rotation * contact.lever;
            contact.normal = contact.normal.map(|normal| pose.rotation * normal);
        }
        contact
    }
}

/// Maps a place by the pose of a mesh.
pub(super) fn place_witness(pose: &Pose, witness: Witness) -> Witness {
    Witness { on_robot: pose * witness.on_robot, on_mesh: pose * witness.on_mesh, ..witness }
}
