use crate::answer::{Contact, Derivative, LinkProximity, MeshError, ProximityError};
use crate::mesh::Mesh;
use crate::pair::{PlacedLink, PlacedRobot, contact, contacts, derivative};
use crate::query::contacts::ContactQuery;
use crate::query::{check_bound, check_margin, check_not_negative};
use crate::robot::Chain;
use parry3d_f64::math::{Pose, Real, Vector};

/// An engine that answers proximity queries between a robot and the mesh it was built for.
///
/// `pose` is the robot's pose in the mesh's frame, and answers are in that frame too. Distances are
/// to the mesh's surface and unsigned: a link that touches nothing may be on either side of it.
///
/// All engines give the same distances. Where several triangles are equally close, or touch,
/// [`BvhSearch`](super::BvhSearch) and [`Exhaustive`](super::Exhaustive) name the one with the
/// lowest number, and of the links that share it the lowest, on any number of threads.
///
/// The batches take many robots, such as a planner's samples, and answer them on all cores, in the
/// order given. Each robot has a `Result` of its own: one that is refused costs the others nothing.
///
/// A query that returns an error leaves `out` empty.
///
/// Only the engines of this crate are engines: the trait is sealed.
#[allow(private_bounds)]
pub trait Proximity: Engine {
    /// The closest triangle of every link, in link order. `out` is cleared first.
    ///
    /// # Errors
    /// The pose is not finite, or it moves a link out of range.
    fn per_link(
        &mut self,
        robot: &Chain,
        pose: &Pose,
        out: &mut Vec<LinkProximity>,
    ) -> Result<(), ProximityError> {
        out.clear();
        self.ask_per_link(PlacedRobot::new(robot, pose)?, out)
    }

    /// The closest link and triangle of the whole robot.
    ///
    /// # Errors
    /// The pose is not finite, or it moves a link out of range.
    fn minimum(&mut self, robot: &Chain, pose: &Pose) -> Result<LinkProximity, ProximityError> {
        let robot = PlacedRobot::new(robot, pose)?;
        let found = self.ask_nearest(robot, Real::INFINITY)?;
        Ok(found.unwrap_or_else(|| any_triangle(self.mesh(), &robot.link(0))))
    }

    /// The closest link and triangle, if they are at most `bound` apart:
    /// [`minimum`](Proximity::minimum) for less work where nothing is as near. Several meshes
    /// are asked in turn, each for what is nearer than the last:
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
    /// A bound below zero asks for nothing, and the answer is `None`. In the example above it is
    /// below zero where one margin is violated by more than another mesh's margin: that mesh
    /// cannot be tighter.
    ///
    /// # Errors
    /// The bound is NaN, the pose is not finite, or it moves a link out of range.
    fn minimum_within(
        &mut self,
        robot: &Chain,
        pose: &Pose,
        bound: Real,
    ) -> Result<Option<LinkProximity>, ProximityError> {
        check_bound(bound)?;
        let robot = PlacedRobot::new(robot, pose)?;
        if bound < 0.0 { Ok(None) } else { self.ask_nearest(robot, bound) }
    }

    /// Whether the robot keeps more than `margin` away from the mesh: exactly `minimum().distance >
    /// margin`, for less work.
    ///
    /// # Errors
    /// The margin is negative or NaN, the pose is not finite, or it moves a link out of range.
    fn clears(&mut self, robot: &Chain, pose: &Pose, margin: Real) -> Result<bool, ProximityError> {
        check_margin(margin)?;
        self.ask_clears(PlacedRobot::new(robot, pose)?, margin)
    }

