//! The trait of all engines: proximity queries between a robot and one mesh.
//!
//! [`Proximity`] is the public interface. It checks the arguments, places the robot and clears
//! `out`. [`Engine`] holds the part that each engine implements itself.
use crate::answer::{Contact, Derivative, LinkProximity, MeshError, ProximityError};
use crate::mesh::Mesh;
use crate::pair::{PlacedLink, PlacedRobot, contact, contacts, derivative};
use crate::query::contacts::ContactQuery;
use crate::query::{check_bound, check_margin, check_not_negative};
use crate::robot::Chain;
use parry3d_f64::math::{Pose, Real, Vector};

/// An engine that answers proximity queries between a robot and the mesh it was built for.
///
/// `pose` is the robot's pose in the mesh's frame. Answers are in the mesh's frame too. Distances,
/// margins and bounds are in its unit of length. Distances are to the mesh's surface and unsigned:
/// a link that touches nothing may be on either side of the mesh.
///
/// All engines return the same distances. [`BvhSearch`](super::BvhSearch) and
/// [`Exhaustive`](super::Exhaustive) break ties alike, on any number of threads: the lowest
/// triangle of equally close ones, then the lowest link.
///
/// The batch methods answer many robots, such as a planner's samples, on all cores. Each robot has
/// its own `Result`, in the order given: one bad robot does not fail the batch.
///
/// A query that returns an error leaves `out` empty.
///
/// The trait is sealed: only this crate implements it.
#[allow(private_bounds)]
pub trait Proximity: Engine {
    /// Finds the closest triangle of every link, in link order.
    ///
    /// `out` is cleared first.
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

    /// Returns the closest link of the whole robot and its closest triangle. Of equal distances the
    /// lowest triangle counts, then the lowest link.
    ///
    /// # Errors
    /// The pose is not finite, or it moves a link out of range.
    fn minimum(&mut self, robot: &Chain, pose: &Pose) -> Result<LinkProximity, ProximityError> {
        let robot = PlacedRobot::new(robot, pose)?;
        let found = self.ask_nearest(robot, Real::INFINITY)?;
        Ok(found.unwrap_or_else(|| any_triangle(self.mesh(), &robot.link(0))))
    }

    /// Returns the closest link and triangle if they are at most `bound` apart.
    ///
    /// The answer is that of [`minimum`](Proximity::minimum). If nothing is within the bound, the
    /// query is cheaper. To search several meshes, pass the best distance so far as the bound of
    /// the next one:
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
    /// // A wall with a margin of 0.5 mm, and a vessel with a margin of 2 mm.
    /// let mut anatomy = [(ball(Vector::ZERO, 10.0)?, 0.5), (ball(Vector::X * 6.0, 1.0)?, 2.0)];
    /// let robot = Chain::from_centreline(&[Vector::ZERO, Vector::Z * 6.0], &[0.5])?;
    ///
    /// // The least slack (distance - margin), and its place.
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
    /// If `bound` is negative, the answer is `None` without a search. The bound of the example is
    /// negative if another margin is violated by more than `margin`: this mesh cannot be tighter.
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

    /// Returns whether the robot is farther than `margin` from the mesh.
    ///
    /// Equal to `minimum().distance > margin`, at lower cost.
    ///
    /// # Errors
    /// The margin is negative or NaN, the pose is not finite, or it moves a link out of range.
    fn clears(&mut self, robot: &Chain, pose: &Pose, margin: Real) -> Result<bool, ProximityError> {
        check_margin(margin)?;
        self.ask_clears(PlacedRobot::new(robot, pose)?, margin)
    }

