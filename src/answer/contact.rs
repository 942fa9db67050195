//! Where and how link and wall are nearest: what a controller needs beyond two points.

use super::Witness;
use super::feature::ContactFeature;
use parry3d_f64::math::{Real, Vector};
use std::ops::{Deref, DerefMut};

/// Where a link is near a mesh, and in which direction. All in the mesh's frame and unit.
///
/// Where the two touch or overlap the distance is 0 and both points are one. Depth and normal belong together then: they
/// are the least translation that separates the link from this triangle, and `fraction`, `lever`, `feature` and `kink` are
/// those of the points that part last. It is the way out of that triangle, and not of the wall that it is part of.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Contact {
    /// The link's position in [`Chain::links`](crate::Chain::links).
    pub link: u32,
    /// Where along the link's axis, from 0 at its start to 1 at its end.
    pub fraction: Real,
    /// Which parts of link and triangle are nearest to each other.
    pub feature: ContactFeature,
    /// The distance between link and triangle, 0 where they touch or overlap.
    pub distance: Real,
    /// The distance with a sign: where they overlap, minus the length of the least translation that separates the link
    /// from this triangle, flat caps and their rims included. Beside the link and beyond a round cap that is the distance
    /// between axis and triangle less the radius, as long as the axis does not cross the triangle and no flat cap is
    /// nearer. There is always one; it is that which the dispatcher's `contact` names for link and triangle.
    pub depth: Option<Real>,
    /// The unit vector from the wall to the robot. Where they overlap a translation of the link by `-depth` along it
    /// separates the two. Beside the link and beyond a round cap it leads from the triangle to the link's axis; at a flat
    /// cap, and where the axis crosses the triangle, to the side that is nearer. There is none where the opposite way out
    /// is as short, as far as rounding can tell (16 u of the extent): where the axis lies in the plane of the triangle and
    /// meets it, neither side is the robot's.
    pub normal: Option<Vector>,
    /// The two closest points, and where they are. The arc length is that of `fraction`.
    pub witness: Witness,
    /// From the point of the axis at `fraction` to the link's closest point, or the one that parts last: the arm on which
    /// a turn of the link moves that point.
    pub lever: Vector,
    /// Whether other points of the two are as near, as far as rounding can tell: an edge or a face along the link, or
    /// one across a flat cap; or, where they overlap, another way out is as short. The distance, or the depth, then has a
    /// kink: its derivative depends on the direction of the motion, and what is computed is that for one of the points. A
    /// triangle without area counts as one too, because its corners can move against one another.
    pub kink: bool,
}

impl Contact {
    /// How fast the distance changes with a joint q, or with time: the derivative of [`depth`](Self::depth), which is the
    /// [`distance`](Self::distance) where they are apart. The wall stands still.
    ///
    /// `velocity` is dc/dq, that of the centreline's point at [`arc_length`](Witness::arc_length), and `angular_velocity`
    /// is how the link turns there, dt/dq = angular_velocity x t for its direction t; both in the mesh's frame. A turn
    /// about the link's own axis has no effect. Beside the link and beyond a round cap only the velocity counts; at a
    /// flat cap the turn moves the closest point on its lever:
    ///
    /// ```text
    /// normal . (velocity + angular_velocity x lever)
    /// ```
    ///
    /// There is none where there is no normal. At a [`kink`](Self::kink) it is the derivative for one of the points that
    /// are as near.
    ///
    /// ```
    /// use parry_continuum::Chain;
    /// use parry_continuum::parry::{math::{Pose, Vector}, shape::TriMesh};
    /// use parry_continuum::proximity::{BvhSearch, Proximity};
    ///
    /// let wall = [Vector::new(-9.0, 0.0, 3.0), Vector::new(9.0, 0.0, 3.0), Vector::new(0.0, 9.0, 4.0)];
    /// let mesh = TriMesh::new(wall.to_vec(), vec![[0, 1, 2]])?;
    /// let mut search = BvhSearch::new(&mesh)?;
    /// // One link with flat caps that turns about the x axis through its base, by q.
    /// let robot = |q: f64| Chain::from_centreline(&[Vector::ZERO, Vector::new(0.0, -q.sin(), q.cos())], &[0.5]);
    /// let q = 0.2;
    /// let closest = search.minimum(&robot(q)?, &Pose::IDENTITY)?;
    /// let contact = search.contact(&robot(q)?, &Pose::IDENTITY, &closest)?;
    /// let tangent = Vector::new(0.0, -q.sin(), q.cos());
    /// let rate = contact.rate(Vector::X.cross(contact.arc_length * tangent), Vector::X).ok_or("no normal")?;
    /// let mut distance = |q: f64| -> Result<f64, Box<dyn std::error::Error>> {
    ///     Ok(search.minimum(&robot(q)?, &Pose::IDENTITY)?.distance)
    /// };
    /// assert!((rate - (distance(q + 1e-6)? - distance(q - 1e-6)?) / 2e-6).abs() < 1e-8);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn rate(&self, velocity: Vector, angular_velocity: Vector) -> Option<Real> {
        Some(self.normal?.dot(velocity + angular_velocity.cross(self.lever)))
    }

    /// [`rate`](Self::rate) for each joint of a robot: `jacobian(arc_length, joint)` gives velocity and angular velocity
    /// of the centreline at an arc length. `out` is cleared first, and stays empty where there is no rate.
    ///
    /// ```
    /// # use parry_continuum::Chain;
    /// # use parry_continuum::parry::{math::{Pose, Vector}, shape::TriMesh};
    /// # use parry_continuum::proximity::{BvhSearch, Proximity};
    /// # let wall = [Vector::new(-9.0, -9.0, 3.0), Vector::new(9.0, -9.0, 3.0), Vector::new(0.0, 9.0, 3.0)];
    /// # let mesh = TriMesh::new(wall.to_vec(), vec![[0, 1, 2]])?;
    /// # let robot = Chain::from_centreline(&[Vector::ZERO, Vector::Z], &[0.5])?;
    /// # let mut search = BvhSearch::new(&mesh)?;
    /// # let closest = search.minimum(&robot, &Pose::IDENTITY)?;
    /// # let contact = search.contact(&robot, &Pose::IDENTITY, &closest)?;
    /// // A straight robot that moves along z by joint 0 and turns about x by joint 1.
    /// let mut rates = Vec::new();
    /// contact.gradient(2, |arc_length, joint| match joint {
    ///     0 => (Vector::Z, Vector::ZERO),
    ///     _ => (Vector::X.cross(arc_length * Vector::Z), Vector::X),
    /// }, &mut rates);
    /// assert_eq!(rates[0], -1.0);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn gradient(
        &self,
        joints: usize,
        mut jacobian: impl FnMut(Real, usize) -> (Vector, Vector),
        out: &mut Vec<Real>,
    ) {
        out.clear();
        out.extend((0..joints).filter_map(|joint| {
            let (velocity, angular_velocity) = jacobian(self.arc_length, joint);
            self.rate(velocity, angular_velocity)
        }));
    }
}

impl Deref for Contact {
    type Target = Witness;

    fn deref(&self) -> &Witness {
        &self.witness
    }
}

impl DerefMut for Contact {
    fn deref_mut(&mut self) -> &mut Witness {
        &mut self.witness
    }
}
