//! Inside or outside, as [`BvhSearch`] answers it.
//!
//! The side of a point is its winding number ([`Winding`]). The side of a robot is the side of its
//! base.

use super::search::BvhSearch;
use crate::answer::{InsideAnswer, ProximityError, Side};
use crate::engine::Proximity;
use crate::pair::rigid_pose;
use crate::query::side::Winding;
use crate::robot::Chain;
use parry3d_f64::math::{Pose, Real, Vector};

impl BvhSearch {
    /// Returns the side of the mesh on which a point lies. The point is in the mesh's frame.
    ///
    /// `Inside` and `Outside` are proven: the error of the winding number is bounded, rounding
    /// included. In a closed mesh the answer is [`Side::Undecided`] only if the point lies on the
    /// surface, within rounding, or is not finite. [`Side`] defines the answer for an open mesh.
    ///
    /// The first query builds the far field of each node, and so does the first one after
    /// [`set_vertices`](Proximity::set_vertices), unless [`prepare`](Self::prepare) has built it.
    /// Clones share the far fields.
    ///
    /// ```
    /// use parry_continuum::parry::{math::Vector, shape::{Ball, TriMesh}};
    /// use parry_continuum::proximity::{BvhSearch, Side};
    ///
    /// let (vertices, triangles) = Ball::new(10.0).to_trimesh(64, 32);
    /// let search = BvhSearch::new(&TriMesh::new(vertices.clone(), triangles)?)?;
    /// assert_eq!(search.side(Vector::X * 9.9), Side::Inside);
    /// assert_eq!(search.side(Vector::X * 10.1), Side::Outside);
    /// assert_eq!(search.side(vertices[0]), Side::Undecided);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn side(&self, point: Vector) -> Side {
        let prepared = self.prepared();
        let hierarchy = &prepared.hierarchy;
        let (mesh, tree) = (&hierarchy.mesh, hierarchy.single());
        Winding { mesh, tree, fields: prepared.far_fields(), point }.side()
    }

    /// Returns whether every link is farther than `margin` from the mesh, and the side of the
    /// robot's base.
    ///
    /// Distances are unsigned, so [`clears`](Proximity::clears) alone is true of a robot outside
    /// the anatomy. In a closed mesh a robot that touches nothing and whose base is inside is
    /// inside as a whole. It may leave through a hole of an open mesh: query the
    /// [`side`](Self::side) of every point that matters there.
    ///
    /// ```
    /// use parry_continuum::{Chain, proximity::{BvhSearch, Side}};
    /// use parry_continuum::parry::{math::{Pose, Vector}, shape::{Ball, TriMesh}};
    ///
    /// let (vertices, triangles) = Ball::new(10.0).to_trimesh(64, 32);
    /// let mut search = BvhSearch::new(&TriMesh::new(vertices, triangles)?)?;
    /// let robot = Chain::from_centreline(&[Vector::ZERO, Vector::Z * 5.0], &[0.5])?;
    /// assert!(search.clears_inside(&robot, &Pose::IDENTITY, 2.0)?.holds());
    /// let beside = search.clears_inside(&robot, &Pose::from_translation(Vector::X * 20.0), 2.0)?;
    /// assert!(beside.clears && beside.base == Side::Outside);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// The margin is negative or NaN, the pose is not finite, or it moves a link out of range.
    pub fn clears_inside(
        &mut self,
        robot: &Chain,
        pose: &Pose,
        margin: Real,
    ) -> Result<InsideAnswer, ProximityError> {
        let clears = self.clears(robot, pose, margin)?;
        let pose = rigid_pose(pose)?;
        let base =
            robot.links().first().map_or(Side::Undecided, |link| self.side(pose * link.start()));
        Ok(InsideAnswer { base, clears })
    }
}
