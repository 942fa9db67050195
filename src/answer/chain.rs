//! Answers about a chain: the closest places of its links, contacts, derivatives, certificates.

use super::Witness;
#[cfg(feature = "serde-serialize")]
use super::checked_fields::check_distance;
use super::checked_fields::checked_fields;
use parry3d_f64::math::{Real, Vector};

/// The place where one link of a robot is closest to a mesh, in the mesh's frame and unit.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde-serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde-serialize",
    serde(try_from = "link_proximity_fields::Fields", into = "link_proximity_fields::Fields")
)]
#[non_exhaustive]
pub struct LinkProximity {
    /// The link's index in [`Chain::links`](crate::Chain::links).
    pub link: u32,
    /// The distance between link and triangle, 0 if they touch or overlap.
    pub distance: Real,
    /// The two closest points and their places.
    pub witness: Witness,
}

impl LinkProximity {
    /// Placeholder in a batch.
    pub(crate) fn placeholder() -> Self {
        Self { link: 0, distance: Real::NAN, witness: Witness::placeholder() }
    }
}

checked_fields!(
    link_proximity_fields,
    "LinkProximity",
    LinkProximity {
        link: u32,
        distance: Real,
        #[serde(flatten)]
        witness: Witness,
    },
    |&Fields { distance, .. }| check_distance(distance)
);

/// A part of a link.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LinkFeature {
    /// The surface around the axis, between its ends.
    Side,
    /// The cap at the start, flat or round.
    StartCap,
    /// The cap at the end, flat or round.
    EndCap,
}

/// A part of a triangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TriangleFeature {
    /// The interior.
    Face,
    /// The edge from this corner (0, 1 or 2) to the next.
    Edge(u8),
    /// This corner (0, 1 or 2).
    Vertex(u8),
}

/// The features at the closest points of a link and a triangle.
///
/// ```
/// use parry_continuum::proximity::{ContactFeature, LinkFeature, TriangleFeature};
///
/// /// Whether the tip of an instrument could cut into an edge of the wall.
/// fn is_sharp(feature: ContactFeature) -> bool {
///     feature.link == LinkFeature::EndCap && !matches!(feature.triangle, TriangleFeature::Face)
/// }
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct ContactFeature {
    /// The part of the link.
    pub link: LinkFeature,
    /// The part of the triangle, up to rounding.
    pub triangle: TriangleFeature,
}

/// A place where a link is near a mesh. All fields are in the mesh's frame and unit.
///
/// If the two touch or overlap, `distance` is 0 and both points are the same. `depth` and `normal`
/// then give the least translation that separates the link from this triangle. `fraction`, `lever`,
/// `feature` and `kink` then belong to the points that separate last. This translation leads out of
/// one triangle, not out of the wall that the triangle belongs to.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Contact {
    /// The link's index in [`Chain::links`](crate::Chain::links).
    pub link: u32,
    /// The place along the link's axis, from 0 at its start to 1 at its end.
    pub fraction: Real,
    /// The nearest parts of link and triangle.
    pub feature: ContactFeature,
    /// The distance between link and triangle, 0 if they touch or overlap.
    pub distance: Real,
    /// The signed distance: `distance` if the two are apart; otherwise minus the length of the
    /// least translation that separates the link from this triangle.
    ///
    /// It equals the `dist` of the dispatcher's `contact` for link and triangle.
    ///
    /// Beside the link and beyond a round cap it is the distance between axis and triangle, minus
    /// the radius. The exceptions are an axis that crosses the triangle, and a nearer flat cap.
    pub depth: Real,
    /// The unit vector from the wall to the robot. If the two overlap, a translation of the link by
    /// `-depth * normal` separates them.
    ///
    /// Beside the link and beyond a round cap it points from the triangle to the link's axis. At a
    /// flat cap, and if the axis crosses the triangle, it points to the nearer side. It is `None`
    /// if the opposite way out is as short, up to rounding (16 u of the extent). Then neither side
    /// is the robot's: the axis lies in the plane of the triangle and meets it, or that plane cuts
    /// the link in equal halves.
    pub normal: Option<Vector>,
    /// The two closest points and their places. The arc length belongs to `fraction`.
    pub witness: Witness,
    /// The vector from the point of the axis at `fraction` to the link's closest point, or to the
    /// point that separates last. It is the lever arm of that point in a turn of the link. Beside
    /// the link and beyond a round cap it is parallel to `normal`; in an overlap it then ends where
    /// the triangle is, inside the link, and a turn has the same rate for both points.
    pub lever: Vector,
    /// Whether the distance, or the depth, has a kink here. The derivative then depends on the
    /// direction of the motion; the computed derivative is that of the points named here. Up to
    /// rounding, a kink occurs if
    ///
    /// - other points are as near: an edge or a face lies along the link, or across a flat cap;
    /// - another way out is as short, and the two overlap;
    /// - the triangle has no area, so that its corners can move against one another.
    pub kink: bool,
}