    /// Every contact at most `margin` away, link by link and nearest first: where the distance
    /// between a link and the mesh has a local minimum. `out` is cleared first.
    ///
    /// A place of the mesh is a local minimum for a link if every way on the mesh to a nearer place
    /// first leads farther away.
    ///
    /// - A wall that bends towards the link is one contact, however many triangles it has.
    /// - A link in a narrow lumen has a contact on each side.
    /// - A piece of wall that is equally near everywhere, up to rounding, is one contact.
    /// - A connected piece of wall inside the link is one contact. It names the triangle nearest to
    ///   the axis.
    /// - The closest point that [`per_link`](Proximity::per_link) finds is among them if it is
    ///   within the margin, or another place as near on the same piece of wall.
    ///
    /// Triangles are joined where they have corners at the same place, whether they share an index
    /// or not.
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
    /// search.within(&robot, &Pose::IDENTITY, 2.0, 0.0, &mut contacts)?;
    /// assert_eq!(contacts.len(), 2);
    /// assert!(contacts[0].normal.is_some_and(|normal| (normal + Vector::Z).length() < 0.2));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Prominence
    /// A rough wall has a contact at each of its bumps. The prominence of a contact is how much
    /// farther every way on the mesh to a nearer place first leads; it is infinite where no
    /// such way stays within the margin. `prominence` is the least that a contact must have, in
    /// the mesh's unit. With 0 each local minimum is a contact. For a surface made of voxels, the
    /// size of a voxel leaves a few contacts for each link.
    ///
    /// No wall is lost, whatever the prominence:
    ///
    /// - Each connected piece of wall within the margin keeps its nearest contact.
    /// - Contacts whose normals differ by more than 60 degrees are never merged, so that both sides
    ///   of a groove stay. The way that counts is the one to a nearer contact that is kept and
    ///   whose normal is within 60 degrees.
    /// - So each contact that is left out has a nearer one that stands for it. The direction in
    ///   which that one pushes the link is within 60 degrees of its own.
    /// - A contact without a [`normal`](Contact::normal) stays.
    ///
    /// A contact that is kept is the same as without a prominence. With a smaller margin there may
    /// be more of them within it: a way beyond the margin joins nothing.
    ///
    /// # Errors
    /// The margin or the prominence is negative or NaN, the pose is not finite, or it moves a link
    /// out of range.
    fn within(
        &mut self,
        robot: &Chain,
        pose: &Pose,
        margin: Real,
        prominence: Real,
        out: &mut Vec<Contact>,
    ) -> Result<(), ProximityError> {
        out.clear();
        check_margin(margin)?;
        check_not_negative("prominence", prominence)?;
        self.ask_contacts(PlacedRobot::new(robot, pose)?, ContactQuery { margin, prominence }, out)
    }

    /// [`per_link`](Self::per_link) for many robots. `out` gets the answer of each, or why there is
    /// none; inner vectors are used again.
    ///
    /// # Errors
    /// The engine's device failed. `out` is then empty.
    fn per_link_batch(
        &mut self,
        robots: &[(&Chain, Pose)],
        out: &mut Vec<Result<Vec<LinkProximity>, ProximityError>>,
    ) -> Result<(), ProximityError> {
        self.ask_per_link_batch(robots, out).inspect_err(|_| out.clear())
    }

    /// [`minimum`](Self::minimum) for many robots. `out` gets the answer of each, or why there is
    /// none.
    ///
    /// ```
    /// use parry_continuum::Chain;
    /// use parry_continuum::parry::{math::{Pose, Vector}, shape::Ball};
    /// use parry_continuum::proximity::{BvhSearch, Proximity};
    ///
    /// let (vertices, triangles) = Ball::new(10.0).to_trimesh(64, 32);
    /// let mut search = BvhSearch::from_triangles(&vertices, &triangles)?;
    /// let robot = Chain::from_centreline(&[Vector::ZERO, Vector::Z * 5.0], &[0.5])?;
    /// let lost = Pose::from_translation(Vector::NAN);
    /// let mut answers = Vec::new();
    /// search.minimum_batch(&[(&robot, Pose::IDENTITY), (&robot, lost)], &mut answers)?;
    /// assert!(answers[0].is_ok_and(|closest| closest.distance > 4.0));
    /// assert_eq!(answers[1].map_err(|error| error.kind()), Err("pose_not_finite"));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// The engine's device failed. `out` is then empty.
    fn minimum_batch(
        &mut self,
        robots: &[(&Chain, Pose)],
        out: &mut Vec<Result<LinkProximity, ProximityError>>,
    ) -> Result<(), ProximityError> {
        self.ask_minimum_batch(robots, out).inspect_err(|_| out.clear())
    }