    /// Finds every contact at most `margin` away, by link and then by distance.
    ///
    /// A contact is a local minimum of the distance between a link and the mesh. A place of the
    /// mesh is a local minimum for a link if every path on the mesh to a nearer place first leads
    /// farther away. `out` is cleared first.
    ///
    /// - A wall that bends towards the link is one contact, however many triangles it has.
    /// - A link in a narrow lumen has a contact on each side.
    /// - A region of the wall at constant distance, up to rounding, is one contact.
    /// - A connected region of the wall inside the link is one contact. It names the triangle
    ///   nearest to the axis.
    /// - If the closest point of [`per_link`](Proximity::per_link) is within the margin, it is a
    ///   contact. An equally near place in the same region of the wall may replace it.
    ///
    /// Triangles are neighbours if they have corners at the same place, whether they share an index
    /// or not. They are neighbours, too, where open edges touch within 32 u times the largest
    /// coordinate (u is 2^-53): at a corner on an edge (a T-vertex), and at a seam of rounding. An
    /// edge is open if no second triangle continues the wall there. The page on
    /// [limits](crate::book::limits) has more.
    ///
    /// ```
    /// use parry_continuum::Chain;
    /// use parry_continuum::parry::{math::{Pose, Vector}, shape::{Ball, TriMesh}};
    /// use parry_continuum::proximity::{BvhSearch, Proximity};
    ///
    /// // A bump below the robot and one above it.
    /// let (ball, triangles) = Ball::new(1.0).to_trimesh(32, 16);
    /// let vertices =
    ///     [-3.0, 2.5].map(|z| ball.iter().map(move |v| v + Vector::Z * z)).into_iter().flatten();
    /// let count = ball.len() as u32;
    /// let other = triangles.iter().map(|corners| corners.map(|corner| corner + count));
    /// let indices = triangles.iter().copied().chain(other).collect();
    /// let mut search = BvhSearch::new(&TriMesh::new(vertices.collect(), indices)?)?;
    /// let robot = Chain::from_centreline(&[-Vector::X, Vector::X], &[0.5])?;
    /// let mut contacts = Vec::new();
    /// search.contacts_within(&robot, &Pose::IDENTITY, 2.0, 0.0, &mut contacts)?;
    /// assert_eq!(contacts.len(), 2);
    /// assert!(contacts[0].normal.is_some_and(|normal| (normal + Vector::Z).length() < 0.2));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Prominence
    /// A rough wall has a contact at each of its bumps. The prominence of a contact is the rise of
    /// the distance along the best path on the mesh to a nearer contact that is reported and whose
    /// normal is within 60 degrees. The prominence is infinite if every such path leaves the
    /// margin. `prominence` is the least prominence of a reported contact, in the mesh's unit. With
    /// 0 every local minimum is a contact. For a surface made of voxels, the size of a voxel leaves
    /// a few contacts per link.
    ///
    /// The filter loses no wall at any prominence:
    ///
    /// - Each connected region of the wall within the margin keeps its nearest contact.
    /// - Contacts whose normals differ by more than 60 degrees are never merged. So both sides of a
    ///   groove stay.
    /// - So each contact that is dropped is represented by a nearer one. That contact pushes the
    ///   link in a direction within 60 degrees.
    /// - A contact without a [`normal`](Contact::normal) stays.
    ///
    /// The filter does not change a contact that it keeps. A smaller margin may yield more contacts
    /// within it, because a path that leaves the margin joins nothing.
    ///
    /// # Errors
    /// The margin or the prominence is negative or NaN, the pose is not finite, or it moves a link
    /// out of range.
    fn contacts_within(
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

    /// [`per_link`](Self::per_link) for many robots.
    ///
    /// Writes one result per robot to `out`, in order, and reuses the inner vectors of `out`.
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

    /// [`minimum`](Self::minimum) for many robots.
    ///
    /// Writes one result per robot to `out`, in order.
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

    /// [`clears`](Self::clears) for many robots, with one margin.
    ///
    /// Writes one result per robot to `out`, in order.
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

    /// Returns the contact of an answer: its normal, its place on the robot and its nearest
    /// features.
    ///
    /// The contact is about the mesh as the engine has it now. Give the same robot and pose as to
    /// the query.
    ///
    /// # Errors
    /// - The answer's link or triangle does not exist.
    /// - The pose is not finite, or it moves the link out of range.
    /// - The answer does not fit link and triangle: the robot or the pose is another one, or the
    ///   mesh has moved since. An answer fits if its error is at most 16 u (c + d). Here u = 2^-53,
    ///   c is the largest coordinate of the two, and d is their extent.
    ///
    /// ```
    /// use parry_continuum::Chain;
    /// use parry_continuum::parry::{math::{Pose, Vector}, shape::TriMesh};
    /// use parry_continuum::proximity::{BvhSearch, LinkFeature, Proximity, TriangleFeature};
    ///
    /// let floor = [
    ///     Vector::new(-9.0, -9.0, -3.0),
    ///     Vector::new(9.0, -9.0, -3.0),
    ///     Vector::new(0.0, 9.0, -3.0),
    /// ];
    /// let mut search = BvhSearch::from_triangles(&floor, &[[0, 1, 2]])?;
    /// let robot =
    ///     Chain::capsules(&[Vector::ZERO, Vector::X, Vector::new(2.0, 0.0, -1.0)], &[0.5, 0.5])?;
    /// let closest = search.minimum(&robot, &Pose::IDENTITY)?;
    /// let contact = search.contact_of(&robot, &Pose::IDENTITY, &closest)?;
    /// assert_eq!((contact.link, contact.fraction, contact.normal), (1, 1.0, Some(Vector::Z)));
    /// assert_eq!(contact.feature.link, LinkFeature::EndCap);
    /// assert_eq!(contact.feature.triangle, TriangleFeature::Face);
    /// assert!((contact.witness.arc_length - (1.0 + 2.0_f64.sqrt())).abs() < 1e-15);
    /// // The floor has moved, so the old answer no longer fits.
    /// search.set_vertices(&floor.map(|corner| corner - Vector::Z))?;
    /// assert!(search.contact_of(&robot, &Pose::IDENTITY, &closest).is_err());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    fn contact_of(
        &self,
        robot: &Chain,
        pose: &Pose,
        answer: &LinkProximity,
    ) -> Result<Contact, ProximityError> {
        contact(self.mesh(), robot, pose, answer)
    }