impl Contact {
    /// The derivative of [`depth`](Self::depth) by a joint value q, or by time, while the wall
    /// rests. If the two are apart, the depth is the [`distance`](Self::distance).
    ///
    /// - `velocity` is dc/dq, the velocity of the centreline's point c at
    ///   [`arc_length`](Witness::arc_length).
    /// - `angular_velocity` is the rate of turn of the link there: dt/dq = angular_velocity x t for
    ///   its direction t. A turn about the link's own axis has no effect.
    ///
    /// Both are in the mesh's frame. Beside the link and beyond a round cap only the velocity
    /// counts. At a flat cap the turn moves the closest point too:
    ///
    /// ```text
    /// normal . (velocity + angular_velocity x lever)
    /// ```
    ///
    /// `None` if there is no normal. At a [`kink`](Self::kink) this is the derivative for one of
    /// several points.
    ///
    /// ```
    /// use parry_continuum::Chain;
    /// use parry_continuum::parry::{math::{Pose, Vector}, shape::TriMesh};
    /// use parry_continuum::proximity::{BvhSearch, Proximity};
    ///
    /// let wall =
    ///     [Vector::new(-9.0, 0.0, 3.0), Vector::new(9.0, 0.0, 3.0), Vector::new(0.0, 9.0, 4.0)];
    /// let mesh = TriMesh::new(wall.to_vec(), vec![[0, 1, 2]])?;
    /// let mut search = BvhSearch::new(&mesh)?;
    /// // One link with flat caps, turned by q about the x axis through its base.
    /// let robot = |q: f64| {
    ///     Chain::from_centreline(&[Vector::ZERO, Vector::new(0.0, -q.sin(), q.cos())], &[0.5])
    /// };
    /// let q = 0.2;
    /// let closest = search.minimum(&robot(q)?, &Pose::IDENTITY)?;
    /// let contact = search.contact_of(&robot(q)?, &Pose::IDENTITY, &closest)?;
    /// let tangent = Vector::new(0.0, -q.sin(), q.cos());
    /// let rate = contact
    ///     .rate(Vector::X.cross(contact.witness.arc_length * tangent), Vector::X)
    ///     .ok_or("no normal")?;
    /// let mut distance = |q: f64| -> Result<f64, Box<dyn std::error::Error>> {
    ///     Ok(search.minimum(&robot(q)?, &Pose::IDENTITY)?.distance)
    /// };
    /// assert!((rate - (distance(q + 1e-6)? - distance(q - 1e-6)?) / 2e-6).abs() < 1e-8);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn rate(&self, velocity: Vector, angular_velocity: Vector) -> Option<Real> {
        Some(self.normal?.dot(velocity + angular_velocity.cross(self.lever)))
    }

    /// [`rate`](Self::rate) for each joint of a robot.
    ///
    /// `jacobian(arc_length, joint)` returns the velocity and the angular velocity of the
    /// centreline at an arc length. `out` is cleared first; it stays empty if there is no normal.
    ///
    /// ```
    /// # use parry_continuum::Chain;
    /// # use parry_continuum::parry::{math::{Pose, Vector}, shape::TriMesh};
    /// # use parry_continuum::proximity::{BvhSearch, Proximity};
    /// # let wall = [[-9.0, -9.0, 3.0], [9.0, -9.0, 3.0], [0.0, 9.0, 3.0]].map(Vector::from_array);
    /// # let mesh = TriMesh::new(wall.to_vec(), vec![[0, 1, 2]])?;
    /// # let robot = Chain::from_centreline(&[Vector::ZERO, Vector::Z], &[0.5])?;
    /// # let mut search = BvhSearch::new(&mesh)?;
    /// # let closest = search.minimum(&robot, &Pose::IDENTITY)?;
    /// # let contact = search.contact_of(&robot, &Pose::IDENTITY, &closest)?;
    /// // A straight robot. Joint 0 moves it along z, joint 1 turns it about x.
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
            let (velocity, angular_velocity) = jacobian(self.witness.arc_length, joint);
            self.rate(velocity, angular_velocity)
        }));
    }
}

