//! Where and how link and wall are nearest: what a controller needs beyond two points.

use super::Witness;
use super::feature::ContactFeature;
use parry3d_f64::math::{Real, Vector};
use std::ops::{Deref, DerefMut};

/// Where a link is near a mesh, and in which direction. All in the mesh's frame and unit.
///
/// Where the two touch or overlap, the distance is 0 and both points are the same. `depth` and
/// `normal` then give the least translation that separates the link from this triangle, and
/// `fraction`, `lever`, `feature` and `kink` belong to the points that separate last. This leads
/// out of one triangle, and not out of the wall that it is part of.
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
    /// The distance with a sign. Where the two are apart it is the distance; where they overlap,
    /// minus the length of the least translation that separates the link from this triangle.
    /// It is always there, and the same as the dispatcher's `contact` gives for link and
    /// triangle.
    ///
    /// Beside the link and beyond a round cap it is the distance between axis and triangle less
    /// the radius, as long as the axis does not cross the triangle and no flat cap is nearer.
    pub depth: Option<Real>,
    /// The unit vector from the wall to the robot. Where they overlap, moving the link by `-depth`
    /// along it separates the two.
    ///
    /// Beside the link and beyond a round cap it points from the triangle to the link's axis. At a
    /// flat cap, and where the axis crosses the triangle, it points to the nearer side. There
    /// is none where the opposite way out is as short, up to rounding (16 u of the extent):
    /// the axis then lies in the plane of the triangle and meets it, and neither side is the
    /// robot's.
    pub normal: Option<Vector>,
    /// The two closest points, and where they are. The arc length is that of `fraction`.
    pub witness: Witness,
    /// From the point of the axis at `fraction` to the link's closest point, or the one that
    /// separates last. A turn of the link moves that point by this arm.
    pub lever: Vector,
    /// Whether the distance, or the depth, has a kink here: its derivative depends on the
    /// direction of the motion, and the one that is computed is that of the points named here.
    /// Up to rounding, this is where
    ///
    /// - other points are as near: an edge or a face lies along the link, or across a flat cap;
    /// - another way out is as short, where the two overlap;
    /// - the triangle has no area, so that its corners can move against one another.
    pub kink: bool,
}

impl Contact {
    /// How fast the distance changes with a joint q, or with time, while the wall stands still: the
    /// derivative of [`depth`](Self::depth), which is the [`distance`](Self::distance) where
    /// the two are apart.
    ///
    /// - `velocity` is dc/dq, the velocity of the centreline's point at
    ///   [`arc_length`](Witness::arc_length).
    /// - `angular_velocity` is how the link turns there: dt/dq = angular_velocity x t for its
    ///   direction t. A turn about the link's own axis has no effect.
    ///
    /// Both are in the mesh's frame. Beside the link and beyond a round cap only the velocity
    /// counts. At a flat cap the turn moves the closest point too:
    ///
    /// ```text
    /// normal . (velocity + angular_velocity x lever)
    /// ```
    ///
    /// `None` where there is no normal. At a [`kink`](Self::kink) this is the derivative for one of
    /// several points.
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

    /// [`rate`](Self::rate) for each joint of a robot: `jacobian(arc_length, joint)` gives velocity
    /// and angular velocity of the centreline at an arc length. `out` is cleared first, and
    /// stays empty where there is no rate.
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