    /// [`clears`](Self::clears) for many robots. `out` gets the answer of each, or why there is
    /// none.
    ///
    /// # Errors
    /// The margin is negative or NaN, or the engine's device failed. `out` is then empty.
    fn clears_batch(
        &mut self,
        robots: &[(&Chain, Pose)],
        margin: Real,
        out: &mut Vec<Result<bool, ProximityError>>,
    ) -> Result<(), ProximityError> {
        out.clear();
        check_margin(margin)?;
        self.ask_clears_batch(robots, margin, out).inspect_err(|_| out.clear())
    }

    /// An answer with its normal, its place on the robot and the features that are nearest, of the
    /// mesh that the engine has now. Give the same robot and pose as to the query.
    ///
    /// # Errors
    /// The answer's link or triangle does not exist, or the pose is not finite or moves the link
    /// out of range. Or the answer does not fit the two: it is about another robot or another
    /// pose, or the mesh has moved since. It fits if it is off by no more than 16 units in the
    /// last place of the largest coordinate and of the extent of link and triangle.
    ///
    /// ```
    /// use parry_continuum::Chain;
    /// use parry_continuum::parry::{math::{Pose, Vector}, shape::TriMesh};
    /// use parry_continuum::proximity::{BvhSearch, LinkFeature, Proximity, TriangleFeature};
    ///
    /// let floor = [Vector::new(-9.0, -9.0, -3.0), Vector::new(9.0, -9.0, -3.0), Vector::new(0.0, 9.0, -3.0)];
    /// let mut search = BvhSearch::from_triangles(&floor, &[[0, 1, 2]])?;
    /// let robot = Chain::capsules(&[Vector::ZERO, Vector::X, Vector::new(2.0, 0.0, -1.0)], &[0.5, 0.5])?;
    /// let closest = search.minimum(&robot, &Pose::IDENTITY)?;
    /// let contact = search.contact(&robot, &Pose::IDENTITY, &closest)?;
    /// assert_eq!((contact.link, contact.fraction, contact.normal), (1, 1.0, Some(Vector::Z)));
    /// assert_eq!(contact.feature.link, LinkFeature::EndCap);
    /// assert_eq!(contact.feature.triangle, TriangleFeature::Face);
    /// assert!((contact.arc_length - (1.0 + 2.0_f64.sqrt())).abs() < 1e-15);
    /// // Once the floor has moved the answer is about one that is no more.
    /// search.set_vertices(&floor.map(|corner| corner - Vector::Z))?;
    /// assert!(search.contact(&robot, &Pose::IDENTITY, &closest).is_err());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    fn contact(
        &self,
        robot: &Chain,
        pose: &Pose,
        answer: &LinkProximity,
    ) -> Result<Contact, ProximityError> {
        contact(self.mesh(), robot, pose, answer)
    }

    /// [`contact`](Self::contact) of every answer, in order. It takes a fraction of the time,
    /// because several are computed at once. `out` is cleared first.
    ///
    /// # Errors
    /// Those of the first answer that has one; `out` is then empty.
    ///
    /// ```
    /// use parry_continuum::Chain;
    /// use parry_continuum::parry::math::{Pose, Vector};
    /// use parry_continuum::proximity::{BvhSearch, Proximity};
    ///
    /// let floor = [Vector::new(-9.0, -9.0, -3.0), Vector::new(9.0, -9.0, -3.0), Vector::new(0.0, 9.0, -3.0)];
    /// let mut search = BvhSearch::from_triangles(&floor, &[[0, 1, 2]])?;
    /// let robot = Chain::capsules(&[Vector::ZERO, Vector::X, Vector::new(2.0, 0.0, -1.0)], &[0.5, 0.5])?;
    /// let (mut answers, mut contacts) = (Vec::new(), Vec::new());
    /// search.per_link(&robot, &Pose::IDENTITY, &mut answers)?;
    /// search.contacts(&robot, &Pose::IDENTITY, &answers, &mut contacts)?;
    /// assert_eq!(contacts[1], search.contact(&robot, &Pose::IDENTITY, &answers[1])?);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    fn contacts(
        &self,
        robot: &Chain,
        pose: &Pose,
        answers: &[LinkProximity],
        out: &mut Vec<Contact>,
    ) -> Result<(), ProximityError> {
        contacts(self.mesh(), robot, pose, answers, out)
    }

    /// How an answer's distance changes with the ends of the link, its radius and the triangle's
    /// corners, of the mesh that the engine has now. Give the same robot and pose as to the
    /// query.
    ///
    /// `None` where there is no normal, because neither side of the triangle is the robot's: see
    /// [`Contact::normal`].
    ///
    /// # Errors
    /// As [`contact`](Self::contact).
    ///
    /// ```
    /// use parry_continuum::Chain;
    /// use parry_continuum::parry::math::{Pose, Vector};
    /// use parry_continuum::proximity::{BvhSearch, Proximity};
    ///
    /// let wall = [Vector::new(-9.0, -9.0, 3.0), Vector::new(9.0, -9.0, 3.0), Vector::new(0.0, 9.0, 3.0)];
    /// let mut search = BvhSearch::from_triangles(&wall, &[[0, 1, 2]])?;
    /// let robot = Chain::capsules(&[Vector::ZERO, Vector::new(1.0, 0.0, 1.0)], &[0.5])?;
    /// let closest = search.minimum(&robot, &Pose::IDENTITY)?;
    /// let derivative = search.derivative(&robot, &Pose::IDENTITY, &closest)?.ok_or("no derivative")?;
    /// assert_eq!((derivative.start, derivative.end, derivative.radius), (Vector::ZERO, -Vector::Z, -1.0));
    /// assert_eq!(derivative.rate(Vector::X, 0.1 * Vector::Z), -0.1);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    fn derivative(
        &self,
        robot: &Chain,
        pose: &Pose,
        answer: &LinkProximity,
    ) -> Result<Option<Derivative>, ProximityError> {
        derivative(self.mesh(), robot, pose, answer)
    }

    /// The mesh's vertices as the engine has them now.
    fn vertices(&self) -> &[Vector] {
        self.mesh().vertices()
    }

    /// The mesh's triangles, each as the positions of its corners among the
    /// [`vertices`](Self::vertices).
    fn triangles(&self) -> &[[u32; 3]] {
        self.mesh().indices()
    }

    /// Moves the mesh's vertices; the triangles stay as they are. Answers given before are about
    /// the mesh as it was, and [`contact`](Self::contact) refuses those that no longer fit.
    ///
    /// The next question that this engine is asked is about the new vertices. Its clones keep the
    /// mesh that they had, and a clone made afterwards has the new one. While a clone lives
    /// that shares the mesh, the mesh and all that was built for it are copied first.
    ///
    /// The vertices are copied and what bounds them is fitted to them, on all cores, in a time that
    /// grows with the mesh. The division of the mesh into nodes stays as it was: build a new
    /// engine where the mesh has become another shape, so that searches are fast again. What
    /// else has to be built depends on the question. Where the table names something, the first
    /// such question after the move waits for it, unless [`prepare`](super::BvhSearch::prepare) is
    /// called before:
    ///
    /// | question | what is built after a move |
    /// |---|---|
    /// | [`per_link`](Self::per_link), [`minimum`](Self::minimum), [`minimum_within`](Self::minimum_within), tubes and motions | nothing |
    /// | [`clears`](Self::clears) | nothing, but where the box around the mesh has moved by several cells of a coarse grid: then which space lies on which side of the wall |
    /// | [`within`](Self::within) | which triangles are joined, if vertices that were at one place have parted or others have met: that is compared once, over all vertices; and near the robot where neighbours of triangles are |
    /// | [`side`](super::BvhSearch::side), [`clears_inside`](super::BvhSearch::clears_inside) | what each part of the mesh is from far away |
    /// | any, about what single precision does not resolve | nothing: a second hierarchy that was built is fitted too, which made the move take two to three times as long |
    ///
    /// The places of the last answers stay, and the next searches start there. The distances that
    /// were known are dropped.
    ///
    /// [`Exhaustive`](super::Exhaustive) refills its blocks of triangles, and the GPU's engine
    /// sends the vertices with the next query.
    ///
    /// # Errors
    /// The number of vertices differs or one of them is not finite or out of range. The engine then
    /// keeps the old ones.
    fn set_vertices(&mut self, vertices: &[Vector]) -> Result<(), MeshError> {
        self.mesh().check_moved(vertices)?;
        self.move_vertices(vertices);
        Ok(())
    }
}

