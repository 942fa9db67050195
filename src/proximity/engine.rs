use super::{LinkProximity, MeshError, ProximityError};
use crate::Chain;
use parry3d_f64::math::{Pose, Real, Vector};

/// An engine that answers proximity queries between a robot and the mesh it was built for.
///
/// `pose` is the robot's in the mesh's frame, and answers are in that frame too. Distances are to the mesh's
/// surface and unsigned: a link that touches nothing may be on either side of it. All engines give the same
/// distances. Of triangles that are as close as one another, touching ones included, [`BvhSearch`](super::BvhSearch) and
/// [`Exhaustive`](super::Exhaustive) name the lowest, and of links that share it the lowest, on any number of threads.
///
/// The batches take many robots, such as a planner's samples, and answer in their order on all cores.
///
/// A query that returns an error leaves `out` empty.
pub trait Proximity {
    /// The closest triangle of every link, in link order. `out` is cleared first.
    ///
    /// # Errors
    /// The pose is not finite, or it moves a link out of range.
    fn per_link(
        &mut self,
        robot: &Chain,
        pose: &Pose,
        out: &mut Vec<LinkProximity>,
    ) -> Result<(), ProximityError>;

    /// The closest link and triangle of the whole robot.
    ///
    /// # Errors
    /// The pose is not finite, or it moves a link out of range.
    fn minimum(&mut self, robot: &Chain, pose: &Pose) -> Result<LinkProximity, ProximityError>;

    /// Whether the robot keeps more than `margin` away from the mesh: exactly `minimum().distance > margin`,
    /// for less work.
    ///
    /// # Errors
    /// The margin is negative or NaN, the pose is not finite, or it moves a link out of range.
    fn clears(&mut self, robot: &Chain, pose: &Pose, margin: Real) -> Result<bool, ProximityError>;

    /// [`Proximity::per_link`] for many robots. `out` gets one entry per robot; its inner vectors are used again.
    ///
    /// # Errors
    /// Those of the first robot that has one.
    fn per_link_batch(
        &mut self,
        robots: &[(&Chain, Pose)],
        out: &mut Vec<Vec<LinkProximity>>,
    ) -> Result<(), ProximityError>;

    /// [`Proximity::minimum`] for many robots. `out` gets one entry per robot.
    ///
    /// # Errors
    /// Those of the first robot that has one.
    fn minimum_batch(
        &mut self,
        robots: &[(&Chain, Pose)],
        out: &mut Vec<LinkProximity>,
    ) -> Result<(), ProximityError>;

    /// [`Proximity::clears`] for many robots. `out` gets one entry per robot.
    ///
    /// # Errors
    /// Those of the first robot that has one.
    fn clears_batch(
        &mut self,
        robots: &[(&Chain, Pose)],
        margin: Real,
        out: &mut Vec<bool>,
    ) -> Result<(), ProximityError>;

    /// Moves the mesh's vertices; the triangles stay as they are.
    ///
    /// # Errors
    /// The number of vertices differs or one of them is not finite or out of range. The engine then keeps the old ones.
    fn set_vertices(&mut self, vertices: &[Vector]) -> Result<(), MeshError>;
}

/// The robots of a batch, one by one.
pub(crate) fn pairs<'a>(robots: &'a [(&Chain, Pose)]) -> impl Iterator<Item = (&'a Chain, &'a Pose)> {
    robots.iter().map(|(robot, pose)| (*robot, pose))
}