    /// [`contact_of`](Self::contact_of) for every answer, in order.
    ///
    /// One call takes a fraction of the time of single calls, because it computes several contacts
    /// at once. `out` is cleared first.
    ///
    /// # Errors
    /// The error of the first answer that has one; `out` is then empty.
    ///
    /// ```
    /// use parry_continuum::Chain;
    /// use parry_continuum::parry::math::{Pose, Vector};
    /// use parry_continuum::proximity::{BvhSearch, Proximity};
    ///
    /// let floor = [
    ///     Vector::new(-9.0, -9.0, -3.0),
    ///     Vector::new(9.0, -9.0, -3.0),
    ///     Vector::new(0.0, 9.0, -3.0),
    /// ];
    /// let mut search = BvhSearch::from_triangles(&floor, &[[0, 1, 2]])?;
    /// let robot =
    ///     Chain::capsules(&[Vector::ZERO, Vector::X, Vector::new(2.0, 0.0, -1.0)], &[0.5, 0.5])?;
    /// let (mut answers, mut contacts) = (Vec::new(), Vec::new());
    /// search.per_link(&robot, &Pose::IDENTITY, &mut answers)?;
    /// search.contacts_of(&robot, &Pose::IDENTITY, &answers, &mut contacts)?;
    /// assert_eq!(contacts[1], search.contact_of(&robot, &Pose::IDENTITY, &answers[1])?);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    fn contacts_of(
        &self,
        robot: &Chain,
        pose: &Pose,
        answers: &[LinkProximity],
        out: &mut Vec<Contact>,
    ) -> Result<(), ProximityError> {
        contacts(self.mesh(), robot, pose, answers, out)
    }

    /// Returns the derivative of an answer's distance by the ends of the link, its radius and the
    /// triangle's corners.
    ///
    /// The derivative is about the mesh as the engine has it now. Give the same robot and pose as
    /// to the query. `None` if the contact has no normal, because neither side of the triangle is
    /// the robot's: see [`Contact::normal`].
    ///
    /// # Errors
    /// As [`contact_of`](Self::contact_of).
    ///
    /// ```
    /// use parry_continuum::Chain;
    /// use parry_continuum::parry::math::{Pose, Vector};
    /// use parry_continuum::proximity::{BvhSearch, Proximity};
    ///
    /// let wall =
    ///     [Vector::new(-9.0, -9.0, 3.0), Vector::new(9.0, -9.0, 3.0), Vector::new(0.0, 9.0, 3.0)];
    /// let mut search = BvhSearch::from_triangles(&wall, &[[0, 1, 2]])?;
    /// let robot = Chain::capsules(&[Vector::ZERO, Vector::new(1.0, 0.0, 1.0)], &[0.5])?;
    /// let closest = search.minimum(&robot, &Pose::IDENTITY)?;
    /// let derivative =
    ///     search.derivative(&robot, &Pose::IDENTITY, &closest)?.ok_or("no derivative")?;
    /// assert_eq!(
    ///     (derivative.start, derivative.end, derivative.radius),
    ///     (Vector::ZERO, -Vector::Z, -1.0)
    /// );
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

    /// The mesh's triangles, each as three indices into [`vertices`](Self::vertices).
    fn triangles(&self) -> &[[u32; 3]] {
        self.mesh().indices()
    }

    /// Moves the mesh's vertices and keeps its triangles.
    ///
    /// `vertices` has one position per vertex, in the mesh's frame. Earlier answers are about the
    /// old mesh; [`contact_of`](Self::contact_of) refuses answers that no longer fit.
    ///
    /// The next query uses the new vertices. Clones made before keep the old mesh; clones made
    /// afterwards have the new one. If a clone shares the mesh, the engine first copies the mesh
    /// and everything built for it.
    ///
    /// The call copies the vertices and refits the bounding volumes on all cores. Its time grows
    /// with the mesh. The tree keeps its topology: build a new engine if the shape has changed
    /// much, so that searches stay fast. Some queries need further structures. The first such query
    /// after a move builds them, unless [`prepare`](super::BvhSearch::prepare) has done so:
    ///
    /// - [`per_link`](Self::per_link), [`minimum`](Self::minimum),
    ///   [`minimum_within`](Self::minimum_within), tubes and motions: nothing.
    /// - [`clears`](Self::clears): the grid of the sides of the wall, only if the bounding box has
    ///   moved by several cells of the grid.
    /// - [`contacts_within`](Self::contacts_within): one pass over all vertices finds vertices that
    ///   have met or parted, and one over open edges finds where they touch. If there are any, the
    ///   query also builds which triangles are joined. Near the robot it builds the neighbours of
    ///   triangles.
    /// - [`side`](super::BvhSearch::side), [`clears_inside`](super::BvhSearch::clears_inside): the
    ///   far field of each node.
    /// - Any query, if single precision is too coarse: the second hierarchy, unless it was built
    ///   before. If it was, the move itself refits it, and takes two to three times as long.
    ///
    /// The engine keeps the places of its last answers as seeds of the next searches. It drops the
    /// cached distances.
    ///
    /// [`Exhaustive`](super::Exhaustive) refills its blocks of triangles. The engines on the GPU
    /// send the vertices with the next query.
    ///
    /// # Errors
    /// The number of vertices differs, or a vertex is not finite or out of range. The engine then
    /// keeps the old vertices.
    fn set_vertices(&mut self, vertices: &[Vector]) -> Result<(), MeshError> {
        self.mesh().check_moved(vertices)?;
        self.move_vertices(vertices);
        Ok(())
    }
}