/// The derivative of a link's distance from a triangle by the axis ends, the radius and the
/// corners, in the mesh's frame.
///
/// If the two overlap, it is the derivative of [`depth`](super::Contact::depth), minus the least
/// translation.
///
/// # Definitions
/// - n: the normal, from triangle to link.
/// - f: the fraction along the axis at the link's closest point.
/// - w: the barycentric coordinates of the triangle's closest point.
/// - L, a: the length of the axis, and its unit direction.
/// - l: the lever, from the axis to the link's closest point.
///
/// If the two overlap, the points that separate last replace the closest points.
///
/// # Formulas
/// By the envelope theorem the closest points count as they are, not how they move. So the distance
/// grows by n times the motion of the link's closest point, minus n times the motion of the
/// triangle's closest point:
///
/// | derivative by | beside the link, or beyond a round cap | beyond a flat cap |
/// |---|---|---|
/// | `start` | (1 - f) n | (1 - f) n + (n . a) l / L |
/// | `end` | f n | f n - (n . a) l / L |
/// | `radius` | -1 | -abs(n x a) |
/// | `vertices[i]` | -w_i n | -w_i n |
///
/// The second term for a flat cap is its lever: the cap turns with the axis. The radius counts at
/// the rim alone, because n is parallel to a if the closest point lies inside the cap.
///
/// # Rounding
/// The derivative is computed with about 32 digits and rounded at the end. If a flat cap or a
/// crossing axis decides the way out, it is computed with 16 digits.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Derivative {
    /// By the start of the axis.
    pub start: Vector,
    /// By the end of the axis.
    pub end: Vector,
    /// By the radius.
    pub radius: Real,
    /// By the triangle's corners.
    pub vertices: [Vector; 3],
    /// Whether the distance has a kink here, as [`Contact::kink`](super::Contact::kink). The fields
    /// are then the derivatives for one of the equally near points.
    pub kink: bool,
}

impl Derivative {
    /// The rate of change of the distance if the ends of the link's axis move with these
    /// velocities, in the mesh's frame.
    pub fn rate(&self, start: Vector, end: Vector) -> Real {
        self.start.dot(start) + self.end.dot(end)
    }
}

/// Bounds on a distance that include all rounding: `lower <= true <= upper`.
///
/// The true distance is from the placed link to the triangle or to another link. The placed link
/// has the axis ends `pose * start` and `pose * end`, both computed in `f64`, and the radius as
/// given.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde-serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde-serialize",
    serde(try_from = "certificate_fields::Fields", into = "certificate_fields::Fields")
)]
#[non_exhaustive]
pub struct Certificate {
    /// Lower bound on the distance, in the unit of the shapes.
    pub lower: Real,
    /// Upper bound on the distance.
    pub upper: Real,
}

checked_fields!(
    certificate_fields,
    "Certificate",
    Certificate { lower: Real, upper: Real },
    |&Fields { lower, upper }| {
        if !(0.0 <= lower && lower <= upper && upper.is_finite()) {
            return Err(format!("{lower} to {upper} bounds no distance"));
        }
        Ok(())
    }
);