/// What an engine does itself: all else is the same for all engines, and stands in [`Proximity`].
/// Robots are placed, margins and bounds at least 0.
pub(crate) trait Engine {
    /// The mesh as it is now.
    fn mesh(&self) -> &Mesh;

    /// The closest triangle of every link, in `out`, which is empty.
    fn ask_per_link(
        &mut self,
        robot: PlacedRobot,
        out: &mut Vec<LinkProximity>,
    ) -> Result<(), ProximityError>;

    /// The closest link and triangle, if they are at most `bound` apart. Without a bound there is
    /// none only where rounding hides all distances.
    fn ask_nearest(
        &mut self,
        robot: PlacedRobot,
        bound: Real,
    ) -> Result<Option<LinkProximity>, ProximityError>;

    /// Whether every link keeps more than `margin` away.
    fn ask_clears(&mut self, robot: PlacedRobot, margin: Real) -> Result<bool, ProximityError>;

    /// The contacts that are asked for, in `out`, which is empty.
    fn ask_contacts(
        &mut self,
        robot: PlacedRobot,
        query: ContactQuery,
        out: &mut Vec<Contact>,
    ) -> Result<(), ProximityError>;

    fn ask_per_link_batch(
        &mut self,
        robots: &[(&Chain, Pose)],
        out: &mut Vec<Result<Vec<LinkProximity>, ProximityError>>,
    ) -> Result<(), ProximityError>;

    fn ask_minimum_batch(
        &mut self,
        robots: &[(&Chain, Pose)],
        out: &mut Vec<Result<LinkProximity, ProximityError>>,
    ) -> Result<(), ProximityError>;

    fn ask_clears_batch(
        &mut self,
        robots: &[(&Chain, Pose)],
        margin: Real,
        out: &mut Vec<Result<bool, ProximityError>>,
    ) -> Result<(), ProximityError>;

    /// Moves the vertices, which were checked.
    fn move_vertices(&mut self, vertices: &[Vector]);
}

/// Some triangle for the first link of a robot whose nearest no search finds.
pub(crate) fn any_triangle(mesh: &Mesh, link: &PlacedLink) -> LinkProximity {
    link.answer(0, &link.measure(0, mesh.corners(0)))
}

/// The robots of a batch in the mesh's frame, or why they are refused.
pub(crate) fn placed<'a>(
    robots: &'a [(&Chain, Pose)],
) -> impl Iterator<Item = Result<PlacedRobot<'a>, ProximityError>> {
    robots.iter().map(|(robot, pose)| PlacedRobot::new(robot, pose))
}