/// The part of an engine that is its own. [`Proximity`] holds the part that all engines share.
///
/// The robots are placed; margins and bounds are at least 0.
pub(crate) trait Engine {
    /// The mesh as it is now.
    fn mesh(&self) -> &Mesh;

    /// Appends the closest triangle of every link to `out`, which is empty.
    fn ask_per_link(
        &mut self,
        robot: PlacedRobot,
        out: &mut Vec<LinkProximity>,
    ) -> Result<(), ProximityError>;

    /// Returns the closest link and triangle if they are at most `bound` apart.
    ///
    /// With an infinite bound, `None` occurs only if rounding hides all distances.
    fn ask_nearest(
        &mut self,
        robot: PlacedRobot,
        bound: Real,
    ) -> Result<Option<LinkProximity>, ProximityError>;

    /// Returns whether every link is farther than `margin` from the mesh.
    fn ask_clears(&mut self, robot: PlacedRobot, margin: Real) -> Result<bool, ProximityError>;

    /// Appends the contacts of `query` to `out`, which is empty.
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

    /// Moves the vertices, which [`Proximity::set_vertices`] has checked.
    fn move_vertices(&mut self, vertices: &[Vector]);
}

/// Returns the first link with triangle 0, for a robot whose closest triangle no search finds.
pub(crate) fn any_triangle(mesh: &Mesh, link: &PlacedLink) -> LinkProximity {
    link.answer(0, &link.measure(0, mesh.corners(0)))
}

/// Places the robots of a batch in the mesh's frame; an element is the error of a bad robot.
#[cfg(feature = "exhaustive")]
pub(crate) fn placed<'a>(
    robots: &'a [(&Chain, Pose)],
) -> impl Iterator<Item = Result<PlacedRobot<'a>, ProximityError>> {
    robots.iter().map(|(robot, pose)| PlacedRobot::new(robot, pose))
}
