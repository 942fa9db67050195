use super::{Contact, LinkProximity, MeshError, ProximityError};
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

    /// The closest link and triangle, if they are at most `bound` apart: [`minimum`](Proximity::minimum) for less work
    /// where nothing is as near. Several meshes are asked in turn, each for what is nearer than the last:
    ///
    /// ```
    /// use parry_continuum::Chain;
    /// use parry_continuum::parry::{math::{Pose, Vector}, shape::{Ball, TriMesh}};
    /// use parry_continuum::proximity::{BvhSearch, Proximity, ProximityError};
    ///
    /// let ball = |centre: Vector, radius: f64| -> Result<BvhSearch, Box<dyn std::error::Error>> {
    ///     let (vertices, triangles) = Ball::new(radius).to_trimesh(64, 32);
    ///     let vertices = vertices.into_iter().map(|vertex| vertex + centre).collect();
    ///     Ok(BvhSearch::new(&TriMesh::new(vertices, triangles)?)?)
    /// };
    /// // A wall that keeps 0.5 mm, and a vessel that keeps 2 mm.
    /// let mut anatomy = [(ball(Vector::ZERO, 10.0)?, 0.5), (ball(Vector::X * 6.0, 1.0)?, 2.0)];
    /// let robot = Chain::from_centreline(&[Vector::ZERO, Vector::Z * 6.0], &[0.5])?;
    ///
    /// // The least room that is left, and where.
    /// let (mut room, mut tightest) = (f64::INFINITY, None);
    /// for (mesh, (search, margin)) in anatomy.iter_mut().enumerate() {
    ///     if let Some(found) = search.minimum_within(&robot, &Pose::IDENTITY, room + *margin)? {
    ///         room = found.distance - *margin;
    ///         tightest = Some((mesh, found));
    ///     }
    /// }
    /// assert_eq!(tightest.map(|(mesh, _)| mesh), Some(1));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// The bound is negative or NaN, the pose is not finite, or it moves a link out of range.
    fn minimum_within(
        &mut self,
        robot: &Chain,
        pose: &Pose,
        bound: Real,
    ) -> Result<Option<LinkProximity>, ProximityError>;

    /// Whether the robot keeps more than `margin` away from the mesh: exactly `minimum().distance > margin`,
    /// for less work.
    ///
    /// # Errors
    /// The margin is negative or NaN, the pose is not finite, or it moves a link out of range.
    fn clears(&mut self, robot: &Chain, pose: &Pose, margin: Real) -> Result<bool, ProximityError>;

    /// Every contact at most `margin` away: where the distance between a link and the mesh has a local minimum, link by
    /// link and nearest first. `out` is cleared first.
    ///
    /// A place of the mesh is a local minimum for a link if no way on the mesh leads from it to a nearer one without
    /// first leading farther away. So a wall that bends towards the link is one contact, however many triangles it has,
    /// and a link in a narrow lumen has one on each side; every closest point that [`per_link`](Proximity::per_link)
    /// finds within the margin is among them, or another place as near on the same piece of wall. Where a piece of wall
    /// is equally near as far as rounding can tell, it is one contact; and so is a connected piece of wall inside the
    /// link, named by the triangle nearest to the axis. Triangles are joined where they have corners at the same place,
    /// whether they share an index or not.
    ///
    /// ```
    /// use parry_continuum::Chain;
    /// use parry_continuum::parry::{math::{Pose, Vector}, shape::{Ball, TriMesh}};
    /// use parry_continuum::proximity::{BvhSearch, Proximity};
    ///
    /// // A bump below the robot and one above it.
    /// let (ball, triangles) = Ball::new(1.0).to_trimesh(32, 16);
    /// let vertices = [-3.0, 2.5].map(|z| ball.iter().map(move |v| v + Vector::Z * z)).into_iter().flatten();
    /// let count = ball.len() as u32;
    /// let other = triangles.iter().map(|corners| corners.map(|corner| corner + count));
    /// let indices = triangles.iter().copied().chain(other).collect();
    /// let mut search = BvhSearch::new(&TriMesh::new(vertices.collect(), indices)?)?;
    /// let robot = Chain::from_centreline(&[-Vector::X, Vector::X], &[0.5])?;
    /// let mut contacts = Vec::new();
    /// search.within(&robot, &Pose::IDENTITY, 2.0, &mut contacts)?;
    /// assert_eq!(contacts.len(), 2);
    /// assert!(contacts[0].normal.is_some_and(|normal| (normal + Vector::Z).length() < 0.2));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// The margin is negative or NaN, the pose is not finite, or it moves a link out of range.
    fn within(
        &mut self,
        robot: &Chain,
        pose: &Pose,
        margin: Real,
        out: &mut Vec<Contact>,
    ) -> Result<(), ProximityError>;

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
